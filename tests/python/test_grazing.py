"""Tabulated materials in the last degrees before grazing, where cells lie across the horizon or were not measured."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import lightband
from support import LUMINANCE, luminance, rendered

CHANNEL_SCALE = np.array([1, 1.15, 1.66]) / 1500  # of a MERL file
UNMEASURED_FROM = 85  # theta_diff, in cells of a degree


def write_merl(path: Path, table: np.ndarray) -> None:
    with path.open("wb") as file:
        np.array([90, 90, 180], "<i4").tofile(file)
        np.moveaxis(table / CHANNEL_SCALE, -1, 0).astype("<f8").tofile(file)


@pytest.fixture(scope="module")
def messages() -> list[str]:
    return []


@pytest.fixture(scope="module")
def logging_context(messages: list[str]) -> Iterator[lightband.Context]:
    with lightband.Context(device="software", cache_path="", log=messages.append) as device:
        yield device


@pytest.fixture(scope="module")
def nickel(logging_context: lightband.Context) -> lightband.Brdf:
    return logging_context.builtin_brdf("rough-nickel")


@pytest.fixture(scope="module")
def merl_file(nickel: lightband.Brdf, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Nickel, of which nothing was measured beyond some theta_diff."""
    path = tmp_path_factory.mktemp("merl") / "nickel.binary"
    table = nickel.table.copy()
    table[:, UNMEASURED_FROM:] = -1
    write_merl(path, table)
    return path


def test_unmeasured_grazing_cells_are_filled(
    logging_context: lightband.Context, messages: list[str], nickel: lightband.Brdf, merl_file: Path
) -> None:
    messages.clear()
    filled = logging_context.load_brdf(merl_file).table
    # Every cell that light and eye above the horizon can reach had a value before, and has one again.
    missing = (nickel.table[:, UNMEASURED_FROM:, :, 0] >= 0).sum()
    said = [line for line in messages if "nickel.binary" in line]
    assert len(said) == 1 and f": {missing} unmeasured cells" in said[0] and "; 0 had none" in said[0]
    np.testing.assert_array_equal(filled >= 0, nickel.table >= 0)
    last, beyond = filled[:, UNMEASURED_FROM - 1 : UNMEASURED_FROM], filled[:, UNMEASURED_FROM:]
    np.testing.assert_array_equal(beyond[beyond >= 0], np.broadcast_to(last, beyond.shape)[beyond >= 0])


def test_filling_may_be_declined(logging_context: lightband.Context, messages: list[str], merl_file: Path) -> None:
    messages.clear()
    table = logging_context.load_brdf(merl_file, fill_unmeasured=False).table
    assert not any("unmeasured" in line for line in messages)
    assert (table[:, UNMEASURED_FROM:] == -1).all()


def test_a_table_in_memory_stays_as_it_is(logging_context: lightband.Context, nickel: lightband.Brdf) -> None:
    table = nickel.table.copy()
    table[:, UNMEASURED_FROM:] = -1
    np.testing.assert_array_equal(logging_context.table_brdf(table).table, table)


@pytest.mark.parametrize("degrees", [80, 87, 89, 89.5, 89.9])
def test_a_grazing_view_of_a_furnace_shows_the_albedo(
    logging_context: lightband.Context, nickel: lightband.Brdf, degrees: float
) -> None:
    """Light of 1 from everywhere: a plane that is seen from far shows the directional albedo in every pixel."""
    theta = np.radians(degrees)
    scene = logging_context.scene()
    scene.environment = logging_context.environment(np.ones((8, 16, 3)))
    scene.camera(eye=50 * np.array([np.sin(theta), 0, np.cos(theta)]), target=(0, 0, 0), fov_y=1e-5)
    scene.add(logging_context.builtin_mesh("plane"), nickel, np.diag([9, 9, 1, 1]))
    frame = rendered(logging_context, scene, 16, 16, samples=1024, sampler="brdf", sequence="random", coarsest_level=0)
    seen = frame.material > 0
    shown = luminance(frame)[seen]
    expected = nickel.albedo(theta) @ LUMINANCE
    # Four standard deviations of the mean, and the rounding of the table to half floats, 2^-12.
    noise = np.sqrt(frame.variance_measured[seen].mean() / frame.sample_count[seen].mean() / seen.sum())
    assert shown.mean() == pytest.approx(expected, abs=4 * noise + expected * 2**-12)
    assert noise < 0.01 * expected
