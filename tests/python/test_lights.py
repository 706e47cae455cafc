"""Scenes of any number of lights, none included."""

import numpy as np
import pytest

import lightband
from test_method import LUMINANCE


@pytest.fixture(scope="module")
def materials(context):
    """Made once each: prediction analyses a lobe when it first meets it, which takes a second."""
    made = {}

    def material(kind, *arguments):
        if (kind, arguments) not in made:
            made[kind, arguments] = getattr(context, kind)(*arguments)
        return made[kind, arguments]

    return material


def scene_of(context, *brdfs, camera=(0.3, 0.2, 1.6)):
    scene = context.scene()
    for k, brdf in enumerate(brdfs):
        scene.add(context.builtin_mesh("sphere", 48), brdf, [[0.7, 0, 0, 0.5 * k], [0, 0.7, 0, 0], [0, 0, 0.7, 0]])
    scene.camera(camera, (0, 0, 0))
    return scene


@pytest.mark.parametrize("settings", [{}, {"target_error": 0.05}, {"method": "reference"}, {"sampler": "combined", "accumulate": 3},
                                      {"background": "environment"}])
def test_a_scene_without_light_is_black(context, materials, settings):
    frame = context.frame(48, 48, **settings)
    frame.render(scene_of(context, materials(*MATTE), materials(*GLOSSY)))
    assert frame.stats.covered_pixels > 300
    assert not frame.color[..., :3].any()
    assert (frame.color[..., 3] == (frame.material > 0)).all()
    assert frame.stats.error == 0 and frame.stats.samples == 0
    for name in ("error", "shaded", "sample_count", "variance_measured", "depth", "position", "normal"):
        values = getattr(frame, name)
        assert np.isfinite(values[frame.material > 0]).all()
    assert not frame.error.any() and not frame.shaded.any()
    if settings.get("method") != "reference":
        inside = (frame.material > 0) & (frame.bandwidth_image < 0.5)  # beside an edge the surface is not known
        assert inside.any() and not frame.bandwidth_image[inside].any()
        assert np.median(frame.curvature[inside]) == pytest.approx(1 / 0.35, rel=0.05)
        assert np.isfinite(frame.level_pyramid).all() and np.isfinite(frame.variance_pyramid).all()
    for absent in ("environment", "probe", "audit", "classify", "shade", "background"):
        assert absent not in frame.plan


TOWARDS = np.array([0.6, 0.35, 0.72]) / np.linalg.norm([0.6, 0.35, 0.72])
ALBEDO = np.array([0.8, 0.5, 0.3])
MATTE, GLOSSY = ("lambert", tuple(ALBEDO)), ("ggx", 0.2, (1, 0.9, 0.5))
SUNLIGHT = np.array([3, 2, 1])


def rendered(context, scene, side=64, **settings):
    frame = context.frame(side, side, **settings)
    frame.render(scene)
    return frame


def difference(frame, true):
    """Root mean square over the covered pixels, relative as in docs/conventions.md. true: RGB of each covered pixel."""
    got, true = frame.color[frame.material > 0][:, :3] @ LUMINANCE, true @ LUMINANCE
    return np.sqrt(np.mean(((got - true) / (true + 0.01 * true.mean())) ** 2))


WAYS = [{"target_error": 0.02}, {"samples": 32}, {"sampler": "combined", "samples": 64}, {"method": "reference", "samples": 64},
        {"sequence": "random", "samples": 64, "variance": "printed", "coarsest_level": 0}]


@pytest.mark.parametrize("settings", WAYS)
@pytest.mark.parametrize("radius", [1e-4, 0.004652, 0.2, np.pi / 2])
def test_a_matte_sphere_in_the_sun(context, materials, settings, radius):
    """Where the disc is above the horizon as a whole: albedo / pi times irradiance times the cosine. A disc of a quarter turn is a
    hemisphere; the view factor of a plane that is tilted against it is (1 + cosine) / 2."""
    scene = scene_of(context, materials(*MATTE))
    scene.add_light(context.sun(TOWARDS, SUNLIGHT, radius))
    frame = rendered(context, scene, **settings)
    cosine = frame.normal[frame.material > 0].astype(float) @ TOWARDS
    seen = 0.5 * (1 + cosine) if radius > 1.5 else np.maximum(cosine, 0)
    clear = np.abs(cosine) > (0 if radius > 1.5 else np.sin(radius))
    true = np.where(clear, seen, 0)[:, None] * ALBEDO / np.pi * SUNLIGHT
    got = frame.color[frame.material > 0][:, :3]
    assert clear.mean() > 0.8
    error = (got - true)[clear] @ LUMINANCE / (true[clear] @ LUMINANCE + 0.01 * (true @ LUMINANCE).mean())
    assert np.sqrt(np.mean(error**2)) <= 1.5 * max(settings.get("target_error", frame.stats.error), 0.005)
    np.testing.assert_allclose(got[clear].mean(0), true[clear].mean(0), rtol=0.01)
    below = cosine < -np.sin(radius)
    assert np.abs(got[below]).max(initial=0) <= 0.02 * true.max()
    if "target_error" in settings:
        assert frame.stats.error <= settings["target_error"]


def test_a_plane_in_the_sun(context, materials):
    """All of its pixels see the same; over half a degree, the cosine varies by less than a hundredth around its mean, which stratified
    samples meet far closer."""
    scene = context.scene()
    scene.add(context.builtin_mesh("plane", 16), materials(*MATTE))
    scene.camera((0.2, 0.1, 2), (0, 0, 0))
    scene.add_light(context.sun(TOWARDS, SUNLIGHT))
    frame = rendered(context, scene, samples=64)
    true = ALBEDO / np.pi * SUNLIGHT * TOWARDS[2]
    np.testing.assert_allclose(frame.color[frame.material > 0][:, :3], np.broadcast_to(true, (frame.stats.covered_pixels, 3)), rtol=1e-3)


def quadrature(brdf, frame, eye, direction, radius, irradiance):
    """What each covered pixel shows, by midpoints of 24 x 48 cells of the disc, even in solid angle; in double precision."""
    seen = frame.material > 0
    normal = frame.normal[seen].astype(float)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    to_eye = np.asarray(eye) - frame.position[seen]
    to_eye /= np.linalg.norm(to_eye, axis=1, keepdims=True)
    tangent = np.cross(normal, to_eye)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    frames = np.stack([tangent, np.cross(normal, tangent), normal], 1)
    down, turn = np.meshgrid((np.arange(24) + 0.5) / 24 * (1 - np.cos(radius)), (np.arange(48) + 0.5) / 48 * 2 * np.pi)
    across = np.linalg.svd(direction[None])[2][1:]
    sine = np.sqrt(down * (2 - down))
    points = ((1 - down)[..., None] * direction + (sine * np.cos(turn))[..., None] * across[0] + (sine * np.sin(turn))[..., None] * across[1]).reshape(-1, 3)
    true = np.zeros((len(normal), 3))
    wo = np.einsum("pij,pj->pi", frames, to_eye)
    for point in points:
        wi = frames @ point
        true += brdf.evaluate(wi, wo) * np.maximum(wi[:, 2:], 0)
    return true / len(points) * 2 * np.pi * (1 - np.cos(radius)) * irradiance / (np.pi * np.sin(radius) ** 2)


@pytest.mark.parametrize("settings", [{"target_error": 0.05}, {"sampler": "brdf", "samples": 256}, {"method": "reference", "samples": 256}])
@pytest.mark.parametrize("radius", [0.004652, 0.1])
@pytest.mark.parametrize("alpha", [0.5, 0.1, 0.02])
def test_a_glossy_sphere_in_the_sun(context, materials, alpha, radius, settings):
    brdf = materials("ggx", alpha, (1, 0.8, 0.6))
    scene = scene_of(context, brdf)
    scene.add_light(context.sun(TOWARDS, SUNLIGHT, radius))
    frame = rendered(context, scene, 48, **settings)
    true = quadrature(brdf, frame, (0.3, 0.2, 1.6), TOWARDS, radius, SUNLIGHT)
    assert difference(frame, true) <= 1.5 * 0.05
    if "target_error" in settings:
        assert frame.stats.error <= settings["target_error"]


@pytest.mark.parametrize("settings", [{"samples": 256}, {"method": "reference", "samples": 256}])
def test_a_mirror_shows_the_disc(context, materials, settings):
    """Of a plane with alpha = 1e-4, every pixel whose ray is mirrored into the disc shows its radiance times the reflectance."""
    scene = context.scene()
    scene.add(context.builtin_mesh("plane", 16), materials("ggx", 1e-4, 1))
    eye = np.array([0.0, 0.0, 2.0])
    scene.camera(eye, (0, 0, 0))
    scene.add_light(context.sun((0, 0, 1), 1, 0.1))
    frame = rendered(context, scene, **settings)
    seen = frame.material > 0
    along = frame.position[seen] - eye
    sine = np.hypot(along[:, 0], along[:, 1]) / np.linalg.norm(along, axis=1)
    got = frame.color[seen][:, 0] * np.pi * np.sin(0.1) ** 2
    inside, outside = sine < np.sin(0.1) - 0.01, sine > np.sin(0.1) + 0.01
    assert inside.sum() > 50
    np.testing.assert_allclose(got[inside], 1, atol=0.05)  # of samples in the lobe's tail, some miss the disc
    assert got[inside].mean() == pytest.approx(1, abs=0.005)
    assert got[outside].mean() < 0.001


@pytest.mark.parametrize("sampler", ["cut", "combined", "filtered", "brdf"])
def test_lights_add_up(context, materials, sampler):
    """Pictures under two suns and a map are the sum of those under each."""
    rng = np.random.default_rng(1)
    environment = context.environment(rng.uniform(0, 2, (16, 32, 3)))
    suns = [context.sun(TOWARDS, SUNLIGHT), context.sun((-0.4, 0.8, 0.3), (1, 2, 4), 0.1)]
    pictures = []
    for lights in ((0, 1, 2), (0,), (1,), (2,)):
        scene = scene_of(context, materials(*MATTE), materials(*GLOSSY))
        if 0 in lights:
            scene.environment = environment
        for k in (1, 2):
            if k in lights:
                scene.add_light(suns[k - 1])
        pictures.append(rendered(context, scene, 64, sampler=sampler, samples=1024, coarsest_level=0))
    seen = pictures[0].material > 0
    assert difference(pictures[0], sum(picture.color[seen][:, :3] for picture in pictures[1:])) <= 0.02


def test_the_world_turns(context, materials):
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    pictures = []
    for rotation in (np.eye(3), turn):
        scene = context.scene()
        scene.add(context.builtin_mesh("blob", 64), materials(*GLOSSY), np.hstack([rotation, np.zeros((3, 1))]))
        scene.camera(rotation @ (0.3, 0.2, 1.6), (0, 0, 0), up=rotation @ (0, 1, 0))
        scene.add_light(context.sun(rotation @ TOWARDS, SUNLIGHT))
        pictures.append(rendered(context, scene, 64, samples=256, coarsest_level=0))
    both = (pictures[0].material > 0) & (pictures[1].material > 0)
    one, other = (picture.color[both][:, :3] @ LUMINANCE for picture in pictures)
    assert np.median(np.abs(one - other) / (one + 0.01 * one.mean())) < 0.01
    assert one.mean() == pytest.approx(other.mean(), rel=0.01)


def test_a_disc_in_a_map_is_a_sun(context, materials):
    """A disc that is painted into a map of texels much smaller than itself lights a matte sphere as a sun of its irradiance does."""
    height, radius = 512, 0.1
    latitude, longitude = np.pi * (0.5 - (np.arange(height) + 0.5) / height)[:, None], np.pi * (1 - (np.arange(2 * height) + 0.5) / height)
    directions = np.stack([np.cos(latitude) * np.sin(longitude), np.sin(latitude) + 0 * longitude, np.cos(latitude) * np.cos(longitude)], -1)
    disc = directions @ TOWARDS > np.cos(radius)
    facing = (np.maximum(directions @ TOWARDS, 0) * np.cos(latitude) * disc).sum() * (np.pi / height) ** 2
    scene = scene_of(context, materials(*MATTE))
    scene.environment = context.environment(np.repeat(disc[..., None], 3, -1) * np.array([2.0, 1, 1]))
    painted = rendered(context, scene, target_error=0.01)
    scene = scene_of(context, materials(*MATTE))
    scene.add_light(context.sun(TOWARDS, np.array([2.0, 1, 1]) * facing, radius))
    sun = rendered(context, scene, target_error=0.01)
    assert difference(sun, painted.color[painted.material > 0][:, :3]) <= 0.02


def test_the_background_shows_the_disc(context):
    scene = context.scene()
    scene.camera((0, 0, 0), -TOWARDS)
    scene.add_light(context.sun(-TOWARDS, (1, 2, 3), 0.1))
    frame = rendered(context, scene, 64, background="environment")
    shown = frame.color[..., 0] > 0
    np.testing.assert_allclose(frame.color[shown][:, :3], np.broadcast_to(np.array([1, 2, 3]) / (np.pi * np.sin(0.1) ** 2), (shown.sum(), 3)), rtol=1e-5)
    pixel = 2 * np.tan(0.35) / 64  # of the plane at distance 1
    assert shown.sum() * pixel**2 == pytest.approx(np.pi * np.tan(0.1) ** 2, rel=0.1)


def test_a_sun_moves_and_goes(context, materials):
    scene = scene_of(context, materials(*MATTE))
    sun = context.sun(TOWARDS, 1)
    scene.add_light(sun)
    first = rendered(context, scene, 32).color
    sun.set((-1, 0, 0), 1)
    moved = rendered(context, scene, 32).color
    assert np.abs(moved - first).max() > 0.1
    sun.set(TOWARDS, 1)
    assert (rendered(context, scene, 32).color == first).all()
    scene.remove_light(sun)
    assert not rendered(context, scene, 32).color[..., :3].any()


@pytest.mark.parametrize("count", [1, 40, 300])
def test_many_suns(context, materials, count):
    """Software renderers end loops after 65,535 iterations: a pixel's samples times its lights may be more."""
    rng = np.random.default_rng(2)
    scene = context.scene()
    scene.add(context.builtin_mesh("plane", 8), materials(*MATTE))
    scene.camera((0, 0, 8), (0, 0, 0))
    heights = rng.uniform(0.3, 1, count)
    for height in heights:
        scene.add_light(context.sun((0, np.sqrt(1 - height**2), height), 1 / count))
    frame = rendered(context, scene, 8, samples=8192, coarsest_level=0)
    np.testing.assert_allclose(frame.color[frame.material > 0][:, 0], heights.mean() * 0.8 / np.pi, rtol=1e-3)
    assert (frame.sample_count[frame.material > 0] == 8192).all()


@pytest.mark.parametrize("scale", [1e-20, 1e8])
def test_suns_of_any_brightness_beside_any_map(context, materials, scale):
    scene = scene_of(context, materials(*MATTE), materials(*GLOSSY))
    scene.environment = context.environment(np.ones((8, 16, 3)))
    scene.add_light(context.sun(TOWARDS, scale))
    frame = rendered(context, scene, 32, target_error=0.05)
    assert np.isfinite(frame.color).all() and np.isfinite(frame.variance_predicted).all() and frame.stats.error <= 0.05


@pytest.mark.parametrize("arguments, message", [
    ({"direction": (0, 0, 0)}, r"direction is \(0, 0, 0\)"),
    ({"direction": (np.nan, 0, 1)}, "direction"),
    ({"angular_radius": 9e-5}, "angular_radius is 9.*e-05; it must be 0.0001"),
    ({"angular_radius": 1.58}, "angular_radius is 1.58.*pi / 2"),
    ({"angular_radius": -0.1}, "angular_radius is -0.1"),
    ({"angular_radius": 0}, "angular_radius is 0"),
    ({"irradiance": (1, -1, 1)}, r"irradiance\[1\] is -1; it must be 0 .. "),
    ({"irradiance": (1, 1, np.inf)}, "irradiance"),
    ({"irradiance": 1e12}, r"irradiance\[0\] is .*e\+11; it must be 0 .. 6.79"),
])
def test_what_is_no_sun_is_refused(context, materials, arguments, message):
    with pytest.raises(lightband.InvalidArgument, match=message):
        context.sun(**{"direction": (0, 1, 0), "irradiance": 1, **arguments})
    sun = context.sun((0, 1, 0), 1)
    scene = scene_of(context, materials(*MATTE))
    scene.add_light(sun)
    before = rendered(context, scene, 16).color
    with pytest.raises(lightband.InvalidArgument, match=message):
        sun.set(**{"direction": (0, 1, 0), "irradiance": 1, **arguments})
    assert (rendered(context, scene, 16).color == before).all()


def test_a_light_is_in_a_scene_once(context):
    scene, sun = context.scene(), context.sun((0, 1, 0), 1)
    with pytest.raises(lightband.InvalidArgument, match="not in the scene"):
        scene.remove_light(sun)
    scene.add_light(sun)
    with pytest.raises(lightband.InvalidArgument, match="already"):
        scene.add_light(sun)
    with lightband.Context(device="software", cache_path="") as other, pytest.raises(lightband.InvalidArgument, match="another context"):
        scene.add_light(other.sun((0, 1, 0), 1))


def test_nothing_is_interpolated_across_the_terminator(shared):
    """A pixel of the finest sample grid lies midway between two or four coarser neighbours. Where it is interpolated, a sun is above the
    horizon of all of them as a whole, or below all: its half angle decides what is between."""
    towards_sun = np.array([0.8, 0.5, 0.2]) / np.linalg.norm([0.8, 0.5, 0.2])
    scene = shared.context.scene()
    scene.camera(eye=(0, 0.3, 1.8), target=(0, 0, 0))
    scene.add(shared.builtin_mesh("sphere"), shared.lambert(0.5))
    scene.environment = shared.context.environment(np.full((4, 8, 3), 0.05, np.float32))
    scene.add_light(shared.context.sun(direction=towards_sun, irradiance=(3, 3, 3)))
    frame = shared.context.frame(128, 128, target_error=0.1)
    frame.render(scene)
    sine = frame.normal.astype(np.float64) @ towards_sun
    side = np.where(frame.material == 0, np.nan, np.where(sine > np.sin(0.004652), 1, np.where(sine < -np.sin(0.004652), -1, 0)))
    interpolated = (frame.material > 0) & (frame.shaded == 0)
    beside = 0
    for y, x in np.argwhere(interpolated[1:-1, 1:-1]) + 1:
        if x % 2 == 0 and y % 2 == 0:
            continue
        neighbours = side[[y - y % 2, y + y % 2]][:, [x - x % 2, x + x % 2]]
        known = neighbours[~np.isnan(neighbours)]
        assert (known == side[y, x]).all() and side[y, x] != 0, f"pixel {x}, {y}"
        beside += bool(side[y, x] != side[y - 3 : y + 4, x - 3 : x + 4].max())
    assert interpolated.sum() > 3000 and beside > 20  # there are such pixels near the terminator
