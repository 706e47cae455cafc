"""The example in README.md runs, and shows the method."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]


def test_the_example_shades_few_of_its_pixels(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("matplotlib", reason="matplotlib is in the extra pictures")
    [program] = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), flags=re.DOTALL)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "data").symlink_to(ROOT / "data")
    names: dict[str, Any] = {}
    exec(program, names)
    stats = names["frame"].stats
    assert 0 < stats.shaded_pixels < 0.4 * stats.covered_pixels
    assert stats.error <= 0.05
    assert "of the pixels were shaded" in capsys.readouterr().out
    assert (tmp_path / "fields.png").stat().st_size > 0
