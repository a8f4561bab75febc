"""Small pictures as SVG, without a plotting library: bars, lines, boxes, and slices of fields."""
from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import ArrayLike

COLOURS = ("#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377")  # they print


class _Canvas:
    """A white page with a title. Coordinates are pixels, y points down."""

    def __init__(self, width: float, height: float, title: str) -> None:
        self._parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{height:g}" '
                       'font-family="sans-serif">']
        self.rect(0, 0, width, height, "#ffffff")
        self.text(10, 20, title, font=14)

    def text(self, x: float, y: float, words: str, anchor: str = "start", font: float = 12) -> None:
        self._parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{font:g}">'
                           f"{escape(words)}</text>")

    def rect(self, x: float, y: float, width: float, height: float, fill: str, stroke: str = "none") -> None:
        self._parts.append(f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" '
                           f'fill="{fill}" stroke="{stroke}"/>')

    def line(self, points: Iterable[tuple[float, float]], stroke: str, width: float) -> None:
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self._parts.append(f'<polyline points="{path}" fill="none" stroke="{stroke}" stroke-width="{width:g}"/>')

    def write(self, path: str | os.PathLike[str]) -> None:
        with open(path, "w", encoding="utf-8") as file:
            file.write("".join(self._parts) + "</svg>\n")


def bars(path: str | os.PathLike[str], title: str, names: Sequence[str],
         columns: dict[str, Sequence[float]]) -> None:
    """One column of bars per entry of `columns`, which has a value per name."""
    canvas = _Canvas(140 + 260 * len(columns), 60 + 24 * len(names), title)
    for row, name in enumerate(names):
        canvas.text(130, 64 + 24 * row, name, "end")
    for column, (label, values) in enumerate(columns.items()):
        left, most = 140 + 260 * column, max(max(values), 1e-300)
        canvas.text(left, 42, label)
        for row, value in enumerate(values):
            width = 180 * value / most
            canvas.rect(left, 50 + 24 * row, width, 18, COLOURS[column % len(COLOURS)])
            canvas.text(left + width + 5, 64 + 24 * row, f"{value:,.0f}" if value >= 1000 else f"{value:.4g}", font=11)
    canvas.write(path)


def lines(path: str | os.PathLike[str], title: str, x_label: str, x: Sequence[float],
          series: dict[str, Sequence[float]]) -> None:
    """Lines over x, both axes logarithmic; every value is above 0. Labels at the last points."""
    canvas = _Canvas(520, 340, title)
    u = np.log10(np.asarray(x, dtype=float))
    all_v = np.log10(np.asarray(list(series.values()), dtype=float))
    low, high = np.floor(all_v.min()), np.ceil(all_v.max())
    to_x = 60 + 300 * (u - u[0]) / (u[-1] - u[0])
    for tick in np.arange(low, high + 1):
        y = 290 - 250 * (tick - low) / (high - low)
        canvas.line([(60, y), (360, y)], "#dddddd", 1)
        canvas.text(54, y + 4, f"{10 ** tick:.{max(0, int(-tick))}f}", "end", 11)
    for at, value in zip(to_x, x):
        canvas.text(at, 306, f"{value:g}", "middle", 11)
    canvas.text(210, 326, x_label, "middle")
    for k, (name, v) in enumerate(zip(series, all_v)):
        y = 290 - 250 * (v - low) / (high - low)
        canvas.line(list(zip(to_x, y)), COLOURS[k % len(COLOURS)], 2)
        canvas.text(368, y[-1] + 4, name)
    canvas.write(path)


def boxes(path: str | os.PathLike[str], title: str, lo: ArrayLike, hi: ArrayLike, marked: ArrayLike) -> None:
    """Rectangles (n, 2) to (n, 2); the marked ones (n,) in another colour."""
    lo, hi = np.asarray(lo, dtype=float), np.asarray(hi, dtype=float)
    scale, left = 400 / (hi.max(0) - lo.min(0)).max(), lo.min(0)
    canvas = _Canvas(420, 450, title)
    for (x, y), (width, height), is_marked in zip((lo - left) * scale, (hi - lo) * scale, np.asarray(marked)):
        colour = COLOURS[1] if is_marked else COLOURS[0]
        canvas.rect(10 + x, 40 + y, width, height, "none", colour)
    canvas.write(path)


def image(path: str | os.PathLike[str], title: str, values: ArrayLike) -> None:
    """A slice (rows from below, columns): blue below 0, red above, in ten steps, darker further away."""
    values = np.asarray(values, dtype=float)
    finite = np.where(np.isfinite(values), values, np.nan)
    most = np.nanmax(np.abs(finite)) or 1.0
    size = 400 / max(values.shape)
    canvas = _Canvas(420, 450, f"{title} (darkest: {most:.3g})")
    far = np.where(np.isnan(finite), 230, 230 - 23 * np.ceil(10 * np.abs(np.nan_to_num(finite)) / most)).astype(int)
    for row, (line, is_below) in enumerate(zip(far[::-1], finite[::-1] < 0)):
        ends = np.flatnonzero(np.diff(line * 2 + is_below, append=-1)) + 1  # of runs of one colour
        for begin, end in zip([0, *ends[:-1]], ends):
            level = f"{line[begin]:02x}"
            canvas.rect(10 + size * begin, 40 + size * row, size * (end - begin), size + 0.3,
                        f"#{level}{level}ff" if is_below[begin] else f"#ff{level}{level}")
    canvas.write(path)
