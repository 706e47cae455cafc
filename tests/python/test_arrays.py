"""The fields as NumPy arrays: shape, type, units, ownership, lifetime."""

from __future__ import annotations

import gc
import math

import numpy as np
import pytest

import lightband

HEIGHT, WIDTH = 24, 40
SHAPES = {"color": (HEIGHT, WIDTH, 4), "position": (HEIGHT, WIDTH, 3), "normal": (HEIGHT, WIDTH, 3)}
BYTES = {"material", "level", "shaded", "level_pyramid"}


def element_type(name: str) -> type:
    return np.uint32 if name == "sample_count" else np.uint8 if name in BYTES else np.float32


@pytest.mark.parametrize("name", lightband.buffer_names())
def test_shape_type_and_strides_are_as_documented(rendered: lightband.Frame, name: str) -> None:
    array = rendered.buffer(name)
    assert array.dtype == element_type(name)
    if name.endswith("_pyramid"):
        assert array.ndim == 2 and array.shape[1] == WIDTH and array.shape[0] > HEIGHT
    else:
        assert array.shape == SHAPES.get(name, (HEIGHT, WIDTH))
    assert array.flags.c_contiguous


@pytest.mark.parametrize("name", lightband.buffer_names())
def test_each_field_is_a_property_with_documentation(rendered: lightband.Frame, name: str) -> None:
    np.testing.assert_array_equal(getattr(rendered, name), rendered.buffer(name))
    documentation = getattr(lightband.Frame, name).__doc__
    assert np.dtype(element_type(name)).name in documentation
    assert "height" in documentation or "rows" in documentation


@pytest.mark.parametrize("name", lightband.buffer_names())
def test_no_field_holds_nan(rendered: lightband.Frame, name: str) -> None:
    assert not np.isnan(rendered.buffer(name)).any()


def test_arrays_are_read_only_for_good(rendered: lightband.Frame) -> None:
    array = rendered.color
    with pytest.raises(ValueError, match="read-only"):
        array[0, 0, 0] = 1
    with pytest.raises(ValueError, match="WRITEABLE"):
        array.setflags(write=True)


def test_the_base_is_the_librarys_buffer(rendered: lightband.Frame) -> None:
    array = rendered.depth
    assert isinstance(array.base, lightband.Buffer)
    assert array.base.name == "depth"
    assert array.base.unit == "metre"
    assert not array.flags.owndata
    assert "depth" in repr(array.base)


def test_rows_run_top_down(rendered: lightband.Frame) -> None:
    seen = rendered.material != 0
    height_in_world = rendered.position[..., 1]
    assert height_in_world[seen].max() > 0.4
    rows = np.nonzero(seen)[0]
    assert height_in_world[rows.min()].max() > 0 > height_in_world[rows.max()].min()


def test_pixels_that_see_nothing(rendered: lightband.Frame) -> None:
    seen = rendered.material != 0
    assert seen.any() and not seen.all()
    assert set(np.unique(rendered.material)) == {0, 1}
    assert np.isposinf(rendered.depth[~seen]).all() and np.isfinite(rendered.depth[seen]).all()
    np.testing.assert_array_equal(rendered.color[..., 3], seen.astype(np.float32))
    assert seen.sum() == rendered.stats.covered_pixels


def test_an_array_outlives_frame_scene_and_context() -> None:
    context = lightband.Context(device="software", cache_path="")
    scene = context.scene()
    scene.add(context.builtin_mesh("plane"), context.lambert(1))
    scene.environment = context.environment(np.ones((2, 4, 3)))
    scene.camera((0, 0, 2), (0, 0, 0))
    frame = context.frame(16, 8, samples=4)
    frame.render(scene)
    array = frame.color
    copy = array.copy()
    del frame, scene, context
    gc.collect()
    np.testing.assert_array_equal(array, copy)
    view = array[2:4, ::2, 0]
    del array
    gc.collect()
    np.testing.assert_array_equal(view, copy[2:4, ::2, 0])


def test_an_array_keeps_its_values_when_the_frame_renders_again(
    context: lightband.Context, frame: lightband.Frame, scene: lightband.Scene
) -> None:
    frame.render(scene)
    before = frame.color
    copy = before.copy()
    darker = context.scene()
    darker.environment = context.environment(np.full((2, 4, 3), 0.01))
    darker.camera((0, 0, 3), (0, 0, 0))
    frame.render(darker)
    np.testing.assert_array_equal(before, copy)
    assert not np.array_equal(frame.color, copy)


def test_closing_the_frame_leaves_its_arrays(frame: lightband.Frame, scene: lightband.Scene) -> None:
    frame.render(scene)
    array = frame.material
    copy = array.copy()
    frame.close()
    np.testing.assert_array_equal(array, copy)
    with pytest.raises(lightband.InvalidHandle):
        frame.buffer("material")


@pytest.mark.parametrize("name", ["level_pyramid", "variance_pyramid"])
def test_a_pyramid_comes_apart_into_views(rendered: lightband.Frame, name: str) -> None:
    packed, levels = rendered.buffer(name), rendered.pyramid(name)
    assert [level.shape for level in levels] == [
        (math.ceil(HEIGHT / 2**k), math.ceil(WIDTH / 2**k)) for k in range(len(levels))
    ]
    assert sum(level.shape[0] for level in levels) == packed.shape[0]
    row = 0
    for level in levels:
        rows, columns = level.shape
        np.testing.assert_array_equal(level, packed[row : row + rows, :columns])
        assert not level.flags.owndata and not level.flags.writeable
        row += rows


def test_the_level_pyramid_holds_least_levels(rendered: lightband.Frame) -> None:
    for fine, coarse in zip(rendered.pyramid("level_pyramid"), rendered.pyramid("level_pyramid")[1:]):
        rows, columns = fine.shape
        padded = np.pad(fine, ((0, rows % 2), (0, columns % 2)), constant_values=255)
        least = padded.reshape(padded.shape[0] // 2, 2, padded.shape[1] // 2, 2).min(axis=(1, 3))
        np.testing.assert_array_equal(coarse, least)


def test_a_frame_of_one_pixel(context: lightband.Context, scene: lightband.Scene) -> None:
    frame = context.frame(1, 1, samples=4)
    frame.render(scene)
    assert frame.color.shape == (1, 1, 4)
    assert frame.pyramid("level_pyramid")[0].shape == (1, 1)


def test_reference_frames_have_no_predicted_fields(frame: lightband.Frame, scene: lightband.Scene) -> None:
    frame["method"] = "reference"
    frame.render(scene)
    assert frame.color.shape == (HEIGHT, WIDTH, 4)
    with pytest.raises(lightband.StateError, match="bandwidth_image"):
        frame.bandwidth_image


def test_environment_fields(context: lightband.Context) -> None:
    radiance = np.random.default_rng(3).random((6, 9, 3), dtype=np.float32)
    environment = context.environment(radiance)
    np.testing.assert_array_equal(environment.radiance, radiance)
    assert environment.radiance.base.unit == "radiance"
    size = environment.bandwidth.shape[0]
    assert environment.bandwidth.shape == (size, size) and environment.bandwidth.dtype == np.float32
    assert (environment.bandwidth >= 0).all()


def test_brdf_fields(context: lightband.Context) -> None:
    table = np.full((90, 90, 180, 3), 0.25, np.float32)
    table[0, 0, 0] = 1, 2, 3
    brdf = context.table_brdf(table)
    np.testing.assert_array_equal(brdf.table, table)
    assert brdf.bandwidth.ndim == 3 and brdf.bandwidth.dtype == np.float32
    with pytest.raises(lightband.StateError):
        context.lambert(0.5).table


def test_fields_of_a_material_outlive_it(context: lightband.Context) -> None:
    table = context.table_brdf(np.full((90, 90, 180, 3), 0.25)).table
    gc.collect()
    assert (table == 0.25).all()
