"""Filtered importance sampling (setting filter): exact where it must be, better where it may be, absent where it is not asked for."""

import numpy as np
import pytest

from test_method import directions, light

FOOTPRINT = {"filter": "footprint", "coarsest_level": 0}
PLAIN = {"filter": "none", "coarsest_level": 0}


def scene_of(context, brdf, environment):
    scene = context.scene()
    scene.environment = environment
    scene.add(context.builtin_mesh("sphere", 64), brdf)
    scene.camera(eye=(0.3, 0.4, 1.9), target=(0, 0, 0), fov_y=0.6)
    return scene


def rendered(context, scene, **settings):
    frame = context.frame(48, 40, **settings)
    frame.render(scene)
    return frame


def deviation(frame, truth):
    """Root mean square over the covered pixels, relative to what they show."""
    covered = truth.material > 0
    return np.sqrt(np.mean((frame.color[covered][:, :3] / truth.color[covered][:, :3] - 1) ** 2))


@pytest.fixture(scope="module")
def smooth(context):
    return context.environment(light(directions()))


def test_a_constant_map_has_no_footprint(context):
    """Whatever the footprint, the mean of a constant is the constant: a Lambertian furnace stays exact but for half floats' 2^-11."""
    scene = scene_of(context, context.lambert(1.0), context.environment(np.ones((16, 32, 3), np.float32)))
    frame = rendered(context, scene, samples=4, sampler="brdf", **FOOTPRINT)
    np.testing.assert_allclose(frame.color[frame.material > 0], 1, atol=2**-11)


def test_a_mirror_looks_the_map_up_as_it_is(context, smooth):
    """A footprint below a texel of 128 x 128 (8e-4 steradians at most) is a lookup of the map itself.

    GGX of alpha a draws densities below p with a chance of 2 a sqrt(pi p): with eight samples for each replicate, footprints of
    1 / (8 p) reach a texel for 0.5 % of the samples, and 7 % of the pixels have one. All others keep every bit.
    """
    scene = scene_of(context, context.ggx(1e-4, (0.9, 0.9, 0.9)), smooth)
    plain, filtered = (rendered(context, scene, samples=16, sampler="brdf", **kind) for kind in (PLAIN, FOOTPRINT))
    covered = plain.material > 0
    assert (plain.color[covered] != filtered.color[covered]).any(axis=-1).mean() < 0.15
    assert deviation(filtered, plain) < 0.05  # 7 % of the pixels, one of whose 16 samples is blurred


@pytest.mark.parametrize("sampler", ["brdf", "combined"])
def test_a_footprint_takes_noise_away_and_its_bias_falls(context, smooth, sampler):
    scene = scene_of(context, context.ggx(0.3, (0.9, 0.6, 0.3)), smooth)
    truth = rendered(context, scene, samples=1024, accumulate=16, seed=9, **PLAIN)
    plain, filtered = (rendered(context, scene, samples=16, sampler=sampler, **kind) for kind in (PLAIN, FOOTPRINT))
    # The BRDF's noise falls by a factor; the combined sampler's is the map's here (docs/decisions/0008), and stays as it is.
    assert deviation(filtered, truth) < (0.5 if sampler == "brdf" else 1.25) * deviation(plain, truth)
    # Sixteen times the samples shrink footprints to a sixteenth: a bias of second order falls by sixteen, noise by four and more.
    assert deviation(rendered(context, scene, samples=256, sampler=sampler, **FOOTPRINT), truth) < deviation(filtered, truth) / 3


@pytest.mark.parametrize("value", [0.0, 1e-40, 1e15])
def test_the_darkest_and_the_brightest_map(context, value):
    """A black, a denormal and the brightest map that is taken: relative to it, everything is as ever."""
    texels = np.full((16, 32, 3), value, np.float32)
    scene = scene_of(context, context.ggx(0.4, (0.9, 0.9, 0.9)), context.environment(texels))
    for sampler in ("brdf", "combined"):
        color = rendered(context, scene, samples=16, sampler=sampler, **FOOTPRINT).color[..., :3]
        assert np.isfinite(color).all()
        assert color.max() <= 1.5 * texels.max()  # twice what is reflected would show a ceiling that was counted twice


def test_one_texel_of_a_million(context):
    texels = np.full((32, 64, 3), 0.01, np.float32)
    texels[9, 17] = 1e6
    scene = scene_of(context, context.ggx(0.4, (0.9, 0.9, 0.9)), context.environment(texels))
    truth = rendered(context, scene, samples=1024, **PLAIN)
    filtered = rendered(context, scene, samples=256, **FOOTPRINT)
    covered = truth.material > 0
    assert np.isfinite(filtered.color).all()
    # The lamp is the map's sampler's: what it sends is as well known as without the filter.
    assert abs(filtered.color[covered][:, :3].mean() / truth.color[covered][:, :3].mean() - 1) < 0.02


def test_layers_are_made_when_they_are_asked_for(context):
    """Eight layers of 8 bytes a texel on the square that fits the map, or one of 16, with all their coarser levels."""
    environment = context.environment(light(directions()))  # 128 rows: a square of 128 texels a side
    scene = scene_of(context, context.ggx(0.3, (0.9, 0.9, 0.9)), environment)
    texels = sum((128 >> level) ** 2 for level in range(8))
    sizes = [rendered(context, scene, samples=16, sampler=sampler, **kind).stats.device_bytes
             for sampler, kind in (("brdf", PLAIN), ("brdf", FOOTPRINT), ("combined", PLAIN), ("combined", FOOTPRINT))]
    assert sizes[1] - sizes[0] == 16 * texels
    assert sizes[3] - sizes[2] == 8 * 8 * texels


def test_a_reference_is_never_filtered(context, smooth):
    scene = scene_of(context, context.lambert(0.5), smooth)
    pictures = [rendered(context, scene, method="reference", samples=16, filter=kind).color.tobytes() for kind in ("footprint", "none")]
    assert pictures[0] == pictures[1]
