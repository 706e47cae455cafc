"""The type stubs against the module, and the package against its types."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import lightband
from lightband import _lightband

pytest.importorskip("mypy", reason="mypy is in the extra dev")

ALLOWED = Path(__file__).with_name("stubtest-allowed.txt")
HEADER = Path(__file__).resolve().parents[2] / "include" / "lightband" / "lightband.h"
STUB = ast.parse(Path(lightband.__file__).with_name("_lightband.pyi").read_text())


def run_module(*arguments: str) -> None:
    outcome = subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True, check=False)
    assert outcome.returncode == 0, outcome.stdout + outcome.stderr


def test_stubs_agree_with_the_module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run_module("mypy.stubtest", "lightband", "--allowlist", str(ALLOWED), "--ignore-missing-stub")


def test_the_package_is_typed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run_module("mypy", "--strict", "-p", "lightband")


def definitions(node: ast.Module | ast.ClassDef, path: str = "") -> Iterator[tuple[str, ast.ClassDef | ast.FunctionDef]]:
    """Every public class, function, method and property of the stub; of overloads and setters the first."""
    seen = set()
    for inner in node.body:
        if not isinstance(inner, ast.ClassDef | ast.FunctionDef) or inner.name in seen:
            continue
        if isinstance(inner, ast.ClassDef) and inner.name.startswith("_"):
            continue
        seen.add(inner.name)
        yield path + inner.name, inner
        if isinstance(inner, ast.ClassDef):
            yield from definitions(inner, inner.name + ".")


@pytest.mark.parametrize(("path", "node"), list(definitions(STUB)), ids=[path for path, _ in definitions(STUB)])
def test_stubs_carry_the_docstrings(path: str, node: ast.ClassDef | ast.FunctionDef) -> None:
    thing: object = _lightband
    for name in path.split("."):
        thing = inspect.getattr_static(thing, name)
    assert thing.__doc__
    assert ast.get_docstring(node) == inspect.cleandoc(thing.__doc__)


def literals(name: str) -> tuple[str, ...]:
    """The strings of a Literal alias in the stub."""
    [alias] = [n for n in STUB.body if isinstance(n, ast.AnnAssign) and ast.unparse(n.target) == name]
    assert alias.value is not None
    return tuple(n.value for n in ast.walk(alias.value) if isinstance(n, ast.Constant))


@pytest.mark.parametrize(("alias", "kind"), [("_Integer", "integer"), ("_Real", "real"), ("_Choice", "choice")])
def test_stubs_know_the_settings(alias: str, kind: str) -> None:
    assert set(literals(alias)) == {setting.name for setting in lightband.settings() if setting.type == kind}


def test_stubs_know_the_values_of_settings() -> None:
    [table] = [n for n in STUB.body if isinstance(n, ast.ClassDef) and n.name == "_Settings"]
    typed = {ast.unparse(n.target): n.annotation for n in table.body if isinstance(n, ast.AnnAssign)}
    assert list(typed) == [setting.name for setting in lightband.settings()]
    for setting in lightband.settings():
        values = tuple(n.value for n in ast.walk(typed[setting.name]) if isinstance(n, ast.Constant))
        assert values == setting.choices


PROGRAM = """
from typing import assert_type
import lightband

def use(context: lightband.Context, scene: lightband.Scene, name: str) -> None:
    frame = context.frame(4, 4, samples=16, target_error=0.05, method="adaptive")
    assert_type(frame["target_error"], float)
    assert_type(frame["samples"], int)
    assert_type(frame["method"], str)
    assert_type(frame[name], int | float | str)
    assert_type(frame.settings["target_error"], float)
    assert_type(frame.settings["seed"], int)
    assert_type(frame.settings["sampler"], str)
    assert_type(frame.settings[name], int | float | str)
    frame["samples"] = 16
    frame["method"] = "reference"
    frame.settings[name] = 16
    frame.render(scene, lambda done: lightband.CANCEL if done > 0.5 else None)
"""
WRONG = [
    'frame["samples"] = "many"',
    'frame["method"] = 3',
    'frame["sample"] = 3',
    'context.frame(4, 4, method="fast")',
    "context.frame(4, 4, sample=3)",
    "context.frame('4', 4)",
    "scene.environment = None",
]


def test_a_setting_is_typed_as_what_it_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("program.py").write_text(PROGRAM + "".join(f"    {line}  # type: ignore\n" for line in WRONG))
    run_module("mypy", "--strict", "program.py")  # an ignored line without an error is one


def test_each_field_of_the_statistics_is_documented() -> None:
    fields = [field.name for field in dataclasses.fields(lightband.FrameStats)]
    assert lightband.FrameStats.__doc__ is not None
    heads = [line.partition(":")[0].strip() for line in lightband.FrameStats.__doc__.splitlines() if re.match(r"    \w.*?:", line)]
    assert [name for head in heads for name in head.split(", ")] == fields
    struct = HEADER.read_text().partition("typedef struct lb_frame_stats {")[2].partition("} lb_frame_stats;")[0]
    members = re.findall(r"^ +u?\w+ ([\w, ]+);", re.sub(r"/\*.*?\*/", "", struct, flags=re.DOTALL), flags=re.MULTILINE)
    assert [name for member in members for name in member.split(", ")] == ["struct_size", *fields]
