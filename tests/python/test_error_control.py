"""A target error or a time budget: what was asked for, what the frame estimates, and what its error is."""

import numpy as np
import pytest

import lightband
from support import BLOB_SIZE, directions, light, luminance, render_blob, rendered


def true_error(frame, a, b):
    """Relative error by two independent references, whose noise cancels."""
    covered = frame.material > 0
    reference = 0.5 * (a + b)[covered]
    scale = reference + 0.01 * reference.mean()
    own = luminance(frame)[covered]
    return np.sqrt(max(np.mean((own - a[covered]) * (own - b[covered]) / scale**2), 0))


@pytest.fixture(scope="module", params=["rough-gold", "matte-fabric", "interference-paint"])
def subject(request, shared, blob_references):
    return shared.builtin_brdf(request.param), blob_references(request.param)


@pytest.mark.parametrize("asked", [0.1, 0.03, 0.01])
def test_the_target_error_is_reached_and_not_far_exceeded(shared, subject, asked):
    brdf, references = subject
    frames = [render_blob(shared, brdf, target_error=asked, seed=seed) for seed in (1, 2, 3)]
    got = np.array([true_error(frame, *references) for frame in frames])
    # Of any frame at most 1.5 times the target error, and of the median at least a third: a frame of few pixels cannot
    # stop in the middle of a round, and one that has the fewest samples everywhere cannot have fewer.
    assert got.max() < 1.5 * asked
    fewest = all(np.percentile(frame.sample_count[frame.sample_count > 0], 90) <= 16 for frame in frames)
    assert np.median(got) > asked / 3 or fewest
    for frame, true in zip(frames, got):
        assert frame.stats.error <= asked
        # The estimate is of 3,000 pixels and some 200 validation pixels.
        assert frame.stats.error / 1.5 < true < 1.5 * frame.stats.error


@pytest.mark.parametrize("settings", [{"samples": 16}, {"samples": 256, "sampler": "combined"}, {"method": "reference", "samples": 64},
                                      {"samples": 64, "coarsest_level": 0}, {"samples": 16, "accumulate": 8},
                                      {"sampler": "brdf", "samples": 64}])
def test_every_frame_estimates_its_error(shared, subject, settings):
    brdf, references = subject
    frame = render_blob(shared, brdf, seed=5, **settings)
    assert frame.stats.error / 1.6 < true_error(frame, *references) < 1.6 * frame.stats.error


@pytest.mark.parametrize("settings", [{"target_error": 0.05}, {"samples": 16, "accumulate": 8}])
def test_the_error_field_has_the_frames_error_as_root_mean_square(shared, subject, settings):
    frame = render_blob(shared, subject[0], **settings)
    covered = frame.material > 0
    assert np.sqrt(np.mean(frame.error[covered].astype(np.float64) ** 2)) == pytest.approx(frame.stats.error, rel=1e-5)
    assert (frame.error[~covered] == 0).all() and (frame.error >= 0).all()
    parts = np.linalg.norm([frame.stats.noise_error, frame.stats.interpolation_error, frame.stats.bias_error])
    assert parts == pytest.approx(frame.stats.error, rel=1e-12)


def test_the_error_field_is_large_where_the_error_is(shared, subject):
    """Pixels in four groups by their estimated error: their true errors rise in the same order."""
    brdf, (a, b) = subject
    frame = render_blob(shared, brdf, samples=64, allocation="constant_variance", sampler="brdf", seed=6)
    covered = frame.material > 0
    reference = 0.5 * (a + b)
    squared = ((luminance(frame) - a) * (luminance(frame) - b) / (reference + 0.01 * reference[covered].mean()) ** 2)[covered]
    groups = np.array_split(np.argsort(frame.error[covered]), 4)
    errors = [squared[group].mean() for group in groups]
    assert errors[0] < errors[3]


def test_a_frame_without_prediction_reaches_its_target_error(shared, subject):
    """Its further rounds are planned by what previous ones measured, and by nothing else."""
    frame = render_blob(shared, subject[0], method="reference", sampler="combined", target_error=0.02)
    covered = frame.material > 0
    assert frame.stats.rounds > 1
    assert frame.stats.shaded_pixels == covered.sum() == np.count_nonzero(frame.sample_count)
    assert frame.sample_count[covered].min() >= 16 and len(np.unique(frame.sample_count[covered])) > 1
    assert frame.stats.error <= 0.02


def test_smaller_target_errors_take_more_samples(shared, subject):
    frames = [render_blob(shared, subject[0], target_error=asked) for asked in (0.1, 0.03, 0.01)]
    assert frames[0].stats.samples < frames[1].stats.samples < frames[2].stats.samples


def test_equal_seeds_give_equal_frames(shared, subject):
    first, second = (render_blob(shared, subject[0], target_error=0.05, seed=8) for _ in range(2))
    assert np.array_equal(first.color, second.color) and first.stats.error == second.stats.error


def test_a_time_budget_is_spent(shared, subject):
    """Not a measurement of speed: a budget of forty times another buys a better frame, from more samples, on a busy
    machine too."""
    for _ in range(2):  # drivers compile until a shader's second use, which may take longer than any budget
        render_blob(shared, subject[0], time_budget=400)
    frames = [render_blob(shared, subject[0], time_budget=budget) for budget in (40, 1600)]
    assert frames[1].stats.samples > 2 * frames[0].stats.samples
    assert frames[1].stats.error < frames[0].stats.error


def test_whichever_comes_first(shared, subject):
    brdf = subject[0]
    easy = render_blob(shared, brdf, target_error=0.2, time_budget=1e6)
    assert easy.stats.error <= 0.2
    hard = render_blob(shared, brdf, target_error=1e-5, time_budget=50)
    assert hard.stats.error > 1e-5
    assert 0 < hard.stats.samples < 0.1 * hard["max_samples"] * hard.stats.covered_pixels


def test_an_error_cannot_be_asked_of_accumulated_frames(shared, scene):
    frame = shared.frame(8, 8, target_error=0.1, accumulate=2)
    with pytest.raises(lightband.StateError, match="accumulate is 2.*target_error"):
        frame.render(scene)


def test_every_round_has_other_validation_pixels(shared):
    """Where levels do not change, the new pixels of a round are its validation pixels: some sixteenth of the
    interpolated ones."""
    scene = shared.scene()
    scene.environment = shared.environment(light(directions()))
    scene.add(shared.builtin_mesh("blob", 128), shared.builtin_brdf("interference-paint"))
    scene.camera(eye=(0.3, 0.4, 1.9), target=(0, 0, 0), fov_y=0.6)
    # Both have the same tolerance of the contrast test (3 %), so that their first rounds are alike.
    frames = [shared.frame(160, 128, target_error=asked, bandwidth_scale=0.2) for asked in (0.025, 0.01)]
    for frame in frames:
        frame.render(scene)
    few, many = (frame.stats for frame in frames)
    assert few.rounds < many.rounds == 8
    new_pixels = (many.shaded_pixels - few.shaded_pixels) / (many.rounds - few.rounds)
    left = many.covered_pixels - np.array([few.shaded_pixels, many.shaded_pixels])
    assert 0.8 * left.min() / 16 < new_pixels < 1.2 * left.max() / 16


@pytest.mark.parametrize("size", [1, 2, 4, 8])
def test_tiny_frames_estimate_their_bias(shared, size):
    """Under constant light all samples of a cut err alike, which no spread contains. All of so few pixels are in the
    control set, which sees the squared error up to a factor of 1 + 0.3 / 4^1.2 (src/frame/control_set.cpp)."""
    scene = shared.scene()
    scene.environment = shared.environment(np.ones((8, 16, 3), np.float32))
    scene.add(shared.builtin_mesh("plane"), shared.lambert(0.5))
    scene.camera(eye=(0, 0, 0.6), target=(0, 0, 0))
    frame = shared.frame(size, size)
    frame.render(scene)
    true = np.sqrt(np.mean(((luminance(frame) - 0.5) / 0.505) ** 2))
    assert frame.stats.control_pixels == size * size
    if frame.stats.sampler_replaced:  # unbiased samples have no error here, and the recheck detected that
        assert true < 1e-5 < frame.stats.error
    else:
        assert true > 0.005 and true / 1.6 < frame.stats.error < 1.6 * true


def test_a_black_frame_has_no_error(shared):
    scene = shared.scene()
    scene.environment = shared.environment(np.zeros((4, 8, 3), np.float32))
    scene.add(shared.builtin_mesh("sphere", 32), shared.lambert(0.5))
    scene.camera(eye=(0, 0, 3), target=(0, 0, 0))
    frame = shared.frame(16, 16, target_error=0.01)
    frame.render(scene)
    assert frame.stats.error == 0 and frame.stats.rounds == 1 and not frame.error.any()


def test_a_frame_that_sees_nothing_has_no_error(shared):
    scene = shared.scene()
    scene.environment = shared.environment(light(directions()))
    scene.camera(eye=(0, 0, 3), target=(0, 0, 0))
    frame = shared.frame(16, 16, target_error=0.01)
    frame.render(scene)
    assert frame.stats.error == 0 and frame.stats.samples == 0


def test_progress_of_rounds_never_goes_back(shared, scene):
    frame = shared.frame(64, 64, target_error=0.01)
    seen = []
    frame.render(scene, progress=seen.append)
    assert seen == sorted(seen) and seen[0] == 0 and seen[-1] == 1
    with pytest.raises(lightband.Cancelled):
        frame.render(scene, progress=lambda fraction: lightband.CANCEL if fraction > 0 else None)


def test_progress_moves_while_a_frame_is_shaded(shared, scene):
    """In dispatches of 2^23 samples at most, whatever the most is that a pixel might have."""
    for settings in ({"samples": 2048}, {"method": "reference", "samples": 2048}):
        frame = shared.frame(192, 192, coarsest_level=0, max_samples=1 << 16, **settings)
        seen = []
        frame.render(scene, progress=seen.append)
        assert any(0.2 < fraction < 0.8 for fraction in seen)
        frame["samples"] = 16
        seen.clear()
        frame.render(scene, progress=seen.append)
        assert seen.count(1) <= 2  # at the end of the last dispatch, and of the frame


def test_of_few_pixels_all_that_may_be_interpolated_are_validated(shared):
    """A sixteenth would be too few validation pixels; in a second round all are, so that none is interpolated without
    validation."""
    scene = shared.scene()
    scene.environment = shared.environment(np.random.default_rng(1).uniform(size=(16, 32, 3)).astype(np.float32) ** 4)
    scene.add(shared.builtin_mesh("sphere", 32), shared.builtin_brdf("matte-fabric"))
    scene.camera(eye=(0, 0, 1.3), target=(0, 0, 0))
    with_second_round = 0
    for size, seed in ((10, 3), (12, 3), (14, 1), (14, 2), (16, 3)):
        frame = shared.frame(size, size, target_error=0.02, bandwidth_scale=0.2, seed=seed)
        frame.render(scene)
        if frame.stats.rounds > 1:
            with_second_round += 1
            assert frame.stats.shaded_pixels == frame.stats.covered_pixels <= 255
    assert with_second_round > 0


@pytest.fixture(scope="module")
def many_samples(shared):
    """A material and its picture with many samples of every pixel."""
    brdf = shared.ggx(0.3, (0.9, 0.7, 0.4))
    return brdf, luminance(render_blob(shared, brdf, samples=16384, coarsest_level=0, sampler="combined", seed=7001))


@pytest.mark.parametrize("samples", [1, 2, 3, 4, 5])
def test_the_fewest_samples_are_unbiased(shared, many_samples, samples):
    """One sample of a pixel comes from the lobe or from the map by chance: frames of few samples have, on average, the
    values of a frame of many."""
    brdf, many = many_samples
    means = []
    for seed in range(0, 16000, 1000):
        few = render_blob(shared, brdf, accumulate=2, samples=samples, coarsest_level=0, sampler="combined", seed=seed)
        covered = few.material > 0
        means.append(np.mean(luminance(few)[covered] / many[covered]) - 1)
    # Frames are independent of each other, so their spread gives the standard error of their mean. It is a quarter of a
    # percent for one sample. Student's t of 15 degrees of freedom exceeds 5.2 once in 10,000 times.
    assert abs(np.mean(means)) < 5.2 * np.std(means, ddof=1) / np.sqrt(len(means))


def one_bright_texel():
    radiance = np.full((32, 64, 3), 0.1, np.float32)
    radiance[10, 20] = 1e6
    return radiance


EXTREME_MAPS = {"sun of 1e6": one_bright_texel(), "one texel": np.ones((1, 1, 3), np.float32),
                "denormal": np.full((4, 8, 3), 1e-39, np.float32), "brightest": np.full((4, 8, 3), 1e15, np.float32)}


@pytest.mark.parametrize("size", [(1, 1), (1, 97), (53, 31)])
@pytest.mark.parametrize("map_name", EXTREME_MAPS)
@pytest.mark.parametrize("material", ["mirror", "black", "rough"])
@pytest.mark.parametrize("asked", [{"target_error": 0.05}, {"time_budget": 20}])
def test_extremes_have_an_error_too(shared, size, map_name, material, asked):
    """Pictures and estimates are finite whatever is asked for, and a black material has no error."""
    brdf = {"mirror": lambda: shared.ggx(1e-4, (1, 1, 1)), "black": lambda: shared.lambert(0),
            "rough": lambda: shared.ggx(0.5, (0.5, 0.5, 0.5))}[material]()
    scene = shared.scene()
    scene.environment = shared.environment(EXTREME_MAPS[map_name])
    scene.add(shared.builtin_mesh("sphere", 32), brdf)
    scene.camera(eye=(0, 0, 2), target=(0, 0, 0))
    frame = shared.frame(*size, max_samples=1024, **asked)
    frame.render(scene)
    assert np.isfinite(frame.color).all() and (frame.color >= 0).all()
    assert np.isfinite(frame.error).all() and np.isfinite(frame.stats.error)
    if material == "black":
        assert frame.stats.error == 0 and not frame.color[..., :3].any()


def test_every_control_pixel_is_compared_with_itself(shared):
    """Pixels of two materials, a bright and a dark one, are shaded in another order than they are compared in."""
    scene = shared.scene()
    scene.environment = shared.environment(light(directions()))
    for x, material in ((-0.45, "matte-fabric"), (0.45, "rough-gold")):
        matrix = np.eye(4)
        matrix[0, 3] = x
        scene.add(shared.builtin_mesh("sphere", 64), shared.builtin_brdf(material), matrix)
    scene.camera(eye=(0, 0.2, 2.5), target=(0, 0, 0), fov_y=0.7)

    settings = {"samples": 8192, "coarsest_level": 0, "sampler": "combined"}
    references = [luminance(rendered(shared, scene, *BLOB_SIZE, seed=seed, **settings)) for seed in (93, 94)]
    frame = rendered(shared, scene, *BLOB_SIZE, target_error=0.03)
    assert frame.stats.control_pixels > 100
    # As with one material alone; if a pixel was compared with another one, the estimate could not fall below their
    # difference.
    assert true_error(frame, *references) < 1.5 * 0.03
    assert frame.stats.error <= 0.03
    assert frame.stats.samples < 256 * frame.stats.covered_pixels
