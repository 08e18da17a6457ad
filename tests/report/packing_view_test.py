"""Data of the 3D view of packings: units, images in periodic containers, limits, scans that are shown."""
import dataclasses
import json
import pathlib
import sys
import unittest

import numpy as np

sys.path[:0] = [str(pathlib.Path(__file__).parents[1] / "observe")]
from synthetic import changed, contacts_of, scans, with_force  # noqa: E402

from mcdem.report.packing_parts import sphere_mesh, walls_of  # noqa: E402
from mcdem.report.packing_view import PackingLimits, ShownPacking, packing_view, scans_shown  # noqa: E402
from mcdem.results import NO_CONTACTS, Box, ContainerShape, Recording, Wall  # noqa: E402

FLOOR = -1 - Wall.floor


def row_of_grains(grains, count):
    """Grains in a row along y; each touches the next one, the first also the floor."""
    position = np.array([(0.05, 0.2 * (g + 0.5) / grains, 0.0617234567) for g in range(grains)])
    first, pairs = [0, *range(grains - 1)], [FLOOR, *range(1, grains)]
    contacts = tuple(contacts_of(first, pairs, [(0, 0, 2e-3)] + [(3e-3 * (s + 1), 4e-3 * (s + 1), 0)] * (grains - 1))
                     for s in range(count))
    return Recording("", {}, Box(0.1, 0.2), 0.15, np.full(grains, 0.0123456), scans(
        count, plate_z=0.15 - 1e-3 * np.arange(count), position=(position,) * count, contacts=contacts))


def view_of(*recordings, limits=PackingLimits()):
    made = packing_view([ShownPacking(f"label {k}", one, range(len(one.scans))) for k, one in enumerate(recordings)], limits)
    return made and json.loads(json.dumps(made))


class PackingViewTest(unittest.TestCase):
    def test_lengths_are_millimetres_and_forces_millinewtons(self):
        view = view_of(row_of_grains(3, 2))
        setting = view["settings"][0]
        scan = setting["scans"][1]
        for found, expected in (
                (setting["label"], "label 0"), (setting["container"], "box"), (setting["box_mm"], [100, 200]), (setting["top_mm"], 150),
                (setting["diameter_mm"][0], 12.346), (scan["plate_mm"], 149), (scan["displacement_mm"], 1), (scan["z_mm"], [61.723] * 3),
                (scan["grain"], [0, 0, 1]), (scan["partner"], [FLOOR, 1, 2]), (scan["force_mN"], [2, 10, 10]),
                (scan["title"], "scan 1: 1.00 mm, loading, cycle 1, top force 0 N"), (view["force_mN"], 10), (view["load_mN"], 20)):
            self.assertEqual(found, expected)

    def test_grains_of_a_periodic_container_are_wrapped_into_it(self):
        made = row_of_grains(3, 1)
        position = made.scans.position[0] + np.array([[0, 0, 0], [0.1, -0.4, 0], [0, 0, 0]])
        moved = dataclasses.replace(changed(made, position=(position,)), box=Box(0.1, 0.2, ContainerShape.periodic))
        setting = view_of(moved)["settings"][0]
        self.assertEqual(setting["container"], "periodic")
        self.assertEqual(setting["scans"][0]["x_mm"], [50, 50, 50])
        self.assertEqual(setting["scans"][0]["y_mm"], [33.333, 100, 166.67])

    def test_a_tilted_cell_is_wrapped_along_its_edges(self):
        box, strain = Box(0.1, 0.2, ContainerShape.cell, 0.1), np.array([[0, 0, 0, 0, 0.5, 0]])
        position = np.array([(0.01, 0.1, 0.05), (0.01, 0.1, 0.15), (0.09, 0.1, -0.05)])
        made = dataclasses.replace(changed(row_of_grains(3, 1), position=(position,), strain=strain), box=box)
        scan = view_of(made)["settings"][0]["scans"][0]
        self.assertEqual(scan["cell_mm"], [100, 200, 100, 0, 50, 0])
        self.assertEqual(scan["x_mm"], [10, 60, 40])
        self.assertEqual(scan["z_mm"], [50, 50, 50])

    def test_opens_at_the_scan_with_the_largest_load(self):
        made = row_of_grains(3, 4)
        self.assertEqual(view_of(made)["settings"][0]["strongest"], 0)
        strong = with_force(made, [0, 0, 3, 0])
        self.assertEqual(view_of(strong)["settings"][0]["strongest"], 2)
        unseen = (np.zeros((0, 3)), *strong.scans.position[1:])  # a scan that is not shown is ignored
        self.assertEqual(view_of(changed(strong, position=unseen))["settings"][0]["strongest"], 1)

    def test_a_cell_has_strains_and_mean_stress(self):
        made = changed(row_of_grains(3, 1), strain=np.array([[0.1, 0, 0, 0, 0, 0]]), packing_fraction=np.array([0.65]),
                       stress=20e3 * np.eye(3)[None])
        made = dataclasses.replace(made, box=Box(0.1, 0.2, ContainerShape.cell, 0.1))
        self.assertEqual(view_of(made)["settings"][0]["scans"][0]["title"],
                         "scan 0: volume strain 10.00 %, deviatoric strain 7.02 %, φ 0.650, p 20 kPa")

    def test_positions_are_needed(self):
        bare = changed(row_of_grains(3, 2), position=(np.zeros((0, 3)),) * 2)
        self.assertIsNone(view_of(bare))
        self.assertEqual([setting["label"] for setting in view_of(bare, row_of_grains(3, 1))["settings"]], ["label 1"])

    def test_large_packings_show_the_grains_nearest_to_the_middle_plane(self):
        setting = view_of(row_of_grains(100, 1), limits=PackingLimits(max_grains=4))["settings"][0]
        scan = setting["scans"][0]
        self.assertEqual(setting["number"], [48, 49, 50, 51])
        self.assertEqual(scan["y_mm"], [97, 99, 101, 103])
        self.assertEqual((scan["grain"], scan["partner"]), ([0, 1, 2], [1, 2, 3]), "contacts between them")

    def test_colours_end_where_one_force_in_two_hundred_is_larger(self):
        made = row_of_grains(3, 1)
        forces = contacts_of([0] * 400, [1] * 400, [(0, 0, 1e-3 * n) for n in range(1, 401)])
        self.assertEqual(view_of(changed(made, contacts=(forces,)))["force_mN"], 398)
        self.assertEqual(view_of(changed(made, contacts=(NO_CONTACTS,)))["force_mN"], 1)

    def test_walls_are_drawn_that_the_container_has(self):
        for shape, corners, names in ((ContainerShape.box, 4, ["box", "plate"]), (ContainerShape.cylinder, 64, ["box", "plate"]),
                                      (ContainerShape.cell, 4, ["box"])):
            walls = walls_of(Box(1, 1, shape, 1))
            self.assertEqual([wall["name"] for wall in walls], names)
            self.assertEqual(len(walls[0]["x"]), 2 * (corners + 2) + 4 * 3)
            self.assertEqual({height for height in walls[0]["z"] if height is not None}, {0, 1, 2})

    def test_spheres_are_round_and_closed(self):
        for times, points, faces in ((0, 12, 20), (1, 42, 80), (2, 162, 320)):
            mesh = sphere_mesh(times)
            self.assertEqual((len(mesh["points"]), len(mesh["faces"])), (points, faces))
            np.testing.assert_allclose(np.linalg.norm(mesh["points"], axis=1), 1, atol=2e-4)
            edges = [frozenset((face[k], face[k - 1])) for face in mesh["faces"] for k in range(3)]
            self.assertEqual({edges.count(edge) for edge in edges}, {2})


def stroke(count, lowest):
    """This number of scans, down to scan `lowest` and back up."""
    plate_z = np.abs(np.arange(count) - float(lowest))
    return with_force(Recording("", {}, Box(), 0, np.zeros(0), scans(count, plate_z=plate_z)), 100 - plate_z)


class ScansShownTest(unittest.TestCase):
    def test_scans_that_are_shown(self):
        for (count, lowest), numbers, most, expected in (
                ((4, 2), 1000, None, [0, 1, 2, 3]), ((61, 60), 1000, 3, [0, 30, 60]), ((61, 30), 1000, 1, [30]), ((0, 0), 1000, None, []),
                ((61, 30), 10_000_000, None, [0, 30, 60]),  # these are always included
                ((61, 28), 1000, 5, [0, 15, 28, 45, 60]), ((61, 0), 1000, 5, [0, 15, 30, 45, 60])):
            self.assertEqual(scans_shown(stroke(count, lowest), numbers, PackingLimits(most)), expected)

    def test_as_many_as_fit(self):
        self.assertEqual(len(scans_shown(stroke(61, 30), 60_000)), 10)


if __name__ == "__main__":
    unittest.main()
