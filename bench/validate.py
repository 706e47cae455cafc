"""Predicted against measured: image bandwidth and variance (figure 12 of Bagher et al. 2013).

    python bench/validate.py --data DATA --materials MERL --out docs/measurements [--size 160]

For each material: the predicted image bandwidth against a 32 x 32 windowed Fourier transform of the converged picture, and the
predicted variance of a light sample against that of the samples of a converged frame, with the papers' sampler and with
combined sampling. The window cannot see below about 0.07 cycles per pixel: a small picture keeps most of an object above that.
Writes validation.csv (rank correlations, median ratios) and a picture per material.
"""
from __future__ import annotations

import argparse
import datetime
from pathlib import Path

import numpy as np
from tqdm import tqdm

from lightband import pictures
from measure import luminance, windowed_bandwidth
from scenes import Stage, machine
from tables import write_table

MATERIALS = ("color-changing-paint3", "gold-paint", "nickel")
COLUMNS = ("material", "mesh", "map", "bandwidth rank", "bandwidth ratio", "box bandwidth rank", "variance rank", "variance ratio",
           "variance rank, brdf", "variance ratio, brdf", "eq. 9 rank, brdf", "eq. 9 ratio, brdf")


def converged(stage: Stage, scene, size: int, samples: int, seed: int, sampler: str):
    frame = stage.context.frame(size, size, samples=samples, coarsest_level=0, seed=seed, sampler=sampler,
                                allocation="constant_variance" if sampler == "combined" else "least_error")
    frame.render(scene)
    return frame


def agreement(predicted: np.ndarray, measured: np.ndarray) -> tuple[float, float]:
    """Rank correlation, and median of predicted over measured where something was measured."""
    seen = measured > 0
    return pictures.rank_correlation(predicted, measured), float(np.median(predicted[seen] / measured[seen]))


def validate(stage: Stage, material: str, mesh: str, map_name: str, size: int, samples: int, out: Path) -> dict:
    scene = stage.scene(mesh, material, map_name)
    first, second = (converged(stage, scene, size, samples, seed, "combined") for seed in (11, 12))
    a, b = luminance(first.color), luminance(second.color)
    covered = first.material > 0

    rows, columns, measured = windowed_bandwidth(a, b, covered)
    predicted = window_means(first.bandwidth_image)[rows, columns]
    bandwidth = agreement(predicted, measured)
    box = stage.context.frame(size, size, samples=16, transport="box")
    box.render(scene)
    box_bandwidth = agreement(window_means(box.bandwidth_image)[rows, columns], measured)

    variance = agreement(first.variance_predicted[covered], first.variance_measured[covered])
    lobe = converged(stage, scene, size, samples, 13, "brdf")
    brdf_variance = agreement(lobe.variance_predicted[covered], lobe.variance_measured[covered])
    printed = stage.context.frame(size, size, samples=16, sampler="brdf", variance="printed")
    printed.render(scene)
    eq9 = agreement(printed.variance_predicted[covered], lobe.variance_measured[covered])

    predicted_map, measured_map = np.full(a.shape, np.nan), np.full(a.shape, np.nan)
    for row, column, ours, theirs in zip(rows, columns, predicted, measured):
        window = slice(row - 2, row + 2), slice(column - 2, column + 2)
        predicted_map[window], measured_map[window] = ours, theirs
    blank = np.where(covered, 1.0, np.nan)
    pictures.draw_pairs(
        [pictures.Pair("Image bandwidth", predicted_map, measured_map, "1/pixel"),
         pictures.Pair("Variance of a sample, combined", first.variance_predicted * blank, first.variance_measured * blank,
                       "radiance^2"),
         pictures.Pair("Variance of a sample, BRDF", lobe.variance_predicted * blank, lobe.variance_measured * blank,
                       "radiance^2")],
        out / f"validation-{material}.png")
    return dict(zip(COLUMNS, (material, mesh, map_name, *bandwidth, box_bandwidth[0], *variance, *brdf_variance, *eq9)))


def window_means(field: np.ndarray, window: int = 32) -> np.ndarray:
    """Mean over the window that the Fourier transform sees, by its Hann weights, at every pixel."""
    hann = np.hanning(window + 2)[1:-1]
    hann /= hann.sum()
    padded = np.pad(field.astype(np.float64), window // 2)
    rows = np.apply_along_axis(np.convolve, 0, padded, hann, mode="same")
    both = np.apply_along_axis(np.convolve, 1, rows, hann, mode="same")
    inner = window // 2
    return both[inner:inner + field.shape[0], inner:inner + field.shape[1]]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--materials", type=Path, required=True)
    parser.add_argument("--out", type=Path, default=Path("docs/measurements"))
    parser.add_argument("--size", type=int, default=160)
    parser.add_argument("--samples", type=int, default=4096)
    parser.add_argument("--mesh", default="blob")
    parser.add_argument("--map", default="forest")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    stage = Stage(arguments.data, arguments.materials)
    rows = [validate(stage, material, arguments.mesh, arguments.map, arguments.size, arguments.samples, arguments.out)
            for material in tqdm(MATERIALS, desc="materials")]
    path = arguments.out / "validation.csv"
    write_table(path, f"{machine(stage.context)}; {arguments.size} x {arguments.size}; {datetime.date.today()}", COLUMNS, rows, ".3f")
    print(path.read_text())


if __name__ == "__main__":
    main()
