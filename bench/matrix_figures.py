"""Figures of the matrix: what every rival would take for our errors, as rows of tables.

Three ways to a rival's time at our error, each in the rival's favour where it has to guess:
- random samples, the papers': E^2 ~ 1/N from one measured N; only shading takes longer, never what surrounds it. The papers'
  adaptive frames are extrapolated likewise, as if their interpolation had no error of its own;
- Mitsuba: log-log between its measured points, and beyond them along the last two, where time grows as E^-1 to E^-2;
- fixed settings: log-log along the best of all those measured (no other is both faster and nearer), beyond them E^2 ~ 1/time.
"""
from __future__ import annotations

from collections.abc import Iterable

import numpy as np

RANDOM = -2.0  # d log time / d log error of independent samples
STRATIFIED = -1.0  # and of the best stratified ones
ASKED = ("mesh", "material", "map", "size", "seed", "target", "got", "estimated", "noise", "interpolation", "bias", "ms", "prediction ms",
         "samples", "shaded", "capped", "rounds", "bytes")
RUNS = ("first ms", "second ms", "third ms")
BUDGET = ("mesh", "material", "map", "size", "budget ms", *RUNS, "got", "estimated")
RIVALS = ("mesh", "material", "map", "size", "seed", "target", "got", "ms", "shaded", "oracle shaded", "reference", "fewer pixels",
          "better samples", "papers adaptive", "Mitsuba", "best fixed")
FIXED = ("mesh", "material", "map", "size", "method", "samples", "bandwidth scale", "error", "ms")

Points = list[tuple[float, float]]  # (error, milliseconds)


def time_of_random(point: dict, error: float) -> float:
    """Milliseconds of random sampling at another error than the measured one."""
    return point["ms"] + ((point["got"] / error) ** 2 - 1) * point["shading_ms"]


def frontier(points: Iterable[tuple[float, float]]) -> Points:
    """Those that no other beats in both error and time; errors fall, times rise."""
    kept: Points = []
    for error, milliseconds in sorted((p for p in points if np.isfinite(p[0])), key=lambda p: (p[1], p[0])):
        if not kept or error < kept[-1][0]:
            kept.append((error, milliseconds))
    return kept


def time_on_frontier(points: Points, error: float) -> float:
    """Milliseconds at an error: log-log between points; below their least error E^2 ~ 1/time, above the largest the fastest."""
    errors, times = np.log(np.array(frontier(points))).T
    wanted = np.log(error)
    if wanted < errors[-1]:
        return float(np.exp(times[-1] + RANDOM * (wanted - errors[-1])))
    return float(np.exp(np.interp(-wanted, -errors, times)))


def time_of_peer(points: Points, error: float) -> float:
    """Milliseconds at an error, along the points' order: log-log between them and beyond either end."""
    errors, times = np.log(np.array(frontier(points))).T
    wanted = np.log(error)
    if len(errors) == 1 or errors[-1] <= wanted <= errors[0]:
        return float(np.exp(np.interp(-wanted, -errors, times)))
    pair, end, least, most = ((0, 1), 0, RANDOM, 0.0) if wanted > errors[0] else ((-2, -1), -1, RANDOM, STRATIFIED)
    slope = np.clip((times[pair[1]] - times[pair[0]]) / (errors[pair[1]] - errors[pair[0]]), least, most)
    return float(np.exp(times[end] + slope * (wanted - errors[end])))


def peer_curve(record: dict) -> Points:
    return [(point["got"], point["ms"]) for point in record["peer_points"]]


def fixed_curve(record: dict) -> Points:
    return [(point["got"], point["ms"]) for point in record["fixed"] + record["full"]]


def names(record: dict) -> dict:
    return {column: record[column] for column in ("mesh", "material", "map", "size")}


def asked_rows(records: list[dict]) -> list[dict]:
    rows = []
    for record in records:
        for asked in record["asked"]:
            rows.append({**names(record), **{column: asked[column.replace(" ", "_")] for column in ASKED[4:]},
                         "shaded": asked["shaded"] / record["covered"]})
    return rows


def budget_rows(records: list[dict]) -> list[dict]:
    return [{**names(record), **dict(zip(BUDGET[4:], (row["budget"], *row["ms"], row["got"], row["estimated"])))}
            for record in records for row in record["budgets"]]


def rival_rows(records: list[dict]) -> list[dict]:
    """Rivals' times at our error over ours; rows whose error the references cannot tell from 0 are left out."""
    rows = []
    for record in records:
        for asked, oracle in zip(record["asked"], record["oracle"]):
            got, ours = asked["got"], asked["ms"]
            if not np.isfinite(got):
                continue
            reference, shaded = time_of_random(record["reference"], got) / ours, asked["shaded"] / record["covered"]
            rows.append({**names(record), **dict(zip(RIVALS[4:], (
                asked["seed"], asked["target"], got, ours, shaded, oracle, reference, 1 / shaded, reference * shaded,
                time_of_random(record["papers"], got) / ours, time_of_peer(peer_curve(record), got) / ours,
                time_on_frontier(fixed_curve(record), got) / ours if record["fixed"] else "")))})
    return rows


def fixed_rows(records: list[dict]) -> list[dict]:
    rows = []
    for record in records:
        points = [("every pixel, " + point["sampler"], point) for point in record["full"]]
        points += [("adaptive", point) for point in record["fixed"]]
        points += [("papers' reference", record["reference"]), ("papers' adaptive", record["papers"])]
        points += [("Mitsuba", {"samples": point["spp"], **point}) for point in record["peer_points"]]
        rows += [{**names(record), **dict(zip(FIXED[4:], (method, point["samples"], point.get("bandwidth_scale", ""),
                                                          point["got"], point["ms"])))} for method, point in points]
    return rows


def column(rows: list[dict], name: str, **where: float | str) -> np.ndarray:
    """One column's numbers, of the rows that hold what is asked; empty cells are left out."""
    chosen = (row[name] for row in rows if all(row[key] == value for key, value in where.items()))
    return np.array([value for value in chosen if value != ""], dtype=float)


def geometric_mean(values: np.ndarray | list[float]) -> float:
    return float(np.exp(np.mean(np.log(values))))
