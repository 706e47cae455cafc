"""Properties of the method that need no second renderer: turn the world, add samples."""

import numpy as np
import pytest

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
HEIGHT, WIDTH = 128, 256


def directions():
    """Unit directions of a latitude-longitude map's texel centres: +Y up, the centre looks along +Z, +X to its left."""
    longitude = (0.5 - (np.arange(WIDTH) + 0.5) / WIDTH) * 2 * np.pi
    latitude = (0.5 - (np.arange(HEIGHT) + 0.5) / HEIGHT) * np.pi
    longitude, latitude = np.meshgrid(longitude, latitude)
    return np.stack([np.cos(latitude) * np.sin(longitude), np.sin(latitude), np.cos(latitude) * np.cos(longitude)], -1)


def light(d):
    """Three coloured lobes over a dim sky; nothing about it is symmetric."""
    centres = np.array([[0.6, 0.7, 0.4], [-0.8, 0.1, 0.6], [0.1, -0.3, 0.95]])
    centres /= np.linalg.norm(centres, axis=1, keepdims=True)
    colours = np.array([[20.0, 18, 15], [3, 6, 9], [5, 2, 1]])
    lobes = np.exp((d @ centres.T - 1) * np.array([60.0, 15, 30]))
    return (lobes @ colours + np.array([0.1, 0.15, 0.2]) * (1.2 + d[..., 1:2])).astype(np.float32)


def quarter_turn(axis):
    """Rotation by 90 degrees about one axis."""
    turn = np.zeros((3, 3))
    a, b = [i for i in range(3) if i != axis]
    turn[axis, axis] = turn[b, a] = 1
    turn[a, b] = -1
    return turn


def render(context, brdf, turn, **settings):
    """The same scene seen in a world that was turned as a whole."""
    scene = context.scene()
    scene.environment = context.environment(light(directions() @ turn))  # light from turn @ d is light(d)
    matrix = np.eye(4)
    matrix[:3, :3] = turn
    scene.add(context.builtin_mesh("blob", 128), brdf, matrix)
    scene.camera(eye=turn @ (0.3, 0.4, 1.9), target=(0, 0, 0), up=turn @ (0, 1, 0), fov_y=0.6)
    frame = context.frame(96, 80, **settings)
    frame.render(scene)
    return frame


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("material", ["table", "ggx", "lambert"])
def test_turning_the_world_changes_nothing_but_noise(context, axis, material):
    brdf = {"table": lambda: context.builtin_brdf("interference-paint"), "ggx": lambda: context.ggx(0.2, (0.9, 0.7, 0.4)),
            "lambert": lambda: context.lambert((0.8, 0.5, 0.3))}[material]()
    before = render(context, brdf, np.eye(3), samples=256, seed=1, coarsest_level=0)
    after = render(context, brdf, quarter_turn(axis), samples=256, seed=2, coarsest_level=0)

    # Rasterised positions may differ by rounding at the outline: compare what both frames see.
    both = (before.material > 0) & (after.material > 0)
    assert both.sum() > 0.99 * (before.material > 0).sum()
    deviation = np.zeros(both.shape)
    for frame in (before, after):
        deviation[both] += frame.variance_measured[both] / frame.sample_count[both]
    difference = (before.color - after.color)[..., :3] @ LUMINANCE
    brightness = before.color[..., :3] @ LUMINANCE
    # A texel is 1.4 degrees wide: the lobes, 6 degrees at their narrowest, come through bilinear lookup in another grid
    # with up to 60 / 8 * 0.0245^2 = 0.45 % less at their top (curvature of the exponential over a texel); twice that.
    score = np.maximum(np.abs(difference) - 0.009 * brightness, 0)[both] / np.sqrt(deviation[both])
    # Stratified samples err less than independent ones, whose sixth deviation one pixel in a billion exceeds.
    assert score.max() < 6


def error(frame, reference):
    covered = frame.material > 0
    mine, true = ((f.color[..., :3] @ LUMINANCE)[covered] for f in (frame, reference))
    return np.sqrt(np.mean(((mine - true) / (true + 0.01 * true.mean())) ** 2))


@pytest.mark.parametrize("material", ["rough-gold", "matte-fabric"])
def test_adaptive_converges_to_the_reference(context, material):
    brdf = context.builtin_brdf(material)
    reference = render(context, brdf, np.eye(3), samples=16384, seed=9, coarsest_level=0)
    errors = [error(render(context, brdf, np.eye(3), samples=n, seed=1), reference) for n in (16, 256, 4096)]
    # Noise falls with the root of the samples, and the balanced interpolation with it: by 4 for each factor of 16. Half of
    # that is demanded; the reference's own noise, a quarter of the last frame's at most, is within it.
    assert errors[1] < errors[0] / 2
    assert errors[2] < errors[1] / 2


def test_the_two_samplers_agree(context):
    """Combined sampling and the papers' sampling of the BRDF have the same mean: two estimators, one integral."""
    brdf = context.builtin_brdf("rough-nickel")
    combined = render(context, brdf, np.eye(3), samples=4096, seed=3, coarsest_level=0, sampler="combined")
    papers = render(context, brdf, np.eye(3), samples=4096, seed=4, method="reference")
    both = (combined.material > 0) & (papers.material > 0)
    variance = sum(f.variance_measured[both] / f.sample_count[both] for f in (combined, papers))
    difference = ((combined.color - papers.color)[..., :3] @ LUMINANCE)[both]
    # Over 2,700 pixels the skewed errors of single ones average out: the sum is normal, of deviation sqrt(sum of variances),
    # and the squares add up to no more than the variances say (stratified points do better).
    assert abs(difference.sum()) < 4 * np.sqrt(variance.sum())
    assert (difference**2).sum() < 1.2 * variance.sum()
