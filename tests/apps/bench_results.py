#!/usr/bin/env python3
"""Checks the kept results of benchmarks, keep.sh, start.sh, and that rows have no ratio to a figure of another machine.

    bench_results.py ROOT BIN
"""
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

root, built = pathlib.Path(sys.argv[1]), sys.argv[2]
COLUMNS = "name,median,unit,pes,ranks,system,version,machine,date,note".split(",")


def rows_of(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    assert rows, f"{path} has no rows"
    for row in rows:
        assert list(row) == COLUMNS and None not in row.values(), f"{path}: columns of {row}"
        assert float(row["median"]) == float(row["median"]) and int(row["pes"]) >= int(row["ranks"]) >= 1, f"{path}: {row}"
        for key in ("name", "unit", "system", "version", "machine", "date"):
            assert row[key], f"{path}: {row['name']} has no {key}"
    return rows


kept = sorted((root / "apps/bench/results").iterdir())
assert kept, "no result is kept"
n_rows = sum(len(rows_of(path)) for path in kept)

# The figures of the first page are kept ones.
found = {(row["name"], row["system"], float(row["median"]), row["date"]) for path in kept for row in rows_of(path)}
page = re.findall(r"^\|[^|]*\| ([\d.]+) ns \| ([\d.]+) ns, (\S+) \| `(\w+)`,(?: `(\w+)`,)? .*, (\S+) \|$",
                  (root / "README.md").read_text(), re.M)
assert len(page) == 3, page
for ours, other, system, name, name_of_other, date in page:
    assert (name, "Tessera", float(ours), date) in found and (name_of_other or name, system, float(other), date) in found, (name, ours, other)

# keep.sh writes such a file, with the rows of one PE, two PEs and two processes.
with tempfile.TemporaryDirectory() as into:
    subprocess.run(["bash", root / "apps/bench/keep.sh", "--built", built, "--into", into, "--quick", "message"],
                   check=True, stdout=subprocess.DEVNULL)
    (path,) = pathlib.Path(into).iterdir()
    places = {(row["pes"], row["ranks"]) for row in rows_of(path) if row["name"] == "message"}
    assert places == {("1", "1"), ("2", "1"), ("2", "2")}, places
    assert "_tessera_" in path.name, path

# A run that fails leaves no file, though the runs before and after it have rows.
with tempfile.TemporaryDirectory() as folder:
    fake, into = pathlib.Path(folder, "bin"), pathlib.Path(folder, "into")
    fake.mkdir()
    into.mkdir()
    (fake / "bench").write_text("#!/bin/sh\n[ \"$2\" = 2 ] && exit 3\nexec '%s/bench' \"$@\"\n" % built)
    (fake / "bench").chmod(0o755)
    done = subprocess.run(["bash", root / "apps/bench/keep.sh", "--built", fake, "--into", into, "--quick", "message"],
                          stdout=subprocess.DEVNULL)
    assert done.returncode == 3 and not list(into.iterdir()), (done.returncode, list(into.iterdir()))

# predict.py runs its six cases on three machines. It reads the times of a transfer more exactly than the printed table has
# them, in steps of 0.1 ms.
with tempfile.TemporaryDirectory() as folder:
    machine = pathlib.Path(folder, "here.sim")
    machine.write_text("latency=1us\noverhead=100ns\n")
    said = subprocess.run(["python3", root / "apps/bench/predict.py", machine, "--built", built, "--quick"], check=True, text=True,
                          stdout=subprocess.PIPE).stdout
    assert len(re.findall(r"[-+][\d.]+%$", said, re.M)) == 18, said
    times = re.findall(r"m2m_transfer.*? ([\d.]+) +\d+% +([\d.]+) +\d+% ", said)
    assert len(times) == 3 and not all(time.endswith("00") for both in times for time in both), said

# monitor_cost.sh ends if its run does not start.
with tempfile.TemporaryDirectory() as fake:
    done = subprocess.run(["bash", root / "apps/bench/monitor_cost.sh", "--built", fake, "--seconds", "1"], text=True,
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=60)
    assert done.returncode == 1 and "the run ended before it could be watched" in done.stderr, done

# start.sh prints a row for each way to start, refuses a number of runs that it cannot do, and ends if a program fails.
start = ["bash", root / "apps/bench/start.sh", "--built", built, "--repeat"]
table = subprocess.run(start + ["2"], check=True, text=True, stdout=subprocess.PIPE).stdout
rows = list(csv.DictReader(table.splitlines()))
assert [row["name"] for row in rows] == ["start_one_process", "start_two_ranks", "start_mpirun_true"], table
assert all(0 < float(row["least"]) <= float(row["median"]) for row in rows), table
assert subprocess.run(start + ["0"], stderr=subprocess.DEVNULL).returncode == 2
with tempfile.TemporaryDirectory() as fake:
    pathlib.Path(fake, "hello").write_text("#!/bin/sh\nexit 3\n")
    pathlib.Path(fake, "hello").chmod(0o755)
    done = subprocess.run(["bash", root / "apps/bench/start.sh", "--built", fake], stdout=subprocess.PIPE)
    assert (done.returncode, done.stdout) == (3, b""), done

# A time of a particle's step has no limit; a share, of two times of the same run, has one.
table = subprocess.run([built + "/bench_dn_field", "--particles", "20000", "--repeat", "1", "--only", "impact"], check=True,
                       text=True, stdout=subprocess.PIPE).stdout
rows = list(csv.DictReader(line for line in table.splitlines() if not line.startswith("#")))
assert len(rows) > 5, table
for row in rows:
    assert (row["ratio"] != "") == (row["unit"] == "%"), row

print(f"bench results: {n_rows} rows in {len(kept)} files, {len(rows)} rows of a run")
