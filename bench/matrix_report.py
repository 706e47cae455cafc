"""The matrix as tables, pictures and a page: asked.csv, budget.csv, rivals.csv, fixed.csv, their plots, and trade.md."""
from __future__ import annotations

import os
import textwrap
from pathlib import Path

import numpy as np

import matrix_figures as figures
from matrix_figures import column, geometric_mean
from tables import write_table

BUDGET_TOLERANCE = 0.2  # relative: a kept time budget
SAMPLERS_COMPARED = ("combined", "cut")
TWO_FIFTHS = 0.4  # of a peer's sample: what one should cost at most
LEAST_SAMPLES = 64  # from which on a sample's cost is told apart from a pixel's
WIDTH = 130  # characters of a line of prose
LEAST_RATIO = {"reference": 10, "papers adaptive": 10, "Mitsuba": 2}  # that every frame should have
LOSS = 1 / 1.2  # best fixed setting's time over ours under which a scene counts as lost: more than 20 % slower


def several(values: list[str]) -> str:
    """What rows agree on, or all that they say."""
    return " / ".join(dict.fromkeys(values))


def head_line(records: list[dict]) -> str:
    dates = sorted({record["date"] for record in records})
    return "; ".join((several([record["machine"] for record in records]), several([record["peer"] for record in records]),
                      " to ".join(dict.fromkeys((dates[0], dates[-1])))))


def table(columns: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def prose(text: str) -> str:
    return textwrap.fill(text, WIDTH, break_long_words=False, break_on_hyphens=False)


def digits(value: float) -> str:
    """Three digits, never an exponent."""
    return f"{value:.3g}" if value < 1000 else f"{value:,.0f}"


def percent(value: float) -> str:
    return f"{100 * value:.3g} %"


def error_section(asked: list[dict]) -> str:
    known = [row for row in asked if np.isfinite(row["got"])]
    rows = []
    for target in sorted({row["target"] for row in known}, reverse=True):
        got, estimated, times = (column(known, name, target=target) for name in ("got", "estimated", "ms"))
        over, trust = got / target, estimated / got
        rows.append((percent(target), f"{np.mean(over <= 1):.0%}", f"{np.median(over):.2f}", f"{over.max():.2f}",
                     f"{np.mean(over <= 1.5):.0%}", f"{np.median(trust):.2f}", f"{trust.min():.2f} to {trust.max():.2f}",
                     f"{np.median(times):.0f}"))
    ratios = np.array([row["got"] / row["target"] for row in known])
    worst = known[int(np.argmax(ratios))]
    text = (f"Of {len(ratios)} frames, {np.mean(ratios <= 1):.0%} got no more error than was asked for; the median of got over "
            f"asked is {np.median(ratios):.2f}, the most {ratios.max():.2f} "
            f"({frame_name(worst)}).")
    if len(known) < len(asked):
        text += f" Of {len(asked) - len(known)} more the references cannot tell the error from 0."
    return prose(text) + "\n\n" + table(("asked", "got <= asked", "median got/asked", "most", "got <= 1.5 asked",
                                         "median estimated/got", "range", "median ms"), rows)


def taken_over_asked(budgets: list[dict], budget: float) -> np.ndarray:
    return np.concatenate([column(budgets, name, **{"budget ms": budget}) for name in figures.RUNS]) / budget


def in_time(budgets: list[dict], budget: float) -> np.ndarray:
    return abs(taken_over_asked(budgets, budget) - 1) <= BUDGET_TOLERANCE


def budget_section(budgets: list[dict]) -> str:
    rows, every = [], []
    for budget in sorted({row["budget ms"] for row in budgets}):
        taken = taken_over_asked(budgets, budget)
        every.append(taken)
        rows.append((f"{budget}", f"{np.mean(in_time(budgets, budget)):.0%}", f"{np.mean(taken <= 1):.0%}",
                     f"{np.mean(taken <= 1 + BUDGET_TOLERANCE):.0%}", f"{np.median(taken):.2f}", f"{taken.max():.2f}",
                     percent(np.nanmedian(column(budgets, "got", **{"budget ms": budget})))))
    ratios = np.concatenate(every)
    return (f"{np.mean(abs(ratios - 1) <= BUDGET_TOLERANCE):.0%} of {len(ratios)} frames took within 20 % of the time asked; "
            f"{np.mean(ratios > 1 + BUDGET_TOLERANCE):.0%} took more, {np.mean(ratios < 1 - BUDGET_TOLERANCE):.0%} less.\n\n"
            + table(("asked, ms", "within 20 %", "not over", "not over by 20 %", "median taken/asked", "most",
                     "median error got"), rows))


def scene_name(row: dict) -> str:
    return f"{row['mesh']}, {row['material']}, {row['map']}, {row['size']} x {row['size']}"


def frame_name(row: dict) -> str:
    return f"{scene_name(row)}, seed {row['seed']}, at {percent(row['target'])}"


def rival_section(rivals: list[dict]) -> str:
    """Ratios at equal error; their split; each rival's least with its scene."""
    rows = []
    for target in sorted({row["target"] for row in rivals}, reverse=True):
        cells = [percent(target)]
        for name in LEAST_RATIO:
            ratios = column(rivals, name, target=target)
            cells += [digits(geometric_mean(ratios)), digits(ratios.min()), f"{np.mean(ratios < LEAST_RATIO[name]):.0%}"]
        cells += [digits(geometric_mean(column(rivals, name, target=target))) for name in ("fewer pixels", "better samples")]
        rows.append(tuple(cells))
    text = []
    for name, rival in (("reference", "the papers' reference"), ("Mitsuba", "Mitsuba")):
        ratios = column(rivals, name)
        least = min(rivals, key=lambda row: row[name])
        text.append(f"Against {rival}: geometric mean {digits(geometric_mean(ratios))}, least {digits(ratios.min())} "
                    f"({frame_name(least)}). Slower than it: {np.sum(ratios < 1)} of "
                    f"{len(ratios)} frames.")
    return "\n\n".join(map(prose, text)) + "\n\n" + table(
        ("asked", *(heading for name, least in LEAST_RATIO.items() for heading in (f"{name}: mean", "least", f"below {least}")),
         "reference by fewer pixels", "by better samples"), rows)


def pixel_section(rivals: list[dict]) -> str:
    rows = []
    for target in sorted({row["target"] for row in rivals}, reverse=True):
        ours, oracle = (column(rivals, name, target=target) for name in ("shaded", "oracle shaded"))
        ratio = ours / oracle
        rows.append((percent(target), percent(np.median(ours)), percent(np.median(oracle)), f"{np.median(ratio):.2f}",
                     f"{ratio.max():.2f}"))
    return table(("asked", "shaded, median", "oracle, median", "ours/oracle, median", "most"), rows)


def fixed_section(rivals: list[dict]) -> str:
    compared = [row for row in rivals if row["best fixed"] != ""]
    if not compared:
        return "No scene was rendered with fixed settings."
    ratios = column(compared, "best fixed")
    lost = sorted((row for row in compared if row["best fixed"] < LOSS), key=lambda row: row["best fixed"])
    text = (f"{len({scene_name(row) for row in compared})} scenes were also rendered with fixed settings. At our error the best "
            f"one, which nobody knows beforehand, takes {geometric_mean(ratios):.2f} times our time (geometric mean). "
            f"Asking for an error lost by more than 20 % in {len(lost)} of {len(compared)} frames")
    if not lost:
        return prose(text + ".")
    return prose(text + ":") + "\n\n" + table(("scene", "seed", "asked", "got", "ms", "best fixed, ms"), [
        (scene_name(row), f"{row['seed']}", percent(row["target"]), percent(row["got"]), f"{row['ms']:.0f}",
         f"{row['ms'] * row['best fixed']:.0f}")
        for row in lost])


def sample_section(fixed: list[dict]) -> str:
    """What a further sample costs, every pixel shaded: the slope between few and many, over Mitsuba's."""
    def slopes(method: str) -> dict[tuple, float]:
        points: dict[tuple, list[tuple[int, float]]] = {}
        for row in fixed:
            if row["method"] == method and row["samples"] >= LEAST_SAMPLES:
                points.setdefault(row_key(row), []).append((row["samples"], row["ms"]))
        return {scene: (most[1] - least[1]) / (most[0] - least[0])
                for scene, pair in points.items() if len(pair) > 1 for least, most in [(min(pair), max(pair))]}

    peer = slopes("Mitsuba")
    rows = []
    for sampler in SAMPLERS_COMPARED:
        ours = slopes(f"every pixel, {sampler}")
        ratios = np.array([ours[scene] / peer[scene] for scene in sorted(ours.keys() & peer.keys())])
        rows.append((sampler, f"{len(ratios)}", f"{geometric_mean(ratios):.2f}", f"{ratios.min():.2f} to {ratios.max():.2f}",
                     f"{np.mean(ratios <= TWO_FIFTHS):.0%}"))
    return table(("sampler", "scenes", "of a sample of Mitsuba's", "range", "at most two fifths"), rows)


def size_section(asked: list[dict], budgets: list[dict], rivals: list[dict]) -> str:
    """The scenes that were measured at every size, size by size."""
    sizes = sorted({row["size"] for row in asked})
    shared = set.intersection(*({row_key(row) for row in asked if row["size"] == size} for size in sizes))
    rows = []
    for size in sizes:
        here, timed, ratios = ([row for row in table_rows if row["size"] == size and row_key(row) in shared]
                               for table_rows in (asked, budgets, rivals))
        got = np.array([row["got"] / row["target"] for row in here])
        means = (digits(geometric_mean(column(ratios, name))) for name in ("reference", "Mitsuba", "fewer pixels"))
        kept = (f"{np.mean(in_time(timed, budget)):.0%}" for budget in sorted({row["budget ms"] for row in timed}))
        rows.append((f"{size} x {size}", f"{len(shared)}", f"{np.mean(got[np.isfinite(got)] <= 1):.0%}",
                     f"{np.nanmax(got):.2f}", *means, " / ".join(kept)))
    return table(("size", "scenes", "got <= asked", "most got/asked", "reference", "Mitsuba", "fewer pixels", "in time"), rows)


def row_key(row: dict) -> tuple[str, str, str]:
    return row["mesh"], row["material"], row["map"]


PAGE = """# What asking for an error or a time gives, and costs

{origin}

## Error asked, error got
{errors}

![error asked and got]({folder}/asked.png)

Every frame: [asked.csv]({folder}/asked.csv).

## Time asked, time taken
{budgets}

![time asked and taken]({folder}/budget.png)

Three frames each, after one that is not counted: [budget.csv]({folder}/budget.csv).

## Rivals at equal error
Time that the rival takes to reach our error, over ours. *Reference*: the papers', every pixel, random samples of the BRDF,
measured at 256 samples; *papers' adaptive*: the operator, variance and allocation as printed, likewise; both extrapolated by
E^2 ~ 1/N. *Mitsuba*: its samples of map and reflectance combined, without shadows (`bench/peer.py`), measured at 16, 64 and 256
samples a pixel and extrapolated beyond along the last two. *Fewer pixels* is covered over shaded pixels; *better samples* is the
rest of the ratio against the reference.

{rivals}

![equal-error ratios]({folder}/rivals.png)

![error against time]({folder}/curves.png)

Dashed curves are extrapolated from one measurement. Every scene: [rivals.csv]({folder}/rivals.csv).

## Pixels shaded
The oracle knows the converged picture and leaves out as many pixels as bilinear interpolation allows at the error that we got, all
of which it spends on interpolation (`bench/matrix_oracle.py`): a bound, not a rival.

{pixels}

## Sizes
The scenes that were measured at every size; geometric means over all targets. *In time*: frames within 20 % of 50, 100, 300 and 1000 ms.

{sizes_table}

## The cost of a sample
What one more sample of each pixel costs, between {least_samples} samples and the most that were measured, every pixel shaded. A sample
of Mitsuba's is one of the map and one of the reflectance; one of *combined* is either, one of *cut* a sample of the lobe or a part of
the light.

{samples}

## Fixed settings
{fixed}

Every measured point of every method: [fixed.csv]({folder}/fixed.csv).
"""


def origin(records: list[dict], head: str) -> str:
    kinds = ", ".join(f"{len({record[kind] for record in records})} {name}"
                      for kind, name in (("mesh", "meshes"), ("material", "materials"), ("map", "maps")))
    size = records[0]["size"]
    return prose(f"Written by `bench/matrix.py` from the tables named below: {len(records)} scenes of {kinds}, {size} x {size} "
                 "unless said otherwise. Definitions: [conventions.md](conventions.md). Ratios are of times at equal error, "
                 f"measured in one run on one machine: {head}. Every error is asked for three times, under other seeds.")


def write_report(records: list[dict], out: Path) -> None:
    """Tables and pictures into out, the page beside it."""
    import matrix_plots as plots  # Matplotlib is slow to load

    head = head_line(records)
    asked, budgets, rivals = figures.asked_rows(records), figures.budget_rows(records), figures.rival_rows(records)
    fixed = figures.fixed_rows(records)
    for name, columns, rows in (("asked", figures.ASKED, asked), ("budget", figures.BUDGET, budgets),
                                ("rivals", figures.RIVALS, rivals), ("fixed", figures.FIXED, fixed)):
        write_table(out / f"{name}.csv", head, columns, rows)
    base = min(record["size"] for record in records)
    sizes = size_section(asked, budgets, rivals)
    asked, budgets, rivals, fixed = ([row for row in rows if row["size"] == base] for rows in (asked, budgets, rivals, fixed))
    plots.draw_asked(asked, out / "asked.png")
    plots.draw_budget(budgets, out / "budget.png")
    plots.draw_speedups(rivals, out / "rivals.png")
    plots.draw_curves([record for record in records if record["size"] == base], out / "curves.png")
    page = PAGE.format(origin=origin([record for record in records if record["size"] == base], head), folder=out.name,
                       sizes_table=sizes, errors=error_section(asked), budgets=budget_section(budgets),
                       rivals=rival_section(rivals), pixels=pixel_section(rivals), samples=sample_section(fixed),
                       least_samples=LEAST_SAMPLES, fixed=fixed_section(rivals))
    part = (out.parent / "trade.md").with_suffix(".part")
    part.write_text(page)
    os.replace(part, out.parent / "trade.md")
