"""Signed distance fields of surfaces, on a grid in single precision: distances are negative inside."""
from __future__ import annotations

import os

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _check, _tessera
from ._tessera import Error

__all__ = ["Field", "build", "read_surface"]


KINDS = ("nearest", "tangent", "trilinear")


class Field:
    """cell: the edge of a voxel. shape: voxels per axis. low, high: the centres of the first and the last voxel."""

    def __init__(self, field: _tessera.Field) -> None:
        self._field = field
        self.cell, self.shape, self.low, self.high = field.grid()

    def sample(self, points: ArrayLike, kind: str = "trilinear") -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Distances (m,) and unit normals (m, 3) at points (m, 3). kind: trilinear or tangent (errors of
        second order in the cell), nearest. Outside of the grid: inf and zeros."""
        if kind not in KINDS:
            raise Error(f"kind: {kind!r} is unknown; choose one of {', '.join(KINDS)}")
        return self._field.sample(_check.points(points, "points"), KINDS.index(kind))


def build(points: ArrayLike, triangles: ArrayLike, n: int = 64, *, margin: float | None = None,
          thickness: float = np.inf, two_sided: bool = False) -> Field:
    """The field of a surface on n³ voxels, 4 <= n <= 1024. points: (p, 3). triangles: (m, 3) int,
    counter-clockwise seen from outside, or all clockwise of a closed surface; neighbours that disagree are an
    Error. margin: free space around it; None is a tenth of its longest side. thickness: distances are cut off
    there, which saves time. two_sided: an open surface, with distances >= 0."""
    corners = _check.points(points, "points")
    layout = "(m, 3), the points of each triangle"
    numbers = _check.indices(triangles, "triangles", (-1, 3), layout, len(corners), "points", np.uint32)
    return Field(_tessera.Field(corners, numbers, n, margin, thickness, two_sided))


def read_surface(path: str | os.PathLike[str]) -> tuple[NDArray[np.float64], NDArray[np.uint32]]:
    """Points (n, 3) and triangles (m, 3) of an OBJ, PLY or STL file."""
    return _tessera.read_surface(os.fspath(path))
