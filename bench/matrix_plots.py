"""Pictures of the matrix, in the manner of lightband.pictures: small type, thin lines, white ground."""
from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullLocator

from lightband.pictures import DOTS_PER_INCH, STYLE
from matrix_figures import RUNS, column, frontier, geometric_mean, peer_curve, time_of_random

INK, GUIDE, OURS = "0.15", "0.6", "#c23b22"
RIVAL_COLOURS = {"papers' reference": "#4d4d4d", "papers' adaptive": "#9a9a9a", "every pixel, BRDF samples": "#8c6bb1",
                 "every pixel, combined samples": "#2b7bba", "every pixel, filtered samples": "#d0729d",
                 "every pixel, cut": "#c99700", "best fixed setting": "#e6a000", "Mitsuba": "#2a9d5c"}
MATERIAL_COLOURS = ("#c99700", "#8c6bb1", "#c23b22", "#2a9d5c", "#2b7bba", "#4d4d4d", "#d0729d", "#8a5a2b")
RIVALS = {"reference": "papers' reference", "Mitsuba": "Mitsuba"}
AIMS = {("reference", 0.05): 100, ("reference", 0.02): 60, ("Mitsuba", 0.05): 10, ("Mitsuba", 0.02): 6}  # of the means
KEPT = 0.2  # relative: how far from a time budget counts as kept
SPREAD = 0.2  # logarithm: half the width over which points of one target lie side by side
TOLERANCE = 1.5  # of a target error: the second guide
CURVE_SCENES = 4


def percent(value: float, _: object = None) -> str:
    return f"{100 * value:.3g} %"


def plain(value: float, _: object = None) -> str:
    return f"{value:,.6g}"


def log_axis(axes: Axes, which: str, ticks: list[float], text=plain) -> None:
    """A logarithmic axis with numbers at the ticks and nothing between them."""
    axis = axes.xaxis if which == "x" else axes.yaxis
    (axes.set_xscale if which == "x" else axes.set_yscale)("log")
    axis.set_ticks(ticks)
    axis.set_major_formatter(FuncFormatter(text))
    axis.set_minor_locator(NullLocator())


def clean(axes: Axes) -> None:
    axes.grid(True, which="major", color="0.92", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(length=2.5, width=0.6)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def jitter(count: int, width: float) -> np.ndarray:
    """Factors about 1, evenly spread and the same in every run."""
    golden = (np.arange(count) * 0.6180339887) % 1
    return np.exp((2 * golden - 1) * width)


def steps(values: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """A level line at every value, as wide as its points are spread, as x and y of one broken line."""
    x = [[value * np.exp(-1.3 * SPREAD), value * np.exp(1.3 * SPREAD), np.nan] for value in values]
    return np.ravel(x), np.repeat(values, 3).astype(float)


def save(figure: Figure, path: Path) -> None:
    figure.savefig(path, dpi=DOTS_PER_INCH, facecolor="white")


def draw_asked(rows: list[dict], path: Path) -> None:
    """Error asked against got, and the frames' own estimates against got; a point is a scene at a target, under one seed."""
    rows = [{**row, "spread": spread} for row, spread in zip(rows, jitter(len(rows), SPREAD)) if np.isfinite(row["got"])]
    materials = sorted({row["material"] for row in rows})
    every = np.concatenate([column(rows, name) for name in ("target", "estimated", "got")])
    low, high = every[every > 0].min() / 1.3, max(every.max(), TOLERANCE * column(rows, "target").max()) * 1.3
    ends = np.array([low, high])
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(10.4, 4.2), layout="constrained")
        for axes, name, label in zip(figure.subplots(1, 2, sharey=True), ("target", "estimated"),
                                     ("error asked", "error that the frame estimates")):
            x = steps(sorted({row["target"] for row in rows})) if name == "target" else (ends, ends)
            axes.plot(*x, color=INK, linewidth=0.8, label="equal")
            axes.plot(x[0], TOLERANCE * x[1], color=GUIDE, linewidth=0.8, linestyle=(0, (4, 3)), label=f"{TOLERANCE} times")
            for material, colour in zip(materials, MATERIAL_COLOURS):
                x, got, spread = (column(rows, key, material=material) for key in (name, "got", "spread"))
                axes.scatter(x * spread if name == "target" else x, got, s=14, color=colour, alpha=0.8, linewidths=0,
                             label=material)
            for which in "xy":
                log_axis(axes, which, [0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0], percent)
            axes.set(xlim=ends, ylim=ends, xlabel=label, aspect="equal")
            clean(axes)
        figure.axes[0].set_ylabel("error got")
        handles, labels = figure.axes[0].get_legend_handles_labels()
        figure.legend(handles[2:] + handles[:2], labels[2:] + labels[:2], loc="outside right center", frameon=False)
        save(figure, path)


def draw_budget(rows: list[dict], path: Path) -> None:
    """Time asked against time taken, three frames a scene and budget, and the error that the time bought."""
    budgets = sorted({row["budget ms"] for row in rows})
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(9, 4), layout="constrained")
        times, errors = figure.subplots(1, 2)
        ends = np.array([budgets[0] / 2, budgets[-1] * 2])
        across, asked = steps(budgets)
        times.fill_between(across, asked * (1 - KEPT), asked * (1 + KEPT), color="0.9", linewidth=0, label="within 20 %")
        times.plot(across, asked, color=INK, linewidth=0.8, label="equal")
        for budget in budgets:
            taken = np.concatenate([column(rows, name, **{"budget ms": budget}) for name in RUNS])
            times.scatter(budget * jitter(len(taken), SPREAD), taken, s=8, color=OURS, alpha=0.5, linewidths=0)
            got = column(rows, "got", **{"budget ms": budget})
            got = got[np.isfinite(got)]
            errors.scatter(budget * jitter(len(got), SPREAD), got, s=12, color=OURS, alpha=0.6, linewidths=0)
            errors.plot(budget * np.array([0.75, 1.33]), [np.median(got)] * 2, color=INK, linewidth=1.5)
        for axes in (times, errors):
            log_axis(axes, "x", budgets)
            axes.set(xlim=ends, xlabel="time asked, ms")
            clean(axes)
        log_axis(times, "y", [20, 50, 100, 200, 300, 500, 1000, 2000, 5000])
        taken = np.concatenate([column(rows, name) for name in RUNS])
        times.set(ylabel="time taken, ms", ylim=(min(ends[0], taken.min() / 1.1), max(ends[1], taken.max() * 1.1)))
        log_axis(errors, "y", [0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2], percent)
        got = column(rows, "got")
        errors.set(ylabel="error got (bar: median)", ylim=(np.nanmin(got) / 1.3, np.nanmax(got) * 1.3))
        times.legend(loc="upper left", frameon=False)
        save(figure, path)


def curves_of(record: dict) -> dict[str, list[tuple[float, float]]]:
    """(error, milliseconds) of every method; extrapolated random samples at fewer and more than were measured."""
    curves = {}
    for name, point in (("papers' reference", record["reference"]), ("papers' adaptive", record["papers"])):
        curves[name] = [(error, time_of_random(point, error)) for error in point["got"] * np.array([2, 1, 0.5, 0.25])]
    for name, sampler in (("every pixel, BRDF samples", "brdf"), ("every pixel, filtered samples", "filtered"),
                          ("every pixel, combined samples", "combined"), ("every pixel, cut", "cut")):
        curves[name] = [(point["got"], point["ms"]) for point in record["full"] if point["sampler"] == sampler]
    if record["fixed"]:
        curves["best fixed setting"] = frontier((point["got"], point["ms"]) for point in record["fixed"])
    curves["Mitsuba"] = peer_curve(record)
    return curves


def curve_scenes(records: list[dict]) -> list[dict]:
    """The first of every mesh among those that were also rendered with fixed settings, as many as are drawn."""
    chosen = [record for record in records if record["fixed"]] or records
    first = {record["mesh"]: record for record in reversed(chosen)}
    return [record for record in chosen if first[record["mesh"]] is record][:CURVE_SCENES]


def draw_curves(records: list[dict], path: Path) -> None:
    """Error against time, every method, for scenes that were also rendered with fixed settings."""
    chosen = curve_scenes(records)
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(9.6, 6.6), layout="constrained")
        panels = figure.subplots(2, 2, sharey=True, sharex=True)
        for axes, record in zip(panels.flat, chosen):
            for name, points in curves_of(record).items():
                error, milliseconds = np.array(points).T
                extrapolated = name.startswith("papers")
                axes.plot(milliseconds, error, color=RIVAL_COLOURS[name], linewidth=1.1, label=name, zorder=2,
                          linestyle=(0, (2, 1.5)) if extrapolated else "-", marker=None if extrapolated else "o", markersize=3)
            ours = [(row["ms"], row["got"]) for row in record["asked"] if row["seed"] == record["asked"][0]["seed"]]
            axes.plot(*np.array(ours).T, color=OURS, linewidth=2, marker="o", markersize=4.5, label="ours, error asked", zorder=3)
            axes.set_title(f"{record['mesh']}, {record['material']}, {record['map']}, {record['size']} x {record['size']}")
            log_axis(axes, "x", [3, 10, 30, 100, 300, 1000, 3000, 10000, 30000])
            log_axis(axes, "y", [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5], percent)
            clean(axes)
        every = np.array([point for record in chosen for points in curves_of(record).values() for point in points]
                         + [(row["got"], row["ms"]) for record in chosen for row in record["asked"]])
        (low, fast), (high, slow) = np.nanmin(every, axis=0), np.nanmax(every, axis=0)
        panels[0, 0].set(xlim=(fast / 1.3, slow * 1.3), ylim=(low / 1.3, high * 1.3))
        for axes in panels.flat[len(chosen):]:
            axes.set_axis_off()
        for axes in panels[1]:
            axes.set_xlabel("time, ms")
        for axes in panels[:, 0]:
            axes.set_ylabel("error")
        handles, labels = panels[0, 0].get_legend_handles_labels()
        figure.legend(handles[::-1], labels[::-1], loc="outside right center", frameon=False)
        save(figure, path)


def draw_speedups(rows: list[dict], path: Path) -> None:
    """A point is a scene: the rival's time at our error, over ours; a row for each target."""
    targets = sorted({row["target"] for row in rows}, reverse=True)
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(9.6, 3.4), layout="constrained")
        for axes, (name, title) in zip(figure.subplots(1, 2, sharey=True), RIVALS.items()):
            for y, target in enumerate(targets):
                ratios = column(rows, name, target=target)
                axes.scatter(ratios, y + 0.22 * np.log(jitter(len(ratios), 1.0)), s=12, color=RIVAL_COLOURS[title], alpha=0.65,
                             linewidths=0)
                if (name, target) in AIMS:
                    axes.plot([AIMS[name, target]] * 2, [y - 0.34, y + 0.34], color=OURS, linewidth=0.9, linestyle=(0, (4, 3)))
                mean = geometric_mean(ratios)
                axes.plot([mean, mean], [y - 0.34, y + 0.34], color=INK, linewidth=1.8, solid_capstyle="butt")
                axes.annotate(f"{mean:.3g}" if mean < 1000 else f"{mean:,.0f}", (mean, y + 0.36), ha="center", va="bottom")
            axes.axvline(1, color=INK, linewidth=0.8)
            every = column(rows, name)
            wide = every.max() / every.min() > 1000
            log_axis(axes, "x", [0.01, 0.1, 1, 10, 100, 1e3, 1e4, 1e5] if wide else [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100])
            axes.set(xlim=(min(0.7, every.min() / 1.4), every.max() * 1.4), ylim=(-0.55, len(targets) - 0.25),
                     xlabel=f"time of {title} at our error, over ours", yticks=range(len(targets)),
                     yticklabels=[percent(target) for target in targets])
            clean(axes)
        figure.axes[0].set_ylabel("error asked")
        key = [Line2D([], [], color=INK, linewidth=1.8, label="geometric mean"),
               Line2D([], [], color=INK, linewidth=0.8, label="equal time")]
        key += [Line2D([], [], color=OURS, linewidth=0.9, linestyle=(0, (4, 3)), label="aim of the mean")]
        figure.legend(handles=key, loc="outside upper right", ncols=3, frameon=False)
        save(figure, path)
