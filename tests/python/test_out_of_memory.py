"""Memory that runs out, as Python sees it; tests/integration/test_out_of_memory.cpp lets single allocations fail."""

from __future__ import annotations

import gc
import resource
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

import lightband


@contextmanager
def no_more_than(further_bytes: int) -> Iterator[None]:
    """Limits what the process may address beyond what it does now."""
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + further_bytes, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


def test_a_map_without_memory_leaves_the_context_usable(
    context: lightband.Context, scene: lightband.Scene, rendered: lightband.Frame, frame: lightband.Frame
) -> None:
    radiance = np.ones((2048, 4096, 3), np.float32)
    gc.collect()  # what other tests have left would be freed meanwhile
    with no_more_than(radiance.nbytes // 8), pytest.raises(MemoryError, match="out of memory") as raised:
        context.environment(radiance)
    assert raised.type is lightband.OutOfMemory
    assert raised.value.code == 6
    frame.render(scene)
    assert np.array_equal(frame.buffer("color"), rendered.buffer("color"))


class Shape:
    def __str__(self) -> str:
        raise MemoryError


class ArrayLike:
    """Looks like an array, but there is no memory to describe it."""

    dtype, ndim, shape = "float64", 1, Shape()


def test_a_value_that_cannot_be_described_for_lack_of_memory_is_not_called_a_wrong_type(
    context: lightband.Context,
) -> None:
    with pytest.raises(MemoryError):
        context.frame(ArrayLike(), 4)  # type: ignore[arg-type]
