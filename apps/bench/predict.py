#!/usr/bin/env python3
"""Sets the times that the simulated machine predicts against measured ones, on one PE, two PEs and two processes.

    bench --pes 2 --calibrate here.sim && mpirun -n 2 bench --pes 1 --calibrate here.sim
    apps/bench/predict.py here.sim [--built build/release/bin] [--repeat 5] [--only stencil] [--within 15] [--quick]

Each run is measured and predicted in turns; medians count. With --within the exit code is 1 if a prediction differs by more
percent. --recalibrate calibrates anew before each turn, for a machine whose cores are not always the same ones, as a virtual one:
FILE is written. --quick runs small problems once: to try out, not to measure. Run it on an idle machine: the load is printed.
"""
import argparse
import functools
import json
import operator
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

STENCIL = r"steps: ([\d.]+) s"
TASKS = r"Elapsed Time ([\d.e+-]+) seconds"
LABORATORY = r"\n\S+ +\d+ greedy_refine +([\d.]+)"
TRANSFER = ["results", 0, "transfer_seconds"]  # in the file of --json: the printed table has steps of 0.1 ms

# Name, program with options, with --quick, where the seconds stand: a pattern of its output, or a place in its JSON.
CASES = [
    ("stencil, 16 points per block", "stencil --size 64 --blocks 16 --steps 2000", "stencil --size 16 --blocks 4 --steps 20", STENCIL),
    ("stencil, 4096 points per block", "stencil --size 512 --blocks 8 --steps 2000", "stencil --size 32 --blocks 2 --steps 20", STENCIL),
    ("task_bench, stencil_1d, empty tasks", "task_bench -type stencil_1d -width 32 -steps 10000", "task_bench -steps 20", TASKS),
    ("task_bench, spread, 1 KiB outputs", "task_bench -type spread -radix 5 -width 32 -steps 3000 -output 1024",
     "task_bench -type spread -width 8 -steps 20", TASKS),
    ("m2m_transfer, 24 576 tetrahedra", "m2m_transfer kuhn:16@0.2 kuhn:17 --field sin", "m2m_transfer kuhn:3 kuhn:4 --field sin", TRANSFER),
    ("lb_lab, linear_comm, greedy_refine",
     "lb_lab --workload linear_comm --per-pe 8 --strategy greedy_refine --iterations 200 --period 20 --grain 100us",
     "lb_lab --workload linear_comm --per-pe 2 --strategy greedy_refine --iterations 20 --period 5 --grain 10us", LABORATORY),
]
# Name, options of the simulated machine, PEs of a process, processes.
MACHINES = [("1 PE", "pes=1", 1, 1), ("2 PEs", "pes=2", 2, 1), ("2 ranks", "pes=2,per-process=1", 1, 2)]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help="what bench --calibrate wrote")
    parser.add_argument("--built", default="build/release/bin", help="the folder of the programs")
    parser.add_argument("--repeat", type=int, default=5, help="runs of each")
    parser.add_argument("--only", default="", help="cases whose name has this text")
    parser.add_argument("--within", type=float, help="percent")
    parser.add_argument("--recalibrate", action="store_true", help="calibrate before each turn; writes the file")
    parser.add_argument("--quick", action="store_true", help="small problems, once")
    given = parser.parse_args()
    if given.repeat < 1:
        parser.error(f"--repeat {given.repeat}: give at least 1")
    if not any(given.only in case[0] for case in CASES):
        parser.error(f"--only {given.only}: no case has this in its name; there are " + "; ".join(case[0] for case in CASES))
    if not given.recalibrate and not os.access(given.file, os.R_OK):
        parser.error(f"{given.file} cannot be read: write it with bench --calibrate {given.file}")
    return given


def seconds_of(command, place):
    with tempfile.TemporaryDirectory() as scratch:
        rows = pathlib.Path(scratch, "rows.json")
        written = [] if isinstance(place, str) else ["--json", str(rows)]
        done = subprocess.run(command + written, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=600)
        seconds = 0.0
        if written and rows.exists():
            seconds = functools.reduce(operator.getitem, place, json.loads(rows.read_text()))
        elif not written and (found := re.search(place, done.stdout)):
            seconds = float(found.group(1))
    if done.returncode != 0 or not seconds > 0:
        sys.exit(f"predict.py: {' '.join(command)}: exit code {done.returncode}, {'' if seconds > 0 else 'no time above 0 in '}its output:\n"
                 + done.stdout + done.stderr)
    return seconds


def calibrate(start, n_pes, given):
    command = start + [str(pathlib.Path(given.built) / "bench"), "--pes", str(n_pes), "--calibrate", given.file]
    command += ["--quick"] if given.quick else []
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=600)
    if done.returncode != 0:
        sys.exit(f"predict.py: {' '.join(command)}: exit code {done.returncode}, its output:\n{done.stdout}")


def main():
    given = arguments()
    mpirun = ["mpirun", "--oversubscribe"] + (["--allow-run-as-root"] if os.geteuid() == 0 else [])
    if given.recalibrate:
        for _, _, n_pes, n_processes in MACHINES[1:]:
            calibrate(mpirun + ["-n", str(n_processes)] if n_processes > 1 else [], n_pes, given)
    print("load before:", *(f"{load:.2f}" for load in os.getloadavg()))
    print(f"{'':<38} {'':<8} {'measured ms':>12} {'spread':>7} {'predicted ms':>13} {'spread':>7} {'differs':>8}")
    worst = 0.0
    for name, full, quick, place in CASES:
        if given.only not in name:
            continue
        program, *options = (quick if given.quick else full).split()
        command = [str(pathlib.Path(given.built) / program), *options]
        for machine, simulated, n_pes, n_processes in MACHINES:
            start = mpirun + ["-n", str(n_processes)] if n_processes > 1 else []
            measured, predicted = [], []
            for _ in range(1 if given.quick else given.repeat):
                if given.recalibrate and n_pes * n_processes == 2:
                    calibrate(start, n_pes, given)
                measured.append(seconds_of(start + command + ["--pes", str(n_pes)], place))
                predicted.append(seconds_of(command + ["--sim", f"file={given.file},{simulated}"], place))
            middle = [statistics.median(times) for times in (measured, predicted)]
            spread = [100 * (max(times) - min(times)) / m for times, m in zip((measured, predicted), middle)]
            differs = 100 * (middle[1] / middle[0] - 1)
            worst = max(worst, abs(differs))
            print(f"{name:<38} {machine:<8} {1e3 * middle[0]:>12.3f} {spread[0]:>6.0f}% {1e3 * middle[1]:>13.3f} {spread[1]:>6.0f}% "
                  f"{differs:>+7.1f}%", flush=True)
    print("load after:", *(f"{load:.2f}" for load in os.getloadavg()))
    if given.within is not None and worst > given.within:
        sys.exit(f"predict.py: a prediction differs by {worst:.1f} %, more than {given.within:g} %")


main()
