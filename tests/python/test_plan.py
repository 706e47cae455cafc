"""The plan of a frame holds the passes that scene and settings need and no others, and what is not needed takes no
memory."""

import numpy as np
import pytest

from support import rendered

SIZE = 64, 64
PREDICTION = ["environment", "bandwidth", "pyramids"]


@pytest.fixture
def sphere(context, environment):
    """A scene of its own, so that nothing that another frame needed is held by its map and material."""
    scene = context.scene()
    scene.environment = context.environment(np.random.default_rng(1).uniform(size=(16, 32, 3)).astype(np.float32) ** 8)
    scene.add(context.builtin_mesh("sphere", 32), context.ggx(0.3, (0.9, 0.7, 0.4)))
    scene.camera(eye=(0, 0, 2), target=(0, 0, 0))
    return scene


def passes(frame):
    return [line.split()[0] for line in frame.plan.splitlines()][:-1]  # the last line is the total


def test_an_adaptive_frame(context, sphere):
    frame = rendered(context, sphere, *SIZE, samples=16)
    assert passes(frame) == ["gbuffer", "covered", "environment", "bandwidth", "control", "pilot", "recheck", "pyramids", "classify", "list",
                             "shade", "upsample", "estimate", "combine"]
    assert frame.stats.rounds == 1


def test_an_unbiased_sampler_has_no_control_set(context, sphere):
    frame = rendered(context, sphere, *SIZE, samples=16, sampler="combined")
    assert passes(frame) == ["gbuffer", "covered", *PREDICTION, "classify", "list", "shade", "upsample", "estimate", "combine"]
    assert frame.stats.control_pixels == 0 and frame.stats.bias_error == 0


def test_a_reference_predicts_and_interpolates_nothing(context, sphere):
    frame = rendered(context, sphere, *SIZE, method="reference", samples=16)
    assert passes(frame) == ["gbuffer", "covered", "classify", "list", "shade", "estimate"]
    assert frame.stats.interpolation_error == 0


def test_without_levels_nothing_is_interpolated(context, sphere):
    frame = rendered(context, sphere, *SIZE, samples=16, coarsest_level=0)
    assert "upsample" not in passes(frame)
    assert frame.stats.shaded_pixels == frame.stats.covered_pixels


def test_no_background_no_pass(context, sphere):
    assert "background" not in passes(rendered(context, sphere, *SIZE, samples=16))
    assert passes(rendered(context, sphere, *SIZE, samples=16, background="environment"))[-1] == "background"


def test_rounds_repeat_passes_and_add_none(context, sphere):
    frame = rendered(context, sphere, *SIZE, time_budget=400)
    for _ in range(4):  # in the first frames, tables and the driver's compiler take all of the time
        frame.render(sphere)
        if frame.stats.rounds == 2 and "control" in passes(frame):
            break
    assert frame.stats.rounds == 2
    once = passes(rendered(context, sphere, *SIZE, samples=16))
    # Where time is short there are no pilot samples; where it is plenty, every pixel is shaded in the end.
    names = passes(frame)
    assert [name for name in once if name in names] == names
    assert set(once) - set(names) <= ({"pilot", "upsample", "combine"} if frame.stats.shaded_pixels == frame.stats.covered_pixels else {"pilot"})
    assert passes(rendered(context, sphere, *SIZE, target_error=0.1)) == once


def test_without_a_gain_nothing_is_interpolated(context, sphere):
    """A target error so small that nearly every pixel is shaded is reached sooner where all are."""
    frame = rendered(context, sphere, *SIZE, target_error=0.001)
    assert frame.stats.shaded_pixels == frame.stats.covered_pixels and "upsample" not in passes(frame)
    assert rendered(context, sphere, *SIZE, target_error=0.1).stats.shaded_pixels < frame.stats.shaded_pixels
    # The buffers of interpolation are released, and levels are those of the bandwidth without a scale.
    every = rendered(context, sphere, *SIZE, target_error=0.001, coarsest_level=0)
    assert frame.stats.device_bytes == every.stats.device_bytes
    np.testing.assert_array_equal(frame.level, rendered(context, sphere, *SIZE, samples=16, bandwidth_scale=1).level)


def test_variances_are_gathered_where_sample_weights_follow_them(context, sphere):
    """With the sampler cut, all pixels of one spacing have equal numbers of samples; the field exists all the same."""
    by_variance, equal = (rendered(context, sphere, *SIZE, samples=16, bandwidth_scale=1, allocation=allocation)
                     for allocation in ("constant_variance", "least_error"))
    rows = by_variance.level_pyramid.shape[0]
    lists = 4 * (by_variance.stats.shaded_pixels - equal.stats.shaded_pixels)
    assert by_variance.stats.device_bytes - equal.stats.device_bytes == 4 * rows * 64 + lists
    np.testing.assert_array_equal(by_variance.variance_pyramid, equal.variance_pyramid)
    assert by_variance.variance_pyramid.max() > 0


def test_the_brdf_sampler_makes_no_directions_of_the_map(context, sphere):
    """The map's directions, 65,536 of 32 bytes, and 64 clusters of as many are computed when they are first needed."""
    before = rendered(context, sphere, *SIZE, samples=16, coarsest_level=0, sampler="brdf").stats.device_bytes
    after = rendered(context, sphere, *SIZE, samples=16, coarsest_level=0, sampler="combined").stats.device_bytes
    importance = 64 * (2 * 16 * 16 + 1) * 4  # of each view, means and peaks of cells, and their integral
    assert after - before == 65536 * 32 + 64 * 32 + importance


def test_only_covered_pixels_are_in_lists(context, sphere):
    """Passes over covered pixels process no others."""
    frame = rendered(context, sphere, *SIZE, samples=16)
    for line in frame.plan.splitlines():
        if line.split()[0] in ("bandwidth", "classify", "upsample"):
            assert f" {frame.stats.covered_pixels} pixels" in line


@pytest.mark.parametrize("settings", [{}, {"allocation": "constant_variance"}, {"coarsest_level": 0}, {"method": "reference"}], ids=str)
def test_a_plan_predicts_passes_and_bytes(context, sphere, settings):
    """It counts lists at the size that they may have at most, 4 bytes a pixel."""
    def planned_bytes(frame):
        return sum(float(line[12:].split()[0]) for line in frame.plan_for(sphere).splitlines()) * 1e6

    frames = [context.frame(side, side, samples=16, background="environment", **settings) for side in (64, 128)]
    plans = [frame.plan_for(sphere) for frame in frames]
    planned = np.diff([planned_bytes(frame) for frame in frames])[0]
    for frame in frames:
        frame.render(sphere)
    held = np.diff([frame.stats.device_bytes for frame in frames])[0]
    lists = np.diff([4 * (frame.stats.covered_pixels + frame.stats.shaded_pixels) for frame in frames])[0]
    assert planned - 2 * 4 * (128**2 - 64**2) == pytest.approx(held - lists, abs=2e4 * len(plans[0].splitlines()))  # two decimals of a MB
    for frame, plan in zip(frames, plans):
        names = [line.split()[0] for line in plan.splitlines()]
        assert set(passes(frame)) <= set(names) and set(names) - set(passes(frame)) <= {"replace"}
        assert frame.plan_for(sphere) == plan
