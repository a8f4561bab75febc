"""tessera.collide and tessera.sdf against brute force and closed forms."""
import os
import tempfile
import unittest

import numpy as np
import tessera
from oracles import box_pairs, boxes_hit, triangle_pairs
from tessera import collide, sdf

RNG = np.random.default_rng(5)


def boxes(n, size=0.1):
    low = np.round(RNG.random((n, 3)), 2)  # so that some touch
    return np.concatenate([low, low + np.round(RNG.random((n, 3)) * size, 2)], 1)


def as_set(pairs):
    assert len(set(map(tuple, pairs))) == len(pairs)
    return set(map(tuple, pairs))


class Pairs(unittest.TestCase):
    def test_boxes(self):
        a, b = boxes(400), boxes(300)
        for touching in (True, False):
            self.assertEqual(as_set(collide.pairs(a, touching=touching)), box_pairs(a, None, touching))
            self.assertEqual(as_set(collide.pairs(a, b, touching=touching)), box_pairs(a, b, touching))
        self.assertLess(len(box_pairs(a, b, False)), len(box_pairs(a, b)))
        self.assertEqual(collide.pairs(np.zeros((0, 6))).shape, (0, 2))

    def test_triangles_tetrahedra_and_balls(self):
        triangles = RNG.random((200, 1, 3)) + RNG.normal(0, 0.1, (200, 3, 3))
        expected = triangle_pairs(triangles)
        self.assertGreater(len(expected), 50)
        self.assertEqual(as_set(collide.pairs(triangles)), expected)
        listed = collide.triangle_pairs(triangles.reshape(-1, 3), np.arange(600).reshape(-1, 3))
        self.assertEqual(as_set(listed), expected)
        balls = np.concatenate([RNG.random((200, 3)), RNG.random((200, 1)) * 0.1], 1)
        apart = np.linalg.norm(balls[:, None, :3] - balls[None, :, :3], axis=-1)
        meet = np.triu(apart <= balls[:, None, 3] + balls[None, :, 3], 1)
        self.assertEqual(as_set(collide.pairs(balls)), set(map(tuple, np.argwhere(meet))))
        tet = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
        self.assertEqual(as_set(collide.pairs(np.stack([tet, tet + 0.2, tet + 0.5]))), {(0, 1), (1, 2)})


class Queries(unittest.TestCase):
    def test_points_and_boxes(self):
        queries = RNG.uniform(-0.2, 1.2, (50, 3))
        for objects in (RNG.random((300, 3)), boxes(300)):
            index = collide.Index(objects)
            low, high = objects[:, :3], objects[:, -3:]
            distance = np.linalg.norm(np.maximum(low - queries[:, None], queries[:, None] - high).clip(0), axis=-1)
            found, at = index.nearest(queries, 4)
            order = np.argsort(distance, 1, kind="stable")[:, :4]
            np.testing.assert_array_equal(found, order)
            np.testing.assert_allclose(at, np.take_along_axis(distance, order, 1), atol=1e-14)
            for radius in (0.15, RNG.uniform(0, 0.3, 50)):
                begin, within = index.within(queries, radius)
                near = distance <= np.reshape(radius, (-1, 1))
                np.testing.assert_array_equal(np.diff(begin), near.sum(1))
                np.testing.assert_array_equal(within, np.nonzero(near)[1])
            self.assertEqual(len(index), 300)
        self.assertEqual(index.nearest(queries, 1000)[0].shape, (50, 300))

    def test_rays(self):
        objects, origins = boxes(200), RNG.uniform(-1, 2, (80, 3))
        ways = RNG.random((80, 3)) - origins
        found, at = collide.Index(objects).ray(origins, ways)
        expected, expected_at = boxes_hit(objects, origins, ways)
        np.testing.assert_array_equal(found, expected)
        np.testing.assert_allclose(at, expected_at)
        self.assertTrue(5 < (found < 0).sum() < 75)
        triangle = collide.Index(np.eye(3)[None])
        found, at = triangle.ray([[0, 0, 0], [0, 0, 0]], [[1, 1, 1], [-1, 1, 1]])
        np.testing.assert_array_equal(found, [0, -1])
        np.testing.assert_allclose(at, [1 / 3, np.inf])
        self.assertEqual(list(collide.Index(np.eye(3).reshape(1, 3, 3)).nearest([[0, 0, 0]])[0][0]), [0])

    def test_errors(self):
        points = collide.Index(RNG.random((10, 3)))
        for call, words in (
                (lambda: collide.pairs(boxes(5)[:, ::-1]), "of object 0 is not valid"),
                (lambda: collide.pairs(np.full((2, 6), np.nan)), "is not valid; give finite"),
                (lambda: collide.pairs(RNG.random((4, 5))), r"objects: its shape is \(4, 5\); expected \(n, 6\)"),
                (lambda: collide.pairs(3.0), r"objects: its shape is \(\)"),
                (lambda: collide.pairs(np.array(["a"])), "objects: its dtype is <U1"),
                (lambda: collide.pairs([[1, 2], [3]]), "objects: no array can be made of this list"),
                (lambda: collide.pairs(boxes(4), RNG.random((4, 4))), "of one kind with the objects"),
                (lambda: collide.pairs(RNG.random((4, 3))), "pairs of points or segments"),
                (lambda: collide.triangle_pairs(np.eye(3), [[0, 1, 3]]), r"triangles\[0, 2\] is 3, and there are 3 points"),
                (lambda: points.ray([[0, 0, 0]], [[1, 0, 0]]), "no ray hits points"),
                (lambda: points.nearest([[0, 0, 0]], 0), "k: 0 is not a number"),
                (lambda: points.nearest([[0, np.inf, 0]]), r"points\[0, 1\] is inf"),
                (lambda: points.within([[0, 0, 0]], -1), "radius of -1"),
                (lambda: points.within([[0, 0, 0]], np.ma.masked_array([1.0], [True])), "radius: it is a masked array"),
                (lambda: collide.Index([[1e160, 0, 0]]), r"objects\[0, 0\] is 1e\+160; give .* at most 1e\+150"),
                (lambda: collide.Index(boxes(3)).ray([[0, 0, 0]], [[0, 0, 0]]), "direction not zero"),
                (lambda: collide.Index(boxes(3)).ray([[0, 0, 0]], np.eye(3)), r"directions: its shape is \(3, 3\); expected \(1, 3\), one per origin")):
            with self.assertRaisesRegex(tessera.Error, words):
                call()


def sphere(n):
    """A sphere of radius 1 with points on it, as quads split in two."""
    u, v = np.meshgrid(np.linspace(0, np.pi, n + 1), np.arange(2 * n) * np.pi / n, indexing="ij")
    points = np.stack([np.sin(u) * np.cos(v), np.sin(u) * np.sin(v), np.cos(u)], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(n), np.arange(2 * n), indexing="ij")
    at = lambda a, b: (i + a) * 2 * n + (j + b) % (2 * n)
    return points, np.concatenate([np.stack([at(0, 0), at(1, 0), at(1, 1)], -1).reshape(-1, 3),
                                   np.stack([at(0, 0), at(1, 1), at(0, 1)], -1).reshape(-1, 3)])


class Distances(unittest.TestCase):
    def test_a_sphere(self):
        points, triangles = sphere(40)
        field = sdf.build(points, triangles, 48, margin=0.3)
        queries = RNG.uniform(-1.1, 1.1, (500, 3))
        radius = np.linalg.norm(queries, axis=1)
        queries = queries[radius > 0.3]
        radius = radius[radius > 0.3]
        distance, normal = field.sample(queries)
        np.testing.assert_allclose(distance, radius - 1, atol=0.012)
        self.assertGreater(np.einsum("ij,ij->i", normal, queries / radius[:, None]).min(), 0.99)
        self.assertEqual(field.shape, (48, 48, 48))
        at = np.array([1e9, 0, -1e7])
        away = sdf.build(points + at, triangles, 48, margin=0.3)
        np.testing.assert_allclose(away.sample(queries + at)[0], distance, atol=1e-5)
        np.testing.assert_allclose((away.low, away.high), (at + field.low, at + field.high))
        np.testing.assert_allclose(np.subtract(field.high, field.low), 47 * field.cell)
        far, none = field.sample([[9, 9, 9]])
        self.assertTrue(np.isinf(far[0]) and not none.any())
        rough, _ = field.sample(queries, "nearest")
        self.assertLess(np.abs(rough - distance).max(), 0.9 * field.cell)
        with tempfile.TemporaryDirectory() as folder:
            obj = os.path.join(folder, "a.obj")
            with open(obj, "w", encoding="ascii") as file:
                file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
            read_points, read_triangles = sdf.read_surface(obj)
            np.testing.assert_array_equal(read_points[read_triangles[0]], [[0, 0, 0], [1, 0, 0], [0, 1, 0]])

    def test_an_open_surface(self):
        corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
        field = sdf.build(corners, [[0, 1, 2], [0, 2, 3]], 24, margin=1.0, two_sided=True)
        distance, normal = field.sample([[0.1, 0.2, 0.5], [0.1, 0.2, -0.5]])
        np.testing.assert_allclose(distance, 0.5, atol=1e-4)
        np.testing.assert_allclose(normal, [[0, 0, 1], [0, 0, -1]], atol=1e-3)

    def test_errors(self):
        points, triangles = sphere(6)
        flipped = triangles.copy()
        flipped[[20, 50]] = flipped[[20, 50], ::-1]
        for turned in (triangles[:, ::-1], np.concatenate([triangles, triangles[20:21]])):
            self.assertLess(sdf.build(points.round(12), turned, 16).sample([[0, 0, 0]])[0][0], -0.7)
        self.assertGreater(sdf.build(points, flipped, 16, two_sided=True).sample([[0, 0, 0]])[0][0], 0.7)
        for call, words in (
                (lambda: sdf.build(points, flipped), r"triangles (\d+ and (20|50)|(20|50) and \d+) pass"),
                (lambda: sdf.build(points[flipped].reshape(-1, 3), np.arange(flipped.size).reshape(-1, 3)), "pass their edge in the same direction"),
                (lambda: sdf.build(points * 1e40, triangles), r"points: the surface has a size of 3.4.*e\+40, .*scale"),
                (lambda: sdf.build(points * 1e-40, triangles), r"cells of .*e-4\d; .*scale"),
                (lambda: sdf.build(points, triangles, margin=-5), "margin -5"),
                (lambda: sdf.build(points, triangles + 1), "triangles.* is 84, and there are 84 points"),
                (lambda: sdf.build(points, triangles[:0]), "."),
                (lambda: sdf.build(points, triangles, 2), "."),
                (lambda: sdf.build(points, triangles, thickness=np.nan), "thickness"),
                (lambda: sdf.build(points, triangles, margin=np.nan), "margin"),
                (lambda: sdf.build(points * np.nan, triangles), r"points\[0, 0\] is nan"),
                (lambda: sdf.build(points, triangles).sample([[0, 0, 0]], "cubic"), "kind: 'cubic' is unknown"),
                (lambda: sdf.read_surface("no_such.obj"), "no_such.obj")):
            with self.assertRaisesRegex(tessera.Error, words):
                call()


if __name__ == "__main__":
    unittest.main()
