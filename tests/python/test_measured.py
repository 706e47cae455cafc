"""Real inputs, where they are: set LIGHTBAND_DATA to a folder of measured data (brdf/make_merl.py, env/*.hdr, env/*.exr)."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

DATA = Path(os.environ.get("LIGHTBAND_DATA", ""))
pytestmark = pytest.mark.skipif(not os.environ.get("LIGHTBAND_DATA"),
                                reason="LIGHTBAND_DATA is not set: no measured materials and maps")

# Albedo at 45 degrees, red, of the npf fits (Bagher et al. 2016) to MERL materials, by midpoint quadrature over 3000 x 6000
# incident directions of the table's nearest cells, which agrees with one over 1000 x 2000 to 0.0002.
ALBEDOS = {"gold-paint": 0.2444, "blue-rubber": 0.0516, "beige-fabric": 0.2797, "nickel": 0.2068}


@pytest.fixture(scope="module")
def materials(tmp_path_factory):
    folder = tmp_path_factory.mktemp("merl")
    subprocess.run([sys.executable, DATA / "brdf" / "make_merl.py", folder, "--fit", "npf", *ALBEDOS], check=True)
    return folder


@pytest.mark.parametrize("name", ALBEDOS)
def test_albedo_of_a_measured_material(context, materials, name):
    brdf = context.load_brdf(materials / f"{name}.binary")
    assert brdf.albedo(np.pi / 4)[0] == pytest.approx(ALBEDOS[name], abs=0.0002)


def test_every_map_lights_a_scene(context, materials):
    brdf = context.load_brdf(materials / "nickel.binary")
    maps = sorted(p for p in (DATA / "env").iterdir() if p.suffix in (".exr", ".hdr"))
    assert maps
    for path in maps:
        scene = context.scene()
        scene.environment = context.load_environment(path)
        scene.add(context.builtin_mesh("sphere", 64), brdf)
        scene.camera(eye=(0, 0, 2), target=(0, 0, 0))
        frame = context.frame(32, 32, samples=16)
        frame.render(scene)
        assert np.isfinite(frame.color).all() and frame.color[..., :3].max() > 0, path.name
