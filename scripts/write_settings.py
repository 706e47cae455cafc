"""Writes docs/settings.md from the library's own table of settings.

    python scripts/write_settings.py            # writes the page
    python scripts/write_settings.py --check    # fails where the page is not what would be written
"""
from __future__ import annotations

import textwrap
from pathlib import Path

import lightband
from written_file import write_or_check

TARGET = Path(__file__).parent.parent / "docs" / "settings.md"
HEAD = """# Settings of a frame

`lb_frame_set_number` and `lb_frame_set_choice` in C, `frame[name] = value` or keyword arguments of `context.frame` in Python.
This page is written by `scripts/write_settings.py` from the table in `src/picture/settings.cpp`, which `lb_setting_at` and
`lightband.settings()` give as well.

"""


def plain(number: float) -> str:
    return f"{number:.10g}"


def values(setting: lightband.Setting) -> str:
    if setting.choices:
        return ", ".join(f"`{choice}`" for choice in setting.choices)
    kind = "whole number" if setting.type == "integer" else "number"
    return f"{kind}, {plain(setting.minimum)} to {plain(setting.maximum)}"


def page() -> str:
    parts = []
    for setting in lightband.settings():
        default = f"`{setting.default}`" if setting.choices else plain(setting.default)
        parts.append(f"## {setting.name}\n{values(setting)}; default {default}\n\n{textwrap.fill(setting.documentation, 120)}\n")
    return HEAD + "\n".join(parts)


if __name__ == "__main__":
    write_or_check(__doc__, TARGET, page())
