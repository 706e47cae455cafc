"""Pictures of a frame's fields, and of pairs of maps that should agree.

Needs Matplotlib: ``pip install matplotlib``.

    from lightband import pictures

    pictures.draw_fields(frame, "fields.png")
    pictures.draw_pairs([pictures.Pair("Image bandwidth", predicted, measured, "cycles/pixel")], "bandwidth.png")
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from os import PathLike
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import Buffer, Frame, InvalidArgument, StateError, buffer_names

try:
    import matplotlib
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import BoundaryNorm, Colormap, FuncNorm, ListedColormap, LogNorm, Normalize
    from matplotlib.figure import Figure
except ImportError as _missing:
    raise ImportError("lightband.pictures needs Matplotlib: pip install matplotlib") from _missing

__all__ = ["Pair", "draw_fields", "draw_pairs", "rank_correlation"]

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

FONT_SIZE = 9  # points, for all text
STYLE: dict[Any, Any] = {
    "font.size": FONT_SIZE,
    "axes.titlesize": FONT_SIZE,
    "axes.labelsize": FONT_SIZE,
    "axes.linewidth": 0.6,
}
DOTS_PER_INCH = 150
UNSEEN = (0.88, 0.88, 0.88, 1.0)  # pixels that see no mesh
ZERO = (1.0, 1.0, 1.0, 1.0)  # zero on a logarithmic scale

# The sheet, in inches: a panel is a title, an image within a square box, and a colour bar with its numbers.
COLUMNS = 5
BOX = 2.7
TITLE = 0.3
BAR_GAP = 0.08
BAR_WIDTH = 0.11
NUMBERS = 0.66
ROW_GAP = 0.14
MARGIN = 0.15
HEADING = 0.32
LEVEL_GAP = 0.1
SLIVER = 0.3  # least side of an image
LINE = 0.19  # from one line of text to the next
WIDEST_NUMBER = 0.55
WIDEST_TITLE = 0.95  # of a level of a pyramid, or of one map of a pair
AXIS = 0.6  # numbers and label along an axis
LEAST_SCATTER = 1.8
PANEL = BOX + BAR_GAP + BAR_WIDTH + NUMBERS
MOST_LEVELS = 10  # of a pyramid; those beyond hold few pixels
LEAST_LEVELS = 6  # that a row has room for, so that few levels do not become large


class FieldStyle(NamedTuple):
    """How a field is shown."""

    title: str
    scale: Literal["radiance", "linear", "log", "category", "yes or no", "instance", "direction", "position"]
    colours: str = ""
    """Name of a colour map of Matplotlib."""


STYLES = {
    "color": FieldStyle("Colour", "radiance"),
    "depth": FieldStyle("Depth", "linear", "cividis_r"),
    "position": FieldStyle("Position", "position"),
    "normal": FieldStyle("Normal", "direction"),
    "curvature": FieldStyle("Curvature", "log", "cividis"),
    "material": FieldStyle("Material", "instance"),
    "bandwidth_spatial": FieldStyle("Spatial bandwidth", "log", "inferno"),
    "bandwidth_angular": FieldStyle("Angular bandwidth", "log", "inferno"),
    "bandwidth_image": FieldStyle("Image bandwidth", "log", "inferno"),
    "level": FieldStyle("Level", "category", "viridis_r"),
    "shaded": FieldStyle("Shaded", "yes or no"),
    "sample_count": FieldStyle("Samples", "log", "viridis"),
    "error": FieldStyle("Relative error, estimated", "log", "magma"),
    "variance_predicted": FieldStyle("Predicted variance", "log", "magma"),
    "variance_measured": FieldStyle("Measured variance", "log", "magma"),
    "level_pyramid": FieldStyle("Pyramid of least levels", "category", "viridis_r"),
    "variance_pyramid": FieldStyle("Pyramid of greatest relative variances", "log", "magma"),
}


class Picture(NamedTuple):
    """Pixels ready to be shown, and what explains their colours."""

    rgba: Floats
    key: ScalarMappable | None
    """None: three ramps, one for each axis."""
    ticks: Sequence[float]
    labels: Sequence[str]


# ---- From values to colours -------------------------------------------------------------------------------------


def srgb_encode(linear: Any) -> Floats:
    """The transfer curve of sRGB (IEC 61966-2-1)."""
    linear = np.clip(np.asarray(linear, np.float64), 0, 1)
    encoded: Floats = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return encoded


def srgb_decode(encoded: Any) -> Floats:
    """The inverse of srgb_encode."""
    encoded = np.clip(np.asarray(encoded, np.float64), 0, 1)
    linear: Floats = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    return linear


def number_label(value: float) -> str:
    """Three digits at most, and as short as they go: 0.25, 20000, 1e8."""
    if value != 0 and not 1e-3 <= abs(value) < 1e5:
        mantissa, exponent = f"{value:.2e}".split("e")
        return f"{float(mantissa):g}e{int(exponent)}"
    return f"{float(f'{value:.3g}'):g}"


def linear_ticks(low: float, high: float) -> list[float]:
    """About five round numbers in [low, high]."""
    raw = (high - low) / 4
    decade = 10.0 ** math.floor(math.log10(raw))
    step = next(factor * decade for factor in (1, 2, 5, 10) if factor * decade >= raw)
    first, last = math.ceil(low / step), math.floor(high / step)
    return [k * step for k in range(first, last + 1)]


def log_ticks(low: float, high: float) -> list[float]:
    """Round numbers in [low, high]: powers of ten, and 2 and 5 times them where there are few."""
    exponents = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    for factors in ((1,), (1, 3), (1, 2, 5), (1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9)):
        ticks = [f * 10.0**e for e in exponents for f in factors if low <= f * 10.0**e <= high]
        if len(ticks) >= 3:
            return ticks[:: math.ceil(len(ticks) / 8)]
    return [low, high]


def widened(low: float, high: float) -> tuple[float, float]:
    """A range of more than nothing, for fields that hold one value."""
    if high - low > 1e-6 * max(abs(low), abs(high)):
        return low, high
    spread = abs(low) / 2 or 0.5
    return low - spread, high + spread


def linear_scale(values: Floats) -> tuple[Normalize, list[float]]:
    low, high = widened(float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
    return Normalize(low, high), linear_ticks(low, high)


def log_scale(values: Floats) -> tuple[Normalize, list[float]]:
    """A scale over all but the least 0.5 % of the positive values, which have no end on paper."""
    positive = values[values > 0]
    low, high = (float(np.quantile(positive, 0.005)), float(positive.max())) if positive.size else (0.1, 1.0)
    if high < 1.05 * low:
        low, high = low / 2, high * 2
    return LogNorm(low, high, clip=True), log_ticks(low, high)


def show_scalar(values: Floats, seen: Mask, scale: tuple[Normalize, list[float]], colours: str) -> Picture:
    norm, ticks = scale
    key = ScalarMappable(norm, matplotlib.colormaps[colours])
    shown = seen & np.isfinite(values)
    if isinstance(norm, LogNorm):
        shown &= values > 0
    rgba = np.empty((*values.shape, 4))
    rgba[...] = np.where(seen[..., None], ZERO, UNSEEN)
    rgba[shown] = key.to_rgba(values[shown])
    return Picture(rgba, key, ticks, [number_label(tick) for tick in ticks])


def show_categories(values: Floats, seen: Mask, colours: Colormap, labels: Sequence[str]) -> Picture:
    """Values 0, 1, ... with one colour each."""
    count = len(labels)
    key = ScalarMappable(BoundaryNorm(np.arange(count + 1) - 0.5, count), colours)
    rgba = np.empty((*values.shape, 4))
    rgba[...] = UNSEEN
    rgba[seen] = key.to_rgba(values[seen])
    step = math.ceil(count / 12)
    return Picture(rgba, key, range(0, count, step), labels[::step])


def show_levels(values: Floats, seen: Mask, coarsest: int, colours: str) -> Picture:
    labels = [str(level) for level in range(coarsest + 1)]
    return show_categories(values, seen, matplotlib.colormaps[colours].resampled(coarsest + 1), labels)


def show_vectors(values: Floats, seen: Mask, low: float, high: float) -> Picture:
    """Three components as red, green and blue, all on one scale."""
    low, high = widened(low, high)
    rgba = np.empty((*seen.shape, 4))
    rgba[...] = UNSEEN
    rgba[seen, :3] = np.clip((values[seen] - low) / (high - low), 0, 1)
    rgba[seen, 3] = 1
    return Picture(rgba, None, [0, 1], [number_label(low), number_label(high)])


def show_radiance(values: Floats, seen: Mask) -> Picture:
    """White is the 95th percentile of the largest component where a mesh is seen (everywhere, where none is)."""
    largest = values[..., :3].max(axis=-1)
    white = float(np.quantile(largest[seen] if seen.any() else largest, 0.95)) or 1.0
    key = ScalarMappable(
        FuncNorm((srgb_encode_to(white), srgb_decode_to(white)), 0, white), matplotlib.colormaps["gray"]
    )
    rgba = np.ones((*seen.shape, 4))
    rgba[..., :3] = srgb_encode(values[..., :3] / white)
    ticks = linear_ticks(0, white)
    return Picture(rgba, key, ticks, [number_label(tick) for tick in ticks])


def srgb_encode_to(white: float) -> Callable[[Any], Floats]:
    return lambda radiance: srgb_encode(np.asarray(radiance) / white)


def srgb_decode_to(white: float) -> Callable[[Any], Floats]:
    return lambda encoded: srgb_decode(encoded) * white


def show_field(name: str, array: NDArray[Any], seen: Mask) -> Picture:
    """A field other than a pyramid."""
    style = STYLES.get(name, FieldStyle(name, "linear", "viridis"))
    values = array.astype(np.float64)
    match style.scale:
        case "radiance":
            return show_radiance(values, seen)
        case "direction":
            return show_vectors(values, seen, -1, 1)
        case "position":
            among = values[seen] if seen.any() else np.zeros(1)
            return show_vectors(values, seen, float(among.min()), float(among.max()))
        case "yes or no":
            return show_categories(values, seen, ListedColormap(["#c9d7e8", "#1f4e86"]), ["no", "yes"])
        case "instance":
            count = max(int(values.max()), 1)
            cycle = [matplotlib.colormaps["tab10"](i % 10) for i in range(count)]
            return show_categories(values - 1, seen, ListedColormap(cycle), [str(i + 1) for i in range(count)])
        case "category":
            return show_levels(values, seen, int(values[seen].max()) if seen.any() else 0, style.colours)
        case "log":
            return show_scalar(values, seen, log_scale(values[seen]), style.colours)
        case _:
            return show_scalar(values, seen, linear_scale(values[seen & np.isfinite(values)]), style.colours)


# ---- From colours to paper --------------------------------------------------------------------------------------


class Size(NamedTuple):
    """Inches."""

    width: float
    height: float


def fitted(columns: int, rows: int, box: float) -> Size:
    """The size of an image of so many pixels that fills a square box; a sliver is widened until it can be seen."""
    longest = max(columns, rows)
    return Size(max(box * columns / longest, SLIVER), max(box * rows / longest, SLIVER))


class Sheet:
    """A figure on which things are placed by inches from the top left corner."""

    def __init__(self, width: float, height: float) -> None:
        self.width, self.height = width, height
        self.figure = Figure(figsize=(width, height), dpi=DOTS_PER_INCH, facecolor="white")

    def axes(self, left: float, top: float, width: float, height: float) -> Axes:
        bottom = self.height - top - height
        return self.figure.add_axes((left / self.width, bottom / self.height, width / self.width, height / self.height))

    def text(self, left: float, top: float, text: str, **style: Any) -> None:
        self.figure.text(left / self.width, 1 - top / self.height, text, va="top", fontsize=FONT_SIZE, **style)

    def image(self, left: float, top: float, size: Size, rgba: Floats, title: str) -> None:
        axes = self.axes(left, top + TITLE, size.width, size.height)
        axes.imshow(rgba, interpolation="antialiased", aspect="auto")
        axes.set_xticks([])
        axes.set_yticks([])
        self.text(left, top + 0.1, title)

    def key(self, left: float, top: float, height: float, picture: Picture) -> None:
        """The colour bar of a picture."""
        axes = self.axes(left, top + TITLE, BAR_WIDTH, height)
        if picture.key is None:
            ramp = np.linspace(1, 0, 256)[:, None, None] * np.eye(3)
            axes.imshow(ramp, aspect="auto", extent=(0, 3, 0, 1))
            axes.set_xticks([])
            axes.yaxis.tick_right()
        else:
            self.figure.colorbar(picture.key, cax=axes).minorticks_off()
        places = axes.transData.transform([(0, tick) for tick in picture.ticks])[:, 1]
        shown = spaced(places - places[0], LINE)
        axes.set_yticks([picture.ticks[i] for i in shown], [picture.labels[i] for i in shown])
        axes.tick_params(length=2, width=0.6, pad=2, labelsize=FONT_SIZE)

    def save(self, path: str | PathLike[str] | None) -> Figure:
        if path is not None:
            self.figure.savefig(path)
        return self.figure


def spaced(pixels: Floats, least: float) -> list[int]:
    """Which of rising places to label, so that each is at least so many inches beyond the one before."""
    chosen: list[int] = []
    for i, place in enumerate(pixels / DOTS_PER_INCH):
        if not chosen or place - pixels[chosen[-1]] / DOTS_PER_INCH >= least:
            chosen.append(i)
    return chosen


def unit_of(array: NDArray[Any]) -> str:
    """The unit that the library's buffer behind the array names; "" for an array from elsewhere."""
    owner: Any = array
    while isinstance(owner, np.ndarray):
        owner = owner.base
    return owner.unit if isinstance(owner, Buffer) else ""


def title_of(name: str, unit: str, note: str = "") -> str:
    title = STYLES[name].title if name in STYLES else name
    notes = [text for text in (unit, note) if text not in ("", "1")]
    return f"{title} ({', '.join(notes)})" if notes else title


# ---- A sheet of all fields --------------------------------------------------------------------------------------


def draw_fields(
    frame: Frame,
    path: str | PathLike[str] | None = None,
    fields: Iterable[str] | None = None,
    title: str | None = None,
) -> Figure:
    """Draws the fields of a rendered frame on one sheet: each with title, unit and colour bar.

    path: file to write (.png, .pdf, .svg ...); None: none.
    fields: their names, in order; None: all that the frame has.
    title: the heading; None: size, samples and time of the frame.

    Bandwidths, variances, curvature and sample counts are on logarithmic scales, zero white; light grey pixels see no
    mesh; radiance is encoded as sRGB, its 95th percentile white. Pyramids follow below, level by level.
    """
    names = list(buffer_names() if fields is None else fields)
    arrays = {name: array for name in names if (array := read_field(frame, name, fields is not None)) is not None}
    seen = frame.material != 0
    panels = [name for name in arrays if not name.endswith("_pyramid")]
    pyramids = {name: frame.pyramid(name)[:MOST_LEVELS] for name in arrays if name.endswith("_pyramid")}

    image = fitted(frame.width, frame.height, BOX)
    row_height = TITLE + image.height + ROW_GAP
    pyramids_top = HEADING + math.ceil(len(panels) / COLUMNS) * row_height
    width = MARGIN + PANEL * (COLUMNS if pyramids else min(COLUMNS, max(len(panels), 2)))
    room_for = max([LEAST_LEVELS, *map(len, pyramids.values())])
    level_box = (width - MARGIN - BAR_GAP - BAR_WIDTH - NUMBERS) / room_for - LEVEL_GAP
    level = fitted(frame.width, frame.height, level_box)
    pyramid_height = 2 * TITLE + level.height + ROW_GAP

    with matplotlib.rc_context(STYLE):
        sheet = Sheet(width, pyramids_top + len(pyramids) * pyramid_height + MARGIN)
        sheet.text(MARGIN, MARGIN, heading_of(frame) if title is None else title, weight="bold")
        for i, name in enumerate(panels):
            left, top = MARGIN + i % COLUMNS * PANEL, HEADING + i // COLUMNS * row_height
            draw_panel(sheet, left, top, image, name, arrays[name], seen)
        for i, (name, levels) in enumerate(pyramids.items()):
            draw_pyramid(sheet, pyramids_top + i * pyramid_height, level, name, levels, seen)
        return sheet.save(path)


def read_field(frame: Frame, name: str, wanted: bool) -> NDArray[Any] | None:
    """The field; None where the frame's method has none and nobody asked for it by name."""
    try:
        return frame.buffer(name)
    except StateError:
        if wanted or name == "color":
            raise
        return None


def heading_of(frame: Frame) -> str:
    stats = frame.stats
    share = 100 * stats.shaded_pixels / max(stats.covered_pixels, 1)
    return (
        f"{stats.width} x {stats.height} pixels, {share:.0f} % of the {stats.covered_pixels:,} covered shaded, "
        f"{stats.samples:,} samples, {stats.milliseconds:,.0f} ms"
    )


def draw_panel(sheet: Sheet, left: float, top: float, size: Size, name: str, array: NDArray[Any], seen: Mask) -> None:
    picture = show_field(name, array, seen)
    title = title_of(name, unit_of(array), "x red, y green, z blue" if picture.key is None else "")
    sheet.image(left, top, size, picture.rgba, title)
    sheet.key(left + size.width + BAR_GAP, top, size.height, picture)


def draw_pyramid(sheet: Sheet, top: float, size: Size, name: str, views: list[Any], seen: Mask) -> None:
    """The levels of a pyramid in one row, all equally large, on one scale."""
    levels = [view.astype(np.float64) for view in views]
    masks = [seen]
    while len(masks) < len(levels):
        masks.append(halved(masks[-1]))
    style = STYLES[name]
    everything = np.concatenate([level[mask] for level, mask in zip(levels, masks, strict=True)])
    scale = log_scale(everything)
    coarsest = int(everything.max(initial=0))
    sheet.text(MARGIN, top + 0.1, title_of(name, unit_of(views[0])))
    left = MARGIN
    for k, (level, mask) in enumerate(zip(levels, masks, strict=True)):
        if style.scale == "category":
            picture = show_levels(level, mask, coarsest, style.colours)
        else:
            picture = show_scalar(level, mask, scale, style.colours)
        sheet.image(left, top + TITLE, size, picture.rgba, f"{k}: {level.shape[1]} x {level.shape[0]}")
        right = left + size.width
        left += max(size.width, WIDEST_TITLE) + LEVEL_GAP
    sheet.key(right + BAR_GAP, top + TITLE, size.height, picture)


def halved(seen: Mask) -> Mask:
    """Whether any of each 2 x 2 pixels is seen; half the size, rounded up."""
    rows, columns = seen.shape
    even = np.pad(seen, ((0, rows % 2), (0, columns % 2)))
    return np.asarray(even.reshape((rows + 1) // 2, 2, (columns + 1) // 2, 2).any(axis=(1, 3)))


# ---- Pairs of maps ----------------------------------------------------------------------------------------------


class Pair(NamedTuple):
    """Two maps of the same thing: what was predicted, and what was measured."""

    title: str
    predicted: ArrayLike
    measured: ArrayLike
    unit: str = ""


def rank_correlation(a: ArrayLike, b: ArrayLike) -> float | None:
    """Spearman's rank correlation of two arrays of one shape, over the elements where both are finite.

    None where it is not defined: fewer than two elements, or one array constant.
    """
    x, y = np.asarray(a, np.float64), np.asarray(b, np.float64)
    if x.shape != y.shape:
        raise InvalidArgument(f"a, b: shapes {x.shape} and {y.shape} differ")
    both = np.isfinite(x) & np.isfinite(y)
    if both.sum() < 2:
        return None
    u, v = mean_ranks(x[both]), mean_ranks(y[both])
    u -= u.mean()
    v -= v.mean()
    norm = math.sqrt(float(u @ u) * float(v @ v))
    return float(u @ v) / norm if norm > 0 else None


def mean_ranks(values: Floats) -> Floats:
    """Ranks from 1; equal values share the mean of theirs."""
    _, inverse, counts = np.unique(values, return_inverse=True, return_counts=True)
    mean: Floats = np.cumsum(counts) - (counts - 1) / 2
    return mean[inverse]


def draw_pairs(
    pairs: Iterable[Pair],
    path: str | PathLike[str] | None = None,
    labels: tuple[str, str] = ("Predicted", "Measured"),
) -> Figure:
    """Draws pairs of maps side by side on one logarithmic scale, with their rank correlation and a scatter plot.

    path: file to write (.png, .pdf, .svg ...); None: none.
    labels: what the first and the second map of each pair are.

    A pixel counts where both maps are finite and above zero; elsewhere the maps are grey. The line in the scatter plot
    is equality.
    """
    rows = list(pairs)
    maps = [read_pair(pair) for pair in rows]
    sizes = [fitted(predicted.shape[1], predicted.shape[0], BOX) for predicted, _ in maps]
    heights = [2 * TITLE + max(size.height, LEAST_SCATTER) + AXIS for size in sizes]
    with matplotlib.rc_context(STYLE):
        sheet = Sheet(MARGIN + 2 * (BOX + MARGIN) + BAR_WIDTH + NUMBERS + AXIS + BOX + MARGIN, sum(heights) + MARGIN)
        top = 0.0
        for pair, (predicted, measured), size, height in zip(rows, maps, sizes, heights, strict=True):
            draw_pair(sheet, top, size, pair, predicted, measured, labels)
            top += height
        return sheet.save(path)


def read_pair(pair: Pair) -> tuple[Floats, Floats]:
    predicted, measured = np.asarray(pair.predicted, np.float64), np.asarray(pair.measured, np.float64)
    if predicted.ndim != 2 or predicted.shape != measured.shape or predicted.size == 0:
        raise InvalidArgument(
            f"{pair.title}: shapes {predicted.shape} and {measured.shape}, where two maps of one size are expected"
        )
    return predicted, measured


def draw_pair(
    sheet: Sheet, top: float, size: Size, pair: Pair, predicted: Floats, measured: Floats, labels: tuple[str, str]
) -> None:
    shown = np.isfinite(predicted) & np.isfinite(measured) & (predicted > 0) & (measured > 0)
    correlation = rank_correlation(predicted[shown], measured[shown])
    agreement = "no rank correlation" if correlation is None else f"rank correlation {correlation:.3f}"
    unit = f" ({pair.unit})" if pair.unit else ""
    sheet.text(MARGIN, top + MARGIN, f"{pair.title}{unit}: {agreement}", weight="bold")

    scale = log_scale(np.concatenate([predicted[shown], measured[shown]]))
    left = MARGIN
    for values, label in ((predicted, labels[0]), (measured, labels[1])):
        picture = show_scalar(values, shown, scale, "inferno")
        sheet.image(left, top + TITLE, size, picture.rgba, label)
        right = left + size.width
        left += max(size.width, WIDEST_TITLE) + MARGIN
    sheet.key(right + BAR_GAP, top + TITLE, size.height, picture)
    left = right + BAR_GAP + BAR_WIDTH + NUMBERS + AXIS
    side = max(size.height, LEAST_SCATTER)
    axes = sheet.axes(left, top + 2 * TITLE, side, side)
    draw_scatter(axes, predicted[shown], measured[shown], scale, labels)


def draw_scatter(
    axes: Axes, predicted: Floats, measured: Floats, scale: tuple[Normalize, list[float]], labels: tuple[str, str]
) -> None:
    """How often each pair of values occurs (darker: more often), on logarithmic axes, with the line of equality."""
    norm, ticks = scale
    low, high = float(norm.vmin or 0), float(norm.vmax or 1)
    inside = (predicted >= low) & (measured >= low)
    axes.set(xscale="log", yscale="log", xlim=(low, high), ylim=(low, high), xlabel=labels[0], ylabel=labels[1])
    if inside.any():
        extent = (math.log10(low), math.log10(high)) * 2
        axes.hexbin(
            predicted[inside],
            measured[inside],
            xscale="log",
            yscale="log",
            extent=extent,
            gridsize=50,
            bins="log",
            mincnt=1,
            cmap=ListedColormap(matplotlib.colormaps["Blues"](np.linspace(0.3, 1, 256))),  # one pixel shows too
            linewidths=0.1,
        )
    axes.plot((low, high), (low, high), color="black", linewidth=0.8)
    corner = axes.transData.transform((low, low))
    places = axes.transData.transform([(tick, tick) for tick in ticks]) - corner
    clear = [
        i for i in range(len(ticks)) if places[i, 1] >= LINE / 2 * DOTS_PER_INCH
    ]  # of the labels of the other axis
    for axis, spacing, which in ((axes.xaxis, WIDEST_NUMBER, 0), (axes.yaxis, LINE, 1)):
        shown = [clear[i] for i in spaced(places[clear, which], spacing)]
        axis.set_ticks([ticks[i] for i in shown], labels=[number_label(ticks[i]) for i in shown])
        axis.set_ticks([], minor=True)
    axes.tick_params(length=2, width=0.6, pad=2)
