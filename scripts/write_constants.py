"""Writes docs/error-control-constants.md from src/picture/constants.h and, where it is there, docs/measurements/constants.csv.

    python scripts/write_constants.py            # writes the page
    python scripts/write_constants.py --check    # fails where the page is not what would be written
"""
from __future__ import annotations

import csv
import re
from pathlib import Path

from written_file import write_or_check

ROOT = Path(__file__).parent.parent
SOURCE, STUDY, TARGET = ROOT / "src/picture/constants.h", ROOT / "docs/measurements/constants.csv", ROOT / "docs/error-control-constants.md"
HEAD = """# Constants of error control

Written by `scripts/write_constants.py` from `src/picture/constants.h`. The last two columns say what happens when a constant is halved and
when it is doubled: time at equal error over that with the constant as it is, where 5 % and 2 % are asked for (`bench/constants.py`, four
scenes, one seed). By chance these are 0.93 to 1.07. Where 100 ms are asked for, chance alone changes the error by a factor of two; those
figures are in [measurements/constants.csv](measurements/constants.csv) alone, with the part of the frames that kept what was asked.
"""
ENTRY = re.compile(r"((?:^// [^\n]*\n)+)^LIGHTBAND_CONSTANT\((\w+), ([^)]+)\);$|^// ---- ([^-]+) ----$", re.M)


def measured() -> dict[str, dict[str, str]]:
    if not STUDY.exists():
        return {}
    lines = [line for line in STUDY.read_text().splitlines() if not line.startswith("#")]
    return {row["constant"]: row for row in csv.DictReader(lines)}


def effect(row: dict[str, str] | None, factor: str) -> str:
    return " / ".join(f"{float(row[f'{what} {factor}']):.2f}" for what in ("5 %", "2 %")) if row else "not measured"


def page() -> str:
    study, parts = measured(), [HEAD]
    for comment, name, value, title in ENTRY.findall(SOURCE.read_text()):
        if title:
            parts.append(f"\n## {title}\n| name | value | unit | what it is, and its origin | halved | doubled |\n|---|---|---|---|---|---|\n")
            continue
        words = " ".join(line[3:] for line in comment.splitlines())
        unit, text = re.fullmatch(r"\[([^]]+)\] (.*)", words).groups()
        row = study.get(name)
        parts.append(f"| `{name}` | {value} | {unit} | {text} | {effect(row, '0.5')} | {effect(row, '2')} |\n")
    return "".join(parts)


if __name__ == "__main__":
    write_or_check(__doc__, TARGET, page())
