"""What the extension module returns: plain records, and the settings of a frame as a mapping."""

from __future__ import annotations

from collections.abc import Iterator, MutableMapping
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Final, Literal, SupportsFloat, overload

from . import _lightband

if TYPE_CHECKING:
    from ._lightband import Frame, _Choice, _Integer, _Real


class Answer(Enum):
    """What a progress callback may return to Frame.render; any other value is ignored."""

    CANCEL = "cancel"
    """Stop: the call raises Cancelled, and the frame holds what it held before."""

    def __repr__(self) -> str:
        return f"lightband.{self.name}"


CANCEL: Final = Answer.CANCEL


@dataclass(frozen=True)
class Setting:
    """One row of the table of settings.

    name: as in frame[name].
    type: "integer", "real" or "choice".
    minimum, maximum: the least and the greatest number it can be; None for a choice.
    default: its value in a new frame.
    choices: the names it can be; empty for a number.
    documentation: what it means, with its unit.
    """

    name: str
    type: Literal["integer", "real", "choice"]
    minimum: float | None
    maximum: float | None
    default: float | str
    choices: tuple[str, ...]
    documentation: str


@dataclass(frozen=True)
class FrameStats:
    """Counts and times of a rendered frame.

    width, height: pixels of the picture.
    frames: frames averaged; the setting "accumulate".
    covered_pixels: pixels that see a mesh.
    shaded_pixels: of them, those whose integral was computed; the others were interpolated.
    samples: light samples that the picture is made of, counted by the shaders themselves, all frames. Those of pixels
        that were sampled again, of pilot and control samples are not among them.
    saturated_pixels: covered pixels whose predicted bandwidth reached 0.5 cycles per pixel.
    bent_normals: covered pixels whose shading normal faced away and was turned to the eye.
    device_bytes: bytes of device memory held by the scene and this frame.
    milliseconds: milliseconds of the whole render call.
    bandwidth_milliseconds: of it, the prediction of bandwidth and variance; 0 in a frame of method "reference".
    shading_milliseconds: of it, the shading integral.
    error: relative error of the frame (1: as large as the picture) as the frame itself estimates it: root of the squares of the
        parts noise, interpolation and bias. The field frame.error holds it pixel by pixel.
    noise_error: the part of it that more samples would reduce.
    interpolation_error: the part of it that finer levels would reduce.
    capped_pixels: pixels whose samples reached the setting "max_samples"; their error may be larger than the others'.
    rounds: rounds of shading; 1 where neither an error nor a time was asked for.
    control_pixels: pixels that were also shaded with more samples, to know how far the others err; 0 where the setting "sampler"
        has no bias or a "time_budget" leaves no time for them.
    bias_error: the part of error that control samples see beyond the other two: the bias of a sampler, which is the same at every
        seed. More samples reduce it.
    sampler_replaced: whether the sampler "cut" did not agree with samples without bias, and the picture was shaded by another (frame.plan
        says which).
    """

    width: int
    height: int
    frames: int
    covered_pixels: int
    shaded_pixels: int
    samples: int
    saturated_pixels: int
    bent_normals: int
    device_bytes: int
    milliseconds: float
    bandwidth_milliseconds: float
    shading_milliseconds: float
    error: float
    noise_error: float
    interpolation_error: float
    capped_pixels: int
    rounds: int
    control_pixels: int
    bias_error: float
    sampler_replaced: bool


@dataclass(frozen=True)
class MeshStats:
    """Size of a mesh.

    vertices: their number.
    triangles: number of those kept.
    dropped_triangles: number of those of zero area, which are left out.
    bounds_min, bounds_max: opposite corners of the box around the mesh, metres.
    """

    vertices: int
    triangles: int
    dropped_triangles: int
    bounds_min: tuple[float, float, float]
    bounds_max: tuple[float, float, float]


class Settings(MutableMapping[str, "float | str"]):
    """The settings of a frame: reads and writes go to the frame at once. Deleting one restores its default."""

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        self._defaults = {setting.name: setting.default for setting in _lightband.settings()}

    @overload
    def __getitem__(self, name: _Integer) -> int: ...
    @overload
    def __getitem__(self, name: _Real) -> float: ...
    @overload
    def __getitem__(self, name: _Choice) -> str: ...
    @overload
    def __getitem__(self, name: str) -> int | float | str: ...
    def __getitem__(self, name: str) -> int | float | str:
        """The value of a setting; KeyError for an unknown name."""
        if name not in self._defaults:
            raise KeyError(name)
        return self._frame[name]

    def __setitem__(self, name: str, value: SupportsFloat | str) -> None:
        """Sets a setting: a number or, for a choice, its name."""
        self._frame[name] = value  # type: ignore[call-overload]  # the frame refuses what does not fit

    def __delitem__(self, name: str) -> None:
        """Restores the default; KeyError for an unknown name."""
        self[name] = self._defaults[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._defaults)

    def __len__(self) -> int:
        return len(self._defaults)

    def __repr__(self) -> str:
        return f"Settings({dict(self)})"
