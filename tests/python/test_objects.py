"""The objects as Python sees them: names, errors, closing, what they refuse."""

from __future__ import annotations

import copy
import gc
import os
import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import lightband
from lightband import errors


def test_version_is_the_packages() -> None:
    from importlib.metadata import version

    assert lightband.__version__ == version("lightband")


def test_everything_public_is_exported_and_documented() -> None:
    for name in lightband.__all__:
        thing = getattr(lightband, name)
        assert name == "__version__" or thing.__doc__, name
    for kind in (
        lightband.Context,
        lightband.Brdf,
        lightband.Environment,
        lightband.Sun,
        lightband.Mesh,
        lightband.Scene,
        lightband.Frame,
    ):
        for name in dir(kind):
            assert name.startswith("_") or getattr(kind, name).__doc__, f"{kind.__name__}.{name}"


def test_lists_of_names(context: lightband.Context) -> None:
    assert len(set(lightband.builtin_materials())) == len(lightband.builtin_materials()) > 0
    assert len(set(lightband.buffer_names())) == len(lightband.buffer_names()) > 0


CODES = {
    1: (lightband.InvalidArgument, ValueError),
    2: (lightband.InvalidHandle, ValueError),
    3: (lightband.StateError, RuntimeError),
    4: (lightband.FileError, OSError),
    5: (lightband.FormatError, ValueError),
    6: (lightband.OutOfMemory, MemoryError),
    7: (lightband.DeviceError, RuntimeError),
    8: (lightband.LimitError, RuntimeError),
    9: (lightband.Cancelled, RuntimeError),
    10: (lightband.InternalError, RuntimeError),
}


@pytest.mark.parametrize("code", CODES)
def test_each_code_has_its_class(code: int) -> None:
    kind, natural = CODES[code]
    assert errors.class_of(code) is kind
    assert issubclass(kind, lightband.Error) and issubclass(kind, RuntimeError) and issubclass(kind, natural)
    raised = kind("what went wrong")
    assert raised.code == code
    assert str(raised) == "what went wrong"
    assert pickle.loads(pickle.dumps(raised)).args == raised.args


def test_the_codes_are_those_of_the_header() -> None:
    header = Path(__file__).resolve().parents[2] / "include" / "lightband" / "lightband.h"
    lines = [line.split() for line in header.read_text().splitlines() if line.startswith("#define LB_ERROR_")]
    assert {int(line[2]) for line in lines} == set(CODES)


def test_an_unknown_code_is_an_error_all_the_same() -> None:
    assert errors.class_of(99) is lightband.Error


def test_a_caught_error_tells_its_code(context: lightband.Context) -> None:
    with pytest.raises(lightband.Error) as caught:
        context.lambert(7)
    assert caught.value.code == 1


MAKERS: dict[str, Callable[[lightband.Context], object]] = {
    "Brdf": lambda context: context.ggx(0.25, 0.5),
    "Environment": lambda context: context.environment(np.ones((2, 4, 3))),
    "Sun": lambda context: context.sun((0, 1, 0), 1),
    "Mesh": lambda context: context.builtin_mesh("plane", 8),
    "Scene": lambda context: context.scene(),
    "Frame": lambda context: context.frame(40, 24),
}
made_kinds = pytest.mark.parametrize("kind", MAKERS)


@made_kinds
def test_only_a_context_makes_them(kind: str) -> None:
    with pytest.raises(TypeError, match="constructor"):
        getattr(lightband, kind)()


@made_kinds
def test_pickling_and_copying_are_refused(context: lightband.Context, kind: str) -> None:
    made = MAKERS[kind](context)
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
        with pytest.raises(TypeError, match="pickle"):
            pickle.dumps(made, protocol)
    with pytest.raises(TypeError, match="pickle"):
        copy.copy(made)


def test_a_context_is_not_pickled(context: lightband.Context) -> None:
    with pytest.raises(TypeError, match="pickle"):
        pickle.dumps(context)


def test_an_array_is_pickled_by_value(rendered: lightband.Frame) -> None:
    array = rendered.normal
    again = pickle.loads(pickle.dumps(array))
    np.testing.assert_array_equal(again, array)
    assert again.base is None or not isinstance(again.base, lightband.Buffer)


@made_kinds
def test_with_closes(context: lightband.Context, kind: str) -> None:
    with MAKERS[kind](context) as made:  # type: ignore[attr-defined]
        assert "closed" not in repr(made)
    assert repr(made).startswith(f"<lightband.{kind} ") and repr(made).endswith(", closed>")
    made.close()


USES_OF_THE_CLOSED: dict[str, Callable[[object], object]] = {
    "Brdf": lambda brdf: brdf.albedo(0),
    "Environment": lambda environment: environment.radiance,
    "Sun": lambda sun: sun.set((0, 1, 0), 1),
    "Mesh": lambda mesh: mesh.stats,
    "Scene": lambda scene: scene.camera((0, 0, 1), (0, 0, 0)),
    "Frame": lambda frame: frame["samples"],
}


@made_kinds
def test_a_closed_object_says_so(context: lightband.Context, kind: str) -> None:
    made = MAKERS[kind](context)
    made.close()  # type: ignore[attr-defined]
    with pytest.raises(lightband.InvalidHandle):
        USES_OF_THE_CLOSED[kind](made)


def test_with_closes_on_an_exception(context: lightband.Context) -> None:
    with pytest.raises(ZeroDivisionError), context.frame(4, 4) as frame:
        1 / 0
    with pytest.raises(lightband.InvalidHandle):
        frame["samples"]


def test_what_was_made_outlives_a_closed_context() -> None:
    context = lightband.Context(device="software", cache_path="")
    brdf = context.lambert(0.5)
    name = context.device_name
    context.close()
    np.testing.assert_allclose(brdf.albedo(0), 0.5, rtol=1e-4)
    with pytest.raises(lightband.InvalidHandle):
        context.lambert(0.5)
    assert context.device_name == name


def test_a_scene_keeps_what_it_shows(context: lightband.Context) -> None:
    scene = context.scene()
    scene.add(context.builtin_mesh("sphere", 16), context.lambert(0.5))
    scene.environment = context.environment(np.ones((2, 4, 3)))
    scene.camera((0, 0, 3), (0, 0, 0))
    gc.collect()
    frame = context.frame(8, 8, samples=4)
    frame.render(scene)
    assert frame.stats.covered_pixels > 0


def test_reprs_tell_what_it_is(context: lightband.Context, scene: lightband.Scene, frame: lightband.Frame) -> None:
    assert context.device_name in repr(context)
    assert repr(scene) == "<lightband.Scene of 1 instance, with environment, with camera>"
    assert repr(context.scene()) == "<lightband.Scene of 0 instances, no environment, no camera>"
    assert repr(frame) == "<lightband.Frame 40 x 24>"
    assert repr(context.ggx(0.25, 1)) == "<lightband.Brdf GGX, alpha 0.25>"
    assert repr(context.environment(np.ones((2, 4, 3)))) == "<lightband.Environment 4 x 2>"
    assert repr(context.builtin_mesh("knot", 16)) == "<lightband.Mesh built-in 'knot'>"


def test_an_empty_scene_is_true(context: lightband.Context) -> None:
    empty = context.scene()
    assert empty and len(empty) == 0 and empty.environment is None


def test_the_environment_of_a_scene_is_the_one_set(
    context: lightband.Context, environment: lightband.Environment
) -> None:
    scene = context.scene()
    scene.environment = environment
    assert scene.environment is environment


def test_software_is_what_was_asked_for(context: lightband.Context) -> None:
    assert context.is_software is True


def test_attributes_cannot_be_invented(frame: lightband.Frame) -> None:
    with pytest.raises(AttributeError):
        frame.samples = 3  # type: ignore[attr-defined]
    with pytest.raises(AttributeError):
        frame.width = 3  # type: ignore[misc]


def test_stats_and_plan(rendered: lightband.Frame) -> None:
    stats = rendered.stats
    assert (stats.width, stats.height) == (40, 24) == (rendered.width, rendered.height)
    assert 0 < stats.shaded_pixels <= stats.covered_pixels < 40 * 24
    assert stats.shaded_pixels == rendered.shaded.sum(dtype=int)
    assert stats.samples == rendered.sample_count.sum(dtype=int)
    assert stats.milliseconds > 0
    with pytest.raises(AttributeError):
        stats.samples = 3  # type: ignore[misc]
    assert len(rendered.plan.splitlines()) >= 3 and "\0" not in rendered.plan


@pytest.mark.parametrize("kind", [str, Path, lambda path: os.fsencode(path)], ids=["str", "Path", "bytes"])
def test_paths_of_any_kind(rendered: lightband.Frame, tmp_path: Path, kind: Callable[[Path], object]) -> None:
    path = tmp_path / "käse.png"
    rendered.save(kind(path))  # type: ignore[arg-type]
    assert path.read_bytes().startswith(b"\x89PNG")


def test_saved_color_is_loaded_again(
    context: lightband.Context, environment: lightband.Environment, tmp_path: Path
) -> None:
    scene = context.scene()
    scene.add(context.builtin_mesh("sphere", 32), context.lambert((0.2, 0.5, 0.8)))
    scene.environment = environment
    scene.camera(eye=(0, 0, 3), target=(0, 0, 0))
    frame = context.frame(40, 24, samples=8)
    frame.render(scene)
    path = tmp_path / "fields.exr"
    frame.save(path, fields=["color", "depth"])
    np.testing.assert_array_equal(context.load_environment(path).radiance, frame.color[..., :3])
    assert "fields.exr" in repr(context.load_environment(path))


CHANNELS = {
    "color": [b"A", b"B", b"G", b"R"],
    "normal": [b"normal.X", b"normal.Y", b"normal.Z"],
    "level": [b"level.Y"],
    "shaded": [b"shaded.Y"],
}


@pytest.mark.parametrize(
    ("fields", "names"),
    [
        (None, ["color"]),
        ("color,normal", ["color", "normal"]),
        (["color", "normal"], ["color", "normal"]),
        (("normal",), ["normal"]),
        (iter(["level", "shaded"]), ["level", "shaded"]),
    ],
    ids=["None", "str", "list", "tuple", "iterator"],
)
def test_fields_to_save(rendered: lightband.Frame, tmp_path: Path, fields: object, names: list[str]) -> None:
    path = tmp_path / "fields.exr"
    rendered.save(path, fields=fields)  # type: ignore[arg-type]
    # The header's list of channels: each a name that a zero ends, its pixel type, here 2 for float, and 12 further bytes.
    listed = path.read_bytes().split(b"channels\0chlist\0")[1][4:]
    expected = sorted(channel for name in names for channel in CHANNELS[name])
    for channel in expected:
        assert listed.startswith(channel + b"\0\2\0\0\0")
        listed = listed[len(channel) + 1 + 16 :]
    assert listed.startswith(b"\0")
