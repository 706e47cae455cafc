"""Tables with black or unmeasured parts under any map, from any view: what is asked is got, and nothing is lost in silence."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st

import lightband
from support import Floats, luminance, rendered


@st.composite
def tables(draw: st.DrawFn) -> npt.NDArray[np.float32]:
    """One value in some cells; next to nothing, nothing, or no measurement in the others."""
    elsewhere = draw(st.sampled_from([0.0, 1e-3, -1.0]))
    cells = np.full((90, 90, 180), elsewhere, np.float32)
    half, diff, phi = draw(st.integers(4, 80)), draw(st.integers(10, 80)), draw(st.integers(0, 170))
    kind = draw(st.sampled_from(["ring", "slice", "halo", "cut off", "block"]))
    if kind == "ring":
        cells[half : half + draw(st.integers(1, 8))] = 0.3
    elif kind == "slice":
        cells[:, :, phi : phi + draw(st.integers(3, 40))] = 0.3
    elif kind == "halo":
        cells[half] = 1.0
        cells[:2] = 10.0
    elif kind == "cut off":
        cells[:, :diff] = 0.3
    else:
        cells[half : half + 10, :diff, phi : phi + 30] = 1.0
        cells[:, :, 90] = 0.05
    return np.repeat(cells[..., None], 3, axis=-1)


@st.composite
def maps(draw: st.DrawFn) -> npt.NDArray[np.float32]:
    """Uniform, random, or random with one texel twenty times as bright."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    texels = random.random((8, 16, 1)) if draw(st.booleans()) else np.ones((8, 16, 1))
    if draw(st.booleans()):
        texels[random.integers(1, 7), random.integers(16)] = 20
    return np.repeat(texels.astype(np.float32), 3, axis=-1)


def looked_up(texels: npt.NDArray[np.float32], directions: Floats) -> Floats:
    """Bilinear, periodic in longitude; +Y is up, the image's centre looks along +Z."""
    height, width = texels.shape[:2]
    x = (0.5 - np.arctan2(directions[..., 0], directions[..., 2]) / (2 * np.pi)) * width - 0.5
    y = np.clip(np.arccos(np.clip(directions[..., 1], -1, 1)) / np.pi * height - 0.5, 0, height - 1)
    left, top = np.floor(x).astype(int), np.minimum(np.floor(y).astype(int), height - 2)
    fx, fy = x - left, y - top
    grid = texels[..., 0].astype(float)
    rows = [grid[top + k, left % width] * (1 - fx) + grid[top + k, (left + 1) % width] * fx for k in (0, 1)]
    return np.asarray(rows[0] * (1 - fy) + rows[1] * fy)


def reflected(values: npt.NDArray[np.float32], texels: npt.NDArray[np.float32], theta: float) -> float:
    """Radiance of a plane that faces +Z, seen at an angle of theta in the plane of X and Z: midpoints over the half vector h, sixteen to a
    cell of theta_half; d(wi) = 4 (h . wo) d(h)."""
    steps, turns = 1440, 360
    wo = np.array([np.sin(theta), 0, np.cos(theta)])
    x = ((np.arange(steps) + 0.5) / steps)[:, None]
    half = x**2 * np.pi / 2
    phi = (np.arange(turns) + 0.5) / turns * 2 * np.pi
    h = np.stack([np.sin(half) * np.cos(phi), np.sin(half) * np.sin(phi), np.broadcast_to(np.cos(half), (steps, turns))], -1)
    oh = h @ wo
    wi = 2 * oh[..., None] * h - wo
    along = np.stack([np.cos(half) * np.cos(phi), np.cos(half) * np.sin(phi), np.broadcast_to(-np.sin(half), (steps, turns))], -1)
    across = np.stack([-np.sin(phi), np.cos(phi), 0 * phi], -1)
    phi_diff = np.arctan2(np.sum(wi * across, -1), np.sum(wi * along, -1)) % np.pi
    cells = (
        np.broadcast_to(np.minimum((x * 90).astype(int), 89), oh.shape),
        np.minimum((np.arccos(np.clip(oh, -1, 1)) / (np.pi / 2) * 90).astype(int), 89),
        np.minimum((phi_diff / np.pi * 180).astype(int), 179),
    )
    f = np.maximum(values[..., 0][cells], 0) * np.maximum(wi[..., 2], 0) * np.where(oh > 0, 4 * oh, 0)
    return float(np.sum(f * looked_up(texels, wi) * np.sin(half) * np.pi * x) / steps * 2 * np.pi / turns)


@seed(20130501)
@settings(max_examples=5, deadline=None, database=None, suppress_health_check=list(HealthCheck))
@given(tables(), maps(), st.floats(0.05, 1.4))
def test_what_is_asked_of_sparse_tables_is_got(
    context: lightband.Context, values: npt.NDArray[np.float32], texels: npt.NDArray[np.float32], theta: float
) -> None:
    """A plane seen from so far away that all pixels see it under one angle, to 1e-4. The quadrature itself errs by up to a sixteenth of a
    cell at each edge, half a percent of a ring of one cell: so 1 % that is asked may be 1.5 % that is seen."""
    expected = reflected(values, texels, theta)
    material = context.table_brdf(values)
    scene = context.scene()
    scene.environment = context.environment(texels)
    scene.camera(eye=(500 * np.sin(theta), 0, 500 * np.cos(theta)), target=(0, 0, 0), fov_y=2e-4)
    scene.add(context.builtin_mesh("plane"), material, np.diag([9, 9, 1, 1]))
    shown = luminance(rendered(context, scene, 12, 12, target_error=0.01))
    if expected < 1e-6:
        assert shown.max() < 1e-5
        return
    assert np.sqrt(np.mean(((shown - expected) / (1.01 * expected)) ** 2)) < 0.015
