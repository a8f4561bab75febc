"""Tessera from Python: mesh transfer, collision, distance fields and load balancing on NumPy arrays.

Arrays of float64 in C order are read where they are; others are converted. Lengths are in the units of
the meshes. Bad input raises tessera.Error, a ValueError with the value, its place and the remedy. The
interpreter's lock is released while the library works. Calls may come from several threads: transfers
take turns, since each uses `pes` threads of its own, and all else runs at once. A KeyboardInterrupt is
raised when the call ends.
"""
from __future__ import annotations

import copy
import enum
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _check, _tessera, balance, collide, plot, sdf
from ._tessera import Error

__all__ = ["Coupling", "Error", "KINDS", "Mesh", "Status", "TransferResult", "balance", "collide",
           "plot", "read_mesh", "sdf", "transfer", "write_mesh"]

KINDS = ("linear", "second-order", "limited", "nearest", "projection", "moving-least-squares",
         "conservative", "conservative-bounded", "conservative-lumped")


class Status(enum.IntEnum):
    """Where a target point lies in the source mesh."""

    INSIDE = 0    #: strictly inside a cell, or covered by the source
    BOUNDARY = 1  #: exactly on a face, edge or vertex
    SNAPPED = 2   #: outside, but within the tolerance of a cell
    OUTSIDE = 3   #: in no cell: `outside` decides the value


class _Search:
    """The checked arguments of a Coupling."""

    def __init__(self, source: tuple[Any, Any], target: tuple[Any, Any], kind: str, outside: Any, *options: Any) -> None:
        self.meshes = _check.mesh(*source, "source_"), _check.mesh(*target, "target_")
        if kind == "native":
            raise Error("kind native needs the elements of a file, which arrays of tetrahedra do not have: choose "
                        "linear, or the program m2m_transfer")
        if not len(self.meshes[0][0]):
            raise Error("source_points: there are none, so no value can be moved; give some")
        if outside is None:
            outside = "keep" if kind.startswith("conservative") else "nearest"
        self.outside = np.nan if isinstance(outside, str) else float(outside)  #: of points without a donor
        if not isinstance(outside, str):
            outside = f"value:{self.outside!r}"
        elif outside not in ("nearest", "keep"):
            raise Error(f"outside: {outside!r} is unknown; give 'nearest', 'keep' or a number")
        *others, self.pes = options
        self.options = (kind, outside, *others)  #: with tolerance, order, clamp
        self.has_weights = kind in ("linear", "second-order", "nearest", "projection") and not others[-1]

    def rooms(self, fields: Sequence[ArrayLike], initial: ArrayLike | None) -> tuple[list[Any], list[Any]]:
        """Fields as arrays, and arrays for the results, with what points without a donor keep."""
        n_sources, n_targets = (len(points) for points, _, _ in self.meshes)
        given = [_check.values(values, "values", n_sources, "source points") for values in fields]
        out = [np.full((n_targets, *values.shape[1:]), self.outside) for values in given]
        for result in out if initial is not None else ():
            kept = _check.values(initial, "initial", n_targets, "target points")
            result[:] = _check.shaped(kept, "initial", result.shape, f"{result.shape}, as the values have it")
        return given, out

    def require_weights(self) -> None:
        if not self.has_weights:
            raise Error(f"kind {self.options[0]} has no weights here, since its values are limited, clamped, or solve a "
                        "system: choose linear, second-order, nearest or projection, without clamp")

    def run(self, fields: list[Any], results: list[Any], weights: bool) -> tuple[Any, ...]:
        return _tessera.transfer(*self.meshes, fields, results, self.options, weights, self.pes)


class Coupling:
    """Searches once where target points lie in a source mesh, then moves any number of fields.

    source_points: (n, 3) float. source_tets: (m, 4) int; (m, 3) of triangles or (m, 2) of edges; None
    for a cloud of points (kinds nearest and moving-least-squares). target_points: (k, 3). target_tets:
    the cells of the target, for conservative kinds. kind: one of tessera.KINDS. outside: "nearest", a
    number, or "keep" (the value of `initial`, or NaN); None is "nearest", and "keep" for conservative
    kinds. tolerance: how far outside a point may be to snap to a cell. order: of moving least squares,
    1 or 2. clamp: keeps values within those of the donor. pes: the number of threads.

    status: (k,) uint8 of Status. distance: (k,), 0 in a cell; of SNAPPED points, as in kind projection, to
    the nearest cell; of OUTSIDE ones to the nearest source point, though the mesh may be nearer, and so of all
    in clouds and moving-least-squares; None for conservative kinds.
    notes: counts of target points that are worth a look, such as {"lower_order": 12}.

    Kinds linear, second-order, nearest and projection keep the matrix of their weights. The others, and
    clamp, have none: each apply() searches again, once for all its fields.
    """

    def __init__(self, source_points: ArrayLike, source_tets: ArrayLike | None, target_points: ArrayLike,
                 kind: str = "linear", outside: str | float | None = None, pes: int = 2, *,
                 target_tets: ArrayLike | None = None, tolerance: float = 0.0, order: int = 1,
                 clamp: bool = False) -> None:
        self._search = _Search((source_points, source_tets), (target_points, target_tets), kind, outside, tolerance,
                               order, clamp, pes)
        self._search.meshes = copy.deepcopy(self._search.meshes)  # the caller's arrays may change later
        self.status, self.distance, self._weights, self.notes = self._search.run([], [], self._search.has_weights)

    def apply(self, *fields: ArrayLike, initial: ArrayLike | None = None) -> Any:
        """The values at the target points of one field, (n,) or (n, c) → (k,) or (k, c); of several
        fields a list. `initial`: what points without a donor keep, in the shape of the result."""
        given, out = self._search.rooms(fields, initial)
        if self._weights is None:
            self._search.run(given, out, False)
        else:
            for values, result in zip(given, out):
                self._weights.apply(values, result)
        return out[0] if len(fields) == 1 else out

    def weights_csr(self) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int64], tuple[int, int]]:
        """(data, indices, indptr, shape) of the matrix in SciPy's CSR layout: target = matrix × source.
        A row without entries is a point without a donor."""
        self._search.require_weights()
        return self._weights.csr()

    def weights(self) -> Any:
        """The same as a scipy.sparse.csr_matrix."""
        data, indices, indptr, shape = self.weights_csr()
        try:
            from scipy.sparse import csr_matrix  # type: ignore[import]
        except ImportError as error:
            raise ImportError("weights() needs SciPy, which cannot be imported here: install it, or take "
                              "weights_csr(), which gives (data, indices, indptr, shape)") from error
        return csr_matrix((data, indices, indptr), shape=shape)


@dataclass(repr=False)
class TransferResult:
    """What transfer() returns. values: (k,) or (k, c) float64. status, distance, notes: as in Coupling."""

    values: NDArray[np.float64]
    status: NDArray[np.uint8]
    distance: NDArray[np.float64] | None
    notes: dict[str, int]
    _search: _Search

    def __repr__(self) -> str:
        counts = ", ".join(f"{int((self.status == s).sum())} {s.name.lower()}" for s in Status)
        return f"TransferResult({len(self.status)} points: {counts})"

    @cached_property
    def donors(self) -> NDArray[np.int64]:
        """(k, w): the source points that each value comes from, padded with -1. The first use searches once
        more, in the arrays as they are then; kinds without weights raise Error."""
        self._search.require_weights()
        _, indices, indptr, shape = self._search.run([], [], True)[2].csr()
        sizes = np.diff(indptr)
        out = np.full((shape[0], int(sizes.max(initial=0))), -1, dtype=np.int64)
        out[np.arange(out.shape[1]) < sizes[:, None]] = indices
        return out


def transfer(source_points: ArrayLike, source_tets: ArrayLike | None, values: ArrayLike,
             target_points: ArrayLike, kind: str = "linear", outside: str | float | None = None, pes: int = 2,
             *, target_tets: ArrayLike | None = None, initial: ArrayLike | None = None, tolerance: float = 0.0,
             order: int = 1, clamp: bool = False) -> TransferResult:
    """Moves a field from a mesh to the points of another one.

    values: (n,) or (n, c), per source point. initial: (k,) or (k, c), kept by points without a donor.
    All else as in Coupling. The result does not depend on `pes`.
    """
    search = _Search((source_points, source_tets), (target_points, target_tets), kind, outside, tolerance, order, clamp, pes)
    given, out = search.rooms([values], initial)
    status, distance, _, notes = search.run(given, out, False)
    return TransferResult(out[0], status, distance, notes, search)


@dataclass
class Mesh:
    """points: (n, 3) float64. tets: (m, 4) int32; (m, 3) of a file of triangles, (m, 2) of edges.
    fields: name → (n,) or (n, c), per point; cell_fields: the same per cell. times: of the file."""

    points: NDArray[np.float64]
    tets: NDArray[np.int32]
    fields: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    cell_fields: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    times: list[float] = field(default_factory=list)


def read_mesh(path: str | os.PathLike[str], step: int = -1) -> Mesh:
    """Reads ExodusII, gmsh (2.x, 4.x) or VTK (.vtu, legacy .vtk), or makes a cube ("kuhn:8@0.2"), with the
    fields of a time step: 0 is the first one, -1 the last. Hexahedra and others become tetrahedra."""
    points, tets, dimension, *fields = _tessera.read_mesh(os.fspath(path), step)
    return Mesh(points, tets[:, :dimension + 1], *fields)


def write_mesh(path: str | os.PathLike[str], points: ArrayLike, tets: ArrayLike,
               fields: dict[str, ArrayLike] | None = None,
               cell_fields: dict[str, ArrayLike] | None = None) -> None:
    """Writes VTK (.vtu) or ExodusII (.exo, .e, .ex2) by the ending of the path, complete or not at all."""
    name, mesh = os.fspath(path), _check.mesh(points, tets)
    if not name.endswith((".vtu", ".exo", ".e", ".ex2")):
        raise Error(f"{name}: meshes are written as .vtu (VTK), or .exo, .e or .ex2 (ExodusII); give a name that ends so")
    rows = ((fields or {}, len(mesh[0]), "points"), (cell_fields or {}, len(np.asarray(tets)), "cells"))
    _tessera.write_mesh(name, mesh, *({key: _check.values(field, f"field {key!r}", n, things)
                                       for key, field in of.items()} for of, n, things in rows))
