"""Load balancing without a run: snapshots of loads, strategies by name, and strategies in Python.

A strategy in Python is a function of a Snapshot that returns the new PE of each element, (n,) int:

    def rotate(snapshot):
        return (snapshot.owners + 1) % snapshot.n_pes

Elements that may not move, or whose load is unknown, stay, whatever it returns.
"""
from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _check, _tessera, plot
from ._tessera import Error

__all__ = ["Comparison", "Evaluation", "Snapshot", "Strategy", "assign", "compare", "evaluate", "read",
           "snapshot", "strategies"]


class Snapshot:
    """Loads of elements before a balance round. loads: (n,) seconds on a PE of speed 1, NaN if unknown.
    owners: (n,) PEs. movable: (n,) bool. sizes: (n,) bytes. speeds: (n_pes,). background: (n_pes,)
    seconds beside the elements. edges: (m, 4): from, to, bytes, messages. positions: (n, 3), or (0, 3)."""

    loads: NDArray[np.float64]
    owners: NDArray[np.int32]
    movable: NDArray[np.bool_]
    sizes: NDArray[np.uint64]
    speeds: NDArray[np.float64]
    background: NDArray[np.float64]
    edges: NDArray[np.int64]
    positions: NDArray[np.float64]

    def __init__(self, handle: _tessera.Snapshot) -> None:
        self._handle = handle
        for name, array in _tessera.arrays(handle).items():
            array.flags.writeable = False
            setattr(self, name, array)
        self.n_pes = len(self.speeds)

    def _assignment(self, given: ArrayLike, name: str) -> NDArray[np.int32]:
        n = len(self.owners)
        return _check.indices(given, name, (n,), f"({n},), a PE per element", self.n_pes, "PEs", np.int32)


Strategy = Union[str, Callable[[Snapshot], ArrayLike]]


@dataclass(frozen=True)
class Evaluation:
    """imbalance: time of the slowest PE over the ideal time, 1 at best. moves: elements that change their
    PE. moved_bytes: their size. external_bytes: of messages between PEs."""

    imbalance: float
    moves: int
    moved_bytes: int
    external_bytes: int


def snapshot(loads: ArrayLike, owners: ArrayLike, n_pes: int, *, speeds: ArrayLike | None = None,
             background: ArrayLike | None = None, sizes: ArrayLike | None = None, edges: ArrayLike | None = None,
             positions: ArrayLike | None = None) -> Snapshot:
    """A snapshot from arrays, which are those of Snapshot; speeds are 1 by default. Strategies rcb and
    hilbert need positions."""
    if not 1 <= n_pes <= 2**24:
        raise Error(f"n_pes: {n_pes} is not a number of PEs from 1 to {2**24}")
    seconds = _check.shaped(_check.array(loads, "loads", "fiu", "real numbers"), "loads", (-1,),
                            "(n,), seconds of each element").astype(float)
    if (bad := np.flatnonzero(~(np.isnan(seconds) | (seconds >= 0) & (seconds <= 1e100)))).size:
        raise Error(f"loads[{bad[0]}] is {seconds[bad[0]]}; give seconds from 0 on, or NaN where the load is unknown")
    n = len(seconds)
    traffic = _check.indices(np.zeros((0, 4), int) if edges is None else edges, "edges", (-1, 4),
                             "(m, 4): from, to, bytes, messages", 2**53, "numbers", np.int64)
    _check.indices(traffic[:, :2], "edges", (-1, 2), "", n, "elements", np.int64)
    return Snapshot(_tessera.Snapshot(
        seconds,
        _check.indices(owners, "owners", (n,), f"({n},), a PE per element", n_pes, "PEs", np.int32),
        _check.doubles(np.ones(n_pes) if speeds is None else speeds, "speeds", (n_pes,), f"({n_pes},)"),
        _check.doubles(np.zeros(n_pes) if background is None else background, "background", (n_pes,), f"({n_pes},)"),
        _check.indices(np.zeros(n, int) if sizes is None else sizes, "sizes", (n,), f"({n},)", 2**53, "bytes", np.int64),
        traffic, np.zeros((0, 3)) if positions is None else _check.doubles(positions, "positions", (n, 3), f"({n}, 3)")))


def read(*paths: str | os.PathLike[str]) -> list[Snapshot]:
    """The phases of one run, in order, from all of its files: those of Tessera (lb_lab --save-snapshot),
    or of vt (one file per rank; .br is unpacked)."""
    return [Snapshot(handle) for handle in _tessera.read_snapshots([os.fspath(path) for path in paths])]


def strategies() -> list[str]:
    """The names of the strategies."""
    return _tessera.strategies()


def assign(snapshot: Snapshot, strategy: Strategy, seed: int = 1) -> NDArray[np.int32]:
    """The new PE of each element, (n,). strategy: a name of strategies(), or a function."""
    if isinstance(strategy, str):
        return _tessera.assign(snapshot._handle, strategy, seed)
    if not callable(strategy):
        raise Error(f"strategy: {strategy!r} is no name and no function; see strategies()")
    run = lambda: snapshot._assignment(strategy(snapshot), "PEs of the strategy")
    return _tessera.assign(snapshot._handle, run, seed)


def evaluate(snapshot: Snapshot, owners: ArrayLike | None = None) -> Evaluation:
    """The quality of an assignment, (n,) int; of the present one without it."""
    chosen = snapshot.owners if owners is None else snapshot._assignment(owners, "owners")
    return Evaluation(*_tessera.evaluate(snapshot._handle, chosen))


@dataclass(frozen=True)
class Comparison:
    """Name → evaluation; the first row, "before", is the present assignment. str() is a table."""

    rows: dict[str, Evaluation]

    def __str__(self) -> str:
        width = max(map(len, self.rows))
        lines = [f"{'strategy':{width}}  imbalance  moves  moved bytes  external bytes"]
        lines += [f"{name:{width}}  {e.imbalance:9.3f}  {e.moves:5}  {e.moved_bytes:11}  {e.external_bytes:14}"
                  for name, e in self.rows.items()]
        return "\n".join(lines)

    def plot(self, path: str | os.PathLike[str]) -> None:
        """Draws the imbalances, and the bytes between PEs, as bars (SVG)."""
        rows = self.rows.values()
        plot.bars(path, "load balancing", list(self.rows), {"slowest PE / ideal": [e.imbalance for e in rows],
                                                            "bytes between PEs": [e.external_bytes for e in rows]})


def compare(snapshot: Snapshot, strategies: Sequence[Strategy], seed: int = 1) -> Comparison:
    """Runs strategies, names or functions with a name each, on one snapshot."""
    rows = {"before": evaluate(snapshot)}
    for strategy in strategies:
        name = strategy if isinstance(strategy, str) else getattr(strategy, "__name__", "own") + "()"
        if name in rows:
            raise Error(f"strategies: two are named {name}, and a row has one; give functions names of their own, by def or __name__")
        rows[name] = evaluate(snapshot, assign(snapshot, strategy, seed))
    return Comparison(rows)
