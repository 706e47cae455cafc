"""Drawings: every field is there, in one size of type, and no text covers another."""

from __future__ import annotations

import itertools
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import lightband

pytest.importorskip("matplotlib", reason="Matplotlib is in the extra pictures")

import matplotlib.image
from matplotlib.figure import Figure
from matplotlib.text import Text

from lightband import pictures


def texts_of(figure: Figure) -> list[Text]:
    figure.canvas.draw()
    texts = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip()]
    return [text for text in texts if in_range(text)]


def in_range(text: Text) -> bool:
    """Tick labels beyond an axis's limits are objects too, but are not drawn."""
    box, axes = text.get_window_extent(), text.axes
    if axes is None:
        return True
    centre = (box.y0 + box.y1) / 2, (box.x0 + box.x1) / 2
    frame = axes.get_window_extent().padded(200)
    return frame.y0 <= centre[0] <= frame.y1 and frame.x0 <= centre[1] <= frame.x1


def assert_readable(figure: Figure) -> None:
    texts = texts_of(figure)
    assert {text.get_fontsize() for text in texts} == {pictures.FONT_SIZE}
    boxes = [(text.get_text(), text.get_window_extent()) for text in texts]
    for (one, a), (other, b) in itertools.combinations(boxes, 2):
        assert not a.overlaps(b), f"{one!r} covers {other!r}"
    for text, box in boxes:
        page = figure.bbox
        assert page.x0 <= box.x0 and box.x1 <= page.x1 and page.y0 <= box.y0 and box.y1 <= page.y1, f"{text!r} is cut"


@pytest.mark.parametrize(("width", "height"), [(40, 24), (24, 40), (32, 32), (64, 2), (1, 1)])
def test_all_fields_on_one_sheet(
    context: lightband.Context, scene: lightband.Scene, tmp_path: Path, width: int, height: int
) -> None:
    frame = context.frame(width, height, samples=8)
    frame.render(scene)
    path = tmp_path / "fields.png"
    figure = pictures.draw_fields(frame, path)
    assert path.read_bytes().startswith(b"\x89PNG")
    written = " ".join(text.get_text() for text in texts_of(figure))
    for name in lightband.buffer_names():
        assert pictures.STYLES[name].title in written
        assert frame.buffer(name).base.unit in written
    assert_readable(figure)


def test_many_instances_and_levels(context: lightband.Context, environment: lightband.Environment) -> None:
    scene = context.scene()
    mesh, brdf = context.builtin_mesh("plane", 8), context.lambert(0.5)
    for row, column in itertools.product(range(5), range(8)):
        place = np.eye(4)
        place[:2, 3] = (column - 3.5) * 1.1, (row - 2) * 1.1
        scene.add(mesh, brdf, place)
    scene.environment = environment
    scene.camera((0, 0, 9), (0, 0, 0))
    frame = context.frame(80, 50, samples=4)
    frame.render(scene)
    assert frame.material.max() == 40
    assert_readable(pictures.draw_fields(frame))


def test_a_frame_that_sees_nothing(context: lightband.Context, environment: lightband.Environment) -> None:
    scene = context.scene()
    scene.environment = environment
    scene.camera((0, 0, 3), (0, 0, 0))
    frame = context.frame(16, 8, samples=4)
    frame.render(scene)
    assert_readable(pictures.draw_fields(frame))


def test_a_reference_frame_shows_what_it_has(context: lightband.Context, scene: lightband.Scene) -> None:
    frame = context.frame(16, 16, samples=4, method="reference")
    frame.render(scene)
    figure = pictures.draw_fields(frame)
    written = [text.get_text() for text in texts_of(figure)]
    assert any("Colour" in text for text in written)
    assert not any("bandwidth" in text for text in written)
    with pytest.raises(lightband.StateError, match="bandwidth_image"):
        pictures.draw_fields(frame, fields=["bandwidth_image"])


def test_chosen_fields_and_title(rendered: lightband.Frame) -> None:
    figure = pictures.draw_fields(rendered, fields=["depth"], title="Only how far")
    written = [text.get_text() for text in texts_of(figure)]
    assert "Only how far" in written and not any("Colour" in text for text in written)
    assert_readable(figure)


def test_a_frame_without_a_picture(frame: lightband.Frame) -> None:
    with pytest.raises(lightband.StateError):
        pictures.draw_fields(frame)


@pytest.mark.parametrize("shape", [(30, 40), (40, 30), (4, 64), (1, 1)])
def test_pairs(tmp_path: Path, shape: tuple[int, int]) -> None:
    random = np.random.default_rng(5)
    predicted = random.lognormal(0, 2, shape)
    measured = predicted * random.lognormal(0, 0.5, shape)
    measured.flat[::7] = 0
    figure = pictures.draw_pairs(
        [
            pictures.Pair("Bandwidth", predicted, measured, "1/pixel"),
            pictures.Pair("Nothing", np.zeros(shape), measured),
        ],
        tmp_path / "pairs.png",
    )
    assert (tmp_path / "pairs.png").stat().st_size > 0
    written = [text.get_text() for text in texts_of(figure)]
    assert any(text.startswith("Bandwidth (1/pixel): ") for text in written)
    assert "Nothing: no rank correlation" in written
    assert_readable(figure)


@pytest.mark.parametrize("measured", [np.ones(3), np.ones((2, 3)), np.ones((2, 2, 1))])
def test_pairs_of_different_shapes_are_refused(measured: Any) -> None:
    with pytest.raises(lightband.InvalidArgument, match="Uneven"):
        pictures.draw_pairs([pictures.Pair("Uneven", np.ones((2, 2)), measured)])


def test_rank_correlation_of_known_ranks() -> None:
    # 1 - 6 sum d^2 / (n (n^2 - 1)) with d = (0, 1, -1, 0), n = 4: 1 - 12 / 60.
    assert pictures.rank_correlation([1, 2, 3, 4], [10, 30, 20, 40]) == pytest.approx(0.8)
    # Ties share their mean rank: ranks (1.5, 1.5, 3) against (1, 2, 3) give cov 1.5, var 1.5 and 2.
    assert pictures.rank_correlation([5, 5, 7], [1, 2, 3]) == pytest.approx(1.5 / np.sqrt(1.5 * 2))
    assert pictures.rank_correlation([1, 2, np.nan, np.inf], [4, 3, 2, 1]) == pytest.approx(-1)
    assert pictures.rank_correlation([1, 1], [1, 2]) is None
    assert pictures.rank_correlation([1], [1]) is None
    with pytest.raises(lightband.InvalidArgument, match="shapes"):
        pictures.rank_correlation([1, 2], [1])


@given(hnp.arrays(np.float64, st.integers(2, 50), elements=st.integers(-1000, 1000).map(float), unique=True))
def test_rank_correlation_sees_order_alone(values: Any) -> None:
    assert pictures.rank_correlation(values, values**3) == pytest.approx(1)
    assert pictures.rank_correlation(values, -np.exp(values / 500)) == pytest.approx(-1)


def test_srgb_curve_and_its_inverse() -> None:
    # IEC 61966-2-1: linear 0.2140 is the code value 0.5.
    assert pictures.srgb_encode(0.21404114) == pytest.approx(0.5, abs=1e-6)
    codes = np.linspace(0, 1, 256)
    np.testing.assert_allclose(pictures.srgb_encode(pictures.srgb_decode(codes)), codes, atol=1e-6)


@pytest.fixture(scope="module")
def with_background(context: lightband.Context, scene: lightband.Scene) -> lightband.Frame:
    frame = context.frame(40, 24, samples=8, background="environment")
    frame.render(scene)
    return frame


def png(frame: lightband.Frame, folder: Path, **options: Any) -> Any:
    frame.save(folder / "frame.png", **options)
    return matplotlib.image.imread(folder / "frame.png")


def test_alpha_of_a_png(rendered: lightband.Frame, with_background: lightband.Frame, tmp_path: Path) -> None:
    for frame in (rendered, with_background):
        assert 0 < frame.color[..., 3].sum() < 40 * 24
        np.testing.assert_array_equal(png(frame, tmp_path)[..., 3], frame.color[..., 3])
        assert (png(frame, tmp_path, alpha="opaque")[..., 3] == 1).all()
    # Whatever alpha is, the colours are those that the frame shows.
    shown = pictures.srgb_encode(with_background.color[..., :3].clip(0, 1))
    for alpha in ("coverage", "opaque"):
        np.testing.assert_allclose(png(with_background, tmp_path, alpha=alpha)[..., :3], shown, atol=0.51 / 255)


def test_exposure_of_a_png(with_background: lightband.Frame, tmp_path: Path) -> None:
    for stops in (-2, 1):
        shown = pictures.srgb_encode((with_background.color[..., :3] * 2.0**stops).clip(0, 1))
        np.testing.assert_allclose(png(with_background, tmp_path, exposure=stops)[..., :3], shown, atol=0.51 / 255)


def test_highlights_of_a_png(with_background: lightband.Frame, tmp_path: Path) -> None:
    """The sky is 0.5 to 1.5 bright; three stops up, all of it is above 1."""
    clipped = png(with_background, tmp_path, exposure=3, alpha="opaque")[0, :, 0]
    filmic = png(with_background, tmp_path, exposure=3, tone_curve="filmic", alpha="opaque")
    assert (clipped == 1).all()
    sky = filmic[:, 0, 0]
    assert sky.max() < 1 and len(np.unique(sky)) > 2 and (np.diff(sky) <= 0).all()


def test_an_exr_says_how_it_was_made(context: lightband.Context, scene: lightband.Scene, tmp_path: Path) -> None:
    rendered = context.frame(40, 24, samples=8)
    rendered.render(scene)
    rendered["samples"] = 9  # for the next picture
    rendered.save(tmp_path / "frame.exr", fields=["color", "depth", "normal", "level"])
    header = (tmp_path / "frame.exr").read_bytes()[:8192]
    for channel in (b"A", b"B", b"G", b"R", b"Z", b"level.Y", b"normal.X", b"normal.Z"):
        assert b"\0" + channel + b"\0" in header
    assert b"chromaticities\0chromaticities\0" in header and b"pixelAspectRatio\0float\0\4\0\0\0\0\0\x80\x3f" in header
    for setting in lightband.settings():
        kind = b"string" if setting.choices else b"double"
        assert b"lightband." + setting.name.encode() + b"\0" + kind + b"\0" in header

    def number(name: bytes) -> float:
        value = header.split(name + b"\0double\0\x08\0\0\0")[1][:8]
        return float(np.frombuffer(value, "<f8")[0])

    assert number(b"lightband.samples") == 8
    assert number(b"lightband.stats.samples") == rendered.stats.samples
    assert number(b"lightband.stats.error") == rendered.stats.error
    stats = [name for name in vars(type(rendered.stats)).get("__annotations__", ()) if name not in ("width", "height")]
    assert stats and all(b"lightband.stats." + name.encode() + b"\0" in header for name in stats)


def test_without_matplotlib_the_error_says_what_to_install() -> None:
    script = "import sys; sys.modules['matplotlib'] = None; import lightband; import lightband.pictures"
    outcome = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert outcome.returncode == 1
    assert "pip install matplotlib" in outcome.stderr.splitlines()[-1]


def test_the_example_runs(tmp_path: Path) -> None:
    example = Path(__file__).resolve().parents[2] / "examples" / "python" / "look_at_bandwidth.py"
    with lightband.Context(device="software", cache_path="") as context:
        sky = context.scene()
        sky.environment = context.environment(np.full((8, 16, 3), 0.5))
        sky.camera((0, 0, 1), (0, 0, 0))
        frame = context.frame(64, 32, samples=1, background="environment")
        frame.render(sky)
        frame.save(tmp_path / "map.exr")
    command = [sys.executable, str(example), str(tmp_path / "map.exr"), str(tmp_path / "sheet.png")]
    outcome = subprocess.run(command, capture_output=True, text=True, check=False)
    assert outcome.returncode == 0, outcome.stderr
    assert "rough-gold" in outcome.stdout
    assert (tmp_path / "sheet.png").stat().st_size > 0
