"""Properties of the method that need no second renderer: turn the world, add samples."""

import numpy as np
import pytest

from support import LUMINANCE, luminance, render_blob


def quarter_turn(axis):
    """Rotation by 90 degrees about one axis."""
    turn = np.zeros((3, 3))
    a, b = [i for i in range(3) if i != axis]
    turn[axis, axis] = turn[b, a] = 1
    turn[a, b] = -1
    return turn


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("material", ["table", "ggx", "lambert"])
def test_turning_the_world_changes_nothing_but_noise(shared, axis, material):
    brdf = {"table": lambda: shared.builtin_brdf("interference-paint"), "ggx": lambda: shared.ggx(0.2, (0.9, 0.7, 0.4)),
            "lambert": lambda: shared.lambert((0.8, 0.5, 0.3))}[material]()
    before = render_blob(shared, brdf, samples=256, seed=1, coarsest_level=0)
    after = render_blob(shared, brdf, quarter_turn(axis), samples=256, seed=2, coarsest_level=0)

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
    mine, true = luminance(frame)[covered], reference[covered]
    return np.sqrt(np.mean(((mine - true) / (true + 0.01 * true.mean())) ** 2))


@pytest.mark.parametrize("material", ["rough-gold", "matte-fabric"])
def test_adaptive_converges_to_the_reference(shared, blob_references, material):
    brdf = shared.builtin_brdf(material)
    reference = np.mean(blob_references(material), axis=0)  # of 16,384 samples
    errors = [error(render_blob(shared, brdf, samples=n, seed=1), reference) for n in (16, 256, 4096)]
    # Noise falls with the root of the samples, and the balanced interpolation with it: by 4 for each factor of 16. Half of
    # that is demanded; the reference's own noise, a quarter of the last frame's at most, is within it.
    assert errors[1] < errors[0] / 2
    assert errors[2] < errors[1] / 2


def test_the_two_samplers_agree(shared):
    """Combined sampling and the papers' sampling of the BRDF have the same mean: two estimators, one integral."""
    brdf = shared.builtin_brdf("rough-nickel")
    combined = render_blob(shared, brdf, samples=4096, seed=3, coarsest_level=0, sampler="combined")
    papers = render_blob(shared, brdf, samples=4096, seed=4, method="reference")
    both = (combined.material > 0) & (papers.material > 0)
    variance = sum(f.variance_measured[both] / f.sample_count[both] for f in (combined, papers))
    difference = ((combined.color - papers.color)[..., :3] @ LUMINANCE)[both]
    # Over 2,700 pixels the skewed errors of single ones average out: the sum is normal, of deviation sqrt(sum of variances),
    # and the squares add up to no more than the variances say (stratified points do better).
    assert abs(difference.sum()) < 4 * np.sqrt(variance.sum())
    assert (difference**2).sum() < 1.2 * variance.sum()
