"""Arguments as arrays. Shapes, kinds of numbers, NaN and indices are checked here, before the library sees them."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ._tessera import Error


def array(given: Any, name: str, kinds: str, needed: str) -> np.ndarray:
    """kinds: of dtypes, such as "iu". In C order."""
    if isinstance(given, np.ma.MaskedArray):
        raise Error(f"{name}: it is a masked array, and a mask would be lost; give .filled(value), or the rows that count")
    try:
        out = np.asarray(given, order="C")
    except ValueError as error:
        raise Error(f"{name}: no array can be made of this {type(given).__name__}; expected {needed}") from error
    if out.size and out.dtype.kind not in kinds:
        raise Error(f"{name}: its dtype is {out.dtype}; expected {needed}; convert it with .astype()")
    return out


def _refuse(name: str, out: np.ndarray, bad: np.ndarray, words: str) -> None:
    at = tuple(np.argwhere(bad)[0])
    raise Error(f"{name}[{', '.join(map(str, at))}] is {out[at]}{words}")


def shaped(out: np.ndarray, name: str, shape: Sequence[int], layout: str) -> np.ndarray:
    """-1 is any length."""
    if out.ndim != len(shape) or any(n not in (-1, size) for n, size in zip(shape, out.shape)):
        raise Error(f"{name}: its shape is {out.shape}; expected {layout}")
    return out


def doubles(given: Any, name: str, shape: Sequence[int], layout: str, most: float = 1e100) -> np.ndarray:
    """Finite numbers as float64; the array itself, if it is that already."""
    out = shaped(array(given, name, "fiu", "real numbers"), name, shape, layout).astype(np.float64, copy=False)
    if out.size and not (out.min() >= -most and out.max() <= most):  # false with NaN
        _refuse(name, out, ~(np.abs(out) <= most), f"; give finite numbers of at most {most:g}")
    return out


def points(given: Any, name: str) -> np.ndarray:
    return doubles(given, name, (-1, 3), "(n, 3), a row of x, y, z per point")


def indices(given: Any, name: str, shape: Sequence[int], layout: str, n: int, things: str, dtype: Any) -> np.ndarray:
    """Integers from 0 to n - 1."""
    out = shaped(array(given, name, "iu", "integers"), name, shape, layout)
    if out.size and (out.min() < 0 or out.max() >= n):
        _refuse(name, out, (out < 0) | (out >= n), f", and there are {n} {things}, numbered from 0 on")
    return out.astype(dtype, copy=False)


def values(given: Any, name: str, n: int, things: str) -> np.ndarray:
    """(n,) or (n, c); NaN is a value."""
    out = array(given, name, "fiu", "real numbers")
    if out.ndim not in (1, 2) or len(out) != n or 0 in out.shape[1:]:
        raise Error(f"{name}: its shape is {out.shape}; expected ({n},) or ({n}, c), for {n} {things}")
    return out.astype(np.float64, copy=False)


def mesh(given: Any, cells: Any, name: str = "") -> tuple[np.ndarray, np.ndarray | None, int]:
    """(points, cells (m, 4) or None, dimension), as the library has them."""
    corners = points(given, name + "points")
    if len(corners) >= 2**31:
        raise Error(f"{name}points: there are {len(corners)}, and a mesh holds at most 2147483647; cut it")
    if cells is None:
        return corners, None, 3
    layout = "(m, 4) of tetrahedra, (m, 3) of triangles or (m, 2) of edges"
    tets = indices(cells, name + "tets", (-1, -1), layout, len(corners), "points", np.int32)
    if tets.shape[1] not in (2, 3, 4):
        shaped(tets, name + "tets", (-1, 4), layout)
    dimension = tets.shape[1] - 1
    return corners, np.ascontiguousarray(tets[:, np.minimum(np.arange(4), dimension)]) if dimension < 3 else tets, dimension
