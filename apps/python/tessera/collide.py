"""Pairs of objects that intersect, decided exactly, and queries.

The shape of an array says what its rows are: (n, 6) boxes (least corner, greatest corner), (n, 3, 3)
triangles, (n, 4, 3) tetrahedra, (n, 4) balls (centre, radius), (n, 2, 3) segments, (n, 3) points.
"""
from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _check, _tessera
from ._tessera import Error

__all__ = ["Index", "pairs", "triangle_pairs"]

_ROWS = {(6,): "(n, 6) of boxes", (3, 3): "(n, 3, 3) of triangles", (4, 3): "(n, 4, 3) of tetrahedra",
         (4,): "(n, 4) of balls", (2, 3): "(n, 2, 3) of segments", (3,): "(n, 3) of points"}


def _objects(given: ArrayLike, name: str, rows: tuple[int, ...] | None = None) -> NDArray[np.float64]:
    out = _check.array(given, name, "fiu", "real numbers")
    if out.ndim < 2 or out.shape[1:] not in ([rows] if rows else _ROWS):
        expected = _ROWS[rows] + ", of one kind with the objects" if rows else ", ".join(_ROWS.values())
        raise Error(f"{name}: its shape is {out.shape}; expected {expected}")
    return out.astype(np.float64, copy=False)


def pairs(objects: ArrayLike, others: ArrayLike | None = None, *, touching: bool = True) -> NDArray[np.uint32]:
    """(k, 2) positions of all pairs that intersect, each once, in no particular order.

    Within one set, first < second. With `others`, of the same kind, the second is a position there.
    touching: whether objects that only touch are pairs. Not for points and segments.
    """
    first = _objects(objects, "objects")
    return _tessera.pairs(first, None if others is None else _objects(others, "others", first.shape[1:]), touching)


def triangle_pairs(points: ArrayLike, triangles: ArrayLike, *, touching: bool = True) -> NDArray[np.uint32]:
    """pairs() of the triangles of a surface: points (n, 3), triangles (m, 3) int. Neighbours touch."""
    corners = _check.points(points, "points")
    layout = "(m, 3), the points of each triangle"
    numbers = _check.indices(triangles, "triangles", (-1, 3), layout, len(corners), "points", np.int64)
    return _tessera.pairs(corners[numbers], None, touching)


class Index:
    """A tree over objects, which are copied. Queries come in batches and may run in several threads.
    Objects are named by their positions. Coordinates are at most 1e150."""

    def __init__(self, objects: ArrayLike) -> None:
        given = _objects(objects, "objects")
        self._index = _tessera.Index(_check.doubles(given, "objects", given.shape, "", 1e150))

    def __len__(self) -> int:
        return len(self._index)

    def within(self, points: ArrayLike, radius: ArrayLike) -> tuple[NDArray[np.int64], NDArray[np.uint32]]:
        """What lies within a distance of points (m, 3). radius: a number, or (m,). Returns begin (m + 1,)
        and objects: those of point i are objects[begin[i]:begin[i + 1]], ascending."""
        given, radii = _check.points(points, "points"), _check.array(radius, "radius", "fiu", "real numbers")
        radii = np.full(len(given), radii) if radii.ndim == 0 else radii
        return self._index.within(given, _check.doubles(radii, "radius", (len(given),), "a number, or one per point"))

    def nearest(self, points: ArrayLike, k: int = 1) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """The k nearest objects of points (m, 3), near ones first, and their distances: two arrays
        (m, min(k, len(self))). Distances below 1e-150 count as 0."""
        if k < 1:
            raise Error(f"k: {k} is not a number of objects; give 1 or more")
        return self._index.nearest(_check.points(points, "points"), k)

    def ray(self, origins: ArrayLike, directions: ArrayLike) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """The first object that each ray (m, 3), (m, 3) meets, and t of origin + t direction, t >= 0:
        two arrays (m,), with -1 and inf where a ray meets none, as a triangle in whose plane it lies. Not for
        points and segments."""
        starts = _check.points(origins, "origins")
        ways = _check.doubles(directions, "directions", starts.shape, f"{starts.shape}, one per origin")
        return self._index.ray(starts, ways)
