"""The reflectances of our scenes as Mitsuba plug-ins: MERL tables by the nearest cell, GGX and Lambert.

Written from the definitions (docs/conventions.md; Matusik et al. 2003; Walter et al. 2007), not from our C++ and GLSL, which they
judge. Beware of names: Mitsuba's `wi` points to the eye and its `wo` to the light; here they are `eye` and `light`, unit vectors
in the local frame.
"""
from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np

from mitsuba_llvm import dr, mi

CELLS = (90, 90, 180)  # theta_half (quadratic), theta_diff, phi_diff
CHANNEL_SCALE = np.array([1.0, 1.15, 1.66]) / 1500  # stored value to 1/steradian: BRDFRead.cpp, distributed with the data
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


@dataclass(frozen=True)
class Lambert:
    """Reflects the share `albedo`, evenly."""
    albedo: tuple[float, float, float]

    def __str__(self) -> str:
        return "Lambert"


@dataclass(frozen=True)
class Ggx:
    """Walter et al. 2007 with height-correlated Smith shadowing and Schlick's Fresnel term."""
    alpha: float
    f0: tuple[float, float, float]

    def __str__(self) -> str:
        return f"GGX {self.alpha:g}"


class Reflector(mi.BSDF):
    """A reflectance `value(eye, light)`, sampled by a mixture of visible GGX normals (roughness alpha) and the cosine (share)."""

    def __init__(self, alpha: float, cosine_share: float) -> None:
        super().__init__(mi.Properties())
        self.m_flags = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide
        self.m_components = [self.m_flags]
        self.alpha, self.cosine_share = float(alpha), float(cosine_share)
        self.lobe = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.alpha, sample_visible=True)

    def value(self, eye: mi.Vector3f, light: mi.Vector3f, active: mi.Bool) -> mi.Color3f:
        raise NotImplementedError

    def density(self, eye: mi.Vector3f, light: mi.Vector3f) -> mi.Float:
        """Of the mixture, per steradian of `light`."""
        half = dr.normalize(eye + light)
        glossy = self.lobe.pdf(eye, half) / (4 * dr.dot(light, half))
        return self.cosine_share * mi.warp.square_to_cosine_hemisphere_pdf(light) + (1 - self.cosine_share) * glossy

    def eval_pdf(self, ctx, si, light, active=True):
        eye = si.wi
        above = active & (eye.z > 0) & (light.z > 0)
        value = self.value(eye, light, above) * light.z
        return value & above, dr.select(above, self.density(eye, light), 0)

    def eval(self, ctx, si, light, active=True):
        return self.eval_pdf(ctx, si, light, active)[0]

    def pdf(self, ctx, si, light, active=True):
        return self.eval_pdf(ctx, si, light, active)[1]

    def sample(self, ctx, si, sample1, sample2, active=True):
        glossy = mi.reflect(si.wi, self.lobe.sample(si.wi, sample2)[0])
        light = dr.select(sample1 < self.cosine_share, mi.warp.square_to_cosine_hemisphere(sample2), glossy)
        value, pdf = self.eval_pdf(ctx, si, light, active)
        result = dr.zeros(mi.BSDFSample3f)
        result.wo, result.pdf, result.eta = light, pdf, 1
        result.sampled_type, result.sampled_component = mi.UInt32(+self.m_flags), mi.UInt32(0)
        return result, dr.select(pdf > 0, value / pdf, 0)


class LambertReflector(Reflector):
    def __init__(self, lambert: Lambert) -> None:
        super().__init__(alpha=1, cosine_share=1)
        self.albedo = mi.Color3f(lambert.albedo)

    def density(self, eye, light):
        return mi.warp.square_to_cosine_hemisphere_pdf(light)

    def value(self, eye, light, active):
        return self.albedo / dr.pi


class GgxReflector(Reflector):
    def __init__(self, ggx: Ggx) -> None:
        super().__init__(ggx.alpha, cosine_share=0)
        self.f0 = mi.Color3f(ggx.f0)

    def smith(self, cosine: mi.Float) -> mi.Float:
        """Lambda of Smith's shadowing (Heitz 2014, eq. 72)."""
        return 0.5 * (dr.sqrt(1 + self.alpha**2 * (1 / cosine**2 - 1)) - 1)

    def value(self, eye, light, active):
        half = dr.normalize(eye + light)
        shadowing = 1 / (1 + self.smith(eye.z) + self.smith(light.z))
        fresnel = self.f0 + (1 - self.f0) * (1 - dr.dot(light, half)) ** 5
        return self.lobe.eval(half) * shadowing * fresnel / (4 * eye.z * light.z)


class MerlReflector(Reflector):
    """A MERL .binary file: the nearest cell, folded by reciprocity; a cell that was not measured is black."""

    def __init__(self, path: Path) -> None:
        self.table = mi.Float(read_merl(path).ravel())
        super().__init__(*self.best_mixture())

    def value(self, eye, light, active):
        total = eye + light
        half = dr.normalize(total)
        square = half.x * half.x + half.y * half.y  # sin^2 theta_half
        theta_half = dr.atan2(dr.sqrt(square), half.z)
        theta_diff = dr.atan2(dr.norm(light - eye), dr.norm(total))
        # The light turned by -phi_half about the normal, then by -theta_half: its azimuth there. Both times sin theta_half.
        y = half.x * light.y - half.y * light.x
        x = half.z * (half.x * light.x + half.y * light.y) - square * light.z
        phi_diff = dr.atan2(y, x)
        phi_diff = dr.select(phi_diff < 0, phi_diff + dr.pi, phi_diff)
        cells = [dr.minimum(mi.UInt32(position * count), count - 1) for position, count in
                 zip((dr.sqrt(theta_half * (2 / dr.pi)), theta_diff * (2 / dr.pi), phi_diff / dr.pi), CELLS)]
        index = (cells[0] * CELLS[1] + cells[1]) * CELLS[2] + cells[2]
        return mi.Color3f(dr.gather(mi.Vector4f, self.table, index, active).xyz)

    def best_mixture(self) -> tuple[float, float]:
        """(alpha, cosine_share) of least noise under white light: geometric mean over views of E[(f cos / pdf)^2] / albedo^2."""
        views, radial, azimuthal = np.radians([15, 40, 65]), 160, 64
        view, i, j = (mi.Float(a.ravel()) for a in np.meshgrid(views, np.arange(radial) + 0.5, np.arange(azimuthal) + 0.5))
        step = i / radial  # half vectors as in the table: theta = step^2 pi / 2, phi to one side of the view
        theta, phi = step * step * (dr.pi / 2), j * (dr.pi / azimuthal)
        eye = mi.Vector3f(dr.sin(view), 0, dr.cos(view))
        half = mi.Vector3f(dr.sin(theta) * dr.cos(phi), dr.sin(theta) * dr.sin(phi), dr.cos(theta))
        light = mi.reflect(eye, half)
        seen = (light.z > 0) & (dr.dot(eye, half) > 0)
        area = dr.select(seen, 4 * dr.dot(eye, half) * dr.sin(theta) * step, 0).numpy()
        value = self.value(eye, light, seen).numpy().T @ LUMINANCE * light.z.numpy()
        cosine, of_view = light.z.numpy() / np.pi, [view.numpy() == np.float32(v) for v in views]

        def noise(alpha: float, share: float) -> float:
            lobe = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, dr.opaque(mi.Float, alpha), sample_visible=True)
            glossy = (lobe.pdf(eye, half) / (4 * dr.dot(eye, half))).numpy()
            density = np.maximum(share * cosine + (1 - share) * glossy, 1e-12)
            moments = [np.sum((value**2 / density * area)[v]) / np.sum((value * area)[v])**2 for v in of_view]
            return float(np.mean(np.log(moments)))

        return min(product(np.geomspace(0.004, 1, 30), np.linspace(0.1, 0.9, 9)), key=lambda pair: noise(*pair))


def read_merl(path: Path) -> np.ndarray:
    """Cells in 1/steradian, RGB and an empty fourth component: Dr.Jit gathers powers of two in one read."""
    raw = path.read_bytes()
    if tuple(np.frombuffer(raw, "<i4", 3)) != CELLS:
        raise ValueError(f"{path}: not a MERL file of {CELLS} cells")
    stored = np.frombuffer(raw, "<f8", offset=12).reshape(3, -1).T
    cells = np.zeros((len(stored), 4), np.float32)
    measured = (stored >= 0).all(axis=1)
    cells[measured, :3] = stored[measured] * CHANNEL_SCALE
    return cells


def reflector(material: Lambert | Ggx | str, materials: Path) -> Reflector:
    """The plug-in for an analytic material, or for the measured one whose table is materials/NAME.binary."""
    if isinstance(material, Lambert):
        return LambertReflector(material)
    if isinstance(material, Ggx):
        return GgxReflector(material)
    return MerlReflector(materials / f"{material}.binary")
