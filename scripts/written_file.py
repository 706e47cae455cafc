"""What the scripts share that write a file of docs from the library: they write it, or check that it is up to date."""
from __future__ import annotations

import argparse
import sys
from pathlib import Path


def write_or_check(description: str, target: Path, text: str) -> None:
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="fail where the file is not what would be written")
    if not parser.parse_args().check:
        target.write_text(text)
    elif target.read_text() != text:
        sys.exit(f"{target} is out of date: run {Path(sys.argv[0]).name}")
