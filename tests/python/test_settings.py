"""The settings of a frame, by name and as a mapping."""

from __future__ import annotations

from collections.abc import MutableMapping

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

import lightband

TABLE = lightband.settings()
by_name = pytest.mark.parametrize("setting", TABLE, ids=[setting.name for setting in TABLE])


def values_of(setting: lightband.Setting) -> st.SearchStrategy[float | str]:
    """Every value that the setting says it takes."""
    if setting.type == "choice":
        return st.sampled_from(setting.choices)
    assert setting.minimum is not None and setting.maximum is not None
    if setting.type == "integer":
        return st.integers(int(setting.minimum), int(setting.maximum))
    return st.floats(setting.minimum, setting.maximum)


def values_outside(setting: lightband.Setting) -> list[object]:
    if setting.type == "choice":
        return ["", "nonsense", setting.choices[0].upper(), 0]
    assert setting.minimum is not None and setting.maximum is not None
    outside = [setting.minimum - 1, setting.maximum + 1, float("nan"), float("inf"), "many", ""]
    return [*outside, setting.minimum + 0.5] if setting.type == "integer" else outside


@by_name
def test_each_row_of_the_table_is_complete(setting: lightband.Setting) -> None:
    assert setting.documentation.strip()
    if setting.type == "choice":
        assert setting.default in setting.choices
    else:
        assert setting.minimum <= setting.default <= setting.maximum
        kind = int if setting.type == "integer" else float
        assert all(type(value) is kind for value in (setting.minimum, setting.default, setting.maximum))


def test_names_are_unique() -> None:
    assert len({setting.name for setting in TABLE}) == len(TABLE) > 0


@by_name
def test_a_new_frame_has_the_defaults(context: lightband.Context, setting: lightband.Setting) -> None:
    assert context.frame(4, 4)[setting.name] == setting.default


@hypothesis_settings(deadline=None)
@given(st.data())
def test_what_is_set_is_read(context: lightband.Context, data: st.DataObject) -> None:
    setting = data.draw(st.sampled_from(TABLE))
    value = data.draw(values_of(setting))
    frame = context.frame(4, 4)
    frame[setting.name] = value
    assert frame[setting.name] == value
    assert type(frame[setting.name]) is type(value)
    assert frame.settings[setting.name] == value
    assert context.frame(4, 4, **{setting.name: value})[setting.name] == value


@by_name
def test_refused_values_change_nothing(frame: lightband.Frame, setting: lightband.Setting) -> None:
    before = dict(frame.settings)
    for value in values_outside(setting):
        with pytest.raises(lightband.InvalidArgument, match=setting.name):
            frame[setting.name] = value  # type: ignore[assignment]
    with pytest.raises(TypeError):
        frame[setting.name] = None  # type: ignore[assignment]
    assert dict(frame.settings) == before


def test_an_unknown_name_is_refused_with_the_names_there_are(frame: lightband.Frame) -> None:
    for act in (
        lambda: frame["sample"],
        lambda: frame.__setitem__("sample", 3),
        lambda: frame.__setitem__("sample", "x"),
    ):
        with pytest.raises(lightband.InvalidArgument, match="sample.*samples"):
            act()
    with pytest.raises(lightband.InvalidArgument, match="zero byte"):
        frame["samples\0"] = 3


def test_settings_are_a_mapping(frame: lightband.Frame) -> None:
    mapping = frame.settings
    assert isinstance(mapping, MutableMapping)
    assert list(mapping) == [setting.name for setting in TABLE]
    assert len(mapping) == len(TABLE)
    assert "samples" in mapping and "sample" not in mapping
    assert mapping.get("sample") is None
    with pytest.raises(KeyError):
        mapping["sample"]
    mapping.update(samples=16, method="reference")
    assert (frame["samples"], frame["method"]) == (16, "reference")
    assert "'samples': 16" in repr(mapping)
    del mapping["samples"]
    assert frame["samples"] == next(setting.default for setting in TABLE if setting.name == "samples")


def test_settings_take_hold(context: lightband.Context, scene: lightband.Scene) -> None:
    frame = context.frame(16, 16, method="reference", samples=8)
    frame.render(scene)
    assert set(frame.sample_count[frame.material != 0].tolist()) == {8}
    frame["samples"] = 12
    frame.render(scene)
    assert set(frame.sample_count[frame.material != 0].tolist()) == {12}
    assert frame.stats.samples == frame.sample_count.sum(dtype=int)


def test_environment_lookup_holds_for_the_background(context: lightband.Context) -> None:
    """One lit texel among eight: looked up as the nearest, it is a square with sharp edges."""
    texels = np.zeros((2, 4, 3), np.float32)
    texels[0, 1] = 1  # longitudes 0 to 90 degrees (from +Z towards +X), above the horizon
    scene = context.scene()
    scene.environment = context.environment(texels)
    scene.camera(eye=(0, 0, 0), target=(0, 0, 1), fov_y=1)  # +X is to the left
    expected = np.zeros((4, 4))
    expected[:2, :2] = 1
    frame = context.frame(4, 4, environment_lookup="nearest", background="environment")
    frame.render(scene)
    np.testing.assert_array_equal(frame.color[..., 0], expected)
    frame["environment_lookup"] = "linear"
    frame.render(scene)
    assert len(np.unique(frame.color[..., 0])) > 2
