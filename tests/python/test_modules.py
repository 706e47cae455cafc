"""The modules of src/ depend on each other as README.md says: none includes a module above it, so that there is no
cycle."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MODULES = re.findall(r"`src/(\w+)/`", (ROOT / "README.md").read_text().split("## Where things are")[1])


def test_every_module_is_named():
    assert sorted(MODULES) == sorted(folder.name for folder in (ROOT / "src").iterdir() if folder.is_dir())


@pytest.mark.parametrize("module", MODULES)
def test_a_module_uses_only_those_below_it(module):
    below = {*MODULES[MODULES.index(module) :], "lightband"}  # the interface's own header
    for source in (ROOT / "src" / module).iterdir():
        used = re.findall(r'#include "(\w+)/', source.read_text())
        assert set(used) <= below, source
