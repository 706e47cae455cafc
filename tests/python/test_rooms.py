"""The rooms of src/ stand on each other as README.md says: none includes what lies above it, so that there is no circle."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
ROOMS = re.findall(r"`src/(\w+)/`", (ROOT / "README.md").read_text().split("## Where things are")[1])


def test_every_room_is_named():
    assert sorted(ROOMS) == sorted(folder.name for folder in (ROOT / "src").iterdir() if folder.is_dir())


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_uses_those_below_it(room):
    below = {*ROOMS[ROOMS.index(room) :], "lightband"}  # the interface's own header
    for source in (ROOT / "src" / room).iterdir():
        used = re.findall(r'#include "(\w+)/', source.read_text())
        assert set(used) <= below, source
