"""The cell list finds every pair of neighbouring grains once."""
import unittest
from unittest import mock

import numpy as np

from mcdem.experiment import near_pairs as module
from mcdem.experiment.container import apart
from mcdem.results import Box, ContainerShape

SHAPES = (ContainerShape.box, ContainerShape.cylinder, ContainerShape.periodic)
SIZES = ((1.0, 1.0, 1.0), (0.3, 1.2, 0.05), (0.15, 0.25, 3.0), (1e-3, 1.0, 1.0))


class NearPairs(unittest.TestCase):
    def found(self, position, box, height, edge):
        blocks = list(module.near_pairs(position, box, height, edge))
        pairs = np.sort(np.concatenate([np.stack(block, axis=1) for block in blocks]), axis=1)
        near = np.linalg.norm(apart(box, position[pairs[:, 0]], position[pairs[:, 1]]), axis=1) < edge
        self.assertEqual(len(np.unique(pairs, axis=0)), len(pairs))
        return {tuple(pair) for pair in pairs[near].tolist()}

    def test_all_pairs_are_found_once(self):
        """Also those of grains outside: beyond a wall, or in another image of a periodic container."""
        random = np.random.default_rng(1)
        for shape in SHAPES:
            for size in SIZES:
                for grains, edge in ((1, 0.1), (60, 0.1), (400, 0.06), (60, 2.0)):
                    with self.subTest(shape=shape.value, size=size, grains=grains, edge=edge):
                        position, box = (random.random((grains, 3)) * 1.4 - 0.2) * size, Box(*size[:2], shape)
                        i, j = np.triu_indices(grains, 1)
                        near = np.linalg.norm(apart(box, position[i], position[j]), axis=1) < edge
                        expected = set(zip(i[near].tolist(), j[near].tolist()))
                        self.assertEqual(self.found(position, box, size[2], edge), expected)

    def test_many_pairs_come_in_blocks(self):
        position = np.full((40, 3), 0.5)
        with mock.patch.object(module, "PAIRS_AT_ONCE", 100):
            self.assertEqual(len(self.found(position, Box(1, 1), 1, 0.1)), 780)
            self.assertEqual(len(list(module.near_pairs(position, Box(1, 1), 1, 0.1))), 16)

    def test_the_number_of_cells_is_limited(self):
        for size in ((1e-9, 1e-9, 1.0), (20.0, 20.0, 20.0), (1e-9, 20.0, 20.0)):
            cells = module._cells_along(np.array(size), 10, 1e-7, False)
            self.assertLessEqual(cells.prod(), 16 * (8 * 10 + 64))


if __name__ == "__main__":
    unittest.main()
