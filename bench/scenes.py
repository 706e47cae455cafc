"""The scenes of the studies: scanned meshes, MERL materials and light probes from a folder of measured data.

The folder (--data) holds mesh/, env/ and brdf/. Its files are not part of the project: they come from the Stanford 3D Scanning
Repository, Poly Haven, P. Debevec, and fits to the MERL database (Bagher et al. 2016), as MERL .binary files.
"""
from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh

import lightband

MESHES = {"bunny": "bun_zipper.ply", "buddha": "happy_vrip_res3.ply", "dragon": "dragon_vrip_res3.ply",
          "car body": "beetle-alt.obj", "sphere": None, "blob": None, "knot": None, "torus": None}  # None: built in
MAPS = {"grace": "grace_probe_latlong.hdr", "stpeters": "stpeters_probe_latlong.hdr", "studio": "studio.hdr",
        "forest": "forest.hdr", "city": "city.hdr", "courtyard": "courtyard.exr", "night": "night.exr", "sunset": "sunset.exr"}
CAMERA = {"eye": (0.35, 0.3, 1.6), "target": (0, 0, 0), "fov_y": 0.56}  # metres, radians


def mesh_arrays(data: Path, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Vertices, centred and scaled so that their bounding sphere has radius 1/2, and triangles of a scanned mesh."""
    loaded = trimesh.load(data / "mesh" / MESHES[name], force="mesh", process=True)
    points = np.asarray(loaded.vertices) - loaded.bounds.mean(axis=0)
    points *= 0.5 / np.linalg.norm(points, axis=1).max()
    return points.astype(np.float32), np.asarray(loaded.faces, np.uint32)


class Stage:
    """Loads what scenes are made of, each once."""

    def __init__(self, data: Path, materials: Path, device: str = "any") -> None:
        self.data, self.materials = data, materials
        self.context = lightband.Context(device=device)
        self._brdfs: dict[str, lightband.Brdf] = {}
        self._maps: dict[str, lightband.Environment] = {}
        self._meshes: dict[str, lightband.Mesh] = {}

    def brdf(self, name: str) -> lightband.Brdf:
        if name not in self._brdfs:
            self._brdfs = {name: self.context.load_brdf(self.materials / f"{name}.binary")}  # one at a time: 35 MB each
        return self._brdfs[name]

    def environment(self, name: str) -> lightband.Environment:
        if name not in self._maps:
            self._maps[name] = self.context.load_environment(self.data / "env" / MAPS[name])
        return self._maps[name]

    def mesh(self, name: str) -> lightband.Mesh:
        if name not in self._meshes:
            self._meshes[name] = (self.context.builtin_mesh(name) if MESHES[name] is None
                                  else self.context.mesh(*mesh_arrays(self.data, name)))
        return self._meshes[name]

    def scene(self, mesh: str, brdf: str, environment: str) -> lightband.Scene:
        scene = self.context.scene()
        scene.environment = self.environment(environment)
        # Nobody sees the inside of a computed shape. Scans have a pixel here and there that shows the back of a fold.
        scene.add(self.mesh(mesh), self.brdf(brdf), double_sided=MESHES[mesh] is not None)
        scene.camera(**CAMERA)
        return scene


def machine(context: lightband.Context) -> str:
    """One line for a table's head: processor, cores, driver."""
    import os
    import platform

    model = platform.processor() or platform.machine()
    for line in Path("/proc/cpuinfo").read_text().splitlines() if Path("/proc/cpuinfo").exists() else []:
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
            break
    return f"{model}, {len(os.sched_getaffinity(0))} cores; {context.device_name}"
