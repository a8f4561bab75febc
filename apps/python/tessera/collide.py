"""Pairs of objects that intersect, decided exactly, and queries.

The shape of an array says what its rows are: (n, 6) boxes (least corner, greatest corner), (n, 3, 3)
triangles, (n, 4, 3) tetrahedra, (n, 4) balls (centre, radius), (n, 2, 3) segments, (n, 3) points.
"""
from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _tessera

__all__ = ["Index", "pairs", "triangle_pairs"]


def pairs(objects: ArrayLike, others: ArrayLike | None = None, *, touching: bool = True) -> NDArray[np.uint32]:
    """(k, 2) positions of all pairs that intersect, each once, in no particular order.

    Within one set, first < second. With `others`, of the same kind, the second is a position there.
    touching: whether objects that only touch are pairs. Not for points and segments.
    """
    return _tessera.pairs(objects, others, touching)


def triangle_pairs(points: ArrayLike, triangles: ArrayLike, *, touching: bool = True) -> NDArray[np.uint32]:
    """pairs() of the triangles of a surface: points (n, 3), triangles (m, 3) int. Neighbours touch."""
    return _tessera.pairs(_tessera.corners(points, triangles), None, touching)


class Index:
    """A tree over objects, which are copied. Queries come in batches and may run in several threads.
    Objects are named by their positions."""

    def __init__(self, objects: ArrayLike) -> None:
        self._index = _tessera.Index(objects)

    def __len__(self) -> int:
        return len(self._index)

    def within(self, points: ArrayLike, radius: ArrayLike) -> tuple[NDArray[np.int64], NDArray[np.uint32]]:
        """What lies within a distance of points (m, 3). radius: a number, or (m,). Returns begin (m + 1,)
        and objects: those of point i are objects[begin[i]:begin[i + 1]], ascending."""
        return self._index.within(points, np.broadcast_to(radius, (len(np.asarray(points)),)))

    def nearest(self, points: ArrayLike, k: int = 1) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """The k nearest objects of points (m, 3), near ones first, and their distances: two arrays
        (m, min(k, len(self)))."""
        return self._index.nearest(points, k)

    def ray(self, origins: ArrayLike, directions: ArrayLike) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """The first object that each ray (m, 3), (m, 3) meets, and t of origin + t direction, t >= 0:
        two arrays (m,), with -1 and inf where a ray meets none. Not for points and segments."""
        return self._index.ray(origins, directions)
