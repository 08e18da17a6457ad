"""Exports for ParaView: the contents of the files."""
import contextlib
import io
import pathlib
import unittest

import numpy as np
from synthetic import FIRST, FLOOR, GRAINS, SECOND, Case, contacts_of, h5py, make_run, vtk

try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader
except ImportError:
    vtkHDFReader = None


def close(found, expected, tolerance=1e-12):
    return np.allclose(found, expected, rtol=0, atol=tolerance)


@unittest.skipUnless(vtkHDFReader, "neither python3-paraview nor python3-vtk9 is installed")
class Vtk(Case):
    """As ParaView reads it."""

    def read(self, name, replica=SECOND, scan=0):
        reader = vtkHDFReader()
        file = str(self.view / replica / f"{name}_{scan:06}.hdf")
        self.assertTrue(reader.CanReadFile(file))
        reader.SetFileName(file)
        reader.Update()
        return reader.GetOutput()

    def arrays(self, data):
        return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}

    def test_grains(self):
        self.assertEqual(self.export(make_run(2, 3), vtk), 24)
        grid = self.read("grains", scan=2)
        self.assertEqual((grid.GetNumberOfPoints(), grid.GetNumberOfCells()), (GRAINS, GRAINS))
        points = self.arrays(grid.GetPointData())
        self.assertEqual(set(points), {"grain", "diameter", "species", "coordination_number", "force_magnitude", "stress", "pressure",
                                       "displacement", "displacement_since_last_scan", "rotation", "rotation_since_last_scan"})
        self.assertTrue((points["species"] == np.arange(GRAINS) % 2).all() and (points["grain"] == np.arange(GRAINS)).all())
        self.assertTrue(close(points["pressure"], points["stress"].reshape(-1, 3, 3).trace(axis1=1, axis2=2) / 3))
        self.assertNotIn("species", self.arrays(self.read("grains", FIRST).GetPointData()))

    def test_contacts_forces_and_walls(self):
        run = make_run(2, 3)
        self.export(run, vtk)
        scan = run[1].scans[2]
        contacts, plate_z = scan.contacts, scan.row["plate_z"]
        grid = self.read("contacts", scan=2)
        self.assertEqual((grid.GetNumberOfCells(), grid.GetNumberOfPoints()), (len(contacts), 2 * len(contacts)))
        cells = self.arrays(grid.GetCellData())
        self.assertEqual(set(cells), {"grain", "partner", "force", "force_magnitude", "normal_force", "tangential_force", "overlap"})
        self.assertTrue((cells["force"] == contacts["force"]).all() and (cells["partner"] == contacts["partner"]).all())
        self.assertTrue(close(np.hypot(cells["normal_force"], cells["tangential_force"]), cells["force_magnitude"]))
        line = grid.GetCell(len(contacts) - 1)
        self.assertEqual((line.GetCellType(), line.GetPoints().GetPoint(1)[2]), (3, plate_z))
        self.assertEqual(self.arrays(grid.GetFieldData())["plate_z"][0], plate_z)
        self.assertTrue((self.arrays(self.read("forces", scan=2).GetPointData())["force"] == contacts["force"]).all())
        walls = self.read("walls", scan=2)
        self.assertEqual([walls.GetCell(i).GetNumberOfPoints() for i in range(6)], 6 * [4])
        self.assertEqual(walls.GetCell(5).GetBounds()[4:], (plate_z, plate_z))

    def test_a_scan_without_contacts(self):
        run = make_run()
        run[0].scans[0].contacts = contacts_of()
        self.assertEqual(self.export(run, vtk), 4)
        self.assertEqual(self.read("grains", FIRST).GetNumberOfPoints(), GRAINS)
        self.assertEqual(set(self.points("grains")), {"grain", "diameter", "displacement", "displacement_since_last_scan", "rotation",
                                                      "rotation_since_last_scan"})
        self.assertEqual(self.read("contacts", FIRST).GetNumberOfCells(), 0)


class Grains(Case):
    def test_displacements_are_relative_to_the_first_and_to_the_previous_scan(self):
        run = make_run(scans=3)
        scans = run[0].scans
        for number, scan in enumerate(scans):
            scan.position = scans[0].position + [0.01 * number ** 2, 0, -0.02 * number]
        self.assertEqual(self.export(run, vtk, scans=[2]), 4)
        points = self.points("grains", scan=2)
        self.assertTrue(close(points["displacement"], [0.04, 0, -0.04]))
        self.assertTrue(close(points["displacement_since_last_scan"], [0.03, 0, -0.02]))

    def test_rotations_are_relative_to_the_start_and_to_the_previous_scan(self):
        run = make_run(scans=3)
        before, now = (run[0].scans[k].rotation for k in (1, 2))
        before[:], now[:] = [0.5, 0, 0], [0.8, 0, 0]
        before[1], now[1] = [np.pi / 2, 0, 0], np.array([1, 1, -1]) * 2 * np.pi / 3 / 3 ** 0.5  # a quarter turn about x, then about y
        before[2], now[2] = [0, 0, 3.0], [0, 0, -3.0]
        before[3], now[3] = [0.1, 0.2, 0.3], [0.1, 0.2, 0.3]
        self.export(run, vtk, scans=[2])
        points = self.points("grains", scan=2)
        self.assertTrue(close(points["rotation"], now))
        self.assertTrue(close(points["rotation_since_last_scan"][:4],
                              [[0.3, 0, 0], [0, np.pi / 2, 0], [0, 0, 2 * np.pi - 6], [0, 0, 0]]))
        for scan in run[0].scans:
            scan.rotation = None
        self.export(run, vtk)
        self.assertFalse({"rotation", "rotation_since_last_scan"} & set(self.points("grains", scan=2)))

    def test_displacements_in_a_cell_are_relative_to_its_own_motion(self):
        run = make_run(scans=2)
        run[0].shape, run[0].edges = "cell", [0.1, 0.1, 0.1]
        moved = np.array([0.003, -0.002, 0.001])
        place = np.array([[0.1 * i / 30, 0.05, 0.09] for i in range(GRAINS)])
        strains = [[0.02, 0, 0, 0, 0.3, 0], [0.05, 0.1, -0.02, 0.1, 0.9, -0.2]]
        for scan, strain, more in zip(run[0].scans, strains, (0, moved)):
            x, y, z, xy, xz, yz = scan.row["strain"] = strain
            motion = np.array([[1 - x, xy, xz], [0, 1 - y, yz], [0, 0, 1 - z]])
            scan.position = place @ motion.T + more
            for axis in (2, 1, 0):  # into the cell
                scan.position -= np.floor(scan.position[:, axis] / (0.1 * motion[axis, axis]))[:, None] * 0.1 * motion[:, axis]
        self.export(run, vtk)
        self.assertTrue(close(self.points("grains", scan=1)["displacement"], moved))
        self.assertEqual(self.grid("walls", scan=1)["FieldData/shear_xz"], [0.9])

    def test_displacements_in_a_cell_are_added_from_scan_to_scan(self):
        """A grain that goes through the cell three times while that is sheared there and back; a scan without positions in between."""
        run = make_run(scans=13)
        run[0].shape, run[0].edges = "cell", [0.1, 0.1, 0.1]
        step = np.array([0.02, 0.01, -0.025])
        at, before = np.full((GRAINS, 3), 0.05), np.eye(3)
        for number, scan in enumerate(run[0].scans):
            scan.row["strain"][4] = 0.2 * min(number, 12 - number)
            x, y, z, xy, xz, yz = scan.row["strain"]
            cell = np.array([[1 - x, xy, xz], [0, 1 - y, yz], [0, 0, 1 - z]])
            at = at @ (cell @ np.linalg.inv(before)).T + step * (number > 0)
            before = cell
            for axis in (2, 1, 0):  # into the cell
                at = at - np.floor(at[:, axis] / (0.1 * cell[axis, axis]))[:, None] * 0.1 * cell[:, axis]
            scan.position = at
        self.export(run, vtk)
        self.assertTrue(close(self.points("grains", scan=12)["displacement"], 12 * step))
        self.export(run, vtk, scans=[11])  # of which other scans are exported does not matter
        self.assertTrue(close(self.points("grains", scan=11)["displacement"], 11 * step))
        self.assertTrue(close(self.points("grains", scan=11)["displacement_since_last_scan"], step))
        run[0].scans[12].row["strain"][4] = run[0].scans[10].row["strain"][4]  # the same cell, one scan not recorded
        run[0].scans[11].position = run[0].scans[11].rotation = None
        run[0].scans[12].position = run[0].scans[10].position + 2 * step * [1, 1, -1]
        self.export(run, vtk, scans=[12])
        self.assertTrue(close(self.points("grains", scan=12)["displacement"], 10 * step + 2 * step * [1, 1, -1]))

    def two_grains(self, shape, position, contacts):
        """Grains of which the first two have contacts."""
        run = make_run()
        run[0].shape, run[0].edges = shape, [0.5, 0.4, 0.5]
        run[0].diameter[:] = 0.2
        run[0].scans[0].position[:2], run[0].scans[0].contacts = position, contacts
        self.export(run, vtk)
        return self.points("grains"), self.points("forces")

    def test_stress_is_the_sum_over_contacts_per_volume(self):
        grains, forces = self.two_grains("box", [[0.1, 0.2, 0.09], [0.29, 0.2, 0.09]], contacts_of(
            (0, -1 - FLOOR, [0.1, 0.2, 0], [0, 0, 5], 0), (0, 1, [0.195, 0.2, 0.09], [-3, 1, 0], 0)))
        volume = np.pi / 6 * 0.008
        self.assertTrue(close(grains["stress"][0] * volume, [0.095 * 3, -0.095, 0, 0, 0, 0, 0, 0, 0.09 * 5]))
        self.assertTrue(close(grains["stress"][1] * volume, [0.095 * 3, -0.095, 0, 0, 0, 0, 0, 0, 0]))
        self.assertTrue(close(forces["normal_force"], [5, 3]) and close(forces["tangential_force"], [0, 1]))
        self.assertEqual(list(grains["coordination_number"][:3]), [2, 1, 0])
        self.assertTrue(close(grains["force_magnitude"][:2], [5 + 10 ** 0.5, 10 ** 0.5]))

    def test_stress_in_a_periodic_container_is_that_of_nearest_images(self):
        grains, forces = self.two_grains("periodic", [[0.1, 0.2, 0.09], [0.1 - 0.19 + 3 * 0.5, 0.2, 0.09]],
                                         contacts_of((0, 1, [0.005, 0.2, 0.09], [3, 0, 0], 0)))
        self.assertTrue(close(grains["stress"][:2, 0] * np.pi / 6 * 0.008, 0.095 * 3) and close(forces["normal_force"], [3]))

    def test_stress_without_contacts_is_zero(self):
        run = make_run()
        run[0].scans[0].contacts = contacts_of()
        run[0].scans[0].row["coordination_number"] = 0
        self.export(run, vtk)
        self.assertTrue((self.points("grains")["stress"] == 0).all())

    def test_the_type_of_grid_is_ascii_as_paraview_requires(self):
        self.export(make_run(), vtk)
        with h5py.File(self.view / FIRST / "grains_000000.hdf") as file:
            kind = h5py.h5a.open(file["VTKHDF"].id, b"Type").get_type()
            self.assertEqual(kind.get_cset(), h5py.h5t.CSET_ASCII)
            self.assertFalse(kind.is_variable_str())


class ContactsAndWalls(Case):
    def test_contacts_end_at_curved_walls_and_at_nearest_images(self):
        run = make_run(2)
        for replica, shape, partner in zip(run, ("cylinder", "periodic"), (-1, 1)):
            replica.shape, replica.edges = shape, [0.1, 0.1, 0.06]
            replica.scans[0].position[:2] = [0.08, 0.09, 0.03], [0.01, 0.015, 0.03]
            replica.scans[0].contacts = contacts_of((0, partner, [0.08, 0.09, 0.03], [0, 0, 1], 0))
        self.export(run, vtk)
        self.assertTrue(close(self.grid("contacts")["Points"], [[0.08, 0.09, 0.03], [0.05 + 0.05 * 0.6, 0.05 + 0.05 * 0.8, 0.03]]))
        self.assertTrue(close(self.grid("contacts", SECOND)["Points"][1], [0.11, 0.115, 0.03]))

    def test_a_single_grain_between_plates(self):
        run = make_run()
        replica, scan = run[0], run[0].scans[0]
        replica.diameter, scan.position, scan.rotation = replica.diameter[:1], scan.position[:1], scan.rotation[:1]
        scan.contacts = contacts_of((0, -5, [0, 0, 0], [0, 0, 1], 0), (0, -6, [0, 0, 0.02], [0, 0, -1], 0))
        self.export(run, vtk)
        self.assertTrue(close(self.grid("contacts")["Points"][1::2, 2], [0, scan.row["plate_z"]]))

    def test_forces_are_at_the_contacts(self):
        run = make_run()
        self.export(run, vtk)
        self.assertTrue((self.grid("forces")["Points"] == run[0].scans[0].contacts["point"]).all())
        self.assertTrue((self.points("forces")["force"] == run[0].scans[0].contacts["force"]).all())

    def walls(self, shape, strain=(0,) * 6):
        """Walls of a container 0.1 m wide; the plate is at 0.08 m after a start at 0.09 m."""
        run = make_run()
        run[0].shape, run[0].edges = shape, [0.1, 0.1, 0.1 if shape == "cell" else 0.09]
        run[0].scans[0].row["plate_z"], run[0].scans[0].row["strain"] = 0.08, strain
        self.export(run, vtk)
        return self.grid("walls")

    def test_walls_are_surfaces_with_their_forces(self):
        walls = self.walls("box")
        self.assertEqual(list(walls["CellData/wall"]), [2, 1, 3, 0, 4, 5])
        self.assertTrue(close(walls["Points"][4:8], [[0.1, 0, 0], [0.1, 0.1, 0], [0.1, 0.1, 0.09], [0.1, 0, 0.09]]))  # x_max
        self.assertEqual(walls["Points"][-1, 2], 0.08)
        self.assertTrue((walls["CellData/force"][-1] == [5, 0, 1 / 6]).all())

    def test_a_cylinder_is_round(self):
        walls = self.walls("cylinder")
        self.assertTrue(close(np.hypot(*(walls["Points"][:, :2] - 0.05).T), 0.05))
        self.assertEqual(list(walls["CellData/wall"]), 64 * [0] + [4, 5])

    def test_periodic_containers_have_edges(self):
        self.assertEqual(list(self.walls("periodic")["CellData/wall"]), 4 * [-1] + [4, 5])
        cell = self.walls("cell", [0.1, 0, 0.2, 0, 0.3, 0])
        self.assertEqual(list(cell["CellData/wall"]), 12 * [-1])
        for axis, length in ((0, 0.09), (2, 0.08)):
            self.assertTrue(close(np.minimum(abs(cell["Points"][:, axis]), abs(cell["Points"][:, axis] - length)), 0))


class Files(Case):
    def test_those_of_an_earlier_export_do_not_remain(self):
        self.export(make_run(scans=4), vtk)
        self.export(make_run(scans=2), vtk)
        there = self.view / FIRST
        self.assertEqual(len(list(there.glob("*.hdf"))), 8)
        for name in ("mine.hdf", "grains_filtered.hdf", "grains_1.vtu"):
            pathlib.Path(there / name).write_text("something else")
            self.export(make_run(scans=2), vtk)
            self.assertTrue((there / name).exists(), name)

    def test_those_of_others_are_kept_and_told(self):
        """Of another program, of another kind, links, and all in a folder that is a link."""
        self.export(make_run(2, 2), vtk)
        there, elsewhere = self.view / FIRST, self.folder / "measured"
        (there / "grains_99.hdf").write_text("my measurement")
        (there / "contacts_98.hdf").mkdir()
        with h5py.File(there / "walls_97.hdf", "w") as file:  # a grid of another program
            file.create_group("VTKHDF").attrs["Version"] = [2, 0]
        (self.view / SECOND).rename(elsewhere)
        (self.view / SECOND).symlink_to(elsewhere)
        (there / "forces_96.hdf").symlink_to(elsewhere / "forces_000001.hdf")
        kept = {there / name for name in ("grains_99.hdf", "contacts_98.hdf", "walls_97.hdf", "forces_96.hdf")}
        kept |= set((self.view / SECOND).glob("*_000001.hdf"))
        with contextlib.redirect_stderr(io.StringIO()) as said:
            self.export(make_run(2, 1), vtk)
        self.assertEqual({file for file in kept if file.exists()}, kept)
        self.assertEqual({line.split(": ")[1] for line in said.getvalue().splitlines()}, set(map(str, kept)))
        self.assertEqual({file.name for file in there.glob("*_000001.hdf")}, set())

    def test_a_grid_of_another_program_is_not_replaced(self):
        (self.view / FIRST).mkdir()
        file = self.view / FIRST / "grains_000000.hdf"
        with h5py.File(file, "w") as grid:
            grid.create_group("VTKHDF").attrs["Version"] = [1, 0]
            grid["VTKHDF/Points"] = np.zeros((5, 3))
        before = file.read_bytes()
        with self.assertRaisesRegex(ValueError, "grains_000000.hdf: is not an export; it is not replaced"):
            self.export(make_run(), vtk)
        self.assertEqual(file.read_bytes(), before)

    def test_only_those_of_selected_scans_are_written(self):
        self.assertEqual(self.export(make_run(2, 4), vtk, replicas=[1], scans=[1, 3]), 8)
        self.assertFalse((self.view / FIRST).exists())
        self.assertTrue((self.view / SECOND / "contacts_000003.hdf").exists())

    def test_an_unfinished_run_with_scans_without_positions(self):
        run = make_run(scans=4)
        run[0].scans[1].position = run[0].scans[1].rotation = None
        self.assertEqual(self.export(run, vtk, parts=[2, 2]), 12)
        self.assertFalse((self.view / FIRST / "grains_000001.hdf").exists())
        moved = run[0].scans[3].position - run[0].scans[2].position
        self.assertTrue(close(self.points("grains", scan=3)["displacement_since_last_scan"], moved))


if __name__ == "__main__":
    unittest.main()
