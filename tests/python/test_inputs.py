"""What the calls take: arrays of any layout and type that NumPy can read, and what they refuse."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import lightband

TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


@settings(deadline=None, max_examples=25)
@given(
    hnp.arrays(
        np.float32, st.tuples(st.integers(1, 9), st.integers(1, 9), st.just(3)), elements=st.floats(0, 1e4, width=32)
    )
)
def test_any_map_comes_back_as_it_was_given(context: lightband.Context, radiance: Any) -> None:
    np.testing.assert_array_equal(context.environment(radiance).radiance, radiance)


@pytest.mark.parametrize(
    "rearrange",
    [
        lambda a: np.asfortranarray(a),
        lambda a: np.repeat(a, 2, axis=1)[:, ::2],
        lambda a: a[::-1][::-1],
        lambda a: np.moveaxis(np.moveaxis(a, 2, 0).copy(), 0, 2),
        lambda a: a.astype(np.float64),
        lambda a: a.astype(">f4"),
        lambda a: a.astype(np.float16).astype(np.float32),
        lambda a: a.tolist(),
    ],
    ids=["column-major", "strided", "reversed", "planar", "float64", "big-endian", "float16", "list"],
)
def test_layout_and_type_do_not_matter(context: lightband.Context, rearrange: Callable[[Any], Any]) -> None:
    radiance = np.arange(4 * 5 * 3, dtype=np.float32).reshape(4, 5, 3)
    np.testing.assert_array_equal(context.environment(rearrange(radiance)).radiance, radiance)


def test_the_given_array_is_copied(context: lightband.Context) -> None:
    radiance = np.ones((2, 4, 3), np.float32)
    environment = context.environment(radiance)
    radiance[...] = 5
    assert (environment.radiance == 1).all()


@pytest.mark.parametrize("indices", [np.array([[0, 1, 2]], t) for t in (np.int8, np.int64, np.uint32, np.uint64)])
def test_indices_of_any_integer_type(context: lightband.Context, indices: Any) -> None:
    stats = context.mesh(TRIANGLE, indices).stats
    assert (stats.vertices, stats.triangles, stats.dropped_triangles) == (3, 1, 0)
    assert stats.bounds_min == (0, 0, 0) and stats.bounds_max == (1, 1, 0)


def test_triangles_of_no_area_are_counted(context: lightband.Context) -> None:
    assert context.mesh(TRIANGLE, [[0, 1, 2], [0, 1, 1]]).stats.dropped_triangles == 1


def test_normals_and_texcoords(context: lightband.Context) -> None:
    mesh = context.mesh(TRIANGLE, [[0, 1, 2]], normals=[[0, 0, 1]] * 3, texcoords=np.zeros((3, 2)))
    assert mesh.stats.triangles == 1


@pytest.mark.parametrize(
    "transform", [np.eye(4), np.eye(4)[:3], np.eye(4).tolist(), np.asfortranarray(np.eye(4)), None]
)
def test_transforms_of_three_and_four_rows(context: lightband.Context, transform: Any) -> None:
    scene = context.scene()
    assert scene.add(context.builtin_mesh("plane"), context.lambert(0.5), transform) == 0
    assert len(scene) == 1


def test_a_transform_moves_the_mesh(context: lightband.Context, environment: lightband.Environment) -> None:
    scene = context.scene()
    shift = np.eye(4)
    shift[:3, 3] = 0.25, 0.5, -1
    index = scene.add(context.builtin_mesh("plane"), context.lambert(0.5), shift)
    scene.environment = environment
    scene.camera((0.25, 0.5, 1), (0.25, 0.5, 0))
    frame = context.frame(9, 9, samples=4)
    frame.render(scene)
    np.testing.assert_allclose(frame.position[4, 4], (0.25, 0.5, -1), atol=1e-5)
    scene.set_transform(index, np.eye(4))
    frame.render(scene)
    np.testing.assert_allclose(frame.position[4, 4], (0.25, 0.5, 0), atol=1e-5)


def test_only_the_front_of_an_instance(context: lightband.Context, environment: lightband.Environment) -> None:
    """A plane faces +Z: its back is drawn unless it is left out, mirrored or not; and computed shapes that are closed look the same."""
    scene = context.scene()
    scene.environment = environment
    front, back = ((0, 0, 2), (0, 0, 0)), ((0, 0, -2), (0, 0, 0))
    frame = context.frame(16, 16, samples=4)

    def covered(camera: tuple[tuple[int, ...], tuple[int, ...]]) -> int:
        scene.camera(*camera)
        frame.render(scene)
        return frame.stats.covered_pixels

    index = scene.add(context.builtin_mesh("plane"), context.lambert(0.5))
    both = covered(front)
    assert both > 0 and covered(back) == both
    scene.set_double_sided(index, False)
    assert covered(front) == both and covered(back) == 0
    for mirrored in (np.diag((-1, 1, 1)), np.diag((1, -1, 1))):
        scene.set_transform(index, np.hstack([mirrored, np.zeros((3, 1))]))
        assert covered(front) == both and covered(back) == 0
    scene.set_transform(index, np.hstack([np.diag((1, 1, -1)), np.zeros((3, 1))]))  # the plane's own front looks away
    assert covered(front) == 0 and covered(back) == both

    # Fine enough that no pixel's centre lies on an edge of the silhouette, where front and back are equally near.
    for shape in ("sphere", "torus", "knot", "blob"):
        pictures = []
        for double_sided in (True, False):
            closed = context.scene()
            closed.environment = environment
            closed.camera((1, 1, 2), (0, 0, 0))
            closed.add(context.builtin_mesh(shape), context.lambert(0.5), double_sided=double_sided)
            frame.render(closed)
            pictures.append((frame.material, frame.normal, frame.color))
        for seen, expected in zip(*pictures):
            np.testing.assert_array_equal(seen, expected)


@pytest.mark.parametrize("normal", [1.0, -1.0])
def test_the_side_that_is_seen(context: lightband.Context, environment: lightband.Environment, normal: float) -> None:
    """Of a square in the plane z = 0 the normal that shows lies towards the eye, wherever that is and whatever the mesh says."""
    square = np.array([(x, y, 0) for y in (-1, 1) for x in (-1, 1)], np.float32)
    mesh = context.mesh(square, [(0, 1, 2), (2, 1, 3)], np.tile(np.float32((0, 0, normal)), (4, 1)))
    scene = context.scene()
    scene.environment = environment
    scene.add(mesh, context.lambert(0.5))
    frame = context.frame(31, 17, samples=4)
    level = [((x, y, height), (0, 0, 0)) for height in (3, 0.3, 0.03) for x, y in ((0, 0), (1, 0.5), (-2, 1))]
    upwards = [((-2, 1, 0.3), (0, 0, 0.7)), ((0.9, 0, 0.03), (0, 0, 0.1))]  # the lower rays meet what lies behind the picture's plane
    for eye, target in level + upwards:
        for side in (1, -1):
            mirrored = np.array((1, 1, side))
            scene.camera(eye * mirrored, target * mirrored, up=(0.1, 1, 0.2), fov_y=1.4)
            frame.render(scene)
            seen = frame.material > 0
            assert seen.any() and frame.stats.bent_normals == 0
            np.testing.assert_array_equal(frame.normal[seen], np.broadcast_to((0, 0, side), (seen.sum(), 3)))


def test_one_number_is_grey(context: lightband.Context) -> None:
    up = (0, 0, 1)
    np.testing.assert_array_equal(context.lambert(0.5).evaluate(up, up), context.lambert([0.5] * 3).evaluate(up, up))
    np.testing.assert_array_equal(context.ggx(0.5, 0.9).evaluate(up, up), context.ggx(0.5, [0.9] * 3).evaluate(up, up))


def test_evaluate_broadcasts(context: lightband.Context) -> None:
    brdf = context.ggx(0.3, (0.9, 0.5, 0.1))
    wi = np.random.default_rng(1).normal(size=(4, 1, 3))
    wo = np.random.default_rng(2).normal(size=(5, 3))
    values = brdf.evaluate(wi, wo)
    assert values.shape == (4, 5, 3) and values.dtype == np.float32
    for i in range(4):
        for j in range(5):
            np.testing.assert_array_equal(values[i, j], brdf.evaluate(wi[i, 0], wo[j]))


def test_lambert_is_albedo_over_pi(context: lightband.Context) -> None:
    value = context.lambert([0.2, 0.4, 0.6]).evaluate((0, 0, 1), (1, 0, 1))
    np.testing.assert_allclose(value, np.array([0.2, 0.4, 0.6]) / np.pi, rtol=1e-6)


def test_albedo_takes_numbers_and_arrays(context: lightband.Context) -> None:
    brdf = context.lambert(0.5)
    assert brdf.albedo(0.3).shape == (3,)
    assert brdf.albedo([[0, 0.5], [1, 1.5]]).shape == (2, 2, 3)
    np.testing.assert_allclose(brdf.albedo([0, 1]), 0.5, rtol=1e-4)


NO_FILE = "/nonexistent/file"

# (call, class, what the message must name)
REFUSED: list[tuple[str, type[Exception], str]] = [
    ("context.load_brdf(NO_FILE)", lightband.FileError, NO_FILE),
    ("context.load_environment(NO_FILE)", lightband.FileError, NO_FILE),
    ("context.load_brdf(__file__)", lightband.FormatError, "test_inputs"),
    ("context.load_environment(__file__)", lightband.FormatError, "test_inputs"),
    ("context.load_brdf('a\\0b')", lightband.InvalidArgument, "path.*null byte"),
    ("context.builtin_brdf('unobtainium')", lightband.InvalidArgument, "unobtainium"),
    ("context.builtin_brdf('a\\0b')", lightband.InvalidArgument, "zero byte"),
    ("context.builtin_brdf(3)", TypeError, "builtin_brdf"),
    ("context.table_brdf(np.zeros((90, 90, 180)))", lightband.InvalidArgument, r"table must be .* not an array of shape \(90, 90, 180\)"),
    ("context.table_brdf(np.full((90, 90, 180, 3), np.nan))", lightband.InvalidArgument, "finite"),
    ("context.table_brdf(np.full((90, 90, 180, 3), 1.1e9))", lightband.InvalidArgument, r"values\[0\] is 1.1e\+09.*at most 1e\+09"),
    ("context.table_brdf(np.full((90, 90, 180, 3), 1e4))", lightband.InvalidArgument, "values: it reflects .* times the light .* at most 100"),
    ("context.lambert(1.5)", lightband.InvalidArgument, "albedo"),
    ("context.lambert(-0.1)", lightband.InvalidArgument, "albedo"),
    ("context.lambert(np.nan)", lightband.InvalidArgument, "albedo"),
    ("context.lambert([1, 1])", lightband.InvalidArgument, r"albedo must be .* not an array of shape \(2,\)"),
    ("context.lambert('red')", lightband.InvalidArgument, "albedo"),
    ("context.lambert(None)", lightband.InvalidArgument, "albedo"),
    ("context.ggx(0, 1)", lightband.InvalidArgument, "alpha"),
    ("context.ggx(2, 1)", lightband.InvalidArgument, "alpha"),
    ("context.ggx(0.5, 1.1)", lightband.InvalidArgument, "f0"),
    ("context.ggx(0.5, 1j)", lightband.InvalidArgument, "f0.*complex"),
    ("context.environment(np.zeros((4, 4)))", lightband.InvalidArgument, r"radiance must be .* not an array of shape \(4, 4\)"),
    ("context.environment(np.zeros((4, 4, 4)))", lightband.InvalidArgument, "radiance must be .*shape"),
    ("context.environment(np.zeros((0, 4, 3)))", lightband.InvalidArgument, "height|width"),
    ("context.environment(np.full((2, 2, 3), -1))", lightband.InvalidArgument, "negative"),
    ("context.environment(np.full((2, 2, 3), np.inf))", lightband.InvalidArgument, "finite"),
    ("context.environment(np.full((2, 2, 3), 1e300))", lightband.InvalidArgument, r"radiance holds 1e\+300"),
    ("context.environment([[[1, 2, 3]], [[1, 2]]])", lightband.InvalidArgument, "radiance must be an array"),
    ("context.mesh([], [])", lightband.InvalidArgument, "positions"),
    ("context.mesh(np.zeros((0, 3)), np.zeros((0, 3), int))", lightband.InvalidArgument, "vert"),
    ("context.mesh(TRIANGLE, np.zeros((0, 3), int))", lightband.InvalidArgument, "triangle"),
    ("context.mesh(TRIANGLE, [[0, 1, 3]])", lightband.InvalidArgument, "index|indices"),
    ("context.mesh(TRIANGLE, [[0, 1, -1]])", lightband.InvalidArgument, "indices holds -1"),
    ("context.mesh(TRIANGLE, [[0, 1, 2**33]])", lightband.InvalidArgument, "indices holds 8589934592"),
    ("context.mesh(TRIANGLE, [[0, 1, 0.5]])", lightband.InvalidArgument, "indices.*whole"),
    ("context.mesh(TRIANGLE, [0, 1, 2])", lightband.InvalidArgument, "indices must be .*shape"),
    ("context.mesh([[0, 0], [1, 0]], [[0, 1, 1]])", lightband.InvalidArgument, "positions must be .*shape"),
    ("context.mesh(np.full((3, 3), np.nan), [[0, 1, 2]])", lightband.InvalidArgument, "finite"),
    ("context.mesh(TRIANGLE, [[0, 0, 0]])", lightband.InvalidArgument, "area"),
    ("context.mesh(TRIANGLE, [[0, 1, 2]], normals=np.zeros((2, 3)))", lightband.InvalidArgument, "normals must be .*shape"),
    ("context.mesh(TRIANGLE, [[0, 1, 2]], normals=np.zeros((3, 3)))", lightband.InvalidArgument, "normal"),
    ("context.mesh(TRIANGLE, [[0, 1, 2]], texcoords=np.zeros((3, 3)))", lightband.InvalidArgument, "texcoords"),
    ("context.builtin_mesh('teapot')", lightband.InvalidArgument, "teapot"),
    ("context.builtin_mesh('sphere', 3)", lightband.InvalidArgument, "resolution"),
    ("context.builtin_mesh('sphere', -8)", lightband.InvalidArgument, "resolution"),
    ("context.builtin_mesh('sphere', 8.5)", TypeError, "builtin_mesh"),
    ("context.frame(0, 4)", lightband.InvalidArgument, "width"),
    ("context.frame(4, 8193)", lightband.InvalidArgument, "height"),
    ("context.frame(4, -1)", lightband.InvalidArgument, "height"),
    ("context.frame(2**40, 4)", lightband.InvalidArgument, "width"),
    ("context.frame(4.0, 4)", TypeError, "frame"),
    ("context.frame(4, 4, sample=3)", lightband.InvalidArgument, "sample"),
    ("context.frame(4, 4, samples=0)", lightband.InvalidArgument, "samples"),
    ("context.lambert(1).evaluate((0, 0), (0, 0, 1))", lightband.InvalidArgument, "wi must be .*shape"),
    ("context.lambert(1).evaluate((0, 0, 1), 1)", lightband.InvalidArgument, "wo must be"),
    ("context.lambert(1).evaluate(np.ones((4, 3)), np.ones((5, 3)))", lightband.InvalidArgument, "wi and wo"),
    ("context.lambert(1).evaluate((0, 0, np.nan), (0, 0, 1))", lightband.InvalidArgument, "wi"),
    ("context.lambert(1).albedo(2)", lightband.InvalidArgument, "theta_o"),
    ("context.lambert(1).albedo(np.nan)", lightband.InvalidArgument, "theta_o"),
    ("scene.add(None, None)", TypeError, "add"),
    ("scene.add(mesh, context.lambert(1), np.eye(2))", lightband.InvalidArgument, "transform must be .*shape"),
    ("scene.add(mesh, context.lambert(1), np.zeros((3, 4)))", lightband.InvalidArgument, "transform"),
    ("scene.add(mesh, context.lambert(1), np.full((3, 4), np.nan))", lightband.InvalidArgument, "transform"),
    ("scene.add(mesh, context.lambert(1), np.ones((4, 4)))", lightband.InvalidArgument, "transform .*last row"),
    ("scene.set_transform(7, np.eye(4))", lightband.InvalidArgument, "index"),
    ("scene.set_transform(-1, np.eye(4))", lightband.InvalidArgument, "index"),
    ("scene.set_double_sided(7, False)", lightband.InvalidArgument, "index"),
    ("scene.camera((0, 0, 0), (0, 0, 0))", lightband.InvalidArgument, "eye|target"),
    ("scene.camera((0, 0), (0, 0, 0))", lightband.InvalidArgument, "eye must be three finite numbers"),
    ("scene.camera((0, 0, 1), (0, 0, np.inf))", lightband.InvalidArgument, "target"),
    ("scene.camera((0, 0, 1), (0, 0, 0), up=(0, 0, 2))", lightband.InvalidArgument, "up"),
    ("scene.camera((0, 0, 1), (0, 0, 0), up=(0, 0, 0))", lightband.InvalidArgument, "up"),
    ("scene.camera((0, 0, 1), (0, 0, 0), fov_y=0)", lightband.InvalidArgument, "fov_y"),
    ("scene.camera((0, 0, 1), (0, 0, 0), fov_y=3.2)", lightband.InvalidArgument, "fov_y"),
    ("scene.camera((0, 0, 1), (0, 0, 0), near_plane=-1)", lightband.InvalidArgument, "near"),
    ("scene.camera((0, 0, 1), (0, 0, 0), near_plane=2, far_plane=1)", lightband.InvalidArgument, "near|far"),
    ("setattr(scene, 'environment', None)", TypeError, "environment"),
    ("frame.render(None)", TypeError, "render"),
    ("frame.render(scene, progress=3)", TypeError, "progress"),
    ("frame.render(scene)", lightband.StateError, "camera"),
    ("frame.color", lightband.StateError, "render"),
    ("frame.stats", lightband.StateError, "render"),
    ("frame.plan", lightband.StateError, "render"),
    ("frame.save('picture.png')", lightband.StateError, "render"),
    ("frame.buffer('colour')", lightband.Error, "colour|render"),
    ("rendered.buffer('colour')", lightband.InvalidArgument, "colour"),
    ("rendered.buffer('')", lightband.InvalidArgument, "field|name"),
    ("rendered.pyramid('color')", lightband.InvalidArgument, "color"),
    ("rendered.save('picture.jpg')", lightband.InvalidArgument, "jpg"),
    ("rendered.save('/nonexistent/picture.png')", lightband.FileError, "/nonexistent/picture.png"),
    ("rendered.save('picture.exr', fields=['colour'])", lightband.InvalidArgument, "colour"),
    ("rendered.save('picture.exr', fields=[])", lightband.InvalidArgument, "fields"),
    ("rendered.save('picture.exr', fields=[3])", TypeError, "str"),
    ("rendered.save('picture.png', fields='depth')", lightband.InvalidArgument, "depth"),
    ("rendered.save('picture.png', exposure=float('nan'))", lightband.InvalidArgument, "exposure"),
    ("rendered.save('picture.png', tone_curve='aces')", lightband.InvalidArgument, "tone_curve.*aces.*none.*filmic"),
    ("rendered.save('picture.png', alpha='none')", lightband.InvalidArgument, "alpha.*none.*coverage.*opaque"),
    ("lightband.Context(device='abacus')", lightband.InvalidArgument, "abacus"),
    ("lightband.Context(device=2)", TypeError, "device"),
    ("lightband.Context(device='software', log=3)", TypeError, "log"),
]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("call", "kind", "message"), REFUSED, ids=[row[0] for row in REFUSED])
def test_bad_input_is_refused_by_name(
    context: lightband.Context,
    frame: lightband.Frame,
    rendered: lightband.Frame,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    call: str,
    kind: type[Exception],
    message: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    names = {
        **globals(),
        "context": context,
        "scene": context.scene(),
        "mesh": context.builtin_mesh("plane", 8),
        "frame": frame,
        "rendered": rendered,
    }
    with pytest.raises(kind, match=message):
        eval(call, names)
    assert not list(tmp_path.iterdir())


ACCEPTED = [
    "scene.camera((0, 0, 2), (0, 0, 0), near_plane=1e-30)",
    "scene.camera((0, 0, 2), (0, 0, 0), far_plane=1e30)",
    "scene.camera((0, 0, 2), (0, 0, 0), near_plane=np.float32(1e-30), far_plane=np.float32(1e30))",
    "context.ggx(1e-4, 1)",
    "context.ggx(1, 0)",
    "context.lambert([0, 1, 0.5])",
    "context.environment(np.full((1, 1, 3), 1e15))",
    "context.builtin_mesh('sphere', 8)",
    "context.builtin_mesh('sphere', 2048)",
    "context.frame(8192, 1)",
    "context.lambert(1).albedo(0)",
]


@pytest.mark.parametrize("call", ACCEPTED)
def test_limits_themselves_are_accepted(context: lightband.Context, call: str) -> None:
    """Those that the interface's header names, as the float that they come as."""
    eval(call, {**globals(), "context": context, "scene": context.scene()})


def test_settings_take_their_least_and_most(frame: lightband.Frame) -> None:
    for setting in lightband.settings():
        for value in setting.choices or (setting.minimum, setting.maximum):
            frame[setting.name] = value
            assert frame[setting.name] == value


@pytest.mark.parametrize("length", [1000, 4050, 4080, 4090, 4095, 4100, 20000])
@pytest.mark.parametrize("letter", ["d", "ä"])
def test_a_long_path_leaves_room_for_the_reason(context: lightband.Context, length: int, letter: str) -> None:
    size = len(letter.encode())
    path = "/nowhere/" + (letter * 100 + "/") * (length // (100 * size + 1)) + "m.exr"
    with pytest.raises(lightband.FileError, match="No such file or directory|File name too long") as caught:
        context.load_environment(path)
    assert str(caught.value).startswith("/nowhere/" + letter) and "\ufffd" not in str(caught.value)


def test_only_regular_files_are_opened(context: lightband.Context, rendered: lightband.Frame, tmp_path: Path) -> None:
    """Opening a pipe would wait for a writer: a call that returns has not."""
    pipe = tmp_path / "pipe.exr"
    os.mkfifo(pipe)
    folder = tmp_path / "folder.exr"
    folder.mkdir()
    for path, kind in ((pipe, "a pipe"), (folder, "a directory"), (Path("/dev/zero"), "a device")):
        for load in (context.load_environment, context.load_brdf):
            with pytest.raises(lightband.FileError, match=kind):
                load(path)
    for path in (pipe, folder):
        with pytest.raises(lightband.FileError, match="not a file that can be replaced"):
            rendered.save(path)
    # In the cache, as well: the material is computed all the same.
    with lightband.Context(device="software", cache_path=str(tmp_path)) as other:
        other.builtin_brdf("rough-gold").close()
        (cached,) = tmp_path.glob("*.binary")
        cached.unlink()
        os.mkfifo(cached)
        other.builtin_brdf("rough-gold").close()


def test_what_a_reader_changes_is_logged(tmp_path: Path) -> None:
    lines: list[str] = []
    path = tmp_path / "freeimage.hdr"
    path.write_bytes(b"#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n\x80\x80\x80\x81")
    with lightband.Context(device="software", log=lines.append, cache_path="") as context:
        assert context.load_environment(path).radiance.shape == (1, 1, 3)
    assert [line for line in lines if str(path) in line and "EXPOSURE=0" in line]


def test_a_scene_holds_254_instances(context: lightband.Context) -> None:
    scene, mesh, brdf = context.scene(), context.builtin_mesh("plane", 8), context.lambert(1)
    for index in range(254):
        assert scene.add(mesh, brdf) == index
    with pytest.raises(lightband.Error, match="254") as caught:
        scene.add(mesh, brdf)
    assert isinstance(caught.value, lightband.LimitError | lightband.InvalidArgument)
    assert len(scene) == 254


def test_objects_of_two_contexts_do_not_mix(context: lightband.Context) -> None:
    with lightband.Context(device="software", cache_path="") as other:
        with pytest.raises(lightband.InvalidArgument):
            context.scene().add(other.builtin_mesh("plane", 8), context.lambert(1))
        with pytest.raises(lightband.InvalidArgument):
            context.scene().environment = other.environment(np.ones((2, 4, 3)))
        with pytest.raises(lightband.InvalidArgument):
            other.frame(4, 4).render(context.scene())
