"""A device, objects of it, references and a rendered frame that the tests share."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator

import numpy as np
import pytest

import lightband
from support import Floats, SharedObjects, luminance, render_blob


@pytest.fixture(scope="session")
def context() -> Iterator[lightband.Context]:
    """Software rendering: the tests ask the same of every machine."""
    with lightband.Context(device="software", cache_path="") as device:
        yield device


@pytest.fixture(scope="session")
def shared(context: lightband.Context) -> SharedObjects:
    """The same context, for tests that render what others render, too."""
    return SharedObjects(context)


@pytest.fixture(scope="session")
def blob_references(shared: SharedObjects) -> Callable[[str], list[Floats]]:
    """Of the blob of a built-in material, two independent references: each without bias, of 8,192 samples a pixel."""

    @functools.cache
    def references(material: str) -> list[Floats]:
        settings = {"samples": 8192, "coarsest_level": 0, "sampler": "combined"}
        brdf = shared.builtin_brdf(material)
        return [luminance(render_blob(shared, brdf, seed=seed, **settings)) for seed in (91, 92)]

    return references


@pytest.fixture(scope="session")
def environment(context: lightband.Context) -> lightband.Environment:
    """A smooth sky, brighter above: radiance from 0.5 to 1.5 by the row."""
    rows = np.linspace(1.5, 0.5, 16, dtype=np.float32)
    return context.environment(np.broadcast_to(rows[:, None, None], (16, 32, 3)))


@pytest.fixture(scope="session")
def scene(context: lightband.Context, environment: lightband.Environment) -> lightband.Scene:
    """A sphere in the middle, with background around it."""
    made = context.scene()
    made.add(context.builtin_mesh("sphere", 32), context.lambert(0.5))
    made.environment = environment
    made.camera(eye=(0, 0, 3), target=(0, 0, 0))
    return made


@pytest.fixture(scope="session")
def rendered(context: lightband.Context, scene: lightband.Scene) -> lightband.Frame:
    """A frame that no test changes. Wider than high, so that a swap of the two shows."""
    frame = context.frame(40, 24, samples=8)
    frame.render(scene)
    return frame


@pytest.fixture
def frame(context: lightband.Context) -> lightband.Frame:
    """A frame of a test's own, not rendered."""
    return context.frame(40, 24, samples=8)
