"""tessera.balance against NumPy, and a strategy in Python against the library's."""
import os
import tempfile
import unittest

import numpy as np
import tessera
from oracles import greedy
from tessera import balance

RNG = np.random.default_rng(7)
N, PES = 60, 5
EDGES = np.stack([RNG.integers(0, N, 200), RNG.integers(0, N, 200), RNG.integers(1, 999, 200), np.ones(200, int)], 1)


def scene(**more):
    return balance.snapshot(RNG.uniform(0.5, 2, N), RNG.integers(0, PES, N), PES, sizes=np.arange(N) * 10,
                            edges=EDGES, positions=RNG.random((N, 3)), **more)


class Balance(unittest.TestCase):
    def test_evaluate(self):
        s = scene()
        new = (s.owners + 1) % PES
        new[:10] = s.owners[:10]
        e = balance.evaluate(s, new)
        times = np.bincount(new, s.loads, PES)
        self.assertAlmostEqual(e.imbalance, times.max() / times.mean())
        self.assertEqual((e.moves, e.moved_bytes), (N - 10, int(s.sizes[10:].sum())))
        crossing = new[EDGES[:, 0]] != new[EDGES[:, 1]]
        self.assertEqual(e.external_bytes, EDGES[crossing, 2].sum())
        self.assertEqual(balance.evaluate(s).moves, 0)

    def test_a_strategy_in_python_does_what_the_library_does(self):
        for more in ({}, {"speeds": [1, 2, 1, 2, 0.5], "background": [0, 3, 1, 0, 2]}):
            s = scene(**more)
            np.testing.assert_array_equal(balance.assign(s, greedy), balance.assign(s, "greedy"))

    def test_every_strategy_gives_pes(self):
        s = scene()
        before = balance.evaluate(s).imbalance
        for name in balance.strategies():
            if name == "graph":
                continue  # Scotch may be left out
            new = balance.assign(s, name)
            self.assertTrue(new.shape == (N,) and new.min() >= 0 and new.max() < PES, name)
            if name in ("greedy", "greedy_refine", "refine", "hierarchical"):
                self.assertLess(balance.evaluate(s, new).imbalance, before, name)
        np.testing.assert_array_equal(balance.assign(s, "none"), s.owners)
        np.testing.assert_array_equal(balance.assign(s, "random", 5), balance.assign(s, "random", 5))

    def test_elements_of_unknown_load_stay(self):
        s = balance.snapshot([1, np.nan, 2], [0, 0, 0], 2)
        self.assertTrue(np.isnan(s.loads[1]))
        np.testing.assert_array_equal(balance.assign(s, lambda snapshot: [1, 1, 1]), [1, 0, 1])

    def test_comparison(self):
        table = balance.compare(scene(), ["greedy", greedy])
        self.assertEqual(list(table.rows), ["before", "greedy", "greedy()"])
        self.assertEqual(table.rows["greedy"], table.rows["greedy()"])
        self.assertIn(f"{table.rows['greedy'].imbalance:.3f}", str(table).splitlines()[2])
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "b.svg")
            table.plot(path)
            with open(path, encoding="utf-8") as file:
                self.assertIn(">greedy()</text>", file.read())

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            ranks = [os.path.join(folder, f"vt.{rank}.json") for rank in range(2)]
            for rank, path in enumerate(ranks):  # as vt writes them: a file per rank
                entity = f'"entity": {{"type": "object", "id": {rank}, "home": {rank}, "migratable": true}}'
                task = f'{{{entity}, "node": {rank}, "resource": "cpu", "time": {rank + 1}.5}}'
                with open(path, "w", encoding="ascii") as file:
                    file.write(f'{{"type": "LBDatafile", "phases": [{{"id": 0, "tasks": [{task}], "communications": '
                               f'[{{"type": "SendRecv", "from": {entity[10:]}, "to": {entity[10:]}, "messages": 2, '
                               f'"bytes": 70.0}}]}}, {{"id": 1, "tasks": [{task}]}}]}}')
            vt, later = balance.read(*ranks)
            self.assertEqual((vt.edges.tolist(), later.edges.shape), ([[0, 0, 70, 2], [1, 1, 70, 2]], (0, 4)))
            self.assertEqual((list(vt.loads), list(vt.owners), vt.n_pes), ([1.5, 2.5], [0, 1], 2))
        with self.assertRaisesRegex(tessera.Error, "no_such"):
            balance.read("no_such.json")

    def test_errors(self):
        s = scene()

        def fails(snapshot):
            raise RuntimeError("of the strategy")

        for call, words in (
                (lambda: balance.assign(s, "greedyy"), "no balance strategy 'greedyy'; choose one of none"),
                (lambda: balance.assign(s, 3), "is no name and no function"),
                (lambda: balance.assign(s, lambda _: [0]), r"PEs of the strategy: its shape is \(1,\)"),
                (lambda: balance.assign(s, lambda x: x.owners + 1), "PEs of the strategy.* is 5, and there are 5 PEs"),
                (lambda: balance.assign(s, lambda x: x.loads), "its dtype is float64"),
                (lambda: balance.assign(balance.snapshot([1], [0], 1), "rcb"), "positions of all elements"),
                (lambda: balance.evaluate(s, s.owners - 1), "is -1"),
                (lambda: balance.compare(s, [lambda x: x.owners, lambda x: x.owners]), "two are named <lambda>"),
                (lambda: balance.snapshot([1, -2], [0, 0], 1), r"loads\[1\] is -2"),
                (lambda: balance.snapshot([1], [1], 1), r"owners\[0\] is 1, and there are 1 PEs"),
                (lambda: balance.snapshot([1], [0], 0), "n_pes: 0"),
                (lambda: balance.snapshot([1], [0], 1, speeds=[0]), "speed"),
                (lambda: balance.snapshot([1], [0], 1, speeds=[np.nan]), r"speeds\[0\] is nan"),
                (lambda: balance.snapshot([1], [0], 1, sizes=[0.5]), "sizes: its dtype is float64; expected integers"),
                (lambda: balance.snapshot([1], [0], 1, edges=[[0, 1, 5, 1]]), r"edges\[0, 1\] is 1, and there are 1 ele")):
            with self.assertRaisesRegex(tessera.Error, words):
                call()
        with self.assertRaisesRegex(RuntimeError, "of the strategy"):
            balance.assign(s, fails)
        with self.assertRaises(ValueError):
            s.loads[0] = 3


if __name__ == "__main__":
    unittest.main()
