#!/usr/bin/env python3
"""Every program's --json has one shape, in each of its modes: one reader reads them all.

    json_shape.py ROOT BIN
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

root, built = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
SCENE = str(root / "apps/particles/scenes/bouncy.json")
COMMANDS = [line.split() for line in f"""
amr --max-level 3 --cells 4 --steps 2
amr --study --max-level 3 --cells 4 --steps 2
amr --stability --pes 2
fsi --panel 8 --steps 8
fsi --study --panel 8 --steps 16
fsi --stability
nqueens 6
nqueens 6 --first
nqueens 6 --study --sim pes=4
leanmd --atoms 500 --cells 3,3,3 --steps 4
leanmd --study --atoms 500 --cells 3,3,3 --steps 8
leanmd --stability
collide_scene boxes:500 --steps 2
collide_scene boxes:500 --pes 2
collide_scene boxes:500 --study voxels
collide_scene boxes:500 --study pes
collide_scene --stability
particles {SCENE} --steps 5
particles {SCENE} --study --resolutions 8
particles --stability
overset kuhn:8 ball:4
overset ball --study h
overset ball --study wall
m2m_transfer kuhn:3 kuhn:4
m2m_transfer kuhn:3 kuhn:4 --kind all
m2m_transfer kuhn:3,4 kuhn:4,5 --study h
m2m_transfer kuhn:3,4 kuhn:4,5 --study kind --fields linear
m2m_transfer kuhn:3 kuhn:4 --study steps
m2m_transfer kuhn:3 kuhn:4 --study pes
m2m_transfer kuhn:3 kuhn:4 --round-trips 1,2
m2m_transfer --stability
lb_lab --workload uniform --per-pe 2 --strategy none,greedy --iterations 20 --grain 20us --sim pes=2
task_bench -steps 4 -width 4 -type stencil_1d -kernel compute_bound -iter 16
task_bench -metg -steps 4 -width 4 -type stencil_1d
bench --quick message
""".strip().splitlines()]
KEYS = ["program", "version", "commit", "compiler", "mpi", "machine", "options", "results"]


def check(command, folder):
    path = os.path.join(folder, "out.json")
    done = subprocess.run([built / command[0], *command[1:], "--json", path], text=True, capture_output=True, cwd=folder)
    said = " ".join(command)
    if done.returncode != 0 or not os.path.exists(path):
        return f"{said}: exit code {done.returncode}: {done.stderr[-300:]}"
    with open(path) as file:
        read = json.load(file)
    os.remove(path)
    if list(read)[:len(KEYS)] != KEYS:
        return f"{said}: the members are {list(read)}"
    if read["program"] != command[0] or not isinstance(read["options"], dict):
        return f"{said}: program {read['program']}, options {read['options']}"
    if not read["results"] or not all(isinstance(row, dict) for row in read["results"]):
        return f"{said}: results is no list of objects"
    if any(set(row) != set(read["results"][0]) for row in read["results"]):
        return f"{said}: rows of results have different members"
    return None


with tempfile.TemporaryDirectory() as into:
    wrong = [text for text in (check(command, into) for command in COMMANDS) if text]
print("\n".join(wrong))
print(f"{len(COMMANDS) - len(wrong)} of {len(COMMANDS)} commands write the one shape")
sys.exit(bool(wrong))
