"""What the extension module returns: plain records, and the settings of a frame as a mapping."""

from __future__ import annotations

from collections.abc import Iterator, MutableMapping
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Final, Literal

from . import _lightband

if TYPE_CHECKING:
    from ._lightband import Frame


class Answer(Enum):
    """What a progress callback may return to Frame.render; any other value is ignored."""

    CANCEL = "cancel"
    """Stop: the call raises Cancelled, and the frame holds what it held before."""

    def __repr__(self) -> str:
        return f"lightband.{self.name}"


CANCEL: Final = Answer.CANCEL


@dataclass(frozen=True)
class Setting:
    """One row of the table of settings."""

    name: str
    type: Literal["integer", "real", "choice"]
    minimum: float | None
    """None for a choice."""
    maximum: float | None
    """None for a choice."""
    default: float | str
    choices: tuple[str, ...]
    """Empty for a number."""
    documentation: str


@dataclass(frozen=True)
class FrameStats:
    """Counts and times of a rendered frame."""

    width: int
    height: int
    frames: int
    """Frames averaged: the setting "accumulate"."""
    covered_pixels: int
    """Pixels that see a mesh."""
    shaded_pixels: int
    """Those whose integral was computed; the others were interpolated."""
    samples: int
    """Light samples that the picture is made of, counted by the shaders themselves, all frames."""
    saturated_pixels: int
    """Covered pixels whose predicted bandwidth reached 0.5 cycles per pixel."""
    bent_normals: int
    """Covered pixels whose shading normal faced away and was turned to the eye."""
    device_bytes: int
    """Device memory held by the scene and this frame."""
    milliseconds: float
    """The whole render call."""
    bandwidth_milliseconds: float
    """Of it: everything beside shading and geometry (bandwidth, audits, lists, interpolation, estimate)."""
    shading_milliseconds: float
    """Of it: the shading integral."""
    error: float
    """Relative error of the frame, as the frame itself estimates it; the field "error" holds it pixel by pixel."""
    noise_error: float
    """The part of it that more samples would lessen."""
    interpolation_error: float
    """The part of it that finer levels would lessen; the squares of it, noise_error and bias_error add up to that of error."""
    capped_pixels: int
    """Pixels whose samples reached the setting "max_samples"; they may have deserved more."""
    rounds: int
    """Rounds of shading: 1 where neither an error nor a time was asked for."""
    audited_pixels: int
    """Pixels that were also shaded with more samples, to know how far the others err; 0: no bias, or no time."""
    bias_error: float
    """The part of error that an audit found beyond the other two: a biased sampler's, and what replicates and witnesses do not tell."""
    sampler_replaced: bool
    """Samples without bias contradicted the sampler "cut"; the picture was drawn by another (frame.plan says which)."""


@dataclass(frozen=True)
class MeshStats:
    """Size of a mesh."""

    vertices: int
    triangles: int
    """Those kept."""
    dropped_triangles: int
    """Those of zero area."""
    bounds_min: tuple[float, float, float]
    """Metres."""
    bounds_max: tuple[float, float, float]
    """Metres."""


class Settings(MutableMapping[str, "float | str"]):
    """The settings of a frame: reads and writes go to the frame at once."""

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        self._defaults = {setting.name: setting.default for setting in _lightband.settings()}

    def __getitem__(self, name: str) -> float | str:
        if name not in self._defaults:
            raise KeyError(name)
        return self._frame[name]

    def __setitem__(self, name: str, value: float | str) -> None:
        self._frame[name] = value

    def __delitem__(self, name: str) -> None:
        """Restores the default."""
        self._frame[name] = self._defaults[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._defaults)

    def __len__(self) -> int:
        return len(self._defaults)

    def __repr__(self) -> str:
        return f"Settings({dict(self)})"
