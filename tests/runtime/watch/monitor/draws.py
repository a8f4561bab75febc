#!/usr/bin/env python3
"""Programs draw on the page of --monitor: draws.py BIN. Each runs until a browser has seen a picture of it with several values."""
import json
import pathlib
import re
import subprocess
import sys
import time
import urllib.request

programs, scenes = pathlib.Path(sys.argv[1]), pathlib.Path(__file__).parents[4] / 'apps/particles/scenes'
runs = [
    ('amr', ['--steps', '1000000'], 'u in the plane through the centre', (128, 128)),
    ('leanmd', ['--atoms', '3000', '--cells', '4,4,4', '--steps', '1000000'], 'atoms in the lowest layer of cells', (32, 32)),
    ('particles', [scenes / 'rain.json', '--steps', '1000000'], 'particles of each block, layer by layer', None),
    ('lb_lab', ['--workload', 'stencil', '--per-pe', '8', '--iterations', '3000'], 'work of each block (s)', (4, 4)),
    ('lb_lab', ['--workload', 'particles', '--per-pe', '8', '--iterations', '300'], 'particles of each block', (4, 4)),
]
n_failed = 0
for program, options, name, shape in runs:
    run = subprocess.Popen([programs / program, *options, '--pes', '2', '--monitor', '0'], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    seen = 'no picture'
    try:
        url = re.search(r'http://[0-9.:]*/', run.stderr.readline())
        kind, begin = '', time.monotonic()
        for line in urllib.request.urlopen(url[0] + 'events', timeout=60) if url else []:
            line = line.decode().rstrip()
            kind = line[7:] if line.startswith('event: ') else kind
            if time.monotonic() - begin > 60:
                break
            if kind != 'picture' or not line.startswith('data: '):
                continue
            picture = json.loads(line[6:])
            seen = f'{picture["name"]}, {picture["width"]} x {picture["height"]}, {picture["least"]} to {picture["most"]}'
            right = picture['name'] == name and shape in (None, (picture['width'], picture['height']))
            if right and len(set(re.findall('..', picture['values']))) > 2:
                seen = None
            if not (right and seen):
                break
    except OSError as error:
        seen = f'{seen} ({error})'
    finally:
        run.terminate()
        run.stderr.close()
        run.wait()
    if seen:
        n_failed += 1
        print(f'FAILED: {program} {" ".join(map(str, options))}: wanted {name}, {shape}: {seen}')
if n_failed:
    sys.exit(f'{n_failed} failed')
print('all programs draw')
