"""The embedded default: one object in three materials under a CC0 map, after the first figure of Bagher et al.

    python examples/python/demo.py [--out out] [--width 768] [--error 0.03]

Asks for an error, writes the picture (EXR with nine fields, and PNG) and a sheet of all fields, and prints the error that was asked,
that the frame estimates and that a reference shows, with time, pixels shaded and samples.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

import lightband
from lightband import pictures

ROOT = Path(__file__).resolve().parents[2]
MATERIALS = ("interference-paint", "red-car-paint", "rough-gold")
FIELDS = ("color", "depth", "normal", "curvature", "bandwidth_image", "level", "shaded", "sample_count", "error")
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
EXPOSURE = 0.0  # stops, for the PNG


def build_scene(context: lightband.Context) -> lightband.Scene:
    """Three blobs side by side, each turned a little further."""
    scene = context.scene()
    scene.environment = context.load_environment(ROOT / "data" / "courtyard.exr")
    scene.camera(eye=(0, 0.35, 3.1), target=(0, 0, 0), fov_y=0.42)
    blob = context.builtin_mesh("blob", 256)
    for place, name in enumerate(MATERIALS):
        angle = 0.5 * place
        transform = np.eye(4)
        transform[0, 0] = transform[2, 2] = np.cos(angle)
        transform[0, 2], transform[2, 0] = np.sin(angle), -np.sin(angle)
        transform[0, 3] = 1.0 * (place - 1)  # metres
        scene.add(blob, context.builtin_brdf(name), transform)
    return scene


def show_progress(what: str):
    def progress(fraction: float) -> None:
        if sys.stderr.isatty():
            print(f"\r{what} {100 * fraction:3.0f} %", end="" if fraction < 1 else "\n", file=sys.stderr, flush=True)
    return progress


def error(picture: np.ndarray, reference: np.ndarray, covered: np.ndarray) -> float:
    """Root mean square of (L - Lref) / (Lref + 0.01 mean Lref) over the covered pixels."""
    mine, true = (image[covered][:, :3] @ LUMINANCE for image in (picture, reference))
    return float(np.sqrt(np.mean(((mine - true) / (true + 0.01 * true.mean())) ** 2)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "out")
    parser.add_argument("--width", type=int, default=768)
    parser.add_argument("--error", type=float, default=0.03, help="relative error that is asked for")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)

    context = lightband.Context(device="any")
    print(f"rendering on {context.device_name}")
    scene = build_scene(context)
    size = arguments.width, arguments.width * 3 // 8
    frame = context.frame(*size, target_error=arguments.error, background="environment", pass_times="on")
    for what in ("first frame, with its tables", "second, with the driver's last compilations", "adaptive"):
        frame.render(scene, progress=show_progress(what))
    # Every pixel shaded, and many samples: what the error is measured against.
    reference = context.frame(*size, samples=2048, coarsest_level=0, sampler="combined", seed=1, background="environment")
    reference.render(scene, progress=show_progress("reference"))

    frame.save(arguments.out / "demo.png", exposure=EXPOSURE, alpha="opaque")
    frame.save(arguments.out / "demo.exr", fields=FIELDS)
    reference.save(arguments.out / "demo_reference.png", exposure=EXPOSURE, alpha="opaque")
    pictures.draw_fields(frame, arguments.out / "demo_fields.png")

    stats = frame.stats
    print(frame.plan)
    print(f"error: asked {arguments.error:.1%}, estimated {stats.error:.1%}, against the reference "
          f"{error(frame.color, reference.color, frame.material > 0):.1%}; {stats.milliseconds:.0f} ms in {stats.rounds} rounds, "
          f"{stats.shaded_pixels / stats.covered_pixels:.0%} of {stats.covered_pixels} pixels shaded, {stats.samples} samples "
          f"(reference: {reference.stats.milliseconds:.0f} ms, {reference.stats.samples} samples); see {arguments.out}")


if __name__ == "__main__":
    main()
