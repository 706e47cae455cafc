"""What the studies measure: errors against two independent references, and the bandwidth of a finished picture.

Definitions are those of docs/conventions.md. Pictures are luminance arrays, rows top-down; `covered` says which pixels see a
mesh.
"""
from __future__ import annotations

import numpy as np

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
DARK_PART = 0.01  # of the mean: keeps the relative error of dark pixels finite


def luminance(color: np.ndarray) -> np.ndarray:
    return color[..., :3].astype(np.float64) @ LUMINANCE


def relative_error(picture: np.ndarray, a: np.ndarray, b: np.ndarray, covered: np.ndarray) -> float:
    """E: root mean square over covered pixels of (L - Lref) / (Lref + 0.01 mean Lref).

    a and b are independent unbiased references: mean((L - a)(L - b)) estimates the squared error without their noise. A small
    true error may come out negative by that noise; then it is not a number.
    """
    reference = 0.5 * (a + b)[covered]
    scale = reference + DARK_PART * reference.mean()
    squared = np.mean((picture[covered] - a[covered]) * (picture[covered] - b[covered]) / scale**2)
    return float(np.sqrt(squared)) if squared >= 0 else float("nan")


def windowed_bandwidth(a: np.ndarray, b: np.ndarray, covered: np.ndarray, window: int = 32, step: int = 4,
                       percentile: float = 0.95) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Local image bandwidth, cycles per pixel, by a windowed Fourier transform (figure 12 of Bagher et al. 2013).

    The frequency below which `percentile` of the window's energy lies (without its mean), from the cross spectrum of two
    independent pictures, in which their noise cancels. Returns (rows, columns, bandwidth) at the centres of the windows that are
    covered entirely.
    """
    hann = np.hanning(window + 2)[1:-1]
    weight = np.outer(hann, hann)
    f = np.fft.fftfreq(window)
    radius = np.hypot(*np.meshgrid(f, f, indexing="ij")).ravel()
    order = np.argsort(radius)
    rows, columns, values = [], [], []
    for y in range(0, a.shape[0] - window + 1, step):
        for x in range(0, a.shape[1] - window + 1, step):
            part = np.s_[y:y + window, x:x + window]
            if not covered[part].all():
                continue
            spectra = [np.fft.fft2((p[part] - np.average(p[part], weights=weight)) * weight) for p in (a, b)]
            power = (spectra[0] * spectra[1].conj()).real.ravel()[order]
            energy = np.cumsum(power)
            if energy[-1] <= 0:  # nothing but noise
                continue
            reached = np.argmax(energy >= percentile * energy[-1])
            rows.append(y + window // 2)
            columns.append(x + window // 2)
            values.append(min(radius[order[reached]], 0.5))
    return np.array(rows), np.array(columns), np.array(values)


def rank_correlation(x: np.ndarray, y: np.ndarray) -> float:
    """Spearman's: the correlation of ranks, ties sharing their mean rank."""
    def ranks(v: np.ndarray) -> np.ndarray:
        _, inverse, counts = np.unique(v, return_inverse=True, return_counts=True)
        ends = np.cumsum(counts)
        return ((ends - counts + ends - 1) / 2)[inverse]

    return float(np.corrcoef(ranks(x), ranks(y))[0, 1])
