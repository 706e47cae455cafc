"""What the constants of error control are worth: each halved and doubled, time at equal error against the constant as it is.

    pip install . --config-settings=cmake.define.LIGHTBAND_STUDY=ON      # a build in which constants can be changed
    python bench/constants.py --data DATA --materials MERL --out docs/measurements

Some scenes at 256 x 256 are asked for 5 and 2 %, and for 100 ms, with the constant and without the change in turn. Time at equal error: the
ratio of the times, times the ratio of the errors to the power of 2 / 1.2 (constants::stratified_gain); over 1 is worse. `kept`: frames that
got at most the error that was asked. Writes constants.csv; scripts/write_constants.py puts it beside the table.
"""
from __future__ import annotations

import argparse
import datetime
import itertools
import os
import re
from pathlib import Path

import numpy as np
from measure import luminance, relative_error
from scenes import Stage, machine
from tables import write_table
from tqdm import tqdm

SCENES = (("sphere", "gold-paint", "grace"), ("bunny", "color-changing-paint3", "stpeters"), ("dragon", "nickel", "forest"),
          ("car body", "red-metallic-paint", "city"))
ASKED = ({"target_error": 0.05}, {"target_error": 0.02}, {"time_budget": 100})
FACTORS, SEEDS, SIDE, GAIN = (0.5, 2), (1,), 256, 1.2
COLUMNS = ("constant", "value", *(f"{what} {factor}" for factor in FACTORS for what in ("5 %", "2 %", "100 ms", "kept")))
TABLE = Path(__file__).parent.parent / "src" / "picture" / "constants.h"


def constants() -> list[tuple[str, float]]:
    found = re.findall(r"LIGHTBAND_CONSTANT\((\w+), ([^)]+)\);", TABLE.read_text())
    return [(name, float(eval(value))) for name, value in found]  # noqa: S307 - numbers of our own header


class Case:
    """One scene with its references, and a frame for each way of asking."""

    def __init__(self, stage: Stage, names: tuple[str, str, str]) -> None:
        self.scene = stage.scene(*names)
        self.references = []
        for seed in (101, 202):
            frame = stage.context.frame(SIDE, SIDE, sampler="combined", coarsest_level=0, samples=512, seed=seed)
            frame.render(self.scene)
            self.references.append(luminance(frame.color))
        self.covered = frame.material > 0
        self.frames = [stage.context.frame(SIDE, SIDE, **asked) for asked in ASKED]
        for frame in self.frames:
            frame.render(self.scene)

    def measure(self, way: int, seed: int, changed: str | None) -> tuple[float, float]:
        """Milliseconds and error."""
        os.environ["LIGHTBAND_CONSTANT"] = changed or ""
        frame = self.frames[way]
        frame["seed"] = seed
        frame.render(self.scene)
        return frame.stats.milliseconds, relative_error(luminance(frame.color), *self.references, self.covered)


def row(cases: list[Case], name: str, value: float) -> dict:
    result: dict = {"constant": name, "value": value}
    for factor in FACTORS:
        kept = []
        for way, asked in enumerate(ASKED):
            ratios = []
            for case, seed in itertools.product(cases, SEEDS):
                before, after = (case.measure(way, seed, changed) for changed in (None, f"{name}={factor * value}"))
                ratios.append(after[0] / before[0] * (after[1] / before[1]) ** (2 / GAIN))
                if "target_error" in asked:
                    kept.append(after[1] <= asked["target_error"])
            result[f"{('5 %', '2 %', '100 ms')[way]} {factor}"] = float(np.exp(np.nanmean(np.log(ratios))))
        result[f"kept {factor}"] = float(np.mean(kept))
    return result


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--materials", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    arguments = parser.parse_args()
    stage = Stage(arguments.data, arguments.materials)
    cases = [Case(stage, names) for names in SCENES]
    rows = [row(cases, name, value) for name, value in tqdm(constants())]
    write_table(arguments.out / "constants.csv", f"{machine(stage.context)}; {datetime.date.today()}", COLUMNS, rows)


if __name__ == "__main__":
    main()
