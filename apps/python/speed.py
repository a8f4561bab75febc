"""Speed of tessera beside the C++ programs, and beside SciPy where it can be imported. By hand:

    ninja -C build/release tessera_python m2m_transfer python_pairs_speed
    PYTHONPATH=build/release/python /usr/bin/python3 apps/python/speed.py build/release/bin [N]

Each row is checked: both give the same answer. Times are those of the fastest of N (5) runs, which take turns;
`ratio` is the time of tessera over that of the peer. Arrays are there before, results are arrays.
"""
import json
import os
import subprocess
import sys
import tempfile
import time

del sys.path[0]  # beside this script stands the package without its extension
import numpy as np
import tessera

programs, n_runs = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 5
rng = np.random.default_rng(1)


def seconds(call):
    """(fastest of as many calls as fit into a fifth of a second, result)."""
    best, end = np.inf, time.perf_counter() + 0.2
    while best == np.inf or time.perf_counter() < end:
        begin = time.perf_counter()
        result = call()
        best = min(best, time.perf_counter() - begin)
    return best, result


def race(what, ours, peer_name, peer, same):
    """peer(): (seconds, answer)."""
    best, of_peer = np.inf, np.inf
    for _ in range(n_runs):
        took, result = seconds(ours)
        peer_took, expected = peer()
        best, of_peer = min(best, took), min(of_peer, peer_took)
        if not same(result, expected):
            sys.exit(f"speed: {what}: {peer_name} gives another answer")
    print(f"{what:44} {best:9.4f} s  {of_peer:9.4f} s {best / of_peer:7.2f}  {peer_name}", flush=True)


def program(*words):
    done = subprocess.run([os.path.join(programs, words[0]), *words[1:]], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"speed: {' '.join(words)}: exit code {done.returncode}; build it first\n{done.stderr}")
    return done.stdout


print(f"{'what':44} {'tessera':>11}  {'peer':>11} {'ratio':>7}  peer")
with tempfile.TemporaryDirectory() as folder:
    names = ("kuhn:46@0.2", "kuhn:46@0.1")
    a, b = map(tessera.read_mesh, names)
    field = a.points @ [1, -3, 2] + 1

    def m2m_transfer():
        report = os.path.join(folder, "report.json")
        program("m2m_transfer", *names, "--fields", "1+x-3*y+2*z", "--policy", "nearest", "--pes", "2", "--json", report,
                "--out", os.path.join(folder, "out.vtu"))
        with open(report, encoding="utf-8") as file:
            row = json.load(file)["results"][0]
        return (row["setup_seconds"] + row["transfer_seconds"] + row["gather_seconds"], row)

    race(f"transfer, {len(a.tets)} tets, {len(b.points)} points, pes=2",
         lambda: tessera.transfer(a.points, a.tets, field, b.points), "m2m_transfer: setup, transfer, gather", m2m_transfer,
         lambda r, row: [(r.status == s).sum() for s in range(4)] == [row[s.name.lower()] for s in tessera.Status]
         and abs(r.values - (b.points @ [1, -3, 2] + 1)).max() < 1e-13)

    low = rng.random((100_000, 3))
    boxes = np.concatenate([low, low + 0.02], 1)
    path = os.path.join(folder, "boxes")
    boxes.tofile(path)

    def pairs_in_cpp():
        took, n = program("python_pairs_speed", path, "10").split()
        return float(took), int(n)

    race("pairs of 100000 boxes", lambda: tessera.collide.pairs(boxes), "the library in C++", pairs_in_cpp,
         lambda found, n: len(found) == n)

try:
    from scipy.interpolate import LinearNDInterpolator
    from scipy.spatial import Delaunay, cKDTree
except ImportError:
    sys.exit("speed: SciPy cannot be imported: its rows are left out")
points, queries = rng.random((100_000, 3)), rng.random((100_000, 3)) * 0.9 + 0.05
mesh = Delaunay(points)
values = np.sin(5 * points[:, 0]) + points[:, 1]
race(f"linear at 100000 points of {len(mesh.simplices)} tets", lambda: tessera.transfer(points, mesh.simplices, values, queries),
     "LinearNDInterpolator(mesh, v)(q), 1 thread", lambda: seconds(lambda: LinearNDInterpolator(mesh, values)(queries)),
     lambda r, expected: np.nanmax(abs(r.values - expected)[r.status != 3]) < 1e-9)
coupling = tessera.Coupling(points, mesh.simplices, queries)
interpolator = LinearNDInterpolator(mesh, values)
race("the same, of a kept Coupling", lambda: coupling.apply(values), "a kept interpolator",
     lambda: seconds(lambda: interpolator(queries)), lambda r, expected: np.nanmax(abs(r - expected)) < 1e-9)
tree, index = cKDTree(points), tessera.collide.Index(points)
race("a tree of 100000 points", lambda: tessera.collide.Index(points), "cKDTree", lambda: seconds(lambda: cKDTree(points)),
     lambda made, of_peer: len(made) == of_peer.n)
for k in (1, 8):
    race(f"nearest {k} of 100000 points", lambda: index.nearest(queries, k), "cKDTree.query",
         lambda: seconds(lambda: tree.query(queries, [*range(1, k + 1)])), lambda r, of_peer: (r[0] == of_peer[1]).all())
race("within 0.03 of 100000 points", lambda: index.within(queries, 0.03), "cKDTree.query_ball_point",
     lambda: seconds(lambda: tree.query_ball_point(queries, 0.03)),
     lambda r, of_peer: (np.diff(r[0]) == [len(one) for one in of_peer]).all())
