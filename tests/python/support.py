"""What several test files use: luminance, one scene that shows much of the method, and objects that are made once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

import lightband

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of Rec. 709
Floats = npt.NDArray[np.float64]


def luminance(frame: lightband.Frame) -> Floats:
    """Of every pixel; 0 where nothing is seen."""
    return np.asarray(frame.color[..., :3].astype(np.float64) @ LUMINANCE)


def rendered(
    context: lightband.Context | SharedObjects, scene: lightband.Scene, width: int, height: int, **settings: float | str
) -> lightband.Frame:
    frame = context.frame(width, height, **settings)
    frame.render(scene)
    return frame


class SharedObjects:
    """Makes every scene and frame of a context anew, and each material, map and mesh once for all tests that want it.

    The tables of a material take up to a second when a frame first needs them, those of a map a third of one. Tests
    that close an object, or count the bytes that it takes, make their own.
    """

    def __init__(self, context: lightband.Context) -> None:
        self.context, self.scene, self.frame = context, context.scene, context.frame
        self._made: dict[object, Any] = {}

    def _once(self, make: Callable[..., Any], *arguments: Any) -> Any:
        key = (make.__name__, *((np.shape(a), np.asarray(a).dtype.str, np.asarray(a).tobytes()) for a in arguments))
        if key not in self._made:
            self._made[key] = make(*arguments)
        return self._made[key]

    def lambert(self, albedo: npt.ArrayLike) -> lightband.Brdf:
        return self._once(self.context.lambert, albedo)

    def ggx(self, alpha: float, f0: npt.ArrayLike) -> lightband.Brdf:
        return self._once(self.context.ggx, alpha, f0)

    def builtin_brdf(self, name: str) -> lightband.Brdf:
        return self._once(self.context.builtin_brdf, name)

    def builtin_mesh(self, name: str, resolution: int = 0) -> lightband.Mesh:
        return self._once(self.context.builtin_mesh, name, resolution)

    def environment(self, radiance: npt.NDArray[Any]) -> lightband.Environment:
        return self._once(self.context.environment, radiance)


# ---- A blob under three lights: rough and smooth parts, silhouettes, and nothing symmetric ----

MAP_HEIGHT, MAP_WIDTH = 128, 256
BLOB_SIZE = 96, 80


def directions() -> Floats:
    """Unit directions of a latitude-longitude map's texel centres: +Y up, the centre looks along +Z, +X to its left."""
    longitude = (0.5 - (np.arange(MAP_WIDTH) + 0.5) / MAP_WIDTH) * 2 * np.pi
    latitude = (0.5 - (np.arange(MAP_HEIGHT) + 0.5) / MAP_HEIGHT) * np.pi
    longitude, latitude = np.meshgrid(longitude, latitude)
    return np.stack([np.cos(latitude) * np.sin(longitude), np.sin(latitude), np.cos(latitude) * np.cos(longitude)], -1)


def light(d: Floats) -> npt.NDArray[np.float32]:
    """Three coloured lobes over a dim sky; nothing about it is symmetric."""
    centres = np.array([[0.6, 0.7, 0.4], [-0.8, 0.1, 0.6], [0.1, -0.3, 0.95]])
    centres /= np.linalg.norm(centres, axis=1, keepdims=True)
    colours = np.array([[20.0, 18, 15], [3, 6, 9], [5, 2, 1]])
    lobes = np.exp((d @ centres.T - 1) * np.array([60.0, 15, 30]))
    return np.asarray(lobes @ colours + np.array([0.1, 0.15, 0.2]) * (1.2 + d[..., 1:2]), np.float32)


UPRIGHT = np.eye(3)


def render_blob(
    shared: SharedObjects, brdf: lightband.Brdf, turn: Floats = UPRIGHT, **settings: float | str
) -> lightband.Frame:
    """The same scene seen in a world that was turned as a whole."""
    scene = shared.scene()
    scene.environment = shared.environment(light(directions() @ turn))  # light from turn @ d is light(d)
    matrix = np.eye(4)
    matrix[:3, :3] = turn
    scene.add(shared.builtin_mesh("blob", 128), brdf, matrix)
    scene.camera(eye=turn @ (0.3, 0.4, 1.9), target=(0, 0, 0), up=turn @ (0, 1, 0), fov_y=0.6)
    return rendered(shared, scene, *BLOB_SIZE, **settings)
