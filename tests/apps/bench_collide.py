#!/usr/bin/env python3
"""bench_collide prints every row that --list names, in CSV and JSON alike; keep.sh keeps its rows; an unknown name is refused.

    bench_collide.py ROOT BIN
"""
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

root, built = pathlib.Path(sys.argv[1]), sys.argv[2]
program = built + "/bench_collide"


def run(*arguments):
    return subprocess.run(arguments, check=True, text=True, stdout=subprocess.PIPE).stdout


listed = re.findall(r"^  (\w+)", run(program, "--list"), re.M)
assert len(listed) == len(set(listed)) and len(listed) > 60, listed

with tempfile.TemporaryDirectory() as scratch:
    file = pathlib.Path(scratch) / "rows.json"
    # It compares the pairs of all methods with each other before it prints a row.
    rows = list(csv.DictReader(run(program, "--quick", "--json", str(file)).splitlines()))
    names = [row["name"] for row in rows]
    # The rows in bytes of a case come after those in nanoseconds.
    assert sorted(names) == sorted(listed), set(names) ^ set(listed)
    kept = json.loads(file.read_text())["results"]
    assert [row["name"] for row in kept] == names
    of = {row["name"]: row for row in rows}
    assert float(of["few_pairs"]["median"]) == 14534, of["few_pairs"]
    assert float(of["conversion_pairs_wrong_faces"]["median"]) == 0
    # Our rows are compared with the fastest other library of the run, if there is one.
    peers = [float(row["median"]) for name, row in of.items() if name in ("few_embree", "few_fcl")]
    for name in ("few_double", "few_float"):
        assert (of[name]["limit"] != "") == bool(peers), of[name]
        assert not peers or abs(float(of[name]["limit"]) / min(peers) - 1) < 1e-3, of[name]

    subprocess.run(["bash", root / "apps/bench/keep.sh", "--built", built, "--into", scratch + "/kept", "--program", "bench_collide",
                    "--quick", "few", "conversion_pairs"], check=True, stdout=subprocess.DEVNULL)
    (path,) = (pathlib.Path(scratch) / "kept").iterdir()
    assert "_tessera_bench_collide_" in path.name, path
    with open(path, newline="") as table:
        systems = {row["name"]: row["system"] for row in csv.DictReader(table)}
    assert {name for name in listed if name.startswith("few_")} | {"conversion_pairs"} == set(systems), systems
    for name, system in systems.items():
        assert system == ("Embree" if "_embree" in name else "FCL" if "_fcl" in name else "Tessera"), (name, system)

one = run(program, "--quick", "growth")
assert "growth_boxes_double_4096," in one and "growth_boxes_float_spread," in one and "few_" not in one, one

refused = subprocess.run([program, "cubes"], text=True, capture_output=True)
assert refused.returncode == 2 and "see --list" in refused.stderr and refused.stdout == "", refused
print(f"bench_collide: {len(listed)} rows")
