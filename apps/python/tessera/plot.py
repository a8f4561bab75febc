"""Small pictures as SVG, without a plotting library: bars, lines, boxes, and slices of fields."""
from __future__ import annotations

import os
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from ._tessera import Canvas

COLOURS = ("#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377")  # they print


def _write(path: str | os.PathLike[str], canvas: Canvas) -> None:
    with open(path, "w", encoding="utf-8") as file:
        file.write(canvas.svg())


def bars(path: str | os.PathLike[str], title: str, names: Sequence[str],
         columns: dict[str, Sequence[float]]) -> None:
    """One column of bars per entry of `columns`, which has a value per name."""
    canvas = Canvas(140 + 260 * len(columns), 60 + 24 * len(names))
    canvas.text(10, 20, title, "start", 14)
    for row, name in enumerate(names):
        canvas.text(130, 64 + 24 * row, name, "end", 12)
    for column, (label, values) in enumerate(columns.items()):
        left, most = 140 + 260 * column, max(max(values), 1e-300)
        canvas.text(left, 42, label, "start", 12)
        for row, value in enumerate(values):
            width = 180 * value / most
            canvas.rect(left, 50 + 24 * row, width, 18, COLOURS[column % len(COLOURS)], "")
            canvas.text(left + width + 5, 64 + 24 * row, f"{value:.4g}", "start", 11)
    _write(path, canvas)


def lines(path: str | os.PathLike[str], title: str, x_label: str, x: Sequence[float],
          series: dict[str, Sequence[float]]) -> None:
    """Lines over x, both axes logarithmic; every value is above 0. Labels at the last points."""
    canvas = Canvas(520, 340)
    canvas.text(10, 20, title, "start", 14)
    u = np.log10(np.asarray(x, dtype=float))
    all_v = np.log10(np.asarray(list(series.values()), dtype=float))
    low, high = np.floor(all_v.min()), np.ceil(all_v.max())
    to_x = 60 + 300 * (u - u[0]) / (u[-1] - u[0])
    for tick in np.arange(low, high + 1):
        y = 290 - 250 * (tick - low) / (high - low)
        canvas.line([(60, y), (360, y)], "#dddddd", 1)
        canvas.text(54, y + 4, f"{10 ** tick:g}", "end", 11)
    for at, value in zip(to_x, x):
        canvas.text(at, 306, f"{value:g}", "middle", 11)
    canvas.text(210, 326, x_label, "middle", 12)
    for k, (name, v) in enumerate(zip(series, all_v)):
        y = 290 - 250 * (v - low) / (high - low)
        canvas.line(list(zip(to_x, y)), COLOURS[k % len(COLOURS)], 2)
        canvas.text(368, y[-1] + 4, name, "start", 12)
    _write(path, canvas)


def boxes(path: str | os.PathLike[str], title: str, lo: ArrayLike, hi: ArrayLike, marked: ArrayLike) -> None:
    """Rectangles (n, 2) to (n, 2); the marked ones (n,) in another colour."""
    lo, hi = np.asarray(lo, dtype=float), np.asarray(hi, dtype=float)
    scale, left = 400 / (hi.max(0) - lo.min(0)).max(), lo.min(0)
    canvas = Canvas(420, 450)
    canvas.text(10, 20, title, "start", 14)
    for (x, y), (width, height), is_marked in zip((lo - left) * scale, (hi - lo) * scale, np.asarray(marked)):
        colour = COLOURS[1] if is_marked else COLOURS[0]
        canvas.rect(10 + x, 40 + y, width, height, "", colour)
    _write(path, canvas)


def image(path: str | os.PathLike[str], title: str, values: ArrayLike) -> None:
    """A slice (rows from below, columns): blue below 0, red above, darker further away; 0 is white."""
    values = np.asarray(values, dtype=float)
    finite = np.where(np.isfinite(values), values, np.nan)
    most = np.nanmax(np.abs(finite)) or 1.0
    size = 400 / max(values.shape)
    canvas = Canvas(420, 450)
    canvas.text(10, 20, f"{title} (white: 0, darkest: {most:.3g})", "start", 13)
    for row, line in enumerate(finite[::-1]):
        for column, value in enumerate(line):
            far = int(230 * (1 - abs(value) / most)) if np.isfinite(value) else 230
            colour = f"#{far:02x}{far:02x}ff" if value < 0 else f"#ff{far:02x}{far:02x}"
            canvas.rect(10 + size * column, 40 + size * row, size + 0.3, size + 0.3, colour, "")
    _write(path, canvas)
