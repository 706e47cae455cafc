"""Pixels that stand out of smooth pictures: six scenes of smooth shapes and built-in materials at 10, 5, 2 and 1 %.

    python bench/speckle.py --data FOLDER --references FOLDER [--pictures FOLDER] > table.csv

A pixel stands out where it differs from the median of its eight neighbours by more than three times the error that the frame
estimates. `outliers`: inner pixels in 1,000 that stand out in the frame and not in the reference; `reference`: those that
stand out in the reference, as the scene itself has edges. Independent normal noise of one size leaves 6 in 1,000: the median
of eight values has 0.44 of their standard deviation. `edges`: error in the tenth of the inner pixels where the reference
changes most. `flip`: mean of the flip-evaluator package over the picture, exposed so that the reference's 90th percentile is
1/2. References (`combined`, every pixel shaded, two of 2,048 samples) are kept in the folder. To compare two versions, run it
once with either package.
"""
from __future__ import annotations

import argparse
from pathlib import Path

import flip_evaluator
import numpy as np
from measure import luminance, relative_error
from PIL import Image
from scenes import CAMERA, MAPS, MESHES, mesh_arrays

import lightband

SCENES = [("sphere", "rough-gold", "studio"), ("torus", "rough-nickel", "forest"), ("blob", "interference-paint", "courtyard"),
          ("knot", "rough-gold", "grace"), ("bunny", "rough-nickel", "city"), ("buddha", "interference-paint", "sunset")]
SIDE, SEEDS = 256, (1, 2, 3)
SHIFTS = [(dy, dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dy or dx]
CROP, ENLARGED = slice(80, 176), 4


def stands_out(picture: np.ndarray, error: float) -> np.ndarray:
    median = np.median([np.roll(picture, shift, (0, 1)) for shift in SHIFTS], axis=0)
    return np.abs(picture - median) > 3 * error * median


def shown(color: np.ndarray, reference: np.ndarray) -> np.ndarray:
    exposed = np.clip(0.5 * color / np.percentile(luminance(reference), 90), 0, 1)
    return np.where(exposed < 0.0031308, 12.92 * exposed, 1.055 * exposed ** (1 / 2.4) - 0.055).astype(np.float32)  # sRGB


def references(context: lightband.Context, scene: lightband.Scene, file: Path) -> list[np.ndarray]:
    if not file.exists():
        pictures = []
        for seed in (101, 202):
            frame = context.frame(SIDE, SIDE, sampler="combined", coarsest_level=0, samples=2048, seed=seed)
            frame.render(scene)
            pictures.append(frame.color[..., :3])
        np.save(file, pictures)
    return list(np.load(file))


def row(frame: lightband.Frame, pair: list[np.ndarray]) -> list[float]:
    """Error, of edges; outliers, those of the reference, in 1,000; FLIP."""
    covered = inner = frame.material > 0
    for shift in SHIFTS:
        inner = inner & np.roll(covered, shift, (0, 1)) & np.roll(covered, 2 * np.array(shift), (0, 1))
    colour = (pair[0] + pair[1]) / 2
    picture, reference, a, b = (luminance(one) for one in (frame.color, colour, *pair))
    change = np.hypot(*np.gradient(np.log(reference + 0.01 * reference[covered].mean())))
    edges = inner & (change > np.percentile(change[inner], 90))
    there = stands_out(reference, frame.stats.error)
    out = stands_out(picture, frame.stats.error) & ~there
    flip = flip_evaluator.evaluate(shown(colour * covered[..., None], colour), shown(frame.color[..., :3] * covered[..., None], colour),
                                   "LDR")[1]
    return [relative_error(picture, a, b, covered), relative_error(picture, a, b, edges), 1e3 * out[inner].mean(),
            1e3 * there[inner].mean(), flip]


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--references", type=Path, required=True)
    parser.add_argument("--pictures", type=Path)
    arguments = parser.parse_args()
    context = lightband.Context(device="any")
    print("mesh,material,map,asked,estimated,got,edges,outliers,reference,flip,milliseconds")
    for mesh, material, light in SCENES:
        scene = context.scene()
        scene.environment = context.load_environment(arguments.data / "env" / MAPS[light])
        scene.camera(**CAMERA)
        shape = context.builtin_mesh(mesh) if MESHES[mesh] is None else context.mesh(*mesh_arrays(arguments.data, mesh))
        scene.add(shape, context.builtin_brdf(material))
        pair = references(context, scene, arguments.references / f"{mesh}.npy")
        for asked in (0.1, 0.05, 0.02, 0.01):
            rows, milliseconds = [], []
            context.frame(SIDE, SIDE, target_error=asked).render(scene)  # makes the programs
            for seed in SEEDS:
                frame = context.frame(SIDE, SIDE, target_error=asked, seed=seed)
                frame.render(scene)
                rows.append([frame.stats.error, *row(frame, pair)])
                milliseconds.append(frame.stats.milliseconds)
            values = ",".join(f"{value:.4g}" for value in np.mean(rows, axis=0))
            print(f"{mesh},{material},{light},{asked},{values},{np.median(milliseconds):.0f}", flush=True)
            if arguments.pictures:
                crop = shown(frame.color[CROP, CROP, :3], (pair[0] + pair[1]) / 2)
                size = 2 * (ENLARGED * crop.shape[0],)
                Image.fromarray((255 * crop + 0.5).astype(np.uint8)).resize(size, Image.Resampling.NEAREST).save(
                    arguments.pictures / f"{mesh}-{asked}.png")


if __name__ == "__main__":
    main()
