"""All that matrix.py measures of one scene, as plain numbers.

Errors are relative_error of measure.py against two independent references. Times are milliseconds of wall time
in this process, after a render that is not timed where shaders or tables are made: the least of two, or one where that is long.
"""
from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import lightband
from judge import comparable
from matrix_oracle import oracle_fractions
from measure import luminance, relative_error
from peer import Peer
from scenes import Stage

TARGETS = (0.10, 0.05, 0.02, 0.01)  # relative error
BUDGETS = (50, 100, 300, 1000)  # milliseconds
SAMPLERS = ("cut", "combined", "filtered", "brdf")
FULL_SAMPLES = (64, 512)
FIXED_SAMPLES = (32, 128, 512)
FIXED_SCALES = (0.25, 0.5, 1, 2)
RIVAL_SAMPLES = 256
PEER_SAMPLES = (16, 64, 256)
LONG = 1000  # milliseconds: what takes longer is not repeated
SEED = 7
ASKED_SEEDS = (7, 8, 9)  # of frames with a target error: which pixels are looked at, and how samples fall
REFERENCE_SEEDS = (100_001, 200_002)
SAME_NORMAL = 1e-4  # builds and drivers round otherwise, by some 1e-7; a pixel that sees another triangle differs by far more
# Operator, variance, allocation and samples as printed.
PAPERS = {"transport": "box", "allocation": "constant_variance", "variance": "printed", "sampler": "brdf",
          "sequence": "random"}


class Scenery:
    """Both renderers and the folder that keeps references."""

    def __init__(self, data: Path, materials: Path, cache: Path, reference_samples: int) -> None:
        self.stage, self.peer = Stage(data, materials), Peer(data, materials)
        self.cache, self.reference_samples = cache, reference_samples


@dataclass(frozen=True)
class Truth:
    """Two independent converged pictures of a scene, and which pixels see a mesh."""
    a: np.ndarray
    b: np.ndarray
    covered: np.ndarray

    def error(self, picture: np.ndarray, compared: np.ndarray | bool = True) -> float:
        return relative_error(picture, self.a, self.b, self.covered & compared)


def references(scenery: Scenery, scene: lightband.Scene, name: str, size: int) -> Truth:
    """From the cache, if its pixels saw what they see now; or made: every pixel shaded, two frames averaged so that the map's
    directions differ too."""
    path = scenery.cache / f"{name} {size} {scenery.reference_samples}.npz".replace(" ", "_")
    surfaces = scenery.stage.context.frame(size, size, method="reference", samples=1)
    surfaces.render(scene)
    if path.exists():
        with np.load(path) as stored:
            if "normal" in stored and np.abs(stored["normal"] - surfaces.normal).max() <= SAME_NORMAL:
                return Truth(stored["a"].astype(np.float64), stored["b"].astype(np.float64), stored["covered"])
    pictures = []
    for seed in REFERENCE_SEEDS:
        frame = scenery.stage.context.frame(size, size, samples=scenery.reference_samples, coarsest_level=0, seed=seed,
                                            sampler="combined", accumulate=2)
        frame.render(scene)
        pictures.append(luminance(frame.color).astype(np.float32))
    part = path.with_suffix(".part.npz")
    np.savez(part, a=pictures[0], b=pictures[1], covered=frame.material > 0, normal=frame.normal)
    part.replace(path)
    return Truth(pictures[0].astype(np.float64), pictures[1].astype(np.float64), frame.material > 0)


def least_of(render: Callable[[], float], runs: int = 2) -> float:
    """The least of several renders' milliseconds; of the first alone where that is long."""
    times: list[float] = []
    while len(times) < runs and (not times or times[-1] < LONG):
        times.append(render())
    return min(times)


def least_time(frame: lightband.Frame, scene: lightband.Scene) -> float:
    def render() -> float:
        frame.render(scene)
        return frame.stats.milliseconds

    return least_of(render)


def asked_errors(frame: lightband.Frame, scene: lightband.Scene, truth: Truth) -> list[dict]:
    """Frames with a target error: what was asked, estimated and got, and at what cost."""
    rows = []
    for seed, target in itertools.product(ASKED_SEEDS, TARGETS):
        frame["seed"], frame["target_error"] = seed, target
        if not rows:
            least_time(frame, scene)  # shaders and tables; later frames use the same
        milliseconds, stats = least_time(frame, scene), frame.stats
        rows.append({"seed": seed, "target": target, "got": truth.error(luminance(frame.color)), "estimated": stats.error,
                     "noise": stats.noise_error, "interpolation": stats.interpolation_error,
                     "bias": stats.bias_error, "ms": milliseconds,
                     "prediction_ms": stats.bandwidth_milliseconds, "samples": stats.samples, "shaded": stats.shaded_pixels,
                     "capped": stats.capped_pixels, "rounds": stats.rounds, "bytes": stats.device_bytes})
    frame["seed"], frame["target_error"] = SEED, 0
    return rows


def asked_times(frame: lightband.Frame, scene: lightband.Scene, truth: Truth) -> list[dict]:
    """Frames with a time budget, three after one that is not counted."""
    rows = []
    for budget in BUDGETS:
        frame["time_budget"] = budget
        frame.render(scene)
        times = []
        for _ in range(3):
            frame.render(scene)
            times.append(frame.stats.milliseconds)
        rows.append({"budget": budget, "ms": times, "got": truth.error(luminance(frame.color)), "estimated": frame.stats.error})
    frame["time_budget"] = 0
    return rows


def fixed_points(scenery: Scenery, scene: lightband.Scene, truth: Truth, points: list[dict]) -> list[dict]:
    """Frames of the given settings, one timed render each after two for each kind of shader: sampler and method."""
    rows, warm = [], set()
    for settings in points:
        height, width = truth.covered.shape
        frame = scenery.stage.context.frame(width, height, seed=SEED, **settings)
        kind = tuple(value for value in settings.values() if isinstance(value, str))
        if kind not in warm:
            warm.add(kind)
            for _ in range(2):  # the driver compiles shaders until the second
                frame.render(scene)
        frame.render(scene)
        rows.append({**settings, "got": truth.error(luminance(frame.color)), "ms": frame.stats.milliseconds,
                     "shading_ms": frame.stats.shading_milliseconds, "shaded": frame.stats.shaded_pixels})
    return rows


def peer_points(scenery: Scenery, mesh: str, material: str, environment: str, frame: lightband.Frame, truth: Truth) -> list[dict]:
    """Mitsuba's renders, over the pixels that see the same point in both.

    Its compiler starts anew at every number of samples: the first render of each is not timed.
    """
    scene = scenery.peer.scene(mesh, material, environment, truth.covered.shape[0])
    compared = comparable(frame, scene)
    rows = []
    for seed, spp in enumerate(PEER_SAMPLES, 1):
        picture, _ = scenery.peer.render(scene, spp, seed)
        milliseconds = least_of(lambda: scenery.peer.render(scene, spp, seed)[1])
        rows.append({"spp": spp, "got": truth.error(luminance(picture), compared), "ms": milliseconds})
    return rows


def measure_scene(scenery: Scenery, mesh: str, material: str, environment: str, size: int, fixed: bool) -> dict:
    """Everything of one scene; fixed: also the grid of fixed adaptive settings."""
    scene = scenery.stage.scene(mesh, material, environment)
    truth = references(scenery, scene, f"{mesh} {material} {environment}", size)
    frame = scenery.stage.context.frame(size, size, seed=SEED)
    asked = asked_errors(frame, scene, truth)
    grid = [{"samples": samples, "bandwidth_scale": scale} for samples in FIXED_SAMPLES for scale in FIXED_SCALES]
    full = [{"samples": samples, "coarsest_level": 0, "sampler": sampler}
            for sampler in SAMPLERS for samples in FULL_SAMPLES]
    return {
        "mesh": mesh, "material": material, "map": environment, "size": size, "covered": int(truth.covered.sum()),
        "asked": asked,
        "budgets": asked_times(frame, scene, truth),
        "full": fixed_points(scenery, scene, truth, full),
        "fixed": fixed_points(scenery, scene, truth, grid) if fixed else [],
        "reference": fixed_points(scenery, scene, truth, [{"samples": RIVAL_SAMPLES, "method": "reference"}])[0],
        "papers": fixed_points(scenery, scene, truth, [{"samples": RIVAL_SAMPLES, **PAPERS}])[0],
        "peer_points": peer_points(scenery, mesh, material, environment, frame, truth),
        "oracle": oracle_fractions(frame, truth.a, truth.b, [row["got"] for row in asked]),
    }
