"""Speed of tessera beside the C++ programs, and beside SciPy where it can be imported. By hand:

    ninja -C build/release tessera_python m2m_transfer python_pairs_speed
    PYTHONPATH=build/release/python /usr/bin/python3 tests/python/speed.py build/release/bin [N]

Each row is checked: both give the same answer. Times are those of the fastest of N (5) turns, which alternate; `ratio`
is the time of tessera over that of the peer. Arrays are there before, and results are arrays. Rows with one thread on
both sides (cpu) are in seconds of the processor, which other programs disturb less.
"""
import json
import subprocess
import sys
import tempfile
import time

import numpy as np
import tessera

programs, n_turns = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 5
rng = np.random.default_rng(1)


def seconds(call, clock=time.thread_time):
    """(fastest of as many calls as fit into a fifth of a second, result)."""
    best, end = np.inf, time.perf_counter() + 0.2
    while best == np.inf or time.perf_counter() < end:
        begin = clock()
        result = call()
        best = min(best, clock() - begin)
    return best, result


def race(what, ours, name, peer, same, clock=time.thread_time):
    """peer() gives (seconds, answer)."""
    best = [np.inf, np.inf]
    for _ in range(n_turns):
        (took, result), (of_peer, answer) = seconds(ours, clock), peer()
        best = [min(best[0], took), min(best[1], of_peer)]
        if not same(result, answer):
            sys.exit(f"speed: {what}: {name} gives another answer")
    what += ", cpu" if clock is time.thread_time else ""
    print(f"{what:40} {best[0]:8.4f} s {best[1]:8.4f} s {best[0] / best[1]:7.3f}  {name}", flush=True)


def program(*words):
    done = subprocess.run([f"{programs}/{words[0]}", *words[1:]], capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else sys.exit(f"speed: {' '.join(words)} failed: {done.stderr}")


print(f"{'what':40} {'tessera':>10} {'peer':>10} {'ratio':>7}  peer")
with tempfile.TemporaryDirectory() as folder:
    a, b = tessera.read_mesh("kuhn:46@0.2"), tessera.read_mesh("kuhn:46@0.1")
    linear = lambda points: points @ [1, -3, 2] + 1

    def m2m_transfer():
        program("m2m_transfer", "kuhn:46@0.2", "kuhn:46@0.1", "--fields", "1+x-3*y+2*z", "--policy", "nearest", "--pes", "2",
                "--json", f"{folder}/a.json", "--out", f"{folder}/a.vtu")
        with open(f"{folder}/a.json", encoding="utf-8") as file:
            row = json.load(file)["results"][0]
        return row["setup_seconds"] + row["transfer_seconds"] + row["gather_seconds"], row

    race(f"transfer, {len(a.tets)} tets, {len(b.points)} points", lambda: tessera.transfer(a.points, a.tets, linear(a.points), b.points),
         "m2m_transfer --pes 2: setup, transfer, gather", m2m_transfer, lambda r, row: np.allclose(r.values, linear(b.points), atol=1e-13)
         and [np.sum(r.status == s) for s in range(4)] == [row[s.name.lower()] for s in tessera.Status], time.perf_counter)
    low = rng.random((100_000, 3))
    boxes = np.concatenate([low, low + 0.02], 1)
    boxes.tofile(f"{folder}/boxes")
    in_cpp = lambda: [float(word) for word in program("python_pairs_speed", f"{folder}/boxes", "10").split()]
    race("pairs of 100000 boxes", lambda: tessera.collide.pairs(boxes), "the library in C++", in_cpp, lambda found, n: len(found) == n)

try:
    from scipy.interpolate import LinearNDInterpolator
    from scipy.spatial import Delaunay, cKDTree
except ImportError as error:
    sys.exit(f"speed: SciPy cannot be imported ({error}): its rows are left out")
points, queries = rng.random((100_000, 3)), rng.random((100_000, 3)) * 0.9 + 0.05
queries = queries[cKDTree(queries).indices]  # neighbours follow each other, which helps LinearNDInterpolator
mesh, values = Delaunay(points), np.sin(5 * points[:, 0]) + points[:, 1]
interpolator, coupling = LinearNDInterpolator(mesh, values), tessera.Coupling(points, mesh.simplices, queries)
race(f"linear at 100000 points in {len(mesh.simplices)} tets", lambda: tessera.transfer(points, mesh.simplices, values, queries).values,
     "LinearNDInterpolator of the same tets", lambda: seconds(lambda: interpolator(queries), time.perf_counter), np.allclose, time.perf_counter)
race("the same, searched before (Coupling)", lambda: coupling.apply(values), "LinearNDInterpolator, which searches",
     lambda: seconds(lambda: interpolator(queries)), np.allclose)
tree, index = cKDTree(points), tessera.collide.Index(points)
race("a tree of 100000 points", lambda: tessera.collide.Index(points), "cKDTree", lambda: seconds(lambda: cKDTree(points)),
     lambda made, of_peer: len(made) == of_peer.n)
for k in (1, 8):
    race(f"nearest {k} of 100000 points", lambda: index.nearest(queries, k), "cKDTree.query",
         lambda: seconds(lambda: tree.query(queries, [*range(1, k + 1)])), lambda r, of_peer: (r[0] == of_peer[1]).all())
race("within 0.03 of 100000 points", lambda: index.within(queries, 0.03), "cKDTree.query_ball_point",
     lambda: seconds(lambda: tree.query_ball_point(queries, 0.03)),
     lambda r, of_peer: (np.diff(r[0]) == [len(one) for one in of_peer]).all())
