"""The interpreter as a host: errors of transfers, threads, signals, mpirun, symbols, stubs and types."""
import ast
import inspect
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
import typing
import unittest

import numpy as np
import tessera
from oracles import kuhn
from tessera import _tessera

POINTS, TETS = kuhn(16, 0.2)
FIELD = POINTS @ [1, 2, 3]
TARGET = np.random.default_rng(1).random((20000, 3))


def call(**changes):
    arguments = {"source_points": POINTS, "source_tets": TETS, "values": FIELD, "target_points": TARGET[:9]}
    return tessera.transfer(**{**arguments, **changes})


class Errors(unittest.TestCase):
    def test_sentences_name_value_place_and_remedy(self):
        bad_tets = TETS.copy()
        bad_tets[7, 2] = -1
        wide = np.zeros((9, 2))
        for changes, words in (
                ({"values": FIELD[1:]}, r"values: its shape is \(4912,\); expected \(4913,\) or \(4913, c\), for"),
                ({"values": FIELD[:, None, None]}, "values: its shape is"),
                ({"values": np.zeros((4913, 0))}, "values: its shape is"),
                ({"values": FIELD * 1j}, "values: its dtype is complex128; expected real numbers"),
                ({"values": None}, "values"),
                ({"values": np.ma.masked_less(FIELD, 1)}, "values: it is a masked array"),
                ({"source_points": POINTS[:, :2]}, r"source_points: its shape is \(4913, 2\); expected \(n, 3\)"),
                ({"source_points": POINTS * 1e200}, r"source_points\[.*\] is .*; give finite numbers of at most"),
                ({"source_tets": bad_tets}, r"source_tets\[7, 2\] is -1, and there are 4913 points"),
                ({"source_tets": TETS * 1.0}, "source_tets: its dtype is float64; expected integers"),
                ({"source_tets": TETS[:, [0]]}, r"source_tets: its shape is .*; expected \(m, 4\)"),
                ({"source_tets": None}, "kind linear needs source_tets"),
                ({"source_points": POINTS * [1, 1, 0]}, "."),
                ({"target_points": TARGET * np.nan}, r"target_points\[0, 0\] is nan"),
                ({"kind": "cubic"}, "kind 'cubic' is unknown; choose one of linear"),
                ({"kind": "native"}, "kind native needs the elements of a file"),
                ({"kind": "conservative"}, "give target_tets"),
                ({"kind": "conservative", "outside": "nearest"}, "no nearest vertex"),
                ({"outside": "value:3"}, "outside: 'value:3' is unknown"),
                ({"outside": np.inf}, "inf"),
                ({"initial": wide, "outside": "keep"}, r"initial: its shape is \(9, 2\); expected \(9,\), as the values have it"),
                ({"tolerance": -1.0}, "tolerance -1"),
                ({"order": 3, "kind": "moving-least-squares"}, "order 3"),
                ({"pes": 0}, "pes: 0 is not a number of threads from 1 to 4096"),
                ({"pes": 5000}, "pes: 5000")):
            with self.assertRaisesRegex(tessera.Error, words, msg=str(changes.keys())):
                call(**changes)
            self.assertNotIn("\n", words)
        for kind in ("moving-least-squares", "limited"):
            limited = tessera.Coupling(POINTS, TETS, TARGET[:9], kind)
            for get in (limited.weights_csr, limited.weights, lambda: call(kind=kind).donors):
                with self.assertRaisesRegex(tessera.Error, f"kind {kind} has no weights here"):
                    get()
        np.testing.assert_allclose(limited.apply(FIELD), TARGET[:9] @ [1, 2, 3])
        self.assertTrue(issubclass(tessera.Error, ValueError))


class Threads(unittest.TestCase):
    def test_another_thread_runs_meanwhile(self):
        boxes = np.concatenate([TARGET, TARGET + 0.02], 1)
        field_points = kuhn(1)[0]
        cube = [[0, 1, 3], [0, 3, 2], [4, 7, 5], [4, 6, 7], [0, 5, 1], [0, 4, 5], [2, 3, 7], [2, 7, 6], [0, 2, 6],
                [0, 6, 4], [1, 5, 7], [1, 7, 3]]
        index = tessera.collide.Index(boxes)
        snapshot = tessera.balance.snapshot(TARGET[:, 0], np.zeros(20000, int), 64)
        for work in (lambda: call(target_points=TARGET), lambda: tessera.collide.pairs(boxes),
                     lambda: index.nearest(TARGET, 8), lambda: tessera.sdf.build(field_points, cube, 48),
                     lambda: tessera.balance.assign(snapshot, "hierarchical")):
            # With the lock held, this thread would sleep through nearly all of the call, each time.
            self.assertTrue(any(self.longest_wait(work) < 0.4 for _ in range(40)))

    def longest_wait(self, work):
        """The longest time without a turn of this thread while another one works, as a part of the work."""
        took = []

        def run():
            begin = time.perf_counter()
            work()
            took.append(time.perf_counter() - begin)

        thread = threading.Thread(target=run)
        longest, last = 0.0, time.perf_counter()
        thread.start()
        while thread.is_alive():
            time.sleep(0.0002)
            now = time.perf_counter()
            longest, last = max(longest, now - last), now
        return longest / took[0]

    def test_calls_of_several_threads(self):
        expected = call(target_points=TARGET).values
        results = {}

        def run(k):
            results[k] = call(target_points=TARGET, pes=1 + k % 3).values

        threads = [threading.Thread(target=run, args=(k,)) for k in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(results), 6)
        for values in results.values():
            np.testing.assert_array_equal(values, expected)

    def test_a_thread_with_a_small_stack_can_call(self):
        before, values = threading.stack_size(128 << 10), []
        thread = threading.Thread(target=lambda: values.append(call().values))
        thread.start()
        thread.join()
        threading.stack_size(before)
        np.testing.assert_allclose(values, [TARGET[:9] @ [1, 2, 3]])

    def test_many_calls_leave_no_threads_and_no_affinity(self):
        cores, n = os.sched_getaffinity(0), len(os.listdir("/proc/self/task"))
        for _ in range(20):
            call()
        self.assertEqual(os.sched_getaffinity(0), cores)
        self.assertLessEqual(len(os.listdir("/proc/self/task")), n)

    def test_memory_does_not_grow(self):
        def resident():
            with open("/proc/self/statm", encoding="ascii") as file:
                return int(file.read().split()[1]) * 4096

        boxes = np.concatenate([TARGET, TARGET + 0.05], 1)
        for k in range(25):
            call(target_points=TARGET)
            tessera.collide.pairs(boxes)
            before = resident() if k == 4 else before if k > 4 else 0
        self.assertLess(resident() - before, 40e6)


class Host(unittest.TestCase):
    def run_python(self, code, *launcher):
        return subprocess.run([*launcher, sys.executable, "-c", code], capture_output=True, text=True, timeout=120)

    def test_an_interrupt_is_raised_when_the_call_ends(self):
        done = self.run_python(
            "import os, signal, threading, time, tessera\n"
            "mesh = tessera.read_mesh('kuhn:24@0.2')\n"
            "f = mesh.points[:, 0]\n"
            "move = lambda: tessera.transfer(mesh.points, mesh.tets, f, mesh.points)\n"
            "move()\n"
            "threading.Timer(0.02, lambda: os.kill(os.getpid(), signal.SIGINT)).start()\n"
            "try:\n"
            "  while True: move()\n"
            "except KeyboardInterrupt: print('interrupted')\n"
            "print(abs(move().values - f).max() < 1e-12, signal.getsignal(signal.SIGINT) is signal.default_int_handler)\n")
        self.assertEqual((done.stdout, done.stderr, done.returncode), ("interrupted\nTrue True\n", "", 0))

    @unittest.skipUnless(shutil.which("mpirun"), "there is no mpirun")
    def test_under_mpirun_each_process_is_a_host_of_its_own(self):
        done = self.run_python(
            "import os, tessera\n"
            "mesh = tessera.read_mesh('kuhn:4')\n"
            "r = tessera.transfer(mesh.points, mesh.tets, mesh.points[:, 0], mesh.points)\n"
            "os.write(1, f'{abs(r.values - mesh.points[:, 0]).max():.0f}\\n'.encode())\n",
            "mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2")
        self.assertEqual((done.stdout.split(), done.returncode), (["0", "0"], 0), done.stderr)

    @unittest.skipUnless(shutil.which("nm"), "there is no nm")
    def test_no_symbol_of_the_libraries_leaves_the_module(self):
        names = subprocess.run(["nm", "-D", "--defined-only", _tessera.__file__], capture_output=True, text=True,
                               check=True).stdout
        self.assertIn("PyInit__tessera", names)
        for leak in ("_Znwm", "_ZdlPv", "tess4"):
            self.assertNotIn(leak, names)

    def test_a_forked_child_can_call(self):
        call()
        pid = os.fork()
        if pid == 0:
            os._exit(0 if abs(call().values - TARGET[:9] @ [1, 2, 3]).max() < 1e-12 else 1)
        self.assertEqual(os.waitpid(pid, 0)[1], 0)

    def test_a_child_forked_during_a_call_of_another_thread_refuses(self):
        done = self.run_python(
            "import os, signal, threading, tessera\n"
            "mesh = tessera.read_mesh('kuhn:8@0.2')\n"
            "move = lambda: tessera.transfer(mesh.points, mesh.tets, mesh.points[:, 0], mesh.points)\n"
            "def work():\n"
            "  while not stop: move()\n"
            "def fork():\n"
            "  pid = os.fork()\n"
            "  if pid: return os.waitpid(pid, 0)[1]\n"
            "  signal.alarm(30)  # ends a child that waits for ever\n"
            "  try: move()\n"
            "  except tessera.Error as error: os._exit(1 if 'spawn' in str(error) else 2)\n"
            "  os._exit(0)\n"
            "stop = []\n"
            "thread = threading.Thread(target=work)\n"
            "thread.start()\n"
            "ends = set()\n"
            "while 1 not in ends and len(ends) < 3: ends.add(os.waitstatus_to_exitcode(fork()))\n"
            "stop.append(1)\n"
            "thread.join()\n"
            "print(ends <= {0, 1}, fork())\n")
        self.assertEqual((done.stdout, done.stderr, done.returncode), ("True 0\n", "", 0))


class Types(unittest.TestCase):
    def test_the_package_is_typed(self):
        folder = os.path.dirname(tessera.__file__)
        self.assertTrue(os.path.exists(os.path.join(folder, "py.typed")))
        with open(os.path.join(folder, "_tessera.pyi"), encoding="utf-8") as file:
            stub = {node.name for node in ast.parse(file.read()).body if hasattr(node, "name")}
        self.assertEqual(stub, {"Error", "__getattr__"})
        self.assertIs(_tessera.Error, tessera.Error)

    def test_all_public_functions_have_types_and_a_docstring(self):
        for module in (tessera, tessera.balance, tessera.collide, tessera.sdf):
            for name in module.__all__:
                thing = getattr(module, name)
                if not callable(thing) or not getattr(thing, "__module__", "").startswith("tessera"):
                    continue
                self.assertTrue(inspect.getdoc(thing), name)
                if inspect.isfunction(thing):
                    self.assertEqual(set(typing.get_type_hints(thing)),
                                     set(inspect.signature(thing).parameters) | {"return"}, name)


if __name__ == "__main__":
    unittest.main()
