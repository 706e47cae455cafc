"""Extremes of every input: rows with a closed form, and properties of any combination of extremes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from extreme_rows import ROUNDING, ROWS, Row, constant_map, half_range_map, luminance, not_finite, one_bright_texel
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import lightband
from support import SharedObjects, rendered


@pytest.mark.parametrize("row", ROWS, ids=[f"{row.name}: {row.figure}" for row in ROWS])
def test_row(context: lightband.Context, row: Row) -> None:
    assert row.measure(context) <= row.bound


# ---- Combinations ----

MAPS: dict[str, NDArray[np.float32]] = {
    "black": constant_map(0),
    "constant": constant_map(1),
    "one texel": one_bright_texel(),
    "half range": half_range_map(),
    "dim": half_range_map(most=1e-3),
    "one texel in all": np.full((1, 1, 3), 2, np.float32),
}
UNSCALABLE_MAPS = {"denormal": constant_map(1e-41), "brightest": one_bright_texel(1e15)}
MATERIALS = ("black", "Lambert", "mirror", "GGX", "table")
MESHES = ("plane", "sphere", "blob")
SIZES = ((1, 1), (1, 37), (41, 1), (17, 13), (2, 129))


@dataclass(frozen=True)
class Case:
    material: str
    map: str
    mesh: str
    elevation: float
    """Of the eye over the plane, metres, at one metre's distance: at 1e-6 its pixels are seen under as small a cosine."""
    fov_y: float
    width: int
    height: int
    settings: dict[str, float | str]


def cases(maps: tuple[str, ...]) -> st.SearchStrategy[Case]:
    choices = {
        "samples": st.sampled_from((1, 2, 3, 64, 5000)),
        "coarsest_level": st.sampled_from((0, 5, 8)),
        "bandwidth_scale": st.sampled_from((0.0, 1e-3, 1.0)),
        "pilots": st.sampled_from((4, 16)),
        "transport": st.sampled_from(("correlated", "box")),
        "variance": st.sampled_from(("moments", "printed")),
        "allocation": st.sampled_from(("least_error", "constant_variance")),
        "sampler": st.sampled_from(("combined", "brdf")),
        "sequence": st.sampled_from(("lattice", "random")),
        "seed": st.integers(0, 2**32 - 1),
    }
    return st.builds(
        lambda size, **rest: Case(width=size[0], height=size[1], **rest),
        size=st.sampled_from(SIZES),
        material=st.sampled_from(MATERIALS),
        map=st.sampled_from(maps),
        mesh=st.sampled_from(MESHES),
        elevation=st.sampled_from((1e-6, 1e-3, 1.0)),
        fov_y=st.sampled_from((1e-3, 0.7, 3.1)),
        settings=st.fixed_dictionaries(choices),
    )


@pytest.fixture(scope="module")
def materials(context: lightband.Context) -> dict[str, lightband.Brdf]:
    """Made once: the analysis of a lobe takes longer than a picture."""
    peaked = np.full((90, 90, 180, 3), 1e-3, np.float32)
    peaked[0] = 1e4  # one cell of theta_half: a mirror as far as a table can hold one
    return {
        "black": context.lambert(0),
        "Lambert": context.lambert(0.7),
        "mirror": context.ggx(1e-4, 0.9),
        "GGX": context.ggx(0.2, (0.9, 0.6, 0.3)),
        "table": context.table_brdf(peaked),
    }


def render(
    context: lightband.Context | SharedObjects,
    brdf: lightband.Brdf,
    case: Case,
    size: float = 1,
    light: float = 1,
    **changed: float | str,
) -> lightband.Frame:
    """The case in a world `size` times as large, under light `light` times as bright."""
    scene = context.scene()
    scene.add(context.builtin_mesh(case.mesh, 16), brdf, np.diag([size, size, size, 1]))
    scene.environment = context.environment({**MAPS, **UNSCALABLE_MAPS}[case.map] * np.float32(light))
    scene.camera(np.array([0.1, -1, case.elevation]) * size, target=(0, 0, 0), up=(0, 0, 1), fov_y=case.fov_y)
    return rendered(context, scene, case.width, case.height, **{**case.settings, **changed})


@settings(deadline=None, max_examples=60)
@given(case=cases((*MAPS, *UNSCALABLE_MAPS)))
def test_any_combination_is_finite_counted_and_repeats(
    shared: SharedObjects, materials: dict[str, lightband.Brdf], case: Case
) -> None:
    brdf = materials[case.material]
    frame, again = render(shared, brdf, case), render(shared.context, brdf, case)  # the second under a map of its own
    assert not_finite(frame) == 0
    assert (frame.color >= 0).all()
    for name in lightband.buffer_names():
        np.testing.assert_array_equal(frame.buffer(name), again.buffer(name), err_msg=name)

    seen, stats = frame.material > 0, frame.stats
    assert stats.covered_pixels == seen.sum()
    assert stats.shaded_pixels == frame.shaded.sum()
    assert stats.samples == frame.sample_count.sum()
    assert stats.saturated_pixels == (frame.bandwidth_image[seen] == 0.5).sum()
    assert frame.bandwidth_image.max() <= 0.5
    assert (frame.shaded[seen & (frame.bandwidth_image == 0.5)] == 1).all()  # nothing may be interpolated there
    assert ((frame.sample_count > 0) == (frame.shaded > 0)).all()


@settings(deadline=None, max_examples=40)
@given(case=cases(tuple(MAPS)), exponent=st.integers(-100, 29))
@example(case=Case("GGX", "dim", "sphere", 1.0, 0.7, 17, 13, {"samples": 64}), exponent=-100)
def test_light_times_a_power_of_two(
    shared: SharedObjects, materials: dict[str, lightband.Brdf], case: Case, exponent: int
) -> None:
    """Multiplication by a power of two commutes with every rounding: not one bit of a significand changes, from texels of 6e-8 *
    2^-100 = 2^-124 to 1e6 * 2^29 = 5e14. What a field cannot hold is the nearest float."""
    brdf, factor = materials[case.material], 2.0**exponent
    one, other = render(shared, brdf, case), render(shared.context, brdf, case, light=factor)
    for name, power in (("color", 1), ("variance_predicted", 2), ("variance_pyramid", 0), ("level", 0), ("sample_count", 0),
                        ("bandwidth_spatial", 0), ("bandwidth_angular", 0), ("bandwidth_image", 0)):
        expected = one.buffer(name)[..., :3] if name == "color" else one.buffer(name)
        found = other.buffer(name)[..., :3] if name == "color" else other.buffer(name)
        held = np.minimum(expected * np.float64(factor) ** power, np.finfo(np.float32).max).astype(np.float32)
        beyond = expected == np.finfo(np.float32).max  # variance as printed: how far, a float does not say
        np.testing.assert_array_equal(found[~beyond], held[~beyond], err_msg=name)


@settings(deadline=None, max_examples=40)
@given(case=cases(tuple(MAPS)), exponent=st.integers(-20, 20))
def test_world_times_a_power_of_two(
    shared: SharedObjects, materials: dict[str, lightband.Brdf], case: Case, exponent: int
) -> None:
    """The same picture to the last bit, from 1e-6 to 1e6 metres; what is per metre is divided."""
    brdf, factor = materials[case.material], 2.0**exponent
    one, other = render(shared, brdf, case), render(shared, brdf, case, size=factor)
    for name, power in (("color", 0), ("depth", 1), ("curvature", -1), ("bandwidth_spatial", -1), ("bandwidth_angular", 0),
                        ("bandwidth_image", 0), ("level", 0), ("sample_count", 0), ("variance_predicted", 0)):
        np.testing.assert_array_equal(other.buffer(name), one.buffer(name) * np.float64(factor) ** power, err_msg=name)


@pytest.mark.parametrize("units", [3e19, 1e-20])
def test_meshes_in_any_units(context: lightband.Context, units: float) -> None:
    """Metres per unit of a mesh, whose square is beyond what a float holds, turn no normal: a tilted square of one metre."""
    corners = np.array([(-1, -1, -0.3), (1, -1, 0.4), (1, 1, 0.4), (-1, 1, -0.3)]) / 2
    expected = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    scene = context.scene()
    scene.environment = context.environment(np.ones((1, 2, 3), np.float32))
    scene.add(context.mesh(corners / units, [(0, 1, 2), (0, 2, 3)]), context.lambert(0.5), np.diag([units, units, units, 1]))
    scene.camera(eye=(0, 0, 2), target=(0, 0, 0))
    frame = context.frame(16, 16, samples=1)
    frame.render(scene)
    seen = frame.material > 0
    assert seen.any() and frame.stats.bent_normals == 0
    np.testing.assert_allclose(frame.normal[seen], np.broadcast_to(expected / np.linalg.norm(expected), (seen.sum(), 3)), atol=4 * 2**-23)


@settings(deadline=None, max_examples=25)
@given(case=cases(tuple(MAPS)), exponent=st.floats(-6, 6), samples=st.sampled_from((1, 7, 64)))
def test_light_times_any_factor(
    shared: SharedObjects, materials: dict[str, lightband.Brdf], case: Case, exponent: float, samples: int
) -> None:
    """Both pictures are sums of n positive terms of the same directions, each rounded n + 8 times at most (extreme_rows). The
    nearest texel: a device interpolates by a + w (b - a), whose rounding is relative to the brighter texel."""
    changed: dict[str, float | str] = {"method": "reference", "samples": samples, "environment_lookup": "nearest"}
    factor = float(np.float32(10.0**exponent))
    brdf = materials[case.material]
    one = luminance(render(shared, brdf, case, **changed))
    other = luminance(render(shared.context, brdf, case, light=factor, **changed))
    assert (np.abs(other - factor * one) <= 2 * (samples + 8) * ROUNDING * factor * one).all()
