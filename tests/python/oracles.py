"""Answers by brute force in NumPy, that the tests compare with."""
import itertools

import numpy as np


def kuhn(n, jitter=0.0, seed=1):
    """The unit cube as n³ cubes of six tetrahedra each; inner points move by up to jitter / n."""
    axis = np.arange(n + 1) / n
    points = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), -1).reshape(-1, 3)
    inner = ((points > 0) & (points < 1)).all(1)
    points[inner] += np.random.default_rng(seed).uniform(-jitter, jitter, (inner.sum(), 3)) / n
    number = np.arange((n + 1) ** 3).reshape((n + 1,) * 3)
    tets = []
    for corner in np.ndindex(n, n, n):
        for order in itertools.permutations(range(3)):
            at, tet = np.array(corner), [number[corner]]
            for k in order:
                at[k] += 1
                tet.append(number[tuple(at)])
            tets.append(tet)
    return points, np.array(tets)


def barycentric(points, tets, at):
    """(len(at), len(tets), 4) weights of the corners."""
    corners = points[tets]
    edges = np.moveaxis(corners[:, 1:] - corners[:, :1], 1, 2)
    inner = np.einsum("tij,ptj->pti", np.linalg.inv(edges), at[:, None] - corners[None, :, 0])
    return np.concatenate([1 - inner.sum(-1, keepdims=True), inner], -1)


def interpolate(points, tets, values, at):
    """Linear in the tetrahedron that holds each point; otherwise of the nearest point; and where it is in one."""
    weights = barycentric(points, tets, at)
    best = weights.min(-1).argmax(1)
    rows = np.arange(len(at))
    inside = weights[rows, best].min(-1) >= -1e-12
    found = (weights[rows, best][..., None] * values[tets[best]].reshape(len(at), 4, -1)).sum(1)
    nearest = np.linalg.norm(at[:, None] - points[None], axis=-1)
    near = values[nearest.argmin(1)].reshape(len(at), -1)
    return np.where(inside[:, None], found, near), inside, nearest.min(1)


def integral(points, tets, values):
    corners = points[tets]
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6
    return (volumes[:, None] * values[tets].reshape(len(tets), 4, -1).mean(1)).sum(0)


def box_pairs(a, b=None, touching=True):
    below = np.less_equal if touching else np.less
    other = a if b is None else b
    meet = (below(a[:, None, :3], other[None, :, 3:]) & below(other[None, :, :3], a[:, None, 3:])).all(2)
    return set(map(tuple, np.argwhere(np.triu(meet, 1) if b is None else meet)))


def _crosses(segments, triangle):
    """Where segments (n, 2, 3) cross a triangle, in general position."""
    a, b, c = triangle
    volume = lambda p, q, r, s: np.einsum("...i,...i", np.cross(q - p, r - p), s - p)
    p, q = segments[:, 0], segments[:, 1]
    sides = volume(a, b, c, p) * volume(a, b, c, q) < 0
    turns = np.stack([volume(p, q, u, v) for u, v in ((a, b), (b, c), (c, a))])
    return sides & ((turns > 0).all(0) | (turns < 0).all(0))


def triangle_pairs(triangles):
    found = set()
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]]
    for i, triangle in enumerate(triangles):
        for j in np.flatnonzero(_crosses(edges.reshape(-1, 2, 3), triangle).reshape(-1, 3).any(1)):
            found.add((min(i, j), max(i, j)))
    return found


def boxes_hit(boxes, origins, directions):
    """(object, t) of the first box that each ray meets; -1 and inf."""
    with np.errstate(divide="ignore"):
        t = (boxes[None].reshape(1, -1, 2, 3) - origins[:, None, None]) / directions[:, None, None]
    enter = np.maximum(t.min(2).max(-1), 0)
    enter = np.where(enter <= t.max(2).min(-1), enter, np.inf)
    best = enter.argmin(1)
    at = enter[np.arange(len(origins)), best]
    return np.where(np.isfinite(at), best, -1), at


def greedy(snapshot):
    """The library's strategy greedy in Python: the heaviest element first, to the PE that finishes first."""
    work, given = np.zeros(snapshot.n_pes), np.zeros(snapshot.n_pes, int)
    time = lambda pe, more=0.0: snapshot.background[pe] + (work[pe] + more) / snapshot.speeds[pe]
    new = snapshot.owners.copy()
    for element in np.argsort(-snapshot.loads, kind="stable"):
        load = snapshot.loads[element]
        first = {}  # of each speed
        for pe in range(snapshot.n_pes):
            key = (time(pe), given[pe], pe)
            first[snapshot.speeds[pe]] = min(first.get(snapshot.speeds[pe], key), key)
        pe = min((time(pe, load), n, pe) for _, n, pe in first.values())[2]
        work[pe] += load
        given[pe] += 1
        new[element] = pe
    return new
