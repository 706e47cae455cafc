"""Agreement with Mitsuba 3: whether lightband and Mitsuba converge to the same pictures.

    python bench/judge.py --data DATA --materials MERL --out docs/measurements [--size 128] [--spp 1024]

Both render each scene four times, independently, with every pixel shaded. Compared are pixels whose centres see the same point in
both, with a shading normal that faces the eye. Reported: the ratio of mean luminances with its standard error, judged against
0.5 %; the relative RMS difference of conventions.md, in which the cross products of independent pairs cancel the noise of both;
how many covered pixels were compared. The two share the meshes' arrays and nothing else: each reads map and table by itself, and
has its own rays, samplers and reflectances. Writes judge.csv and prints a table.
"""
from __future__ import annotations

import argparse
import datetime
from pathlib import Path

import numpy as np
from tqdm import tqdm

import lightband
from measure import DARK_PART, luminance
from peer import Peer, PeerScene
from peer_brdfs import Ggx, Lambert
from scenes import CAMERA, Stage, machine
from tables import write_table

GOLD = Ggx(alpha=0.3, f0=(1.0, 0.78, 0.34))
GREY = Lambert(albedo=(0.5, 0.5, 0.5))
SCENES = (("sphere", GREY, "studio"), ("sphere", GOLD, "grace"), ("sphere", Ggx(alpha=0.05, f0=GOLD.f0), "forest"),
          ("sphere", "gold-paint", "forest"), ("sphere", "gold-paint", "grace"), ("bunny", "gold-paint", "forest"),
          ("bunny", "nickel", "forest"), ("car body", "blue-rubber", "studio"), ("car body", "beige-fabric", "grace"),
          ("dragon", "color-changing-paint3", "studio"))
COLUMNS = ("mesh", "material", "map", "mean ratio", "standard error", "rms difference", "compared", "verdict")
TOLERANCE = 0.005  # of the mean luminance
SAME_POINT = 0.002  # metres between two hits of one pixel: a pixel's width on the object is 0.007 m at 128 x 128
FACING = 0.0105  # cosine just above that under which bent normals are seen (shaders/gbuffer.frag)
PICTURES = 4  # independent ones by each renderer; even
SAMPLES = 256  # our mean samples a pixel of one frame; frames are accumulated


def our_material(stage: Stage, material: Lambert | Ggx | str) -> lightband.Brdf:
    if isinstance(material, Lambert):
        return stage.context.lambert(material.albedo)
    if isinstance(material, Ggx):
        return stage.context.ggx(material.alpha, material.f0)
    return stage.brdf(material)


def our_pictures(stage: Stage, mesh: str, material: Lambert | Ggx | str, environment: str, size: int, spp: int) -> tuple:
    """PICTURES pictures, and the last one's frame. Many frames make each: one has no more than 65,536 directions of the map."""
    scene = stage.context.scene()
    scene.environment = stage.environment(environment)
    scene.add(stage.mesh(mesh), our_material(stage, material))
    scene.camera(**CAMERA)
    pictures, frames = [], max(2 * spp // SAMPLES, 1)
    for k in range(PICTURES):
        frame = stage.context.frame(size, size, samples=SAMPLES, coarsest_level=0, sampler="combined", seed=k * frames, accumulate=frames)
        frame.render(scene)
        pictures.append(luminance(frame.color))
    return pictures, frame


def peer_pictures(peer: Peer, scene: PeerScene, spp: int) -> list[np.ndarray]:
    return [luminance(peer.render(scene, spp, seed)[0]) for seed in range(PICTURES)]


def comparable(frame: lightband.Frame, scene: PeerScene) -> np.ndarray:
    """Pixels that see the same point in both, under a shading normal that did not have to be bent."""
    to_eye = CAMERA["eye"] - frame.position
    cosine = np.sum(to_eye * frame.normal, axis=-1) / np.linalg.norm(to_eye, axis=-1)
    apart = np.linalg.norm(frame.position - scene.position, axis=-1)  # not a number where Mitsuba sees nothing
    return (frame.material > 0) & (cosine > FACING) & (apart < SAME_POINT)


def mean_ratio(ours: list[np.ndarray], theirs: list[np.ndarray], compared: np.ndarray) -> tuple[float, float]:
    """Mean luminance of ours over theirs, and its standard error from the spread of the independent pictures' means."""
    means = np.array([[picture[compared].mean() for picture in pictures] for pictures in (ours, theirs)])
    errors = means.std(axis=1, ddof=1) / np.sqrt(PICTURES) / means.mean(axis=1)
    return means[0].mean() / means[1].mean(), float(np.hypot(*errors))


def rms_difference(ours: list[np.ndarray], theirs: list[np.ndarray], compared: np.ndarray) -> float:
    """E of docs/conventions.md between the converged pictures: the noise of both cancels in products of independent pairs.

    By what is left of it the estimate of a small squared difference may come out negative; then 0 is reported.
    """
    (a, b), (c, d) = ([np.mean(pictures[k::2], axis=0)[compared] for k in (0, 1)] for pictures in (ours, theirs))
    scale = 0.5 * (c + d)
    scale += DARK_PART * scale.mean()
    squared = 0.5 * np.mean(((a - c) * (b - d) + (a - d) * (b - c)) / scale**2)
    return float(np.sqrt(max(squared, 0)))


def judge(stage: Stage, peer: Peer, mesh: str, material: Lambert | Ggx | str, environment: str, size: int, spp: int) -> dict:
    ours, frame = our_pictures(stage, mesh, material, environment, size, spp)
    scene = peer.scene(mesh, material, environment, size, compensate=False)
    theirs = peer_pictures(peer, scene, spp)
    compared = comparable(frame, scene)
    ratio, error = mean_ratio(ours, theirs, compared)
    return dict(zip(COLUMNS, (
        mesh, str(material), environment, f"{ratio:.5f}", f"{error:.5f}", f"{rms_difference(ours, theirs, compared):.4f}",
        f"{compared.sum() / frame.stats.covered_pixels:.4f}", "agree" if abs(ratio - 1) <= TOLERANCE else "DIFFER")))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--materials", type=Path, required=True)
    parser.add_argument("--out", type=Path, default=Path("docs/measurements"))
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--spp", type=int, default=1024, help="of each picture by Mitsuba: a sample of the map and one of "
                        "the reflectance each; ours draws as many samples, half of either kind")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    stage, peer = Stage(arguments.data, arguments.materials), Peer(arguments.data, arguments.materials)
    rows = [judge(stage, peer, *scene, arguments.size, arguments.spp) for scene in tqdm(SCENES, desc="scenes")]
    path = arguments.out / "judge.csv"
    write_table(path, f"{machine(stage.context)}; {peer.description}; {arguments.size} x {arguments.size}; "
                      f"{datetime.date.today()}", COLUMNS, rows)
    print(path.read_text())
    raise SystemExit(any(row["verdict"] != "agree" for row in rows))


if __name__ == "__main__":
    main()
