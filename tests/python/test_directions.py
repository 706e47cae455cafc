"""Interpolation over directions: from pixels that mirror the eye towards nearby directions (docs/decisions/0012)."""

import numpy as np
import pytest

import lightband

SIZE = 96
EYE = np.array([0.4, 0.3, 1.7])


def linear_light(context, constant, slope):
    """A map of radiance constant + slope . direction."""
    v, u = (np.indices((64, 128)) + 0.5) / np.array([64, 128])[:, None, None]
    polar, longitude = v * np.pi, (0.5 - u) * 2 * np.pi  # docs/conventions.md
    towards = np.stack([np.sin(polar) * np.sin(longitude), np.cos(polar), np.sin(polar) * np.cos(longitude)], axis=-1)
    radiance = constant + towards @ np.asarray(slope)
    return context.environment(np.repeat(radiance[..., None], 3, axis=-1).astype(np.float32))


def shown(context, environment, things, size=SIZE, **settings):
    """things: mesh, material, and where it stands."""
    scene = context.scene()
    scene.environment = environment
    for mesh, brdf, place in things:
        pose = np.eye(4)
        pose[:3, 3] = place
        scene.add(context.builtin_mesh(mesh), brdf, pose)
    scene.camera(eye=tuple(EYE), target=(0, 0, 0))
    frame = context.frame(size, size, **{"interpolation": "directions", **settings})
    frame.render(scene)
    return frame


def mirror_directions(frame):
    wo = EYE - frame.position.astype(np.float64)
    wo /= np.linalg.norm(wo, axis=-1, keepdims=True)
    normal = frame.normal.astype(np.float64)
    return 2 * np.sum(wo * normal, axis=-1, keepdims=True) * normal - wo


def square_of(directions):
    """docs/conventions.md, the octahedral square."""
    p = directions[..., (0, 2)] / np.abs(directions).sum(axis=-1, keepdims=True)
    folded = (1 - np.abs(p[..., ::-1])) * np.where(p < 0, -1, 1)
    return 0.5 * np.where(directions[..., 1:2] < 0, folded, p) + 0.5


@pytest.fixture(scope="module")
def patched(context):
    return context.environment(np.random.default_rng(1).uniform(size=(16, 32, 3)).astype(np.float32) ** 8)


@pytest.mark.parametrize("scale", [1, 4])
def test_matte_light_is_that_of_the_closed_form(context, scale):
    """Light of a + b . d leaves a matte surface of albedo k with k (a + 2/3 b . n). Without a slope, a value a cell's width w away would
    err by the gradient times the normal's step, up to w; planes leave a part of it, since slopes that few neighbours tell are taken to be
    small: a third in the root mean square at most."""
    constant, slope, albedo = 1.0, np.array([0.3, 0.5, -0.2]), 0.8
    frame = shown(context, linear_light(context, constant, slope), [("knot", context.lambert(albedo), (0, 0, 0))], samples=512,
                  bandwidth_scale=scale)
    interpolated = (frame.material > 0) & (frame.shaded == 0)
    assert interpolated.sum() > 0.5 * (frame.material > 0).sum()
    irradiance = constant + 2 / 3 * frame.normal.astype(np.float64) @ slope
    errors = (frame.color[..., 0] / (albedo * irradiance) - 1)[interpolated]
    gradient = 2 / 3 * np.linalg.norm(slope) / irradiance[interpolated]  # relative, per radian at most
    reach = np.abs(mirror_directions(frame)[interpolated]).sum(axis=-1)
    width = 2 * reach**1.5 / 2.0 ** frame.cell_level[interpolated]
    assert np.sqrt(np.mean(errors**2)) < np.sqrt(np.mean((gradient * width) ** 2)) / 3


def test_constant_light_stays_constant(context):
    """A white matte surface in a furnace shows 1 at every sample: what is interpolated between ones is one, to the rounding of nine
    weights and of a 4 x 4 inverse."""
    frame = shown(context, context.environment(np.ones((8, 16, 3), np.float32)), [("knot", context.lambert(1.0), (0, 0, 0))], samples=16,
                  sampler="brdf", bandwidth_scale=1)
    seen = frame.material > 0
    assert (frame.shaded[seen] == 0).any()
    np.testing.assert_allclose(frame.color[seen][:, :3], 1, atol=1e-5)


def test_every_cell_has_a_shaded_pixel(context, patched):
    """Levels follow the bandwidth; of each cell's pixels at least one is shaded, and what asks for finer cells than there are is."""
    frame = shown(context, patched, [("knot", context.ggx(0.2, 0.9), (0, 0, 0))], samples=16, bandwidth_scale=0.7)
    seen = frame.material > 0
    direction, level = mirror_directions(frame)[seen], frame.cell_level[seen].astype(int)
    reach = np.abs(direction).sum(axis=-1)
    wanted = np.log2(np.maximum(0.7 * 2 * frame.bandwidth_reflected[seen] * 2 * reach**1.5, 1))
    finest = level[level < 15].max()
    asked = np.clip(np.ceil(wanted), 3, None)
    clear = np.abs(wanted - np.round(wanted)) > 1e-3  # else rounding decides
    assert (level == np.where(asked <= finest, asked, 15))[clear].all()
    shaded = frame.shaded[seen] == 1
    assert shaded[level == 15].all() and not shaded.all()
    side = 2.0**level
    place = square_of(direction) * side[:, None]
    sure = np.all(np.abs(place - np.round(place)) > 1e-3, axis=-1)  # of the cell that the device put it in
    cell = np.minimum(place.astype(int), side.astype(int)[:, None] - 1)
    keys, inverse = np.unique(np.column_stack([level, cell]), axis=0, return_inverse=True)
    pixels, speakers = np.bincount(inverse, sure), np.bincount(inverse, shaded)
    unsure = np.bincount(inverse, ~sure)
    inner = (pixels > 0) & (unsure == 0) & (keys[:, 0] < 15)
    assert inner.sum() > 100
    # A pixel at the border of a cell may speak for it from outside as it is computed here: such cells are few.
    assert (speakers[inner] == 0).mean() < 0.02


def test_materials_are_never_mixed(context, patched):
    frame = shown(context, patched, [("sphere", context.lambert(0), (-0.45, 0, 0)), ("sphere", context.lambert(1), (0.45, 0, 0))],
                  samples=16, bandwidth_scale=1)
    black = frame.material == 1
    assert (frame.shaded[black] == 0).any() and (frame.shaded[frame.material == 2] == 0).any()
    assert (frame.color[black][:, :3] == 0).all()
    assert (frame.color[frame.material == 2][:, :3] > 0).all()


def test_equal_seeds_give_equal_frames(context, patched):
    pictures = [shown(context, patched, [("knot", context.ggx(0.3, 0.9), (0, 0, 0))], target_error=0.05, seed=3).color for _ in range(2)]
    np.testing.assert_array_equal(*pictures)


@pytest.mark.parametrize("material", ["rough-gold", "interference-paint"])
def test_what_is_asked_is_reached(context, patched, material):
    things = [("knot", context.builtin_brdf(material), (0, 0, 0))]
    a, b = (shown(context, patched, things, samples=8192, coarsest_level=0, sampler="combined", seed=seed) for seed in (91, 92))
    seen = a.material > 0
    weights = np.array([0.2126, 0.7152, 0.0722])
    first, second = (frame.color[seen][:, :3].astype(np.float64) @ weights for frame in (a, b))
    mean = 0.5 * (first + second)
    for asked in (0.1, 0.03):
        frame = shown(context, patched, things, target_error=asked)
        picture = frame.color[seen][:, :3].astype(np.float64) @ weights
        got = np.sqrt(np.mean((picture - first) * (picture - second) / (mean + 0.01 * mean.mean()) ** 2))
        assert frame.stats.error <= asked
        assert got < 1.5 * asked  # the promise of every frame


def test_fewer_pixels_are_shaded_than_in_the_image(context, patched):
    """On a strongly curved shape, at the same error asked for."""
    things = [("knot", context.ggx(0.4, 0.9), (0, 0, 0))]
    directions, image = (shown(context, patched, things, 192, target_error=0.1, interpolation=way) for way in ("directions", "image"))
    assert directions.stats.shaded_pixels < 0.6 * image.stats.shaded_pixels


def passes(frame):
    return [line.split()[0] for line in frame.plan.splitlines()][:-1]  # the last line is the total


def test_only_what_is_needed(context, patched):
    """Cells and foresight belong to interpolation over directions, pyramids to that in the image; a small frame looks for neither."""
    things = [("knot", context.ggx(0.4, 0.9), (0, 0, 0))]
    frame = shown(context, patched, things, samples=16)
    assert passes(frame) == ["gbuffer", "covered", "environment", "bandwidth", "audit", "probe", "recheck", "foresee", "cells", "classify",
                             "list", "shade", "interpolate", "estimate", "combine"]
    assert "foresee" not in passes(shown(context, patched, things, samples=16, bandwidth_scale=1))
    small = shown(context, patched, things, samples=16, interpolation="auto")
    assert not {"foresee", "cells", "interpolate"} & set(passes(small)) and (small.cell_level == 0).all()
    every = shown(context, patched, things, samples=16, coarsest_level=0)
    assert not {"foresee", "cells", "interpolate", "pyramids"} & set(passes(every))
    assert every.stats.device_bytes < frame.stats.device_bytes


def test_levels_and_pyramids_are_there_all_the_same(context, patched):
    """They are predictions, whoever uses them: those of scale 1."""
    things = [("knot", context.ggx(0.4, 0.9), (0, 0, 0))]
    directions, image = (shown(context, patched, things, samples=16, bandwidth_scale=1, interpolation=way) for way in ("directions", "image"))
    for name in ("level", "level_pyramid", "variance_pyramid"):
        np.testing.assert_array_equal(directions.buffer(name), image.buffer(name))


@pytest.mark.parametrize("light", ["black", "sun"])
@pytest.mark.parametrize("material", ["black", "mirror"])
def test_extremes(context, light, material):
    radiance = np.zeros((16, 32, 3), np.float32)
    if light == "sun":
        radiance[5, 7] = 1e6
    brdf = context.lambert(0) if material == "black" else context.ggx(1e-4, 1.0)
    for settings in ({"samples": 16}, {"target_error": 0.05, "max_samples": 256}, {"time_budget": 50}):
        for size in (1, 31):
            frame = shown(context, context.environment(radiance), [("knot", brdf, (0, 0, 0))], size, **settings)
            assert np.isfinite(frame.color).all() and (frame.color >= 0).all()
            assert np.isfinite(frame.error).all() and np.isfinite(frame.stats.error)
            if light == "black" or material == "black":
                assert (frame.color[..., :3] == 0).all()


@pytest.mark.parametrize("settings", [{"samples": 16}, {"target_error": 0.05}, {"time_budget": 50}])
def test_a_frame_that_sees_nothing(context, patched, settings):
    """With a mesh behind the eye, and with none."""
    for meshes in (0, 1):
        scene = context.scene()
        scene.environment = patched
        for _ in range(meshes):
            scene.add(context.builtin_mesh("sphere", 16), context.ggx(0.3, 0.9))
        scene.camera(eye=(0, 0, 2), target=(0, 0, 4))
        frame = context.frame(32, 16, interpolation="directions", **settings)
        frame.render(scene)
        assert frame.stats.covered_pixels == frame.stats.shaded_pixels == 0 and frame.stats.error == 0
        assert (frame.color == 0).all() and (frame.cell_level == 0).all()
