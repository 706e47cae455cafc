"""How few pixels would do: what an oracle that knows the converged picture would shade.

The lattice is the library's (docs/conventions.md, "Levels"): a pixel that is new on the lattice of level l may be interpolated
between its neighbours on that of level l + 1, bilinearly, each neighbour weighed by how well it lies in the pixel's tangent
plane. The oracle leaves unshaded as many pixels as it can, those of least error first, until the picture's relative error
reaches the target. It interpolates between converged values, and so is a bound rather than a rival.
"""
from __future__ import annotations

import numpy as np

import lightband
from measure import DARK_PART

LEVELS = 5  # finest to coarsest at which a pixel can be new: the setting coarsest_level
GUARD_SLOPE = 0.25  # rise over distance at which a neighbour's weight has fallen to 1/e
LEAST_WEIGHT = 0.5  # of the neighbours' mean: with less, the pixel is shaded
MOST_OFFSET = 0.25  # of the spacing, between the pixel and its neighbours' centre: beyond, it would be extrapolated
TINY = 1e-20  # metres, and sums of weights: keeps quotients of zeros finite


class Lattice:
    """Pixels that are new on one level's lattice and see a mesh, and the weights of their neighbours on the next coarser."""

    def __init__(self, material: np.ndarray, position: np.ndarray, normal: np.ndarray, level: int) -> None:
        spacing = 1 << level
        rows, columns = (axis.ravel() for axis in np.mgrid[0:material.shape[0]:spacing, 0:material.shape[1]:spacing])
        odd = np.stack([(rows >> level) & 1, (columns >> level) & 1])
        new = odd.any(axis=0) & (material[rows, columns] > 0)
        self.rows, self.columns, odd = rows[new], columns[new], odd[:, new]
        self.neighbours: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
        total, count, offset = np.zeros(new.sum()), np.zeros(new.sum()), np.zeros((2, new.sum()))
        for sign in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
            step = odd * np.reshape(sign, (2, 1))
            used = np.all((odd == 1) | (np.reshape(sign, (2, 1)) < 0), axis=0)  # an even coordinate has one neighbour, not two
            weight = used * self._weight(material, position, normal, spacing * step)
            self.neighbours.append((*self._at(material.shape, spacing * step), weight))
            total, count, offset = total + weight, count + used, offset + weight * step
        self.guarded = (total >= LEAST_WEIGHT * count) & (np.hypot(*offset) <= MOST_OFFSET * total)
        self.total = np.maximum(total, TINY)

    def _at(self, shape: tuple[int, ...], step: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.clip(self.rows + step[0], 0, shape[0] - 1), np.clip(self.columns + step[1], 0, shape[1] - 1)

    def _weight(self, material: np.ndarray, position: np.ndarray, normal: np.ndarray, step: np.ndarray) -> np.ndarray:
        here, there = (self.rows, self.columns), self._at(material.shape, step)
        inside = (there[0] == self.rows + step[0]) & (there[1] == self.columns + step[1])
        chord = position[there] - position[here]
        rise = np.maximum(abs(np.sum(chord * normal[here], -1)), abs(np.sum(chord * normal[there], -1)))
        slope = rise / np.maximum(np.linalg.norm(chord, axis=-1), TINY)
        return np.exp(-((slope / GUARD_SLOPE) ** 2)) * (inside & (material[there] == material[here]))

    def surplus(self, picture: np.ndarray) -> np.ndarray:
        """Interpolated less true, where it is guarded."""
        sums = sum(weight * picture[rows, columns] for rows, columns, weight in self.neighbours)
        return (sums / self.total - picture[self.rows, self.columns])[self.guarded]


def oracle_fractions(frame: lightband.Frame, a: np.ndarray, b: np.ndarray, targets: list[float]) -> list[float]:
    """Fractions of the covered pixels to shade for the target errors, from two independent converged pictures."""
    material, position, normal = frame.material, frame.position.astype(np.float64), frame.normal.astype(np.float64)
    covered = material > 0
    scale = 0.5 * (a + b)
    scale += DARK_PART * scale[covered].mean()
    squares = []
    for level in range(LEVELS):
        lattice = Lattice(material, position, normal, level)
        here = scale[lattice.rows, lattice.columns][lattice.guarded]
        squares.append(lattice.surplus(a) * lattice.surplus(b) / here**2)  # noise cancels in the product
    ordered = np.concatenate(squares)
    ordered = ordered[np.argsort(abs(ordered))]
    sums = np.maximum.accumulate(np.cumsum(ordered)) / covered.sum()
    return [1 - float(np.searchsorted(sums, target**2) / covered.sum()) for target in targets]
