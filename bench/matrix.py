"""What asking for an error or a time gives and costs, over sixty scenes, beside every rival: docs/trade.md and its tables.

    python bench/matrix.py --data DATA --materials MERL --cache CACHE --out docs/measurements [--scenes N] [--size 256]
    python bench/matrix.py --cache CACHE --out docs/measurements --only-report

Every scene is measured at one size, the first --large of them again at twice that size (matrix_scene.py says what). A finished
scene is one line of CACHE/results.jsonl and its references one file beside it: a rerun measures what is missing, and stopping
loses the scene at work. The report (matrix_report.py) is written from the lines alone.
"""
from __future__ import annotations

import argparse
import datetime
import json
import os
from pathlib import Path

from tqdm import tqdm

from matrix_report import write_report

MESHES = ("sphere", "bunny", "buddha", "dragon", "car body")
MATERIALS = ("gold-paint", "color-changing-paint3", "red-metallic-paint", "green-metallic-paint", "blue-rubber", "nickel",
             "white-marble", "beige-fabric")
MAPS = ("grace", "stpeters", "studio", "forest", "city", "night")
SCENES = 60
SECONDS_A_PIXEL = 50 / 256**2  # of a scene, by software rendering on two cores; a third of it for references

Key = tuple[str, str, str, int]


def scene_list() -> list[tuple[str, str, str]]:
    """Scene k: mesh k mod 5, material (k + floor(k / 6)) mod 8, map k mod 6. Every pair of two of them occurs."""
    return [(MESHES[k % 5], MATERIALS[(k + k // 6) % 8], MAPS[k % 6]) for k in range(SCENES)]


def key_of(record: dict) -> Key:
    return record["mesh"], record["material"], record["map"], record["size"]


def read_records(path: Path) -> list[dict]:
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def append_record(path: Path, record: dict) -> None:
    """Whole or not at all: a run that is stopped leaves the old lines or the old ones and the new."""
    part = path.with_suffix(".part")
    part.write_text((path.read_text() if path.exists() else "") + json.dumps(record) + "\n")
    os.replace(part, path)


def measure_all(arguments: argparse.Namespace, wanted: list[Key], path: Path) -> None:
    """Measures the wanted scenes that have no line yet."""
    from matrix_scene import Scenery, measure_scene  # needs Mitsuba, which a report does not
    from scenes import machine

    done = {key_of(record) for record in read_records(path)}
    missing = [key for key in wanted if key not in done]
    seconds = sum(SECONDS_A_PIXEL * size**2 for *_, size in missing)
    print(f"{len(wanted) - len(missing)} of {len(wanted)} are done; about {seconds / 60:.0f} minutes for the others")
    scenery = Scenery(arguments.data, arguments.materials, arguments.cache, arguments.reference_samples)
    for key in tqdm(missing, desc="scenes"):
        fixed = scene_list().index(key[:3]) % arguments.fixed_every == 0 and key[3] == arguments.size
        record = {"machine": machine(scenery.stage.context), "peer": scenery.peer.description,
                  "date": str(datetime.date.today()), **measure_scene(scenery, *key, fixed)}
        append_record(path, record)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path)
    parser.add_argument("--materials", type=Path)
    parser.add_argument("--cache", type=Path, required=True, help="references and finished scenes; outside the repository")
    parser.add_argument("--out", type=Path, default=Path("docs/measurements"), help="trade.md is written beside this folder")
    parser.add_argument("--scenes", type=int, default=SCENES, help="the first N of the list")
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--large", type=int, default=12, help="the first N scenes are also measured at twice the size")
    parser.add_argument("--fixed-every", type=int, default=7, help="every Nth scene is also rendered with fixed settings; prime to 5, 8 and 6")
    parser.add_argument("--reference-samples", type=int, default=2048)
    parser.add_argument("--only-report", action="store_true")
    arguments = parser.parse_args()
    arguments.cache.mkdir(parents=True, exist_ok=True)
    arguments.out.mkdir(parents=True, exist_ok=True)
    scenes = scene_list()[:arguments.scenes]
    wanted = [(*scene, arguments.size) for scene in scenes] + [(*scene, 2 * arguments.size) for scene in scenes[:arguments.large]]
    path = arguments.cache / "results.jsonl"
    if not arguments.only_report:
        if arguments.data is None or arguments.materials is None:
            parser.error("measuring needs --data and --materials")
        measure_all(arguments, wanted, path)
    records = {key_of(record): record for record in read_records(path)}
    if not records:
        parser.error(f"{path} holds no finished scene")
    write_report([records[key] for key in wanted if key in records], arguments.out)


if __name__ == "__main__":
    main()
