"""Memory that runs out: every allocation of every scenario of tests/integration/test_out_of_memory.cpp fails in turn.

    python bench/out_of_memory.py --program build/release/tests/integration/test_out_of_memory \\
        --out docs/measurements [--only SCENARIO ...]

Each allocation fails twice: alone, and together with all that follow it in the call. In a scenario of more than 500
allocations, those fail that are the first or the last of one place in the code. Writes out_of_memory.csv, after each
scenario anew, with a row for each: how many calls had an allocation fail; how many of them returned
LB_ERROR_OUT_OF_MEMORY, how many read a file a second time and succeeded, and how many returned something else; after
how many the state differed from that before the call, or the repeated call gave another result; how many blocks of the
library and of OpenEXR were left; how many calls ended the process. Fails where the library is at fault: OpenEXR 3.1
itself ends the process where it has no memory within a DWAA or DWAB block (lightband.h, lb_environment_load).
"""
from __future__ import annotations

import argparse
import csv
import datetime
import subprocess
import sys
from pathlib import Path

from tqdm import tqdm

import lightband
from scenes import machine
from tables import write_table

COLUMNS = ("scenario", "failed calls", "out of memory", "recovered", "other results", "not as before", "blocks left",
           "blocks OpenEXR lost", "processes ended")
ENDED_BY_OPENEXR = ("load_dwab",)
GOOD = ("LB_ERROR_OUT_OF_MEMORY", "recovered")


def attempts_of(program: Path, scenario: str) -> list[list[str]]:
    """The program's lines. A call that ends the process leaves a line without a result; the next one goes on."""
    lines: list[list[str]] = []
    first = 0
    while True:
        outcome = subprocess.run([str(program), scenario, str(first)], capture_output=True, text=True)
        lines += csv.reader(outcome.stdout.splitlines())
        if outcome.returncode == 0:
            return lines
        if not lines or len(lines[-1]) > 4:
            sys.exit(f"{program} {scenario} {first}: status {outcome.returncode} outside of a call:\n{outcome.stderr}")
        first = int(lines[-1][1]) + 1


def row_of(program: Path, scenario: str) -> dict:
    attempts = attempts_of(program, scenario)
    ended = [line for line in attempts if len(line) == 4]
    failed = [line for line in attempts if len(line) > 4 and line[3] != "no failure"]
    for line in attempts:
        if line in ended or (line in failed and (line[3] not in GOOD or line[4:6] != ["yes", "0"])):
            print(",".join(line), file=sys.stderr)
    return dict(zip(COLUMNS, (
        scenario, len(failed) + len(ended),
        *(sum(line[3] == result for line in failed) for result in GOOD),
        sum(line[3] not in GOOD for line in failed),
        sum(line[4] != "yes" for line in failed),
        sum(int(line[5]) for line in failed),
        sum(int(line[6]) for line in failed),
        len(ended))))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--out", type=Path, default=Path("docs/measurements"))
    parser.add_argument("--only", nargs="*")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    listing = subprocess.run([str(arguments.program), "--list"], capture_output=True, text=True, check=True)
    scenarios = arguments.only or listing.stdout.split()
    path = arguments.out / "out_of_memory.csv"
    head = f"{machine(lightband.Context(device='software'))}; {datetime.date.today()}"
    rows = []
    for scenario in tqdm(scenarios, desc="scenarios"):
        rows.append(row_of(arguments.program, scenario))
        write_table(path, head, COLUMNS, rows)
    print(path.read_text())
    faults = ("other results", "not as before", "blocks left")
    broken = [row["scenario"] for row in rows
              if any(row[fault] for fault in faults)
              or (row["processes ended"] and row["scenario"] not in ENDED_BY_OPENEXR)]
    if broken:
        sys.exit("not as it should be: " + ", ".join(broken))


if __name__ == "__main__":
    main()
