"""What the two forms of the reflection operator shade, and at which error: correlated against the box of the papers.

    python bench/transport.py --data DATA --materials MERL --out docs/measurements [--size 512] [--samples 256]

Sixteen scenes: bunny, buddha, dragon and car body, two paints, a probe and a CC0 map. Both forms get the same samples per shaded
pixel and the same scale of bandwidth as predicted (1). Writes transport.csv.
"""
from __future__ import annotations

import argparse
import datetime
import itertools
from pathlib import Path

import numpy as np
from tqdm import tqdm

from measure import luminance, relative_error
from scenes import Stage, machine
from tables import write_table

MESHES = ("bunny", "buddha", "dragon", "car body")
MATERIALS = ("gold-paint", "color-changing-paint3")
MAPS = ("grace", "forest")
FORMS = ("correlated", "box")
COLUMNS = ("mesh", "material", "map", *(f"{form} {what}" for form in FORMS for what in ("shaded", "error")))


def measure(stage: Stage, mesh: str, material: str, map_name: str, size: int, samples: int) -> dict:
    scene = stage.scene(mesh, material, map_name)
    pictures = []
    for seed in (1001, 2002):
        frame = stage.context.frame(size, size, samples=2 * samples, coarsest_level=0, sampler="combined", seed=seed)
        frame.render(scene)
        pictures.append(luminance(frame.color))
    covered = frame.material > 0
    row: dict = {"mesh": mesh, "material": material, "map": map_name}
    for form in FORMS:
        frame = stage.context.frame(size, size, samples=samples, transport=form, bandwidth_scale=1, sampler="combined", seed=7)
        frame.render(scene)
        row[f"{form} shaded"] = np.count_nonzero(frame.shaded) / np.count_nonzero(covered)
        row[f"{form} error"] = relative_error(luminance(frame.color), *pictures, covered)
    return row


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--materials", type=Path, required=True)
    parser.add_argument("--out", type=Path, default=Path("docs/measurements"))
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--samples", type=int, default=256)
    arguments = parser.parse_args()
    stage = Stage(arguments.data, arguments.materials)
    rows = [measure(stage, *scene, arguments.size, arguments.samples)
            for scene in tqdm(list(itertools.product(MESHES, MATERIALS, MAPS)), desc="scenes")]
    path = arguments.out / "transport.csv"
    write_table(path, f"{machine(stage.context)}; {arguments.size} x {arguments.size}; {datetime.date.today()}", COLUMNS, rows, ".4f")
    print(path.read_text())


if __name__ == "__main__":
    main()
