"""Bandwidth at the eye, pixel by pixel, against the operators of src/bandwidth/transport.h in double precision, under light of known
bandwidth: isolated texels, whose own is kept by a mirror, and cut to the lobe's by a matte surface."""

import numpy as np
import pytest

from support import rendered

SIDE, PILOTS, NYQUIST = 96, 16, 0.5
EPSILON = 2.0**-23  # of float
MEAN_ERROR = (PILOTS + 4) * EPSILON  # of a mean over pilots: half of that for each term of each of two sums, and conversions
SEGMENTS = 256  # of the sphere, around


@pytest.fixture(scope="module")
def lights(shared):
    """A black sky but for texels around +Y, four apart on the octahedral square, and what bounds the bandwidth of those."""
    height, side = 64, 64
    x, z = np.meshgrid(*2 * [(np.arange(2 * side) + 0.5) / side - 1])  # 2 x 2 lookups in each texel, as shaders/environment_resample.glsl
    y = 1 - np.abs(x) - np.abs(z)
    latitude = np.arccos(y / np.sqrt(x * x + y * y + z * z))
    rows, columns = (latitude / np.pi * height).astype(int), ((0.5 - np.arctan2(x, z) / (2 * np.pi)) * 2 * height).astype(int)
    chosen = (latitude < 0.5) & ((np.indices(x.shape) // 2 % 4 == 2).all(0))
    radiance = np.zeros((height, 2 * height, 3))
    radiance[rows[chosen], columns[chosen]] = 1
    environment = shared.environment(radiance)
    lit = radiance[rows, columns, 0].reshape(side, 2, side, 2).any((1, 3))
    assert environment.bandwidth.shape == lit.shape
    bandwidth = environment.bandwidth[lit]
    return environment, np.array([bandwidth.min(), bandwidth.max()], float)


@pytest.fixture(scope="module")
def materials(shared):
    """What reflects all that arrives, its bandwidth unbounded, and what cuts it."""
    return {"mirror": shared.ggx(1e-4, 1), "matte": shared.lambert(1)}


def shown(shared, environment, material, radius, distance, **settings):
    """The side of a sphere that mirrors +Y to an eye so many radii away, up to the silhouette."""
    scene = shared.scene()
    scene.environment = environment
    scene.add(shared.builtin_mesh("sphere", SEGMENTS), material, np.diag([2 * radius, 2 * radius, 2 * radius, 1]))
    scene.camera((0, 0, distance * radius), (0, 0.7 * radius, 0.7 * radius), fov_y=1.2 / distance)
    return rendered(shared, scene, SIDE, SIDE, samples=1, sampler="brdf", pilots=PILOTS, **settings)


@pytest.mark.parametrize("distance", [3, 6])
@pytest.mark.parametrize("radius", [1, 1e-3])
@pytest.mark.parametrize("material", ["mirror", "matte"])
@pytest.mark.parametrize("transport", ["correlated", "box"])
def test_bandwidth_at_the_eye(shared, lights, materials, transport, material, radius, distance):
    environment, light = lights
    frame = shown(shared, environment, materials[material], radius, distance, transport=transport)
    seen = frame.material > 0
    spatial, angular, image, curvature = (frame.buffer(name)[seen].astype(float)
                                          for name in ("bandwidth_spatial", "bandwidth_angular", "bandwidth_image", "curvature"))
    to_eye = (0, 0, distance * radius) - frame.position[seen].astype(float)
    travelled = np.linalg.norm(to_eye, axis=-1)
    cosine = np.sum(frame.normal[seen] * to_eye, -1) / travelled

    # Within a flat triangle positions sink by up to 1/8, and steps stretch by 1/4, of its diagonal's square (two squared segments). A
    # sphere's two curvatures differ by the root of what cancelling products leave: 8 EPSILON over the squared sine between the steps.
    assert (np.abs(curvature * radius - 1) < 0.75 * (2 * np.pi / SEGMENTS) ** 2 + np.sqrt(8 * EPSILON) / cosine).all()

    lobe = materials[material].bandwidth
    kept_bounds = np.minimum(light, [lobe.min(), lobe.max()])[:, None]
    first_bounds = light[:, None] if transport == "box" else kept_bounds  # what the light's side shears
    least, most = kept_bounds + travelled * curvature * (first_bounds + kept_bounds) / cosine
    radians_per_pixel = 2 * np.tan(0.6 / distance) / SIDE
    limit, lit = NYQUIST / radians_per_pixel, angular > 0
    assert (angular[lit] > np.minimum(least, limit)[lit] * (1 - MEAN_ERROR)).all()
    assert (angular < np.minimum(most, limit) * (1 + MEAN_ERROR)).all()

    free = lit & (most < limit)  # no pilot was limited: both components are linear in what was kept
    kept = angular - travelled * spatial
    first = spatial * cosine / curvature - kept
    error = (2 * MEAN_ERROR + 8 * EPSILON) * angular  # of both means, and of cosine and distance from public arrays
    assert free.sum() > 100
    for value, (low, high) in ((kept, kept_bounds), (first, first_bounds)):
        assert (value > low - error)[free].all() and (value < high + error)[free].all()
    if transport == "correlated" or material == "mirror":
        assert (np.abs(first - kept) < error)[free].all()

    expected = np.minimum(angular * radians_per_pixel, NYQUIST)
    full = angular > limit * (1 - MEAN_ERROR)
    assert full.any() and (image[full] == NYQUIST).all()
    np.testing.assert_allclose(image, expected, rtol=MEAN_ERROR)


def test_curvature_is_the_larger_of_two(shared, lights, materials):
    """A torus turns by 1 / 0.14 m around its tube, by 1 / 0.2 m at most along it. One-sided differences err by half of a pixel's turn."""
    scene, eye = shared.scene(), (0.3, 1.3, 0.6)
    scene.environment = lights[0]
    scene.add(shared.builtin_mesh("torus"), materials["mirror"])
    scene.camera(eye, (0, 0, 0), fov_y=0.6)
    frame = rendered(shared, scene, SIDE, SIDE, samples=1)
    to_eye = eye - frame.position.astype(float)
    travelled = np.linalg.norm(to_eye, axis=-1)
    cosine = np.sum(frame.normal * to_eye, -1) / travelled
    turn = travelled * 2 * np.tan(0.3) / SIDE / cosine.clip(0.5) / 0.14
    plain = (frame.material > 0) & (cosine > 0.5)
    assert plain.sum() > 1000 and (np.abs(frame.curvature * 0.14 - 1) < 0.5 * turn)[plain].all()


@pytest.mark.parametrize("scale", [0.1, 1, 3])
@pytest.mark.parametrize("material", ["mirror", "matte"])
def test_a_level_is_the_coarsest_spacing_that_nyquist_allows(shared, lights, materials, material, scale):
    frame = shown(shared, lights[0], materials[material], 1, 3, bandwidth_scale=scale, coarsest_level=4)
    seen = frame.material > 0
    image, level = frame.bandwidth_image[seen].astype(float), frame.level[seen]
    # log2 errs by 3 units of up to 2^-21 below 8 (GLSL 4.50, 4.7.1), its argument by three roundings: 10 EPSILON of the bandwidth.
    for slack, compare in ((10, np.less_equal), (-10, np.greater_equal)):
        spacing = NYQUIST / np.maximum(scale * image * (1 + slack * EPSILON), 1e-30)
        expected = np.where(image < NYQUIST, np.clip(np.floor(np.log2(spacing)), 0, 4), 0)
        assert compare(expected, level).all()
    assert (image == NYQUIST).any() and len(set(level)) > 1
