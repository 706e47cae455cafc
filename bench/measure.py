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

    The frequency below which `percentile` of the window's energy lies, from the cross spectrum of two independent pictures, in
    which their noise cancels. A plane is taken out first, and the Hann window reaches 0 at its edge: what is left of low
    frequencies does not leak. The spectrum is summed over rings one bin wide and its running sum read linearly between them.
    Windows in which noise leaves less than a fifth of the energy certain have no result. Returns (rows, columns, bandwidth) at
    the centres of the windows that are covered entirely.
    """
    hann = np.hanning(window + 2)[1:-1]
    weight = np.outer(hann, hann)
    y, x = np.mgrid[:window, :window] - (window - 1) / 2
    plane = np.stack([np.ones_like(x), x, y]).reshape(3, -1)
    fit = np.linalg.inv((plane * weight.ravel()) @ plane.T) @ (plane * weight.ravel())  # weighted least squares
    f = np.fft.fftfreq(window) * window
    ring = np.minimum(np.rint(np.hypot(*np.meshgrid(f, f, indexing="ij"))), window // 2).astype(int).ravel()
    rows, columns, values = [], [], []
    for top in range(0, a.shape[0] - window + 1, step):
        for left in range(0, a.shape[1] - window + 1, step):
            part = np.s_[top:top + window, left:left + window]
            if not covered[part].all():
                continue
            flat = [p[part].ravel() - (fit @ p[part].ravel()) @ plane for p in (a, b)]
            spectra = [np.fft.fft2(p.reshape(window, window) * weight) for p in flat]
            energy = np.cumsum(np.bincount(ring, (spectra[0] * spectra[1].conj()).real.ravel()))
            both = np.sqrt(np.prod([np.sum(np.abs(spectrum)**2) for spectrum in spectra]))
            if energy[-1] < 0.2 * both:
                continue
            energy = np.maximum.accumulate(energy) / energy.max()
            rows.append(top + window // 2)
            columns.append(left + window // 2)
            values.append(np.interp(percentile, energy, np.arange(len(energy)) + 0.5) / window)
    return np.array(rows), np.array(columns), np.minimum(values, 0.5)
