"""Maps with a small bright source: what is promised, what is got, and the time, with and without split_suns.

    python bench/suns.py --out docs/measurements [--map sunset.exr ...] [--device software]

One texel of 1e4 to 1e8 over a sky of 1 (maps of 256 rows) lights a matte sphere, whose picture has a closed form, at 5 and 1 %. Maps that
are named light a glossy sphere, judged against two pictures without bias. Each frame is rendered twice and the second timed, so that
tables and programs are made. Writes suns.csv.
"""
from __future__ import annotations

import argparse
import datetime
import sys
from pathlib import Path

import numpy as np

import lightband
from measure import luminance, relative_error
from scenes import machine
from tables import write_table

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests" / "python"))
from test_suns import ALBEDO, exact, sky  # noqa: E402

COLUMNS = ("map", "split_suns", "asked", "said", "got", "milliseconds", "shaded")
SIDE = 256


def rendered(context: lightband.Context, environment: lightband.Environment, brdf: lightband.Brdf, **settings) -> lightband.Frame:
    scene = context.scene()
    scene.environment = environment
    scene.add(context.builtin_mesh("sphere"), brdf)
    scene.camera((0, 0, 1.6), (0, 0, 0))
    frame = context.frame(SIDE, SIDE, **settings)
    frame.render(scene)
    if "target_error" in settings:
        frame.render(scene)
    return frame


def rows_of(name: str, context, environment, brdf, references) -> list[dict]:
    rows = []
    for asked in (0.05, 0.01):
        for split in ("on", "off"):
            frame = rendered(context, environment, brdf, target_error=asked, split_suns=split)
            got = relative_error(luminance(frame.color), *references(frame), frame.material > 0)
            stats = frame.stats
            rows.append(dict(zip(COLUMNS, (name, split, asked, stats.error, got, stats.milliseconds, stats.shaded_pixels))))
            print(rows[-1], flush=True)
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("docs/measurements"))
    parser.add_argument("--map", type=Path, action="append", default=[])
    parser.add_argument("--device", default="software")
    arguments = parser.parse_args()
    context = lightband.Context(device=arguments.device)
    matte, glossy = context.lambert(ALBEDO), context.ggx(0.3, (1, 0.8, 0.6))
    rows = []
    for brightness in (1e4, 1e6, 1e8):
        pixels = sky(256, 1, [(80, 160)], brightness)

        def closed_form(frame: lightband.Frame) -> tuple[np.ndarray, np.ndarray]:
            true = np.zeros((SIDE, SIDE))
            true[frame.material > 0] = exact(frame.normal[frame.material > 0].astype(float), pixels)
            return true, true

        rows += rows_of(f"texel of {brightness:g}", context, context.environment(np.repeat(pixels[..., None], 3, -1)), matte, closed_form)
    for path in arguments.map:
        environment = context.load_environment(path)
        pair = [luminance(rendered(context, environment, glossy, sampler="combined", samples=4096, coarsest_level=0, split_suns="off",
                                   seed=seed).color) for seed in (1, 2)]
        rows += rows_of(path.stem, context, environment, glossy, lambda frame, pair=pair: pair)
    write_table(arguments.out / "suns.csv", f"{machine(context)}; {datetime.date.today()}", COLUMNS, rows)


if __name__ == "__main__":
    main()
