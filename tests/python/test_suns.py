"""Small bright sources over a dim sky: radiance has an edge where a surface's horizon crosses one, beside which a pixel is a hundredth as
bright. What is promised is kept there too."""

import numpy as np
import pytest

from support import LUMINANCE, rendered

ALBEDO = np.array([0.8, 0.5, 0.3])
TORUS = [[-0.4551, 0.4806, -0.1382, 0], [-0.4805, -0.3684, 0.3009, 0], [0.1386, 0.3007, 0.5895, 0]]


def towards(row, column, height):
    """Directions to places on a map, in texels."""
    latitude, longitude = np.pi * (0.5 - (row + 0.5) / height), np.pi * (1 - (column + 0.5) / height)
    return np.stack([np.cos(latitude) * np.sin(longitude), np.sin(latitude) + 0 * longitude, np.cos(latitude) * np.cos(longitude)], -1)


def sky(height, radiance, texels, source):
    pixels = np.full((height, 2 * height), radiance, np.float32)
    for texel in texels:
        pixels[texel] = source
    return pixels


def disc(height, half_angle):
    """Of one radiance, in a black sky."""
    axis = np.array([0.6, 0.35, 0.72])
    cosine = towards(*np.mgrid[0:height, 0 : 2 * height], height) @ (axis / np.linalg.norm(axis))
    return (cosine > np.cos(half_angle)).astype(np.float32)


SCENES = {  # map, mesh, its segments and transform, eye
    "sun over a sphere": (sky(32, 0.1, [(12, 20)], 1e6), "sphere", 0, None, (0, 0, 1.6)),
    "small sun over a sphere": (sky(256, 0.1, [(100, 160)], 1e7), "sphere", 0, None, (0, 0, 1.6)),
    "sun over bumps": (sky(32, 0.1, [(12, 20)], 1e6), "blob", 0, None, (0, 0, 1.6)),
    "sun over large triangles": (sky(64, 0.1, [(55, 74)], 1e6), "blob", 8, None, (0, 0, 1.6)),
    "a source in the dark": (sky(16, 0, [(13, 7)], 1), "torus", 96, TORUS, (-0.162, -0.055, 0.903)),
    "three sources in the dark": (sky(16, 0, [(13, 7), (13, 9), (11, 7)], 1), "torus", 96, TORUS, (-0.162, -0.055, 0.903)),
    "a disc in the dark": (disc(64, 0.07), "torus", 96, None, (0.2, 0.5, 1.2)),
}


def exact(normals, pixels):
    """What a matte surface shows: the sky's own part, and quadrature over the pyramids that bilinear lookup makes of brighter texels."""
    height, dim = len(pixels), pixels.min()
    irradiance = np.full(len(normals), np.pi * float(dim))
    step = (np.arange(64) + 0.5) / 32 - 1  # of two texels
    down, right = np.meshgrid(step, step, indexing="ij")
    share = (1 - np.abs(down)) * (1 - np.abs(right)) / 32**2 * (np.pi / height) ** 2  # times the solid angle of what lies at the equator
    for row, column in np.argwhere(pixels > dim):
        place = towards(row + down, column + right, height).reshape(-1, 3)
        weight = share.ravel() * np.sqrt(1 - place[:, 1] ** 2) * (float(pixels[row, column]) - float(dim))
        irradiance += np.maximum(normals @ place.T, 0) @ weight
    return irradiance / np.pi * (ALBEDO @ LUMINANCE)


@pytest.mark.parametrize("settings", [{"target_error": 0.1}, {"target_error": 0.03}])
@pytest.mark.parametrize("name", SCENES)
def test_what_is_asked_is_reached(shared, name, settings):
    pixels, mesh, segments, transform, eye = SCENES[name]
    scene = shared.scene()
    scene.environment = shared.environment(np.repeat(pixels[..., None], 3, -1))
    scene.add(shared.builtin_mesh(mesh, segments), shared.lambert(ALBEDO), transform)
    scene.camera(eye, (0, 0, 0))
    frame = rendered(shared, scene, 96, 96, **settings)
    seen = frame.material > 0
    true = exact(frame.normal[seen].astype(float), pixels)
    got = np.sqrt(np.mean(((frame.color[seen][:, :3] @ LUMINANCE - true) / (true + 0.01 * true.mean())) ** 2))
    assert frame.stats.error <= settings["target_error"]
    assert got <= 1.5 * settings["target_error"]  # what is promised of any frame
