"""Walls of containers, and distances to them and between points."""
import math
import unittest

import numpy as np

from mcdem.experiment.container import apart, floor_area, into_cell, towards_wall, wall_distance, walls_of
from mcdem.results import Box, ContainerShape, Wall

BOX, CYLINDER, PERIODIC = (Box(2, size_y, shape) for size_y, shape in
                           ((3, ContainerShape.box), (2, ContainerShape.cylinder), (3, ContainerShape.periodic)))
POINT = np.array([[0.5, 1.0, 0.25]])


class Containers(unittest.TestCase):
    def test_walls_have_distances_and_normals(self):
        self.assertEqual([wall_distance(BOX, wall, 4, POINT)[0] for wall in walls_of(BOX)], [0.5, 1.5, 1, 2, 0.25, 3.75])
        normals = np.concatenate([towards_wall(BOX, wall, POINT) for wall in walls_of(BOX)])
        np.testing.assert_array_equal(normals, [[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]])
        self.assertEqual(walls_of(PERIODIC), [Wall.floor, Wall.plate])

    def test_a_cylinder_touches_the_planes_of_its_sizes(self):
        self.assertEqual(walls_of(CYLINDER), [Wall.x_min, Wall.floor, Wall.plate])
        points = np.array([[1, 1, 0.5], [1.3, 1.4, 0.5], [4, 1, 0.5]])
        np.testing.assert_allclose(wall_distance(CYLINDER, Wall.x_min, 4, points), [1, 0.5, -2])
        np.testing.assert_allclose(towards_wall(CYLINDER, Wall.x_min, points), [[1, 0, 0], [0.6, 0.8, 0], [1, 0, 0]])
        self.assertEqual(wall_distance(CYLINDER, Wall.plate, 4, points)[0], 3.5)

    def test_floors_have_areas(self):
        for box, area in ((BOX, 6), (PERIODIC, 6), (CYLINDER, math.pi)):
            self.assertAlmostEqual(floor_area(box), area)

    def test_periodic_containers_have_images(self):
        there = np.array([[1.75, 2.75, 8.0], [7.25, -5.5, 0.5]])
        np.testing.assert_array_equal(apart(BOX, POINT, there)[0], [1.25, 1.75, 7.75])
        np.testing.assert_array_equal(apart(PERIODIC, POINT, there), [[-0.75, -1.25, 7.75], [0.75, -0.5, 0.25]])
        np.testing.assert_array_equal(into_cell(PERIODIC, there), [[1.75, 2.75, 8], [1.25, 0.5, 0.5]])
        np.testing.assert_array_equal(into_cell(PERIODIC, np.array([[-1e-20, 1, 1]])), [[0, 1, 1]])  # rounding
        np.testing.assert_array_equal(into_cell(BOX, there), there)


if __name__ == "__main__":
    unittest.main()
