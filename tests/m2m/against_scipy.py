"""against_scipy.py BIN: weights, values and errors of m2m_transfer against NumPy and SciPy, on random points.

Linear weights: barycentric coordinates in the tetrahedron that NumPy finds by trying all. Nearest: scipy.spatial.cKDTree. Moving
least squares: numpy.linalg.lstsq with Wendland's weights. Radial basis functions: scipy.interpolate.RBFInterpolator.
"""
import json
import subprocess
import sys
import tempfile

import numpy as np
from scipy.interpolate import RBFInterpolator
from scipy.io import netcdf_file
from scipy.spatial import Delaunay, cKDTree

FIELD = "sin(3*x)*y+z^2"
TOLERANCE = 1e-10
scratch = tempfile.TemporaryDirectory()
random = np.random.default_rng(1)


def write_mesh(name, points):
    """The Delaunay mesh of the points, as a legacy VTK file, whose numbers read back as the same."""
    tets = Delaunay(points).simplices
    edges = points[tets[:, 1:]] - points[tets[:, :1]]
    tets = tets[np.abs(np.linalg.det(edges)) > 1e-12]
    path = f"{scratch.name}/{name}.vtk"
    with open(path, "w") as out:
        out.write(f"# vtk DataFile Version 3.0\n{name}\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {len(points)} double\n")
        out.writelines("%r %r %r\n" % tuple(map(float, p)) for p in points)
        out.write(f"CELLS {len(tets)} {5 * len(tets)}\n")
        out.writelines("4 %d %d %d %d\n" % tuple(t) for t in tets)
        out.write(f"CELL_TYPES {len(tets)}\n" + "10\n" * len(tets))
    return path, tets


def transfer(*options):
    command = [sys.argv[1] + "/m2m_transfer", source_file, target_file, "--fields", FIELD, "--pes", "2", *options]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def weights(*options):
    """The matrix of a kind; a row of NaN where a target point has no weights."""
    path = scratch.name + "/weights.nc"
    transfer("--weights", path, *options)
    matrix = np.zeros((len(targets), len(sources)))
    with netcdf_file(path, mmap=False) as file:
        rows, columns = file.variables["row"][:] - 1, file.variables["col"][:] - 1
        np.add.at(matrix, (rows, columns), file.variables["S"][:])
    matrix[np.setdiff1d(np.arange(len(targets)), rows)] = np.nan
    return matrix


def values(*options):
    """The result in its ExodusII file: moving least squares write no weights."""
    path = scratch.name + "/result.exo"
    transfer("--out", path, *options)
    with netcdf_file(path, mmap=False) as file:
        return file.variables["vals_nod_var1"][-1].copy()


def field(p):
    return np.sin(3 * p[:, 0]) * p[:, 1] + p[:, 2] ** 2


def linear():
    corners = sources[tets]
    inverse = np.linalg.inv(np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2))
    matrix = np.zeros((len(targets), len(sources)))
    for i, point in enumerate(targets):
        inner = np.einsum("tij,tj->ti", inverse, point - corners[:, 0])
        all_four = np.column_stack([1 - inner.sum(axis=1), inner])
        best = all_four.min(axis=1).argmax()
        matrix[i, tets[best]] = all_four[best]
    return matrix


def nearest():
    return np.eye(len(sources))[cKDTree(sources).query(targets)[1]]


def moving_least_squares(order):
    """Fits in offsets from the target, where the value is the constant term."""
    matrix = np.zeros((len(targets), len(sources)))
    distances, neighbours = cKDTree(sources).query(targets, 12 if order == 1 else 30)
    for i, (r, near) in enumerate(zip(distances, neighbours)):
        s = r / (1.1 * r.max())
        d = (sources[near] - targets[i]) / r.max()
        terms = np.column_stack([np.ones(len(d)), d])
        if order == 2:
            terms = np.column_stack([terms] + [d[:, k] * d[:, m] for k in range(3) for m in range(k, 3)])
        root = np.sqrt((1 - s) ** 4 * (4 * s + 1))
        matrix[i, near] = np.linalg.lstsq(root[:, None] * terms, np.diag(root), rcond=None)[0][0]
        assert np.abs(matrix[i]).sum() < 10, "the library would choose a lower order there"
    return matrix @ field(sources)


def radial_basis():
    """RMS and largest error of the reference, and the same by SciPy."""
    path = scratch.name + "/report.json"
    transfer("--reference", "radial-basis", "--json", path)
    with open(path) as file:
        row = next(r for r in json.load(file)["results"] if r["kind"] == "radial-basis")
    fit = RBFInterpolator(sources, field(sources), kernel="thin_plate_spline", degree=1)
    error = fit(targets) - field(targets)
    return np.array([row["rms"], row["linf"]]), np.array([np.sqrt(np.mean(error**2)), np.abs(error).max()])


cube = np.array([[i >> k & 1 for k in range(3)] for i in range(8)], dtype=float)
sources = np.vstack([cube, random.random((900, 3))])
targets = 0.2 + 0.6 * random.random((300, 3))
source_file, tets = write_mesh("source", sources)
target_file, _ = write_mesh("target", targets)
failed = False
for name, (got, want) in {
    "linear": (weights("--kind", "linear"), linear()),
    "nearest": (weights("--kind", "nearest"), nearest()),
    "moving-least-squares, order 1": (values("--kind", "moving-least-squares"), moving_least_squares(1)),
    "moving-least-squares, order 2": (values("--kind", "moving-least-squares", "--order", "2"), moving_least_squares(2)),
    "radial-basis": radial_basis(),
}.items():
    difference = np.abs(got - want).max()
    good = difference <= TOLERANCE  # false for NaN
    failed = failed or not good
    print(f"{'ok' if good else 'FAILED'}: {name}: {got.size} numbers, the greatest difference is {difference:.2e} (at most {TOLERANCE:g})")
sys.exit(failed)
