"""Interpolation over directions against interpolation in the image: pixels shaded, errors got, and times, in one run.

    python bench/directions.py --data DATA --materials MERL --cache CACHE --out docs/measurements [--scenes 12] [--sizes 256 512]

The first scenes of matrix.py, at each size, asked for 5 and for 2 %; the ways take turns, and the least of two times counts. The
oracle is that of matrix_oracle.py: the fewest pixels from which bilinear interpolation in the image gets the error that was got.
References are matrix.py's, from its CACHE. Writes directions.csv and directions.png.
"""
from __future__ import annotations

import argparse
import datetime
import itertools
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from tqdm import tqdm

from lightband.pictures import DOTS_PER_INCH, STYLE
from matrix import scene_list
from matrix_figures import geometric_mean
from matrix_oracle import oracle_fractions
from matrix_plots import GUIDE, clean, log_axis, percent
from matrix_scene import references
from measure import luminance
from scenes import Stage, machine
from tables import write_table

WAYS = ("image", "directions", "auto")
TARGETS = (0.05, 0.02)
RUNS = 2
COLUMNS = ("mesh", "material", "map", "size", "asked", *(f"{way} {what}" for way in WAYS for what in ("shaded", "got", "ms")),
           "auto chose", "directions/oracle")
SEED = 7
COLOURS = ("#c99700", "#2b7bba", "#2a9d5c")  # of sizes


class Scenery:
    """What matrix_scene.references asks for."""

    def __init__(self, data: Path, materials: Path, cache: Path) -> None:
        self.stage, self.cache, self.reference_samples = Stage(data, materials), cache, 2048


def measure(scenery: Scenery, names: tuple[str, str, str], size: int) -> list[dict]:
    scene = scenery.stage.scene(*names)
    truth = references(scenery, scene, " ".join(names), size)
    frames = {way: scenery.stage.context.frame(size, size, seed=SEED, interpolation=way, target_error=TARGETS[0]) for way in WAYS}
    for frame in frames.values():
        frame.render(scene)  # tables and shaders
    rows = []
    for target in TARGETS:
        row: dict = dict(zip(COLUMNS, (*names, size, target)))
        for run, way in itertools.product(range(RUNS + 1), WAYS):
            frame = frames[way]
            frame["target_error"] = target
            frame.render(scene)
            if run > 0:  # the driver compiles until the second
                row[f"{way} ms"] = min(row.get(f"{way} ms", np.inf), frame.stats.milliseconds)
        for way, frame in frames.items():
            row[f"{way} shaded"] = frame.stats.shaded_pixels / frame.stats.covered_pixels
            row[f"{way} got"] = truth.error(luminance(frame.color))
        row["auto chose"] = "directions" if frames["auto"].cell_level.any() else "image"
        oracle = oracle_fractions(frames["directions"], truth.a, truth.b, [row["directions got"]])[0]
        row["directions/oracle"] = row["directions shaded"] / oracle
        rows.append(row)
    return rows


def summary(rows: list[dict]) -> str:
    lines = []
    for size, target in itertools.product(sorted({row["size"] for row in rows}), TARGETS):
        own = [row for row in rows if row["size"] == size and row["asked"] == target]
        chosen = [row for row in own if row["auto chose"] == "directions"]
        lines.append(
            f"{size} x {size}, {100 * target:.0f} %: of the pixels shaded in the image, directions "
            f"{geometric_mean([row['directions shaded'] / row['image shaded'] for row in own]):.2f}; of the oracle's, "
            f"{np.median([row['directions/oracle'] for row in own]):.2f} (median), but for spheres "
            f"{np.median([row['directions/oracle'] for row in own if row['mesh'] != 'sphere']):.2f}; of the time, directions "
            f"{geometric_mean([row['directions ms'] / row['image ms'] for row in own]):.2f}, auto "
            f"{geometric_mean([row['auto ms'] / row['image ms'] for row in own]):.2f}; auto chose directions in {len(chosen)} of {len(own)}"
            + (f", there {geometric_mean([row['auto ms'] / row['image ms'] for row in chosen]):.2f} of the time" if chosen else ""))
    for size in sorted({row["size"] for row in rows}):
        halved = [row for row in rows if row["size"] == size and row["directions shaded"] < 0.5 * row["image shaded"]]
        times = [row["directions ms"] / row["image ms"] for row in halved]
        if halved:
            lines.append(f"{size} x {size}: directions shade less than half the pixels in {len(halved)} frames, in {geometric_mean(times):.2f} "
                         f"of the time, at most {max(times):.2f}")
    return "\n".join(lines)


def draw(rows: list[dict], path: Path) -> None:
    with plt.rc_context(STYLE):
        figure, (pixels, times) = plt.subplots(1, 2, figsize=(9.6, 4.6), layout="constrained")
        sizes = sorted({row["size"] for row in rows})
        for (size, color), (target, marker) in itertools.product(zip(sizes, COLOURS), zip(TARGETS, "os")):
            own = [row for row in rows if row["size"] == size and row["asked"] == target]
            ratios = [row["directions shaded"] / row["image shaded"] for row in own]
            style = {"color": color, "marker": marker, "linestyle": "", "markersize": 4.5, "alpha": 0.85}
            pixels.plot([row["image shaded"] for row in own], [row["directions shaded"] for row in own], **style,
                        label=f"{size} x {size}, {100 * target:.0f} %")
            times.plot(ratios, [row["directions ms"] / row["image ms"] for row in own], **style)
        pixels.plot([0.04, 1], [0.04, 1], color=GUIDE, linewidth=0.8)
        pixels.set(xlabel="shaded in the image, of the covered pixels", ylabel="shaded over directions",
                   title="Pixels for the same error asked for")
        for which in "xy":
            log_axis(pixels, which, [0.05, 0.1, 0.2, 0.5, 1], percent)
        pixels.legend()
        times.axhline(1, color=GUIDE, linewidth=0.8)
        times.set(xlabel="pixels, over directions / in the image", ylabel="time, over directions / in the image", title="What that saves")
        log_axis(times, "x", [0.25, 0.5, 1, 2])
        log_axis(times, "y", [0.25, 0.5, 1, 2])
        for axes in (pixels, times):
            clean(axes)
        figure.savefig(path, dpi=DOTS_PER_INCH)
        plt.close(figure)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--materials", type=Path, required=True)
    parser.add_argument("--cache", type=Path, required=True, help="references; outside the repository")
    parser.add_argument("--out", type=Path, default=Path("docs/measurements"))
    parser.add_argument("--scenes", type=int, default=12)
    parser.add_argument("--sizes", type=int, nargs="+", default=[256, 512])
    arguments = parser.parse_args()
    arguments.cache.mkdir(parents=True, exist_ok=True)
    arguments.out.mkdir(parents=True, exist_ok=True)
    scenery = Scenery(arguments.data, arguments.materials, arguments.cache)
    rows: list[dict] = []
    for size, names in tqdm(list(itertools.product(arguments.sizes, scene_list()[:arguments.scenes])), desc="scenes"):
        rows += measure(scenery, names, size)
    write_table(arguments.out / "directions.csv", f"{machine(scenery.stage.context)}; {datetime.date.today()}", COLUMNS, rows, ".4g")
    draw(rows, arguments.out / "directions.png")
    print(summary(rows))


if __name__ == "__main__":
    main()
