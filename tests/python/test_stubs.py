"""The type stubs against the module, and the package against its types."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("mypy", reason="mypy is in the extra dev")

ALLOWED = Path(__file__).with_name("stubtest-allowed.txt")


def run_module(*arguments: str) -> None:
    outcome = subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True, check=False)
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr


def test_stubs_agree_with_the_module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run_module("mypy.stubtest", "lightband", "--allowlist", str(ALLOWED), "--ignore-missing-stub")


def test_the_package_is_typed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run_module("mypy", "--strict", "-p", "lightband")
