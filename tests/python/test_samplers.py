"""The biased samplers (filtered, cut): exact where there is no blur, less noisy elsewhere, without cost where they are
not used."""

import numpy as np
import pytest

from support import LUMINANCE, directions, light, rendered

EVERY = {"coarsest_level": 0}  # pixel is shaded
SIZE = 48, 40


def scene_of(shared, brdf, environment):
    scene = shared.scene()
    scene.environment = environment
    scene.add(shared.builtin_mesh("sphere", 64), brdf)
    scene.camera(eye=(0.3, 0.4, 1.9), target=(0, 0, 0), fov_y=0.6)
    return scene


def deviation(frame, truth):
    """Root mean square over the covered pixels, relative to their truth."""
    covered = truth.material > 0
    return np.sqrt(np.mean((frame.color[covered][:, :3] / truth.color[covered][:, :3] - 1) ** 2))


@pytest.fixture(scope="module")
def smooth(shared):
    return shared.environment(light(directions()))


def test_a_constant_map_has_no_footprint(shared):
    """The mean of a constant over any footprint is the constant: a Lambertian furnace is exact up to the 2^-11 of half
    floats."""
    scene = scene_of(shared, shared.lambert(1.0), shared.environment(np.ones((16, 32, 3), np.float32)))
    frame = rendered(shared, scene, *SIZE, samples=4, sampler="filtered", **EVERY)
    np.testing.assert_allclose(frame.color[frame.material > 0], 1, atol=2**-11)


def test_a_mirror_looks_the_map_up_as_it_is(shared, smooth):
    """A footprint below a texel of 128 x 128 (8e-4 steradians at most) is a lookup of the map itself.

    GGX of alpha a draws densities below p with a chance of 2 a sqrt(pi p): footprints of 1 / (16 p) reach a texel for
    0.3 % of the samples, and 5 % of the pixels have one. The others differ by where their points lie, within a peak
    some 1e-4 radians wide.
    """
    scene = scene_of(shared, shared.ggx(1e-4, (0.9, 0.9, 0.9)), smooth)
    plain, filtered = (rendered(shared, scene, *SIZE, samples=16, sampler=sampler, **EVERY)
                       for sampler in ("brdf", "filtered"))
    covered = plain.material > 0
    apart = abs(filtered.color[covered] / plain.color[covered] - 1).max(axis=-1)
    assert (apart > 1e-3).mean() < 0.15
    assert deviation(filtered, plain) < 0.05  # 5 % of the pixels, one of whose 16 samples is blurred


@pytest.mark.parametrize("sampler, unbiased", [("filtered", "brdf"), ("cut", "combined")])
def test_biased_samplers_have_less_noise_and_converge(shared, smooth, sampler, unbiased):
    scene = scene_of(shared, shared.ggx(0.3, (0.9, 0.6, 0.3)), smooth)
    truth = rendered(shared, scene, *SIZE, samples=1024, accumulate=16, seed=9, sampler="combined", **EVERY)
    plain = rendered(shared, scene, *SIZE, samples=16, sampler=unbiased, **EVERY)
    biased, finer = (rendered(shared, scene, *SIZE, samples=samples, sampler=sampler, **EVERY) for samples in (16, 256))
    # Half the error at equal samples (a quarter of the samples at equal error) under the smoothest map.
    assert deviation(biased, truth) < 0.5 * deviation(plain, truth)
    # Sixteen times the samples shrink footprints and parts to a sixteenth: a bias of second order falls by sixteen,
    # noise by four and more.
    assert deviation(finer, truth) < deviation(biased, truth) / 3


def test_a_cut_of_a_constant_map_is_the_constant(shared):
    """Light below the soft ceilings and light above them add up to the furnace's 1, at any roughness.

    The nodes of the cut are cells of the sphere, and the cosine is that at their centres. With 16 samples a cell is w =
    0.6 radians wide. One that the horizon halves contributes nothing instead of its w^3 / (8 pi) = 0.9 %, or twice
    that: of some ten around the horizon, half at most err to one side. Half of the light lies above the ceilings. With
    1,024 samples a cell is 0.1 radians wide.
    """
    scene = scene_of(shared, shared.lambert(1.0), shared.environment(np.ones((16, 32, 3), np.float32)))
    for samples, bound in ((16, 0.045), (1024, 0.003)):
        frame = rendered(shared, scene, *SIZE, samples=samples, sampler="cut", **EVERY)
        np.testing.assert_allclose(frame.color[frame.material > 0], 1, atol=bound)


def test_a_cut_does_not_depend_on_the_orientation_of_the_world(shared):
    """Turning the world by a quarter about the up axis turns the map's columns, its blocks and its tree along."""
    texels = light(directions())
    pictures = []
    for quarter in (0, 1):
        scene = shared.scene()
        scene.environment = shared.environment(np.roll(texels, quarter * texels.shape[1] // 4, axis=1))
        scene.add(shared.builtin_mesh("sphere", 64), shared.ggx(0.3, (0.9, 0.6, 0.3)))
        angle = -quarter * np.pi / 2  # +X of the map lies left of its middle
        scene.camera(eye=(1.9 * np.sin(0.3 + angle), 0.4, 1.9 * np.cos(0.3 + angle)), target=(0, 0, 0), fov_y=0.6)
        pictures.append(rendered(shared, scene, *SIZE, samples=1024, sampler="cut", **EVERY))
    one, other = (picture.color[picture.material > 0][:, :3].mean(axis=0) for picture in pictures)
    # Two frames of 1,024 samples a pixel, each within half a percent: their means agree to far better.
    np.testing.assert_allclose(one, other, rtol=2e-3)


@pytest.mark.parametrize("value", [0.0, 1e-40, 1e15])
def test_the_darkest_and_the_brightest_map(shared, value):
    """A black map, a denormal one and the brightest that is accepted."""
    texels = np.full((16, 32, 3), value, np.float32)
    scene = scene_of(shared, shared.ggx(0.4, (0.9, 0.9, 0.9)), shared.environment(texels))
    for sampler in ("filtered", "cut"):
        color = rendered(shared, scene, *SIZE, samples=16, sampler=sampler, **EVERY).color[..., :3]
        assert np.isfinite(color).all()
        assert color.max() <= 1.5 * texels.max()  # light counted both below and above a ceiling would be twice as much


def test_one_texel_of_a_million(shared):
    texels = np.full((32, 64, 3), 0.01, np.float32)
    texels[9, 17] = 1e6
    scene = scene_of(shared, shared.ggx(0.4, (0.9, 0.9, 0.9)), shared.environment(texels))
    truth = rendered(shared, scene, *SIZE, samples=1024, sampler="combined", **EVERY)
    cut = rendered(shared, scene, *SIZE, samples=256, sampler="cut", **EVERY)
    covered = truth.material > 0
    assert np.isfinite(cut.color).all()
    # The lamp is a node of every cut, so that its light has no noise.
    assert abs(cut.color[covered][:, :3].mean() / truth.color[covered][:, :3].mean() - 1) < 0.02


@pytest.mark.parametrize("hides, bytes_below", [(False, 8), (True, 16)])
def test_tables_are_made_when_a_sampler_needs_them(context, hides, bytes_below):
    """The sampler filtered needs one layer of 16 bytes a texel on the square that fits the map; cut needs eight layers
    of 8 bytes, and the tree. Both have all coarser levels. A texel of the eight layers has 16 bytes where a surface may
    face light so dim, relative to light that it does not see, that half floats cannot hold it."""
    radiance = light(directions())
    if hides:
        radiance[40, 0] = 1e9
    environment = context.environment(radiance)  # 128 rows: a square of 128 texels a side
    scene = scene_of(context, context.ggx(0.3, (0.9, 0.9, 0.9)), environment)
    texels = sum((128 >> level) ** 2 for level in range(8))
    sizes = [rendered(context, scene, *SIZE, samples=16, sampler=sampler, split_suns="off", **EVERY).stats.device_bytes
             for sampler in ("brdf", "filtered", "combined", "cut")]
    importance = 64 * (2 * 16 * 16 + 1) * 4  # of each view, means and peaks of cells, and their integral
    points = 65536 * 32 + 64 * 32  # control samples and rechecks of both biased samplers use directions of the map
    tree = (64 + 32) * (512 * (4 + 8 * 4) * 4 + 32)  # two trunks, each of whose nodes has a tree
    assert sizes[1] - sizes[0] == 16 * texels + points + importance
    assert sizes[2] == sizes[1]
    assert sizes[3] - sizes[2] == 8 * bytes_below * texels + tree


def test_a_reference_has_no_bias(shared, smooth):
    scene = scene_of(shared, shared.lambert(0.5), smooth)
    frames = [rendered(shared, scene, *SIZE, method="reference", samples=16, sampler=sampler)
              for sampler in ("cut", "brdf")]
    assert frames[0].color.tobytes() == frames[1].color.tobytes()
    assert frames[0].stats.control_pixels == 0 and frames[0].stats.bias_error == 0


def test_control_samples_find_the_bias(shared):
    """Under one lamp, filtering errs by far more than the spread of its samples: the frame estimates by how much."""
    texels = np.full((64, 128, 3), 0.05, np.float32)
    texels[20:23, 40:43] = 500
    scene = scene_of(shared, shared.ggx(0.1, (0.9, 0.6, 0.3)), shared.environment(texels))
    truth = rendered(shared, scene, *SIZE, samples=4096, seed=9, sampler="combined", **EVERY)
    frame = rendered(shared, scene, *SIZE, samples=16, sampler="filtered", **EVERY)
    covered = truth.material > 0
    seen, true = (picture.color[covered][:, :3] @ LUMINANCE for picture in (frame, truth))
    error = np.sqrt(np.mean(((seen - true) / (true + 0.01 * true.mean())) ** 2))
    assert frame.stats.control_pixels > 100
    assert frame.stats.bias_error > 0.3 * frame.stats.error
    # Squared deviations are clamped at 1, and half of the few hundred covered pixels are in the control set.
    assert frame.stats.error == pytest.approx(error, rel=0.5)
