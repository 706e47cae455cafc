"""Types of the extension module, with its docstrings."""

from collections.abc import Callable, Iterable
from os import PathLike
from types import TracebackType
from typing import Literal, Self, SupportsFloat, SupportsIndex, TypeAlias, TypedDict, Unpack, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._records import FrameStats, MeshStats, Setting, Settings

_Path: TypeAlias = str | bytes | PathLike[str] | PathLike[bytes]
_Floats: TypeAlias = NDArray[np.float32]
_Bytes: TypeAlias = NDArray[np.uint8]
_Progress: TypeAlias = Callable[[float], object]

# The names in lightband.settings(), by type.
_Integer: TypeAlias = Literal["samples", "max_samples", "coarsest_level", "pilots", "seed", "accumulate"]
_Real: TypeAlias = Literal["target_error", "time_budget", "bandwidth_scale"]
_Choice: TypeAlias = Literal[
    "method",
    "transport",
    "band_rule",
    "variance",
    "allocation",
    "sampler",
    "sequence",
    "brdf_lookup",
    "environment_lookup",
    "split_suns",
    "background",
    "pass_times",
]

class _Settings(TypedDict, total=False):
    method: Literal["adaptive", "reference"]
    target_error: SupportsFloat
    time_budget: SupportsFloat
    samples: SupportsFloat
    max_samples: SupportsFloat
    bandwidth_scale: SupportsFloat
    coarsest_level: SupportsFloat
    pilots: SupportsFloat
    transport: Literal["correlated", "box"]
    band_rule: Literal["energy", "sum"]
    variance: Literal["moments", "printed"]
    allocation: Literal["least_error", "constant_variance"]
    sampler: Literal["cut", "combined", "filtered", "brdf"]
    sequence: Literal["lattice", "random"]
    brdf_lookup: Literal["nearest", "linear"]
    environment_lookup: Literal["linear", "nearest"]
    split_suns: Literal["on", "off"]
    background: Literal["none", "environment"]
    seed: SupportsFloat
    accumulate: SupportsFloat
    pass_times: Literal["off", "on"]

__version__: str

def settings() -> tuple[Setting, ...]:
    """The settings of a frame: a tuple of Setting, in the library's order."""
def builtin_materials() -> tuple[str, ...]:
    """Names for Context.builtin_brdf."""
def buffer_names() -> tuple[str, ...]:
    """Names for Frame.buffer and Frame.save."""

class Context:
    """One OpenGL device, without a window; everything else is made by it.

    device: "hardware" (a GPU; DeviceError where there is none), "software" (the CPU) or "any" (a GPU, else the CPU;
        is_software tells which it became). Software rendering is never a silent fallback.
    cache_path: folder for the tables of built-in materials (35 MB each). None: the user's cache folder. "": no cache.
    log: called with each message of driver and library. It must not call the library; what it raises is reported to
        sys.unraisablehook. None: silence. The context and all that is made by it keep the callable alive, in a way that
        the garbage collector sees: it may be a method of the object that holds the context.

    Calls on objects of one context wait for each other; objects of different contexts are independent.
    """

    def __init__(
        self,
        device: Literal["hardware", "software", "any"] = "hardware",
        cache_path: _Path | None = None,
        log: Callable[[str], object] | None = None,
    ) -> None:
        """Opens the device; the class says what the arguments mean."""
    def close(self) -> None:
        """Releases the handle now instead of when the object is collected.

        Calls on it then raise InvalidHandle; objects made from it live on.
        """
    def __enter__(self) -> Self:
        """The object itself."""
    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Closes the object."""
    @property
    def device_name(self) -> str:
        """Renderer and version, as the driver names them."""
    @property
    def is_software(self) -> bool:
        """Whether the device is a software renderer."""
    def load_brdf(self, path: _Path, fill_unmeasured: bool = True) -> Brdf:
        """A measured reflectance from a MERL .binary file.

        fill_unmeasured: cells that were not measured are filled from the measured cells of the same theta_half and
        phi_diff, towards grazing with the last of them; the log callback hears how many. False: they reflect nothing.
        Raises FileError when the file cannot be read, FormatError when it is no MERL file.
        """
    def builtin_brdf(self, name: str) -> Brdf:
        """A material that the library computes itself.

        lightband.builtin_materials() lists the names. Computed at first use (about a second), then kept in the cache
        folder.
        """
    def table_brdf(self, table: ArrayLike) -> Brdf:
        """A measured reflectance from an array.

        table: 90 x 90 x 180 x 3 values in 1/steradian, cells (theta_half [quadratic], theta_diff, phi_diff) as in a
        MERL file, RGB last. A cell with a negative value was not measured and reflects nothing. Copied.
        """
    def lambert(self, albedo: ArrayLike) -> Brdf:
        """A diffuse reflectance, albedo / pi.

        albedo: RGB or one number for all three, each in [0, 1].
        """
    def ggx(self, alpha: SupportsFloat, f0: ArrayLike) -> Brdf:
        """A reflectance of GGX microfacets (Walter et al. 2007).

        alpha: roughness squared, in [1e-4, 1].
        f0: reflectance at normal incidence, RGB or one number for all three, each in [0, 1].
        """
    def load_environment(self, path: _Path) -> Environment:
        """Distant light from an OpenEXR or Radiance file.

        A latitude-longitude map: +Y is up, the centre looks along +Z, the left edge along -Z.
        """
    def environment(self, radiance: ArrayLike) -> Environment:
        """Distant light from an array.

        radiance: height x width x 3, linear RGB, rows top-down; laid out as in load_environment. Copied.
        """
    def sun(self, direction: ArrayLike, irradiance: ArrayLike, angular_radius: SupportsFloat | None = None) -> Sun:
        """A disc of uniform radiance, infinitely far away.

        direction: towards the sun, in world space, of any length but zero.
        irradiance: RGB, or one number for all three: of a surface that faces the sun, in units of radiance times steradian. It is
            the radiance of the disc times pi sin^2(angular_radius).
        angular_radius: radians, 1e-4 to pi / 2; None: 0.004652, that of the sun seen from the earth.
        Scene.add_light puts it into a scene.
        """
    def mesh(
        self,
        positions: ArrayLike,
        indices: ArrayLike,
        normals: ArrayLike | None = None,
        texcoords: ArrayLike | None = None,
    ) -> Mesh:
        """Triangles from arrays, copied.

        positions: vertices x 3, metres.
        indices: triangles x 3, whole numbers below the number of vertices.
        normals: vertices x 3; None: computed, area-weighted.
        texcoords: vertices x 2; None: none.
        """
    def builtin_mesh(self, name: str, resolution: SupportsIndex = 0) -> Mesh:
        """A computed shape about one metre across: "sphere", "plane", "torus", "knot" or "blob".

        resolution: segments around, 8 to 2048; 0: 256.
        """
    def scene(self) -> Scene:
        """An empty scene."""
    def frame(self, width: SupportsIndex, height: SupportsIndex, **settings: Unpack[_Settings]) -> Frame:
        """A picture of width x height pixels, each 1 to 8192.

        Keywords are settings: context.frame(512, 512, samples=64). lightband.settings() lists them.
        """

class Brdf:
    """A reflectance, in 1/steradian.

    Made by Context.load_brdf, builtin_brdf, table_brdf, lambert and ggx.
    """

    def close(self) -> None:
        """Releases the handle now instead of when the object is collected.

        Calls on it then raise InvalidHandle; objects made from it live on.
        """
    def __enter__(self) -> Self:
        """The object itself."""
    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Closes the object."""
    @property
    def table(self) -> _Floats:
        """float32, 90 x 90 x 180 x 3: 1/steradian, cells (theta_half, theta_diff, phi_diff).

        Raises StateError for a reflectance that has no table.
        """
    @property
    def bandwidth(self) -> _Floats:
        """float32, 32 x 64 x 64: cycles/radian of the lobe, 1e9 where unbounded.

        First axis: views in steps of cos(theta_o); then the square of incident directions (docs/conventions.md).
        """
    def evaluate(self, wi: ArrayLike, wo: ArrayLike) -> _Floats:
        """The value for directions to the light and to the eye.

        wi, wo: arrays of shape (..., 3) in the local frame, +Z the normal; broadcast against each other.
        Returns RGB in 1/steradian, shape (..., 3); zero below the horizon. Nearest cell of a table.
        """
    def albedo(self, theta_o: ArrayLike) -> _Floats:
        """Directional albedo: the part of the light that is reflected.

        theta_o: angle of the view to the normal, radians in [0, pi/2), a number or an array.
        Returns RGB, shape theta_o.shape + (3,).
        """

class Environment:
    """Distant light. Made by Context.load_environment and Context.environment."""

    def close(self) -> None:
        """Releases the handle now instead of when the object is collected.

        Calls on it then raise InvalidHandle; objects made from it live on.
        """
    def __enter__(self) -> Self:
        """The object itself."""
    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Closes the object."""
    @property
    def radiance(self) -> _Floats:
        """float32, height x width x 3: linear RGB as loaded, rows top-down."""
    @property
    def bandwidth(self) -> _Floats:
        """float32, size x size: cycles/radian per direction, on the octahedral square (docs/conventions.md).

        It ends at what its texels, or the map's, can show.
        """

class Sun:
    """A disc of uniform radiance, infinitely far away. Made by Context.sun."""

    def close(self) -> None:
        """Releases the handle now instead of when the object is collected.

        Calls on it then raise InvalidHandle; objects made from it live on.
        """
    def __enter__(self) -> Self:
        """The object itself."""
    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Closes the object."""
    def set(self, direction: ArrayLike, irradiance: ArrayLike, angular_radius: SupportsFloat | None = None) -> None:
        """Moves and changes the sun; see Context.sun.

        Scenes that it is in show it when they are rendered next.
        """

class Mesh:
    """Triangles. Made by Context.mesh and Context.builtin_mesh."""

    def close(self) -> None:
        """Releases the handle now instead of when the object is collected.

        Calls on it then raise InvalidHandle; objects made from it live on.
        """
    def __enter__(self) -> Self:
        """The object itself."""
    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Closes the object."""
    @property
    def stats(self) -> MeshStats:
        """Counts and bounds, a MeshStats."""

class Scene:
    """Meshes with their materials, one environment, other lights, one camera.

    Made by Context.scene. It needs a camera before it can be rendered; it may have no mesh and no light, where it is black.
    """

    def close(self) -> None:
        """Releases the handle now instead of when the object is collected.

        Calls on it then raise InvalidHandle; objects made from it live on.
        """
    def __enter__(self) -> Self:
        """The object itself."""
    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Closes the object."""
    @property
    def environment(self) -> Environment | None:
        """The distant light; None before it was set."""
    @environment.setter
    def environment(self, environment: Environment) -> None: ...
    def add(self, mesh: Mesh, brdf: Brdf, transform: ArrayLike | None = None, double_sided: bool = True) -> int:
        """Adds a mesh with its material; returns the instance's number, counted from 0.

        transform: object to world, a 3x4 or 4x4 affine matrix; None: identity.
        double_sided: False: only the front of its triangles is drawn, from which their vertices run counter-clockwise
            in the mesh's own space; a mirroring transform does not change which side that is. Of a closed surface that is
            wound outwards, seen from outside and not cut by the near plane nobody sees the back; about half of its
            triangles are then not drawn.
        The array frame.material holds the number plus one. At most 254 instances.
        """
    def add_light(self, light: Sun) -> None:
        """Adds a light, a Sun, to those of the scene: at most 1024, each once. The light from all of them and from the environment adds up."""
    def remove_light(self, light: Sun) -> None:
        """Takes a light out of the scene again."""
    def set_transform(self, index: SupportsIndex, transform: ArrayLike) -> None:
        """Replaces the transform of an instance."""
    def set_double_sided(self, index: SupportsIndex, double_sided: bool) -> None:
        """Whether both sides of an instance's triangles are drawn, or only the front: see add."""
    def camera(
        self,
        eye: ArrayLike,
        target: ArrayLike,
        up: ArrayLike | None = None,
        fov_y: SupportsFloat | None = None,
        near_plane: SupportsFloat | None = None,
        far_plane: SupportsFloat | None = None,
    ) -> None:
        """Sets the camera.

        eye, target: points in metres; the target is in the middle of the picture.
        up: a direction, not along the view; None: +Y.
        fov_y: vertical field of view, radians, above 0 and below pi - 0.001; None: 0.7.
        near_plane, far_plane: metres, 1e-30 to 1e30; None: 1e-3 and 1e3 times the distance from eye to target.
        """
    def __len__(self) -> int:
        """The number of instances."""
    def __bool__(self) -> bool:
        """True, also of a scene without instances."""

class Frame:
    """A picture's size and settings; renders scenes and holds their fields.

    Made by Context.frame. Settings are read and written by name: frame["samples"] = 64.

    The fields of the last frame are arrays (frame.color, frame.depth, ...). Rows run top-down; pixels that see no mesh
    hold 0 unless said otherwise. An array is read-only and shows the library's memory without a copy; it stays as it is
    when the frame renders again or is deleted. Each access reads the field back from the device anew: keep the array.
    Equations: Bagher et al. 2013.
    """

    def close(self) -> None:
        """Releases the handle now instead of when the object is collected.

        Calls on it then raise InvalidHandle; objects made from it live on.
        """
    def __enter__(self) -> Self:
        """The object itself."""
    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Closes the object."""
    @property
    def width(self) -> int:
        """Pixels."""
    @property
    def height(self) -> int:
        """Pixels."""
    @property
    def settings(self) -> Settings:
        """The settings as a mapping from name to value; deleting one restores its default."""
    @overload
    def __getitem__(self, name: _Integer) -> int:
        """The value of a setting."""
    @overload
    def __getitem__(self, name: _Real) -> float: ...
    @overload
    def __getitem__(self, name: _Choice) -> str: ...
    @overload
    def __getitem__(self, name: str) -> int | float | str: ...
    @overload
    def __setitem__(self, name: _Integer | _Real, value: SupportsFloat) -> None:
        """Sets a setting: a number or, for a choice, its name."""
    @overload
    def __setitem__(self, name: _Choice, value: str) -> None: ...
    def render(self, scene: Scene, progress: _Progress | None = None) -> None:
        """Renders the scene.

        progress: called between parts of the frame with the fraction of the call's time that has passed, which rises
            from 0 to 1; an estimate where the number of rounds is not known beforehand. When it returns lightband.CANCEL,
            the call raises Cancelled; what it raises, the call raises. Any other value is ignored. It must not call the
            library.

        Other threads run meanwhile, and Ctrl-C raises KeyboardInterrupt at the next part. After any failure the frame
        holds what it held before.
        """
    def plan_for(self, scene: Scene) -> str:
        """What render would do for a scene, as text: one line for each pass.

        Each with the device memory that it fills, its reason, and the buffers that it reads and writes. Nothing runs.
        """
    @property
    def stats(self) -> FrameStats:
        """Counts and times of the last frame, a FrameStats."""
    @property
    def plan(self) -> str:
        """The passes that the last render ran, as text: each with its reason, bytes and invocations.

        Where the setting pass_times is "on", with its milliseconds as well.
        """
    def save(
        self,
        path: _Path,
        fields: str | Iterable[str] | None = None,
        exposure: SupportsFloat = 0.0,
        tone_curve: Literal["none", "filmic"] = "none",
        alpha: Literal["coverage", "opaque"] = "coverage",
    ) -> None:
        """Writes the frame to a file, which is complete or, on any failure, what it was before.

        path: ends in ".exr" (float channels, any fields; settings and statistics as attributes) or ".png" (color alone, as sRGB).
        fields: names, as a sequence or separated by commas; None: color alone.
        The others are for ".png" alone:
        exposure: radiance is multiplied by 2**exposure.
        tone_curve: "none" shows what is above 1 as 1; "filmic" (Hable 2010) lets it fade towards 1 and leaves mid-grey where it is.
        alpha: "coverage" makes a cut-out, in which the background, drawn or not, is transparent; "opaque" shows it.
        """
    def buffer(self, name: str) -> NDArray[np.generic]:
        """A field of the last frame as an array; lightband.buffer_names() lists the names."""
    def pyramid(self, name: str) -> list[NDArray[np.generic]]:
        """A pyramid level by level: a list of views of one array.

        name: "level_pyramid" or "variance_pyramid". Level k has the size of the frame divided by 2**k, rounded up.
        """
    @property
    def color(self) -> _Floats:
        """float32, height x width x 4: radiance RGB (linear, Rec. 709) and coverage (0 or 1)."""
    @property
    def depth(self) -> _Floats:
        """float32, height x width: metres from the eye's plane; infinity where nothing is seen."""
    @property
    def position(self) -> _Floats:
        """float32, height x width x 3: metres, world."""
    @property
    def normal(self) -> _Floats:
        """float32, height x width x 3: unit length, world, towards the eye."""
    @property
    def curvature(self) -> _Floats:
        """float32, height x width: 1/metre, the largest principal curvature in magnitude."""
    @property
    def material(self) -> _Bytes:
        """uint8, height x width: 0 where nothing is seen; else the instance's number plus one."""
    @property
    def bandwidth_spatial(self) -> _Floats:
        """float32, height x width: cycles/metre at the surface (first component of eq. 5)."""
    @property
    def bandwidth_angular(self) -> _Floats:
        """float32, height x width: cycles/radian at the eye (second component of eq. 5)."""
    @property
    def bandwidth_image(self) -> _Floats:
        """float32, height x width: cycles/pixel, at most 0.5 (eq. 6)."""
    @property
    def level(self) -> _Bytes:
        """uint8, height x width: log2 of the spacing at which the pixel may be shaded (eq. 11, Nyquist)."""
    @property
    def shaded(self) -> _Bytes:
        """uint8, height x width: 1 where the integral was computed; 0: interpolated, or nothing seen."""
    @property
    def sample_count(self) -> NDArray[np.uint32]:
        """uint32, height x width: light samples drawn, by one of the frames that are accumulated."""
    @property
    def error(self) -> _Floats:
        """float32, height x width: error of the luminance L that is expected here.

        It is relative to L + 0.01 of the frame's mean L.
        """
    @property
    def variance_predicted(self) -> _Floats:
        """float32, height x width: radiance^2, predicted variance of one light sample's luminance.

        By the setting "variance" (eq. 9 where that is "printed").
        """
    @property
    def variance_measured(self) -> _Floats:
        """float32, height x width: radiance^2, variance of one light sample's luminance, from the samples drawn.

        0 where fewer than two were drawn.
        """
    @property
    def level_pyramid(self) -> _Bytes:
        """uint8, rows x width: the levels' min pyramid, level below level; 255 where nothing is seen.

        pyramid() takes it apart.
        """
    @property
    def variance_pyramid(self) -> _Floats:
        """float32, rows x width: the relative variances' max pyramid, level below level.

        pyramid() takes it apart.
        """

class Buffer:
    """The library's memory of one field.

    The base of every array that the library returns: it keeps the memory alive as long as any array shows it, whatever
    happens to the frame, material or map that it came from, and says what the numbers mean:

        >>> frame.bandwidth_image.base.unit
        '1/pixel'
    """

    @property
    def name(self) -> str:
        """Name of the field."""
    @property
    def unit(self) -> str:
        """Unit of the elements; "" of a pure number."""
