"""Wrong arguments of every public call: the message names the argument and what is expected, and never pybind11's overloads."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lightband

CLASSES = (
    lightband.Context,
    lightband.Brdf,
    lightband.Environment,
    lightband.Sun,
    lightband.Mesh,
    lightband.Scene,
    lightband.Frame,
    lightband.Buffer,
)
FUNCTIONS = (lightband.settings, lightband.builtin_materials, lightband.buffer_names)


class Thing:
    """Of no type that any call takes; its repr must not matter."""

    def __repr__(self) -> str:
        raise RuntimeError("no repr")


def methods() -> Iterator[tuple[str, Callable[..., object]]]:
    for function in FUNCTIONS:
        yield function.__name__, function
    for kind in CLASSES:
        for name, thing in vars(kind).items():
            if isinstance(thing, property):
                yield f"{kind.__name__}.{name}", thing.fget  # type: ignore[misc]
            elif name.startswith("_pybind11") or name in ("__module__", "__doc__", "__new__", "__init__"):
                continue
            elif callable(getattr(kind, name)):
                yield f"{kind.__name__}.{name}", getattr(kind, name)


METHODS = dict(methods())
every_call = pytest.mark.parametrize("path", METHODS)


def refusal(call: Callable[..., object], *arguments: object, **named: object) -> str:
    with pytest.raises(lightband.InvalidType) as caught:
        call(*arguments, **named)
    assert isinstance(caught.value, TypeError) and caught.value.code == 1
    text = str(caught.value)
    for sign in ("incompatible", "Invoked with", "arg0", "object at 0x"):
        assert sign not in text
    return text


@every_call
def test_wrong_numbers_of_arguments(path: str) -> None:
    method = METHODS[path]
    too_many = refusal(method, *[None] * 12)
    assert path in too_many and "12" in too_many or "11" in too_many
    unknown = refusal(method, colour_of_nothing=3) if path != "Context.frame" else "colour_of_nothing"
    assert "colour_of_nothing" in unknown
    if "." in path:
        assert "self is missing" in refusal(method)


@every_call
def test_self_of_a_wrong_type(path: str) -> None:
    if path.endswith("__enter__") or path in {function.__name__ for function in FUNCTIONS}:
        return
    try:
        count = len(inspect.signature(METHODS[path]).parameters)
    except ValueError:  # a getter has no name of its own
        count = 1
    text = refusal(METHODS[path], *[Thing()] * (count - path.endswith("Context.frame")))
    assert path in text and "self must be a lightband." in text and "Thing" in text


@pytest.fixture
def objects(context: lightband.Context, scene: lightband.Scene, rendered: lightband.Frame) -> dict[str, Any]:
    return {
        "Context": context,
        "Brdf": context.lambert(0.5),
        "Environment": scene.environment,
        "Sun": context.sun((0, 1, 0), 1),
        "Mesh": context.builtin_mesh("plane", 8),
        "Scene": scene,
        "Frame": rendered,
        "Buffer": rendered.color.base,
    }


RIGHT: dict[str, dict[str, object]] = {
    "Context.load_brdf": {"path": "x", "fill_unmeasured": True},
    "Context.builtin_brdf": {"name": "x"},
    "Context.table_brdf": {"table": 1},
    "Context.lambert": {"albedo": 0.5},
    "Context.ggx": {"alpha": 0.5, "f0": 0.5},
    "Context.load_environment": {"path": "x"},
    "Context.environment": {"radiance": 1},
    "Context.sun": {"direction": (0, 1, 0), "irradiance": 1, "angular_radius": 0.01},
    "Sun.set": {"direction": (0, 1, 0), "irradiance": 1, "angular_radius": 0.01},
    "Context.mesh": {"positions": np.eye(3), "indices": [[0, 1, 2]], "normals": np.eye(3), "texcoords": np.ones((3, 2))},
    "Context.builtin_mesh": {"name": "plane", "resolution": 8},
    "Context.frame": {"width": 4, "height": 4, "samples": 4, "target_error": 0.1, "method": "adaptive"},
    "Brdf.evaluate": {"wi": (0, 0, 1), "wo": (0, 0, 1)},
    "Brdf.albedo": {"theta_o": 0},
    "Scene.add": {"mesh": None, "brdf": None, "transform": np.eye(4), "double_sided": True},
    "Scene.add_light": {"light": None},
    "Scene.remove_light": {"light": None},
    "Scene.set_transform": {"index": 0, "transform": np.eye(4)},
    "Scene.set_double_sided": {"index": 0, "double_sided": True},
    "Scene.camera": {"eye": (0, 0, 3), "target": (0, 0, 0), "up": (0, 1, 0), "fov_y": 0.7, "near_plane": 1e-3, "far_plane": 1e3},
    "Frame.__getitem__": {"name": "samples"},
    "Frame.__setitem__": {"name": "samples", "value": 8},
    "Frame.render": {"scene": None, "progress": None},
    "Frame.plan_for": {"scene": None},
    "Frame.save": {"path": "x.png", "fields": None, "exposure": 0.0, "tone_curve": "none", "alpha": "coverage"},
    "Frame.buffer": {"name": "color"},
    "Frame.pyramid": {"name": "level_pyramid"},
}
WRONG = {
    "an object": Thing(),
    "a class": lightband.Frame,
    "a dict": {"a": 1},
    "a set": {1, 2},
    "a complex": 1j,
    "bytearray": bytearray(b"abc"),
    "dates": np.array(["2026-11-28"] * 3, "datetime64[D]"),
    "objects": np.array([Thing(), Thing(), Thing()]),
    "an ellipsis": ...,
}
parameters = pytest.mark.parametrize(
    ("path", "name"), [(path, name) for path, right in RIGHT.items() for name in right], ids=lambda value: str(value)
)


def test_every_parameter_is_tried() -> None:
    for path, method in METHODS.items():
        try:
            names = set(inspect.signature(method).parameters) - {"self", "settings", "protocol", "kind", "error", "trace"}
        except ValueError:
            continue
        assert names <= set(RIGHT.get(path, {})), path


@parameters
@pytest.mark.parametrize("wrong", WRONG.values(), ids=WRONG)
def test_a_wrong_type_is_refused_by_the_arguments_name(
    objects: dict[str, Any], path: str, name: str, wrong: object
) -> None:
    owner, method = path.split(".")
    arguments = dict(RIGHT[path])
    arguments.update({key: objects[key.capitalize()] for key in ("mesh", "brdf", "scene") if key in arguments})
    if "light" in arguments:
        arguments["light"] = objects["Sun"]
    arguments[name] = wrong
    if name == "fields" and isinstance(wrong, dict) or name == "progress" and callable(wrong):
        return  # names, one of which is unknown; a callable
    said = "samples" if name == "value" else name
    text = refusal(getattr(objects[owner], method), **arguments)
    assert f"{path}: {said} must be " in text or path == "Frame.__setitem__" and f"{said} must be " in text


REFUSED = {
    "context.frame(True, 4)": "width must be a whole number, not bool True",
    "context.frame(4, np.True_)": "height must be a whole number",
    "context.frame(4.0, 4)": "width must be a whole number, not float 4.0",
    "context.frame(np.float32(4), 4)": "width must be a whole number, not numpy.float32 4.0",
    "context.frame('a', 3)": "width must be a whole number, not str 'a'",
    "context.frame(10**5000, 4)": "width is an int of thousands of digits",
    "context.frame(4)": "height is missing",
    "context.frame(4, 4, width=4)": "width is given twice",
    "context.frame(4, 4, samples=True)": "samples must be a whole number, not bool True",
    "context.frame(4, 4, target_error=None)": "target_error must be a number, not None",
    "context.frame(4, 4, samples=10**400)": "samples is beyond the largest double",
    "context.frame(4, 4, method=None)": r"method must be a str, one of adaptive\|reference, not None",
    "context.frame(4, 4, method=b'reference')": "method must be a str",
    "context.frame(4, 4, sample=None)": 'no setting "sample"',
    "context.ggx(None, 1)": "alpha must be a number, not None",
    "context.ggx('0.5', 1)": "alpha must be a number, not str '0.5'",
    "context.ggx(np.bool_(1), 1)": "alpha must be a number",
    "context.ggx(np.complex64(1), 1)": "alpha must be a number",
    "context.ggx([0.5], 1)": "alpha must be a number, not list",
    "context.ggx(np.ma.masked, 1)": "alpha must be a number",
    "context.ggx(1e300, 1)": r"alpha is 1e\+300; it must fit a 32-bit float",
    "context.ggx(10**400, 1)": "alpha is beyond the largest double",
    "context.ggx(float('nan'), 1)": "alpha",
    "context.lambert('x' * 10**6)": "albedo must be one number or three .RGB., not str 'xxx.{,70}$",
    "context.lambert([True] * 3)": "albedo must be .* bool",
    "context.lambert(np.ma.array([1, 1, 1], mask=[0, 1, 0]))": "albedo has masked elements",
    "context.lambert([0.5, 10**400, 1])": "albedo",
    "context.environment(np.full((2, 2, 3), 1e300))": r"radiance holds 1e\+300",
    "context.builtin_brdf(b'rough-gold')": "name must be a str, not bytes b'rough-gold'",
    "context.builtin_brdf(pathlib.Path('rough-gold'))": "name must be a str",
    "context.builtin_brdf('\\ud800')": "name holds characters that have no UTF-8",
    "context.load_brdf('\\ud800')": "path is no path",
    "context.load_brdf(b'a\\0b')": "path is no path",
    "scene.camera(eye=1)": "target is missing",
    "scene.camera(eye=1, target=2)": "eye must be three finite numbers, not int 1",
    "scene.camera((0, 0, 1), (0, 0, 0), fov_y=True)": "fov_y must be a number or None, not bool True",
    "scene.camera((0, 0, 1), (0, 0, 0), fov_y=1e-60)": "fov_y is 0",
    "scene.add(mesh, mesh)": "brdf must be a lightband.Brdf, not lightband._lightband.Mesh",
    "scene.add(mesh, brdf, double_sided='no')": "double_sided must be True or False, not str 'no'",
    "scene.add(mesh, brdf, double_sided=0)": "double_sided must be True or False, not int 0",
    "scene.add(closed, brdf)": "mesh was closed",
    "setattr(scene, 'environment', 3)": "environment must be a lightband.Environment, not int 3",
    "frame.render(scene, 3)": "progress must be a callable or None, not int 3",
    "frame.save('x.exr', fields=['color', 3])": "fields must be .* one is int 3",
    "frame.save('x.exr', fields=b'color')": "fields must be .* not bytes b'color'",
    "frame.save('x.exr', exposure='bright')": "exposure must be a number, not str 'bright'",
    "lightband.Context('software', log=3)": "Context: log must be a callable or None, not int 3",
    "lightband.Context(cache_path=3)": "cache_path must be a path .* or None, not int 3",
    "lightband.Context(device=2)": "device must be a str, not int 2",
    "lightband.Context(devices='any')": "no parameter devices",
    "lightband.Frame()": "Context.frame makes one",
    "lightband.Frame(3, width=4)": "Context.frame makes one",
    "lightband.Context.__new__(lightband.Context).scene()": "never initialised",
}


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("call", REFUSED)
def test_what_is_refused_is_named(context: lightband.Context, rendered: lightband.Frame, call: str) -> None:
    import pathlib

    closed = context.builtin_mesh("plane", 8)
    closed.close()
    names = {
        "context": context,
        "scene": context.scene(),
        "frame": rendered,
        "mesh": context.builtin_mesh("plane", 8),
        "brdf": context.lambert(0.5),
        "closed": closed,
    }
    with pytest.raises(lightband.Error, match=REFUSED[call]) as caught:
        eval(call, {**names, "np": np, "lightband": lightband, "pathlib": pathlib})
    assert isinstance(caught.value, lightband.InvalidArgument | lightband.InvalidHandle)


def test_numbers_of_any_kind_are_taken(context: lightband.Context, tmp_path: Path) -> None:
    for number in (0.5, np.float16(0.5), np.float64(0.5), np.array(0.5), Fraction(1, 2)):
        assert repr(context.ggx(number, 1)) == "<lightband.Brdf GGX, alpha 0.5>"
    for size in (4, np.int8(4), np.uint64(4), np.array(4)):
        assert context.frame(size, size).width == 4
    with pytest.raises(lightband.FileError):
        context.load_brdf(tmp_path / "none.binary")


def test_what_an_argument_raises_is_passed_on(context: lightband.Context, rendered: lightband.Frame) -> None:
    class Mishap(Exception):
        pass

    class Failing:
        def __fspath__(self) -> str:
            raise Mishap

        __index__ = __float__ = __array__ = __iter__ = __fspath__

    for call in (
        lambda: context.load_brdf(Failing()),
        lambda: context.frame(Failing(), 4),
        lambda: context.ggx(Failing(), 1),
        lambda: context.lambert(Failing()),
        lambda: rendered.save("x.exr", Failing()),
        lambda: rendered.__setitem__("samples", Failing()),
    ):
        with pytest.raises(Mishap):
            call()
