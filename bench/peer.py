"""Mitsuba 3 as a peer: the scenes of scenes.py, rendered with the same rays, light, reflectances and lack of shadows.

    peer = Peer(data, materials)
    picture, milliseconds = peer.render(peer.scene("bunny", "gold-paint", "forest", 512), spp=64, seed=1)

    python bench/peer.py --data DATA --materials MERL      # its speed beside that of Mitsuba's own `direct`

Mitsuba supplies ray casting, the importance-sampled map, GGX normals, the sampler (multijitter, the best of its own) and the
compiler; a short integrator replaces its `direct`, which would cast shadows: one sample of the map and one of the reflectance,
combined by the power heuristic as there. What favours the peer: no lane is spent on pixels that see no mesh, a pixel's one ray is
traced once for all its samples, and none after it.
"""
from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mitsuba_llvm import dr, mi
from peer_brdfs import Ggx, Lambert, Reflector, reflector
from scenes import CAMERA, MAPS, MESHES, mesh_arrays

SILHOUETTE_COSINE = 0.0104  # shaders/gbuffer.frag: under which a shading normal that faces away is seen


@dataclass
class PeerScene:
    """One view, ready to render."""
    scene: mi.Scene
    size: int
    position: np.ndarray
    """[H][W][3], metres, world: what a pixel's centre sees; not a number where nothing."""

    @property
    def covered(self) -> np.ndarray:
        return ~np.isnan(self.position[..., 0])


class Peer:
    """Loads what scenes are made of, each once."""

    def __init__(self, data: Path, materials: Path) -> None:
        self.data, self.materials = data, materials
        self._meshes: dict[str, tuple[np.ndarray, np.ndarray, np.ndarray]] = {}
        self._maps: dict[tuple[str, bool], mi.Emitter] = {}
        self._reflectors: dict[Lambert | Ggx | str, Reflector] = {}

    @property
    def description(self) -> str:
        return f"Mitsuba {mi.__version__} {mi.variant()}, Dr.Jit {dr.__version__}, {dr.thread_count()} threads"

    def mesh(self, name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Positions, normals, triangles."""
        if name not in self._meshes:
            if name == "sphere":
                self._meshes[name] = sphere()
            elif MESHES[name] is None:
                raise ValueError(f"mesh {name!r} is built into lightband and cannot be read; there are sphere and scanned meshes")
            else:
                positions, triangles = mesh_arrays(self.data, name)
                self._meshes[name] = positions, vertex_normals(positions, triangles), triangles
        return self._meshes[name]

    def environment(self, name: str, compensate: bool) -> mi.Emitter:
        if (name, compensate) not in self._maps:
            bitmap = mi.Bitmap(rows_to_poles(read_map(self.data / "env" / MAPS[name])))
            self._maps[name, compensate] = mi.load_dict({"type": "envmap", "bitmap": bitmap, "mis_compensation": compensate})
        return self._maps[name, compensate]

    def reflector(self, material: Lambert | Ggx | str) -> Reflector:
        if material not in self._reflectors:
            self._reflectors = {material: reflector(material, self.materials)}  # one at a time: 23 MB each
        return self._reflectors[material]

    def scene(self, mesh: str, material: Lambert | Ggx | str, environment: str, size: int, compensate: bool = True) -> PeerScene:
        """material: a measured one's name, or a Lambert or Ggx. compensate: draw less from the map where the reflectance
        serves (Karlik et al. 2019)."""
        scene = mi.load_dict({
            "type": "scene", "mesh": mitsuba_mesh(*self.mesh(mesh), self.reflector(material)),
            "light": self.environment(environment, compensate),
            "sensor": {"type": "perspective", "fov": float(np.degrees(CAMERA["fov_y"])), "fov_axis": "y", "near_clip": 1e-3,
                       "to_world": mi.ScalarTransform4f().look_at(CAMERA["eye"], CAMERA["target"], (0, 1, 0)),
                       "sampler": {"type": "multijitter"},
                       "film": {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}}}})
        seen, hits = first_hits(scene, size)
        position = np.full((size * size, 3), np.nan, np.float32)
        position[seen.numpy()] = hits.p.numpy().T
        return PeerScene(scene, size, position.reshape(size, size, 3))

    def render(self, scene: PeerScene, spp: int, seed: int) -> tuple[np.ndarray, float]:
        """(picture [H][W][3] float32 of linear radiance, black where no mesh is seen; milliseconds of wall time).

        spp: samples of the map, and as many of the reflectance; what multijitter cannot cut into a grid is rounded up. The
        first render of a kind of scene compiles its kernel: its time means nothing.
        """
        start = time.perf_counter()
        seen, hits = first_hits(scene.scene, scene.size)
        # The seed is the base's: seed() adds its own to a pixel's number, so that neighbours under other seeds repeat patterns.
        sampler = mi.load_dict({"type": "multijitter", "sample_count": spp, "seed": seed})
        spp, count = sampler.sample_count(), dr.width(seen)
        if count * spp >= 2**32:
            raise ValueError(f"{spp} samples of {count} pixels exceed the 2^32 lanes of a kernel: average several seeds instead")
        sampler.set_samples_per_wavefront(spp)
        sampler.seed(0, count * spp)
        slot = dr.arange(mi.UInt32, count * spp) // dr.opaque(mi.UInt32, spp)
        light = unshadowed_light(scene.scene, sampler, dr.gather(mi.SurfaceInteraction3f, hits, slot))
        sums = dr.zeros(mi.Color3f, count)
        dr.scatter_reduce(dr.ReduceOp.Add, sums, light / spp, slot)
        picture = np.zeros((scene.size**2, 3), np.float32)
        picture[seen.numpy()] = sums.numpy().T
        return picture.reshape(scene.size, scene.size, 3), 1e3 * (time.perf_counter() - start)


def first_hits(scene: mi.Scene, size: int) -> tuple[mi.UInt32, mi.SurfaceInteraction3f]:
    """What is seen through the pixels' centres: numbers of the pixels that see a mesh, in rows, and what they see."""
    pixel = dr.arange(mi.UInt32, size * size)
    centre = (mi.Point2f(pixel % size, pixel // size) + 0.5) / size
    ray = scene.sensors()[0].sample_ray(0, 0, centre, mi.Point2f(0.5))[0]
    hit = scene.ray_intersect(ray)
    turn_towards_eye(hit, -ray.d)
    seen = dr.compress(hit.is_valid())
    return seen, dr.gather(mi.SurfaceInteraction3f, hit, seen)


def turn_towards_eye(hit: mi.SurfaceInteraction3f, eye: mi.Vector3f) -> None:
    """Both sides of triangles are shaded, and a shading normal that faces away is bent until it is just seen, as ours is."""
    facet = dr.mulsign(hit.n, dr.dot(hit.n, eye))
    normal = dr.mulsign(hit.sh_frame.n, dr.dot(hit.sh_frame.n, facet))
    cosine = dr.dot(normal, eye)
    tangent = dr.normalize(dr.fma(-cosine, eye, normal))
    bent = SILHOUETTE_COSINE * eye + dr.sqrt(1 - SILHOUETTE_COSINE**2) * tangent
    hit.sh_frame = mi.Frame3f(dr.select(cosine > 0, normal, bent))
    hit.wi = hit.to_local(eye)


def unshadowed_light(scene: mi.Scene, sampler: mi.Sampler, hit: mi.SurfaceInteraction3f) -> mi.Color3f:
    """Light reflected towards the eye as if nothing stood before the map: one sample of the map, one of the reflectance."""
    bsdf, light, context = hit.bsdf(), scene.environment(), mi.BSDFContext()

    from_map, arriving = light.sample_direction(hit, sampler.next_2d())
    reflected, density = bsdf.eval_pdf(context, hit, hit.to_local(from_map.d))
    both = dr.select(from_map.pdf > 0, reflected * arriving * power_heuristic(from_map.pdf, density), 0)

    drawn, weight = bsdf.sample(context, hit, sampler.next_1d(), sampler.next_2d())
    direction, beyond = dr.zeros(mi.DirectionSample3f), dr.zeros(mi.SurfaceInteraction3f)
    direction.d = hit.to_world(drawn.wo)
    beyond.wi = -direction.d
    arriving, density = light.eval(beyond), light.pdf_direction(hit, direction)
    return both + dr.select(drawn.pdf > 0, weight * arriving * power_heuristic(drawn.pdf, density), 0)


def power_heuristic(own: mi.Float, other: mi.Float) -> mi.Float:
    """Veach 1997, with exponent 2."""
    return dr.select(own > 0, own**2 / (own**2 + other**2), 0)


def read_map(path: Path) -> np.ndarray:
    """[H][W][3] float32, linear Rec. 709, read by Mitsuba; negative values of lossy compression become 0.

    A Radiance file stores mantissas rounded down; Radiance adds half a step back (colr_color), and so do we. Mitsuba does not,
    which darkens a map by 0.3 to 0.5 %. The step is 2^-8 of the power of two above the largest component.
    """
    texels = np.array(mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))
    if path.suffix == ".hdr":
        largest = texels.max(axis=-1, keepdims=True)
        texels += np.where(largest > 0, np.ldexp(0.5, np.frexp(largest)[1] - 8), 0)
    return np.maximum(texels, 0)


def rows_to_poles(texels: np.ndarray) -> np.ndarray:
    """A map that Mitsuba interpolates as ours.

    Ours samples row y of H at the polar angle (y + 1/2) pi / H and is constant beyond the first and the last; Mitsuba puts row k
    of K at k pi / (K - 1). With K = 2 H + 1 the odd rows are ours, the even ones the means that ours would have there.
    """
    height, width, _ = texels.shape
    rows = np.empty((2 * height + 1, width, 3), np.float32)
    rows[1::2] = texels
    rows[0], rows[-1] = texels[0], texels[-1]
    rows[2:-1:2] = 0.5 * (texels[:-1] + texels[1:])
    return rows


def vertex_normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Unit sums of the adjacent triangles' normals, weighted by area."""
    a, b, c = (positions[triangles[:, k]].astype(np.float64) for k in range(3))
    facets = np.cross(b - a, c - a)
    sums = np.zeros(positions.shape)
    for k in range(3):
        np.add.at(sums, triangles[:, k], facets)
    length = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.where(length > 0, sums / np.where(length > 0, length, 1), (0, 0, 1)).astype(np.float32)


def sphere(columns: int = 256) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The built-in sphere, of radius 1/2 with exact normals: a grid of longitude and latitude."""
    rows = columns // 2
    v, u = np.meshgrid(np.linspace(0, np.pi, rows + 1), np.linspace(0, 2 * np.pi, columns + 1), indexing="ij")
    normals = np.stack([np.sin(v) * np.sin(u), np.cos(v), np.sin(v) * np.cos(u)], axis=-1).reshape(-1, 3)
    a = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    b, c = a + 1, a + columns + 1
    triangles = np.stack([np.stack([a, c, b], -1), np.stack([b, c, c + 1], -1)], axis=1).reshape(-1, 3)
    return (0.5 * normals).astype(np.float32), normals.astype(np.float32), triangles.astype(np.uint32)


def mitsuba_mesh(positions: np.ndarray, normals: np.ndarray, triangles: np.ndarray, bsdf: mi.BSDF) -> mi.Mesh:
    properties = mi.Properties()
    properties["bsdf"] = bsdf
    mesh = mi.Mesh("mesh", len(positions), len(triangles), properties, has_vertex_normals=True)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"], parameters["faces"] = positions.ravel(), triangles.ravel()
    parameters["vertex_normals"] = normals.ravel()
    parameters.update()
    return mesh


def speed_beside_direct(peer: Peer, size: int, spp: int, runs: int) -> None:
    """Prints seconds of the peer and of Mitsuba's own `direct` (which casts shadow rays) where both give the same picture: on a
    sphere. Wall time and, since others may use the machine, processor time shared by the threads; the least of several runs."""
    mesh, material, environment = "sphere", "gold-paint", "forest"
    scene = peer.scene(mesh, material, environment, size)
    spp = mi.load_dict({"type": "multijitter", "sample_count": spp}).sample_count()
    scene.scene.sensors()[0].sampler().set_sample_count(spp)
    direct = mi.load_dict({"type": "direct", "hide_emitters": True})
    renders = {"peer": lambda seed: peer.render(scene, spp, seed)[0],
               "direct": lambda seed: mi.render(scene.scene, integrator=direct, spp=spp, seed=seed).numpy()[..., :3]}
    covered = scene.covered
    print(f"{peer.description}; {mesh}, {material}, {environment}; {size} x {size}, {covered.sum()} covered; {spp} spp")
    for name, render in renders.items():
        render(0)
        times = []
        for seed in range(1, 1 + runs):
            wall, processor = time.perf_counter(), time.process_time()
            picture = render(seed)
            times.append((time.perf_counter() - wall, (time.process_time() - processor) / dr.thread_count()))
        wall, processor = np.min(times, axis=0)
        rate = covered.sum() * spp / processor / 1e6
        print(f"{name:7} wall {wall:.3f} s, processor {processor:.3f} s: {rate:.1f} million spp/s of covered pixels; "
              f"mean {picture[covered].mean():.5f}")


def main() -> None:
    parser = argparse.ArgumentParser(description="The peer's speed beside that of Mitsuba's own direct integrator.")
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--materials", type=Path, required=True)
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--spp", type=int, default=132)
    parser.add_argument("--runs", type=int, default=5)
    arguments = parser.parse_args()
    speed_beside_direct(Peer(arguments.data, arguments.materials), arguments.size, arguments.spp, arguments.runs)


if __name__ == "__main__":
    main()
