"""Small pictures as SVG, without a plotting library: bars, boxes, and slices of fields."""
from __future__ import annotations

import os
from collections.abc import Sequence
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import ArrayLike

COLOURS = ("#4477aa", "#ee6677", "#228833", "#ccbb44")  # they print


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

    def paths(self, of_colour: dict[str, str]) -> None:
        self._parts.extend(f'<path fill="{colour}" d="{path}"/>' for colour, path in of_colour.items())

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
    paths: dict[str, str] = {}  # per colour
    for row, (line, is_below) in enumerate(zip(far[::-1], finite[::-1] < 0)):
        ends = np.flatnonzero(np.diff(line * 2 + is_below, append=-1)) + 1  # of runs of one colour
        for begin, end in zip([0, *ends[:-1]], ends):
            level, x, width = f"{line[begin]:02x}", 10 + size * begin, size * (end - begin)
            colour = f"#{level}{level}ff" if is_below[begin] else f"#ff{level}{level}"
            paths[colour] = paths.get(colour, "") + f"M{x:g} {40 + size * row:g}h{width:g}v{size + 0.2:g}h-{width:g}z"
    canvas.paths(paths)
    canvas.write(path)
