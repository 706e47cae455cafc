"""Extremes whose answer is a closed form: one definition for the tests and for bench/extremes.py.

A row measures one figure on a device and has a bound that it may not exceed; where the bound comes from stands beside it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import lightband
import support

ROUNDING = 2.0**-24  # of a float: half a unit in its last place
HALF_LEAST, HALF_MOST = 6e-8, 65504.0

Picture = NDArray[np.float64]


@dataclass(frozen=True)
class Row:
    name: str
    figure: str
    bound: float
    measure: Callable[[lightband.Context], float]


# ---- Scenes ----


def constant_map(radiance: float) -> NDArray[np.float32]:
    return np.full((4, 8, 3), radiance, np.float32)


def half_range_map(least: float = HALF_LEAST, most: float = HALF_MOST) -> NDArray[np.float32]:
    """Log-uniform over all that a half float holds, its denormals included, or over a part of that."""
    exponents = np.random.default_rng(1).uniform(np.log(least), np.log(most), (16, 32, 3))
    return np.exp(exponents).astype(np.float32)


def one_bright_texel(radiance: float = 1e6, height: int = 16, row: int = 5, column: int = 13) -> NDArray[np.float32]:
    """28 degrees off +Z in longitude, 28 up: far above the horizon of a plane that faces +Z."""
    texels = np.zeros((height, 2 * height, 3), np.float32)
    texels[row, column] = radiance
    return texels


def scene_of(
    context: lightband.Context, brdf: lightband.Brdf, radiance: NDArray[np.float32], mesh: str = "plane", size: float = 1
) -> lightband.Scene:
    """A shape about `size` metres across that fills most of the picture; the plane faces +Z."""
    scene = context.scene()
    scene.add(context.builtin_mesh(mesh, 64), brdf, np.diag([size, size, size, 1]))
    scene.environment = context.environment(radiance)
    scene.camera(eye=np.array([0.3, 0.4, 1.2]) * size, target=(0, 0, 0))
    return scene


def rendered(context: lightband.Context, scene: lightband.Scene, side: int = 16, **settings: float | str) -> lightband.Frame:
    return support.rendered(context, scene, side, side, **settings)


def luminance(frame: lightband.Frame) -> Picture:
    """Of the covered pixels."""
    return support.luminance(frame)[frame.material > 0]


def view_cosines(frame: lightband.Frame, eye: tuple[float, float, float]) -> Picture:
    seen = frame.material > 0
    to_eye = np.array(eye) - frame.position[seen].astype(np.float64)
    return np.sum(frame.normal[seen] * to_eye, axis=-1) / np.linalg.norm(to_eye, axis=-1)


def largest(values: Picture) -> float:
    return float(np.abs(values).max())


def float_fields(frame: lightband.Frame) -> dict[str, NDArray[np.floating]]:
    return {name: frame.buffer(name) for name in lightband.buffer_names() if frame.buffer(name).dtype == np.float32}


def not_finite(frame: lightband.Frame) -> int:
    """Numbers that are NaN or infinite; depth is infinite where nothing is seen, and there alone."""
    wrong = 0
    for name, values in float_fields(frame).items():
        finite = np.isfinite(values)
        wrong += int(np.sum(finite != (frame.material > 0))) if name == "depth" else int(np.sum(~finite))
    return wrong


# ---- Light that needs no noise ----


def lambert_under_a_constant(radiance: float, samples: int) -> Row:
    """Every sample of the cosine carries albedo * radiance. Adding n of them rounds n times, at most; weight, luminance, mean
    and map add eight roundings. What is left of radiance in float32 is exact. The picture's own floats are whole numbers of
    2^-149 and round by half of it."""
    albedo = 0.7

    def measure(context: lightband.Context) -> float:
        scene = scene_of(context, context.lambert(albedo), constant_map(radiance))
        frame = rendered(context, scene, samples=samples, sampler="brdf")
        return largest(luminance(frame) / (np.float64(np.float32(albedo)) * np.float64(np.float32(radiance))) - 1)

    name = f"Lambert under {radiance:g} everywhere, {samples} samples"
    return Row(name, "relative deviation", (samples + 8) * ROUNDING + 2.0**-150 / (albedo * radiance), measure)


def mirror_under_a_constant(sampler: str) -> Row:
    """GGX of alpha 1e-4 reflects Schlick's Fresnel term. Its microfacets lean to either side; their mean square, tails included
    (2 alpha^2 ln(1 / alpha) = 2e-7), times half the curvature of the fifth power (20 / 2) is 2e-6. Shadowing takes
    alpha^2 tan^2 / 2 = 5e-7 at a cosine of 0.1. The sum of 4096 nearly equal numbers rounds as many times."""
    f0, eye = 0.5, (0.3, 0.4, 1.2)

    def measure(context: lightband.Context) -> float:
        scene = scene_of(context, context.ggx(1e-4, f0), constant_map(3), mesh="sphere")
        frame = rendered(context, scene, samples=4096, sampler=sampler, coarsest_level=0)
        seen = frame.material > 0
        cosine = view_cosines(frame, eye)
        expected = 3 * (f0 + (1 - f0) * (1 - cosine) ** 5)
        # The lean's first power and the map's samples, which seldom meet the peak, leave noise that the samples tell of.
        noise = np.sqrt(frame.variance_measured[seen] / frame.sample_count[seen])
        deviation = np.maximum(np.abs(luminance(frame) - expected) - 5 * noise, 0) / expected
        return largest(deviation[cosine > 0.1])

    name = f"mirror under a constant, samples {sampler}"
    return Row(name, "relative deviation beyond noise", 4096 * ROUNDING + 2.5e-6, measure)


def light_of_one_texel(texels: NDArray[np.float32]) -> float:
    """Integral of the z component over bilinear light around the one texel that shines: two tents, over the texel's own
    neighbourhood of 2 x 2, by Gauss's rule of 16 points on each smooth quarter (exact to rounding)."""
    height, width = texels.shape[:2]
    row, column = np.argwhere(texels[..., 0] > 0)[0]
    nodes, weights = np.polynomial.legendre.leggauss(16)
    part, weight = 0.5 * (nodes + 1), 0.5 * weights
    offset = np.concatenate([part - 1, part])
    tent = (1 - np.abs(offset)) * np.concatenate([weight, weight])
    latitude = (0.5 - (row + 0.5 + offset) / height) * np.pi
    longitude = (0.5 - (column + 0.5 + offset) / width) * 2 * np.pi
    texel_area = np.pi / height * 2 * np.pi / width
    # z = cos(latitude) cos(longitude), and cos(latitude) of the solid angle.
    integral = np.sum(tent * np.cos(latitude) ** 2) * np.sum(tent * np.cos(longitude)) * texel_area
    return float(texels[row, column, 0]) * float(integral)


def one_texel_under_lambert(figure: str) -> Row:
    """Albedo / pi times the texel's irradiance. Every pixel of the plane has the same; independent points, so the deviations
    over their standard errors are normal: five for the largest of 256, three of the mean's own 1 / 16 for the mean."""
    albedo = 0.5

    def measure(context: lightband.Context) -> float:
        texels = one_bright_texel()
        scene = scene_of(context, context.lambert(albedo), texels)
        frame = rendered(context, scene, samples=1024, coarsest_level=0, sequence="random", sampler="combined")
        seen = frame.material > 0
        error = np.sqrt(frame.variance_measured[seen].astype(np.float64) / frame.sample_count[seen])
        score = (luminance(frame) - albedo / np.pi * light_of_one_texel(texels)) / error
        return abs(float(score.mean())) if figure.startswith("mean") else largest(score)

    bound = 3 / 16 if figure.startswith("mean") else 5.0
    return Row("one texel of 1e6, Lambert, bilinear", figure, bound, measure)


def black(name: str, brdf: Callable[[lightband.Context], lightband.Brdf], radiance: NDArray[np.float32]) -> Row:
    """Nothing times anything is nothing."""

    def measure(context: lightband.Context) -> float:
        frame = rendered(context, scene_of(context, brdf(context), radiance), background="environment")
        return largest(luminance(frame)) + not_finite(frame)

    return Row(name, "largest luminance, and values not finite", 0, measure)


# ---- Counts ----


def saturation(name: str, radiance: NDArray[np.float32]) -> Row:
    """What the statistics count is what the field shows, and a mirror under noise shows it everywhere."""

    def measure(context: lightband.Context) -> float:
        frame = rendered(context, scene_of(context, context.ggx(1e-4, 0.9), radiance, mesh="sphere"))
        shown = int(np.sum(frame.bandwidth_image[frame.material > 0] == 0.5))
        assert shown > 0
        # Just below the limit lies nothing but a mean that was rounded.
        nearly = int(np.sum((frame.bandwidth_image < 0.5) & (frame.bandwidth_image > 0.5 * (1 - 1e-6))))
        return abs(frame.stats.saturated_pixels - shown) + nearly

    return Row(name, "saturated pixels counted amiss", 0, measure)


# ---- Units ----


def unit_of_light(factor: float, samples: int = 16) -> Row:
    """Light times k is the picture times k. Both are sums of n positive terms, each rounded n + 8 times at most: the texel, its
    product with k, the weight, luminance, mean. (The nearest texel: interpolation rounds relative to the brighter one.)"""

    def measure(context: lightband.Context) -> float:
        radiance = half_range_map()
        one, other = (
            luminance(rendered(context, scene_of(context, context.ggx(0.2, 0.8), radiance * np.float32(k), mesh="blob"),
                               samples=samples, method="reference", environment_lookup="nearest"))
            for k in (1, factor)
        )
        lit = one > 0
        assert lit.any()
        return largest(other[lit] / (one[lit] * np.float64(np.float32(factor))) - 1)

    return Row(f"light times {factor:g}", "relative deviation", 2 * (samples + 8) * ROUNDING, measure)


def unit_of_length(factor: float) -> Row:
    """World times k is spatial bandwidth over k. Positions round by 1e-6 of the distance (ten roundings of the rasteriser), and a
    pixel is 0.7 / 64 of it: 1e-4 for each of a step's two ends and of the normals' difference over it, and the torus's
    principal curvatures differ by as much as they are: three times that together. At outlines and where two sides' differences
    are alike to rounding, another side may be taken: one pixel in fifty."""

    def measure(context: lightband.Context) -> float:
        scenes = (scene_of(context, context.lambert(0.5), half_range_map(), mesh="torus", size=k) for k in (1, factor))
        metres, other = (rendered(context, scene, side=64, samples=1) for scene in scenes)
        both = (metres.material > 0) & (other.material > 0) & (metres.bandwidth_spatial > 0)
        ratio = other.bandwidth_spatial[both].astype(np.float64) * factor / metres.bandwidth_spatial[both]
        return float(np.quantile(np.abs(ratio - 1), 0.98))

    return Row(f"world of {factor:g} m", "98th percentile, relative deviation of spatial bandwidth", 1e-3, measure)


ROWS: tuple[Row, ...] = (
    *(lambert_under_a_constant(radiance, samples) for radiance in (1e-42, 1e-30, HALF_LEAST, HALF_MOST, 1e15) for samples in (1, 4096)),
    mirror_under_a_constant("brdf"),
    mirror_under_a_constant("combined"),
    one_texel_under_lambert("mean deviation, standard errors"),
    one_texel_under_lambert("largest deviation, standard errors"),
    black("black map", lambda context: context.ggx(1e-4, 1), constant_map(0)),
    black("black Lambert", lambda context: context.lambert(0), half_range_map()),
    black("black table", lambda context: context.table_brdf(np.zeros((90, 90, 180, 3), np.float32)), half_range_map()),
    saturation("mirror under noise", half_range_map()),
    saturation("mirror under one texel", one_bright_texel()),
    *(unit_of_light(factor) for factor in (1e-6, 1e6, 1e9)),
    *(unit_of_length(factor) for factor in (1e-6, 1e6)),
)
