"""Shading of measured materials by bandwidth prediction.

    import lightband

    context = lightband.Context(device="any")
    scene = context.scene()
    scene.add(context.builtin_mesh("sphere"), context.load_brdf("nickel.binary"))
    scene.environment = context.load_environment("forest.exr")
    scene.camera(eye=(0, 0, 3), target=(0, 0, 0))
    frame = context.frame(512, 512)
    frame.render(scene)
    frame.save("nickel.exr", fields=["color", "bandwidth_image"])
    print(frame.bandwidth_image.max(), frame.stats)

Units are metres, radians and cycles; radiance is linear with Rec. 709 primaries; rows run top-down. Directions `wi`
(to the light) and `wo` (to the eye) are in the local frame, whose +Z is the normal.
"""

from . import errors
from ._lightband import (
    Brdf,
    Buffer,
    Context,
    Environment,
    Frame,
    Mesh,
    Scene,
    Sun,
    __version__,
    buffer_names,
    builtin_materials,
    settings,
)
from ._records import CANCEL, FrameStats, MeshStats, Setting, Settings
from .errors import (
    Cancelled,
    DeviceError,
    Error,
    FileError,
    FormatError,
    InternalError,
    InvalidArgument,
    InvalidHandle,
    InvalidType,
    LimitError,
    OutOfMemory,
    StateError,
)

__all__ = [
    "CANCEL",
    "Brdf",
    "Buffer",
    "Cancelled",
    "Context",
    "DeviceError",
    "Environment",
    "Error",
    "FileError",
    "FormatError",
    "Frame",
    "FrameStats",
    "InternalError",
    "InvalidArgument",
    "InvalidHandle",
    "InvalidType",
    "LimitError",
    "Mesh",
    "MeshStats",
    "OutOfMemory",
    "Scene",
    "Setting",
    "Settings",
    "StateError",
    "Sun",
    "__version__",
    "buffer_names",
    "builtin_materials",
    "errors",
    "settings",
]
