"""Tables as the studies publish them: CSV under a line that says what measured them."""
from __future__ import annotations

import csv
import os
from collections.abc import Sequence
from pathlib import Path


def write_table(path: Path, head: str, columns: Sequence[str], rows: list[dict], form: str = ".4g") -> None:
    """Whole or not at all: a reader never sees half a table. head: machine; driver; date. form: of numbers with a fraction."""
    part = path.with_suffix(".part")
    with open(part, "w", newline="") as out:
        out.write(f"# {head}\n")
        writer = csv.DictWriter(out, columns)
        writer.writeheader()
        writer.writerows({key: format(value, form) if isinstance(value, float) else value for key, value in row.items()}
                         for row in rows)
    os.replace(part, path)
