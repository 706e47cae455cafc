"""Extremes of every input: what was measured, and the bound that the tests hold it to.

    python bench/extremes.py --oracle build/release/tests/integration/test_extremes --out docs/measurements [--device software]

The rows with a closed form are those of tests/python/extreme_rows.py; those against the double-precision oracle come from the
test program, which prints them (by software rendering, whatever the device here). Writes extremes.csv and prints it; fails when
a bound is not kept.
"""
from __future__ import annotations

import argparse
import datetime
import subprocess
import sys
from pathlib import Path

from tqdm import tqdm

import lightband
from scenes import machine
from tables import write_table

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests" / "python"))
from extreme_rows import ROWS  # noqa: E402

COLUMNS = ("row", "figure", "against", "measured", "bound")


def oracle_rows(program: Path) -> list[dict]:
    """The program prints "row | name | figure | measured | bound" and stops at a bound that is not kept."""
    outcome = subprocess.run([str(program)], capture_output=True, text=True)
    if outcome.returncode != 0:
        sys.exit(f"{program} failed:\n{outcome.stderr}")
    lines = (line.split(" | ") for line in outcome.stdout.splitlines() if line.startswith("row | "))
    return [dict(zip(COLUMNS, (name, figure, "oracle", float(measured), float(bound))))
            for _, name, figure, measured, bound in lines]


def closed_form_rows(context: lightband.Context) -> list[dict]:
    return [dict(zip(COLUMNS, (row.name, row.figure, "closed form", row.measure(context), row.bound)))
            for row in tqdm(ROWS, desc="rows")]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--oracle", type=Path, required=True)
    parser.add_argument("--out", type=Path, default=Path("docs/measurements"))
    parser.add_argument("--device", default="software")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    context = lightband.Context(device=arguments.device)
    rows = oracle_rows(arguments.oracle) + closed_form_rows(context)
    path = arguments.out / "extremes.csv"
    write_table(path, f"{machine(context)}; {datetime.date.today()}", COLUMNS, rows)
    print(path.read_text())
    broken = [row for row in rows if not row["measured"] <= row["bound"]]
    if broken:
        sys.exit(f"{len(broken)} of {len(rows)} bounds are not kept: " + "; ".join(row["row"] for row in broken))
    print(f"{len(rows)} bounds are kept")


if __name__ == "__main__":
    main()
