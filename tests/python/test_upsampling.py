"""Every interpolated pixel shows its parents weighted as section 3.2 says: an oracle in double precision, of public arrays alone."""

import numpy as np
import pytest

from support import rendered

SIDE, EYE = 96, np.array([0.0, 0.0, 2.0])
CHORD_SLOPE = CENTRE_TOLERANCE = 0.25  # shaders/parents.glsl, as least_weight
LEAST_WEIGHT = 1e-30
CORNERS = np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]])  # rows, columns
PARTS = {"g_a", "g_z", "material"}
EPSILON = 2.0**-23  # of float


def torus(shared, scene):
    """Curved, from its near side to its silhouettes; levels vary over it."""
    scene.add(shared.builtin_mesh("torus"), shared.ggx(0.4, (0.9, 0.7, 0.4)), [[1.4, 0, 0, 0], [0, 0.8, -1.1, 0], [0, 1.1, 0.8, 0]])
    return 0, 1, 0


def floor(shared, scene):
    """Seen flat by a camera that lies on its side, so that weights differ along a diagonal; two instances meet along another."""
    material = shared.lambert((0.9, 0.8, 0.7))
    for x in (-2, 2):
        turned = [[4 * 0.88, 8 * 0.48, 0, 0.88 * x], [0, 0, -4, -0.4], [-4 * 0.48, 8 * 0.88, 0, -0.48 * x]]
        scene.add(shared.builtin_mesh("plane"), material, turned)
    return 1, 0.4, 0


def shown_by(shared, environment, build, coarsest_level):
    """One random sample a pixel: noise sets neighbours apart, so that weights show. Returns the picture's axes, down and right, too."""
    scene = shared.scene()
    scene.environment = environment
    up = build(shared, scene)
    scene.camera(EYE, (0, 0, 0), up, 0.6)
    frame = rendered(shared, scene, SIDE, SIDE, bandwidth_scale=0.2, coarsest_level=coarsest_level, samples=1,
                     sampler="brdf", sequence="random")
    right = np.cross(-EYE, up)
    down = np.cross(-EYE, right)
    return frame, np.stack([down / np.linalg.norm(down), right / np.linalg.norm(right)], 1)


def parents_of(frame, axes, parts):
    """Of the interpolated pixels: where they are, the spacing to their parents, where those are, their weights before normalisation, what
    part of itself floats may take a weight off by, and whether enough parents stand evenly around."""
    position, normal, material = (frame.buffer(name).astype(float) for name in ("position", "normal", "material"))
    at = np.argwhere((material > 0) & (frame.shaded == 0))
    bits = at[:, 0] | at[:, 1]
    spacing = bits & -bits
    odd = at & spacing[:, None]
    offset = CORNERS * odd[:, None]
    parent = at[:, None] + offset
    meant = ~((CORNERS > 0) & (odd == 0)[:, None]).any(-1)  # midway between two, each of them once
    exists = meant & (parent < SIDE).all(-1)
    here, there = tuple(at.T), tuple(np.where(exists[..., None], parent, at[:, None]).transpose(2, 0, 1))
    if "material" in parts:
        exists &= material[there] == material[here][:, None]

    chord, to_eye = position[there] - position[here][:, None], EYE - position[here]
    length, distance = np.maximum(np.linalg.norm(chord, axis=-1), LEAST_WEIGHT), np.linalg.norm(to_eye, axis=-1)
    slope = np.maximum(*(np.abs(np.sum(chord * n, -1)) for n in (normal[here][:, None], normal[there]))) / length / CHORD_SLOPE
    g_z = exists * (np.exp(-(slope**2)) if "g_z" in parts else 1)
    cosine = np.sum(normal[here] * to_eye, -1) / distance
    axis = normal[here] @ axes / np.linalg.norm(normal[here] @ axes, axis=-1, keepdims=True)
    steps = offset / np.exp2(frame.level[here])[:, None, None]  # of the pixel's own spacing
    flat = np.sum(steps * axis[:, None], -1) ** 2 * (1 / cosine**2 - 1)[:, None]
    weight = g_z * (np.maximum(np.exp(-flat), LEAST_WEIGHT) if "g_a" in parts else 1)

    # Each end of a chord is off by EPSILON of its distance from the eye, and by half of that in the array; rise and length by as much. The
    # cosine is off by 4 EPSILON (shaders/gbuffer.frag), the axis by 2 / sin; times the derivatives of 1 / cos^2 and along^2. exp errs by
    # 3 + 2 |x| units (GLSL 4.50, 4.7.1), the rounding of its argument by no more.
    float_error = 2 * slope * 6 * EPSILON * distance[:, None] / length / CHORD_SLOPE
    float_error += 12 * EPSILON * np.sum(steps**2, -1) / cosine[:, None] ** 3 + EPSILON * (6 + 4 * (slope**2 + flat))
    centre = np.linalg.norm(np.sum(weight[..., None] * offset, 1), axis=-1) / spacing / weight.sum(1)
    slack = 1 + float_error[weight > 0].max()
    balanced = (g_z.sum(1) * slack >= 0.5 * meant.sum(1)) & (centre <= CENTRE_TOLERANCE * slack)
    return at, spacing, there, weight, float_error, balanced


def mismatch(frame, parents):
    """By how much pixels differ from what their parents say, in units of what rounding explains."""
    at, _, there, weight, float_error, _ = parents
    color = frame.color[..., :3].astype(float)
    weight = (weight / weight.sum(1, keepdims=True))[..., None]
    mean = np.sum(weight * color[there], 1)
    apart = np.abs(color[there] - mean[:, None])
    # Weights are kept in 16 bits and then divided by their sum: an error of one moves the mean by that of its parent's distance from it.
    off = np.sum((0.5 / 65535 * (weight > 0) + weight * float_error[..., None]) * apart, 1)
    return np.abs(color[tuple(at.T)] - mean) / np.maximum(off + 8 * EPSILON * mean, LEAST_WEIGHT)  # 4 products and their sum


@pytest.mark.parametrize("coarsest_level", [1, 3])
@pytest.mark.parametrize("build, shown", [(torus, {"g_a", "g_z"}), (floor, {"g_a", "material"})])
def test_an_interpolated_pixel_shows_its_weighted_parents(shared, environment, build, shown, coarsest_level):
    frame, axes = shown_by(shared, environment, build, coarsest_level)
    parents = at, spacing, there, weight, _, balanced = parents_of(frame, axes, PARTS)
    for level in range(coarsest_level):
        assert (spacing == 2**level).sum() > 20
    assert spacing.max() < 2**coarsest_level
    # Neither a parent, nor a pixel of the blocks between them, asks for a finer spacing than theirs, twice that to the pixel.
    allowed, unseen = 2.0**frame.level, frame.material == 0
    assert (allowed[there] > spacing[:, None])[weight > 0].all()
    for step in np.ndindex(8, 8):
        near = at + step - 4
        between = ((near >= at - spacing[:, None]) & (near < at + spacing[:, None]) & (near >= 0) & (near < SIDE)).all(-1)
        place = tuple(near[between].T)
        assert ((allowed[place] > spacing[between]) | unseen[place]).all()
    assert balanced.all()
    assert mismatch(frame, parents).max() <= 1
    for part in shown:  # and an oracle that leaves one out is found wrong
        assert mismatch(frame, parents_of(frame, axes, PARTS - {part})).max() > 10
