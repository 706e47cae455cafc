"""No shaded pixel stands out among interpolated ones: a frame's error is spread like noise of one size."""

from pathlib import Path

import numpy as np
import pytest

from support import luminance, rendered

SHIFTS = [(dy, dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dy or dx]
SIDE = 192


@pytest.fixture(scope="module")
def metal_sphere(context, shared):
    scene = context.scene()
    scene.environment = context.load_environment(Path(__file__).parents[2] / "data" / "courtyard.exr")
    scene.camera(eye=(0, 0.1, 1.6), target=(0, 0, 0))
    scene.add(shared.builtin_mesh("sphere"), shared.builtin_brdf("rough-gold"))
    return scene


def outliers(frame):
    """How many of how many inner pixels differ from the median of their eight neighbours by more than three times the frame's error."""
    shown, inner = luminance(frame), frame.material > 0
    for shift in SHIFTS:
        inner = inner & np.roll(frame.material > 0, shift, (0, 1))
    median = np.median([np.roll(shown, shift, (0, 1)) for shift in SHIFTS], axis=0)
    return np.sum(np.abs(shown[inner] / median[inner] - 1) > 3 * frame.stats.error), inner.sum()


@pytest.mark.parametrize("asked", [0.06, 0.05])
def test_no_pixel_stands_out(shared, metal_sphere, asked):
    """Normal noise leaves 2.7 in 1,000 beyond three standard deviations, give or take the root of their number; with its shaded pixels
    alone this scene had 4.5 and 8.9."""
    frame = rendered(shared, metal_sphere, SIDE, SIDE, target_error=asked)
    assert frame.stats.shaded_pixels < 0.5 * frame.stats.covered_pixels  # or nothing is tested
    many, inner = outliers(frame)
    assert many <= 2.7e-3 * inner + 3 * np.sqrt(2.7e-3 * inner)
