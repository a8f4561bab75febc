"""tessera.transfer, Coupling and files of meshes against brute force."""
import os
import tempfile
import unittest

import numpy as np
import tessera
from oracles import integral, interpolate, kuhn

SOURCE, TETS = kuhn(4, 0.2)
RNG = np.random.default_rng(3)
TARGET = RNG.uniform(-0.1, 1.1, (150, 3))
FIELD = np.sin(3 * SOURCE[:, 0]) + SOURCE[:, 1] * SOURCE[:, 2]


class Points(unittest.TestCase):
    def test_values_status_and_distance_are_those_of_brute_force(self):
        expected, inside, nearest = interpolate(SOURCE, TETS, FIELD, TARGET)
        result = tessera.transfer(SOURCE, TETS, FIELD, TARGET)
        np.testing.assert_allclose(result.values, expected[:, 0], atol=1e-12)
        np.testing.assert_array_equal(result.status == tessera.Status.OUTSIDE, ~inside)
        np.testing.assert_allclose(result.distance, np.where(inside, 0, nearest), atol=1e-12)
        self.assertTrue(10 < inside.sum() < 140)
        self.assertIn(f"{(~inside).sum()} outside", repr(result))

    def test_the_result_does_not_depend_on_threads_or_layout(self):
        fields = np.stack([FIELD, FIELD ** 2, -FIELD], 1)
        bits = [tessera.transfer(SOURCE, TETS, fields, TARGET, pes=pes).values.tobytes() for pes in (1, 2, 3)]
        self.assertEqual(len(set(bits)), 1)
        other = tessera.transfer(np.asfortranarray(SOURCE), TETS.astype(np.uint16), np.asfortranarray(fields),
                                 np.repeat(TARGET, 2, 0)[::2])
        self.assertEqual(other.values.tobytes(), bits[0])
        for c in range(3):
            one = tessera.transfer(SOURCE.tolist(), TETS, fields[:, c], TARGET).values
            np.testing.assert_array_equal(one, other.values[:, c])

    def test_outside(self):
        _, inside, _ = interpolate(SOURCE, TETS, FIELD, TARGET)
        first = np.arange(150.0)
        for outside, initial, expected in ((7, None, 7), (np.float32(0.5), None, 0.5), ("keep", None, np.nan),
                                           ("keep", first, first[~inside])):
            result = tessera.transfer(SOURCE, TETS, FIELD, TARGET, outside=outside, initial=initial).values
            np.testing.assert_array_equal(result[~inside], expected)
            coupled = tessera.Coupling(SOURCE, TETS, TARGET, outside=outside).apply(FIELD, initial=initial)
            np.testing.assert_array_equal(coupled, result)
        np.testing.assert_array_equal(first, np.arange(150.0))

    def test_kinds(self):
        linear = SOURCE @ [1, 2, 3] + 4
        within = RNG.uniform(0, 1, (60, 3))
        for kind in ("linear", "second-order", "limited", "projection", "moving-least-squares"):
            values = tessera.transfer(SOURCE, TETS, linear, within, kind).values
            np.testing.assert_allclose(values, within @ [1, 2, 3] + 4, atol=1e-12, err_msg=kind)
        near = np.linalg.norm(TARGET[:, None] - SOURCE, axis=-1).argmin(1)
        for tets in (TETS, None):
            result = tessera.transfer(SOURCE, tets, FIELD, TARGET, "nearest")
            np.testing.assert_array_equal(result.values, FIELD[near])
            np.testing.assert_array_equal(result.donors[:, 0], near)
        cloud = tessera.transfer(SOURCE, None, linear, TARGET, "moving-least-squares", pes=3)
        np.testing.assert_allclose(cloud.values, TARGET @ [1, 2, 3] + 4, atol=1e-11)
        clamped = tessera.transfer(SOURCE, None, linear, TARGET, "moving-least-squares", clamp=True)
        self.assertTrue(clamped.values.min() >= linear.min() and clamped.values.max() <= linear.max())

    def test_a_surface(self):
        points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], float)
        result = tessera.transfer(points, [[0, 1, 2], [1, 3, 2]], points[:, 0], [[0.3, 0.2, 0.7]], "projection")
        np.testing.assert_allclose([result.values[0], result.distance[0]], [0.3, 0.7])

    def test_conservative_kinds_keep_the_integral(self):
        points, tets = kuhn(3)
        fields = np.stack([FIELD, FIELD ** 2], 1)
        for kind in ("conservative", "conservative-bounded", "conservative-lumped"):
            result = tessera.transfer(SOURCE, TETS, fields, points, kind, target_tets=tets)
            np.testing.assert_allclose(integral(points, tets, result.values), integral(SOURCE, TETS, fields),
                                       rtol=1e-12)
            self.assertIsNone(result.distance)
            coupling = tessera.Coupling(SOURCE, TETS, points, kind, target_tets=tets)
            one, two = coupling.apply(FIELD, FIELD ** 2)
            np.testing.assert_array_equal(np.stack([one, two], 1), result.values)

    def test_a_coupling_applies_its_matrix(self):
        for kind in ("linear", "second-order", "projection"):
            coupling = tessera.Coupling(SOURCE, TETS, TARGET, kind)
            result = tessera.transfer(SOURCE, TETS, FIELD, TARGET, kind)
            data, indices, indptr, shape = coupling.weights_csr()
            self.assertEqual(shape, (150, 125))
            dense = np.zeros(shape)
            np.add.at(dense, (np.repeat(np.arange(150), np.diff(indptr)), indices), data)
            np.testing.assert_allclose(dense.sum(1), 1, atol=1e-12)
            np.testing.assert_allclose(dense @ FIELD, result.values, atol=1e-12)
            np.testing.assert_allclose(coupling.apply(FIELD), result.values, atol=1e-14)
            both = coupling.apply(FIELD, np.stack([FIELD, FIELD], 1))
            np.testing.assert_array_equal(both[1], np.stack([both[0], both[0]], 1))
            used = [set(row[row >= 0]) for row in result.donors]
            self.assertEqual(used, [set(indices[a:b]) for a, b in zip(indptr, indptr[1:])])
            with self.assertRaises(ValueError):
                data[0] = 1
            try:
                import scipy.sparse  # noqa: F401
            except ImportError:
                with self.assertRaisesRegex(ImportError, r"weights_csr\(\)"):
                    coupling.weights()
            else:
                np.testing.assert_array_equal(coupling.weights().toarray(), dense)

    def test_a_coupling_keeps_its_meshes(self):
        for kind in ("limited", "linear"):
            points, tets, target = SOURCE.copy(), TETS.astype(np.int32), TARGET.copy()
            coupling = tessera.Coupling(points, tets, target, kind)
            before = coupling.apply(FIELD)
            points[:], tets[:], target[:] = np.nan, 10**6, 0
            np.testing.assert_array_equal(coupling.apply(FIELD), before)

    def test_no_target_points(self):
        result = tessera.transfer(SOURCE, TETS, FIELD, np.zeros((0, 3)))
        self.assertEqual((result.values.shape, result.status.shape, result.donors.shape), ((0,), (0,), (0, 0)))


class Files(unittest.TestCase):
    def test_what_is_written_is_read_back(self):
        velocity, per_cell = np.stack([FIELD, FIELD, FIELD ** 2], 1), np.arange(len(TETS)) / 7.0
        with tempfile.TemporaryDirectory() as folder:
            for name in ("a.vtu", "a.exo", "a.e"):
                path = os.path.join(folder, name)
                tessera.write_mesh(path, SOURCE, TETS, {"p": FIELD, "v": velocity}, {"c": per_cell})
                mesh = tessera.read_mesh(path)
                np.testing.assert_array_equal(mesh.points, SOURCE)
                np.testing.assert_array_equal(mesh.tets, TETS)
                self.assertEqual((set(mesh.fields), set(mesh.cell_fields)), ({"p", "v"}, {"c"}))
                np.testing.assert_array_equal(mesh.fields["p"], FIELD)
                np.testing.assert_array_equal(mesh.fields["v"], velocity)
                np.testing.assert_array_equal(mesh.cell_fields["c"], per_cell)
                with self.assertRaisesRegex(tessera.Error, "step 3: .* has 1 steps"):
                    tessera.read_mesh(path, 3)
            with self.assertRaisesRegex(tessera.Error, "a.stl: meshes are written as .vtu"):
                tessera.write_mesh(os.path.join(folder, "a.stl"), SOURCE, TETS)
            with self.assertRaisesRegex(tessera.Error, "field 'p': its shape is"):
                tessera.write_mesh(os.path.join(folder, "b.vtu"), SOURCE, TETS, {"p": FIELD[1:]})
            with open(os.path.join(folder, "t.msh"), "w", encoding="ascii") as file:
                file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
                           "$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n")
            triangle = tessera.read_mesh(os.path.join(folder, "t.msh"))
            np.testing.assert_array_equal(triangle.tets, [[0, 1, 2]])
        with self.assertRaisesRegex(tessera.Error, "no_such"):
            tessera.read_mesh("no_such.exo")
        self.assertEqual(tessera.read_mesh("kuhn:3").tets.shape, (162, 4))


if __name__ == "__main__":
    unittest.main()
