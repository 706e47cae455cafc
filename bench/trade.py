"""What bandwidth prediction pays: time of the papers' reference at our error, over our time.

    python bench/trade.py --data DATA --materials MERL --out docs/measurements [--size 512] [--quick]

Bunny, buddha, dragon and car body, two paints, a probe and a CC0 map (method and definitions: docs/measurements.md). For each
scene: two independent full-resolution references; our adaptive frame in both forms of the operator; the papers' reference
(every pixel, constant N, random samples of the BRDF) at a measured N, extrapolated to our error by E^2 ~ 1/N. Times are the
least of three runs in this process. Writes trade.csv and prints a table. Resumes: rows already in the CSV are kept.
"""
from __future__ import annotations

import argparse
import csv
import datetime
from pathlib import Path

import numpy as np
from tqdm import tqdm

import lightband
from measure import luminance, relative_error
from scenes import Stage, machine

MESHES = ("bunny", "buddha", "dragon", "car body")
MATERIALS = ("gold-paint", "color-changing-paint3")
MAPS = ("grace", "forest")
COLUMNS = ("mesh", "material", "map", "samples", "error", "ms", "shaded", "samples drawn", "bandwidth share", "reference N",
           "reference error", "reference ms", "ratio", "box shaded", "box error", "bytes")
RUNS = 3


def best_time(frame: lightband.Frame, scene: lightband.Scene) -> tuple[float, float]:
    """Milliseconds of the frame and of its prediction: the fastest of several runs after one that builds the tables."""
    frame.render(scene)
    times = []
    for _ in range(RUNS):
        frame.render(scene)
        times.append((frame.stats.milliseconds, frame.stats.bandwidth_milliseconds))
    return min(times)


def references(stage: Stage, scene: lightband.Scene, size: int, samples: int) -> list[np.ndarray]:
    """Two independent unbiased pictures: every pixel shaded, samples shared by predicted variance."""
    pictures = []
    for seed in (1001, 2002):
        frame = stage.context.frame(size, size, samples=samples, coarsest_level=0, seed=seed)
        frame.render(scene)
        pictures.append(luminance(frame.color))
    return pictures


def measure(stage: Stage, mesh: str, material: str, map_name: str, size: int, samples: int, reference_samples: int) -> dict:
    scene = stage.scene(mesh, material, map_name)
    a, b = references(stage, scene, size, reference_samples)

    ours = stage.context.frame(size, size, samples=samples, seed=7)
    ours_ms, bandwidth_ms = best_time(ours, scene)
    covered, stats = ours.material > 0, ours.stats
    error = relative_error(luminance(ours.color), a, b, covered)

    box = stage.context.frame(size, size, samples=samples, seed=7, transport="box")
    box.render(scene)

    rival_samples = 256
    rival = stage.context.frame(size, size, samples=rival_samples, method="reference", seed=9)
    rival_ms, _ = best_time(rival, scene)
    rival_error = relative_error(luminance(rival.color), a, b, covered)
    shading = rival.stats.shading_milliseconds
    equal = (rival_error / error) ** 2  # how many times its samples it needs
    return dict(zip(COLUMNS, (
        mesh, material, map_name, samples, error, ours_ms, stats.shaded_pixels / stats.covered_pixels, stats.samples,
        bandwidth_ms / ours_ms, rival_samples, rival_error, rival_ms, (rival_ms + (equal - 1) * shading) / ours_ms,
        box.stats.shaded_pixels / stats.covered_pixels, relative_error(luminance(box.color), a, b, covered),
        stats.device_bytes)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--materials", type=Path, required=True)
    parser.add_argument("--out", type=Path, default=Path("docs/measurements"))
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--reference-samples", type=int, default=1024)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    stage = Stage(arguments.data, arguments.materials)
    path = arguments.out / "trade.csv"
    head = f"# {machine(stage.context)}; {arguments.size} x {arguments.size}; {datetime.date.today()}"
    rows = []
    if path.exists():
        lines = path.read_text().splitlines()
        if lines[0] == head:
            rows = list(csv.DictReader(lines[1:]))
    done = {(row["mesh"], row["material"], row["map"]) for row in rows}
    scenes = [(mesh, material, name) for material in MATERIALS for name in MAPS for mesh in MESHES]
    for scene in tqdm([s for s in scenes if s not in done], desc="scenes"):
        rows.append(measure(stage, *scene, arguments.size, arguments.samples, arguments.reference_samples))
        with open(path, "w", newline="") as out:
            out.write(head + "\n")
            writer = csv.DictWriter(out, COLUMNS)
            writer.writeheader()
            writer.writerows({k: f"{v:.4g}" if isinstance(v, float) else v for k, v in row.items()} for row in rows)
    ratios = np.array([float(row["ratio"]) for row in rows])
    shares = np.array([float(row["bandwidth share"]) for row in rows])
    print(path.read_text())
    print(f"ratio at equal error: geometric mean {np.exp(np.log(ratios).mean()):.1f}, least {ratios.min():.1f}; "
          f"bandwidth share: mean {shares.mean():.1%}, most {shares.max():.1%}")


if __name__ == "__main__":
    main()
