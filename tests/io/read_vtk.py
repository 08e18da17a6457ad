"""Reads one exported scan with VTK, as ParaView does, and compares it with the arguments.

read_vtk.py FOLDER SCAN GRAINS CONTACTS FORCE_Z_OF_LAST_CONTACT PLATE_Z; exit code 77: no VTK for Python.
"""
import sys

try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader
except ImportError:
    sys.exit(77)


def read(name):
    reader = vtkHDFReader()
    assert reader.CanReadFile(name), f"{name}: not readable"
    reader.SetFileName(name)
    reader.Update()
    return reader.GetOutput()


def arrays(data):
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}


folder, scan = sys.argv[1], sys.argv[2]
grains, contacts = int(sys.argv[3]), int(sys.argv[4])
force_z, plate_z = float(sys.argv[5]), float(sys.argv[6])
of_species = {"species"} if sys.argv[7:] == ["species"] else set()

grid = read(f"{folder}/grains_{scan}.hdf")
assert grid.GetNumberOfPoints() == grid.GetNumberOfCells() == grains, grid
points = arrays(grid.GetPointData())
of_contacts = {"coordination_number", "force_magnitude", "stress", "pressure"} if contacts else set()  # otherwise not recorded
assert set(points) == {"grain", "diameter", "displacement", "displacement_since_last_scan", "rotation",
                       "rotation_since_last_scan"} | of_species | of_contacts, points
assert not of_species or (points["species"] == [grain % 2 for grain in range(grains)]).all()
assert (points["grain"] == range(grains)).all() and (points["diameter"] > 0).all()
if contacts == 0:
    sys.exit(0)
assert points["coordination_number"].sum() >= contacts
stress = points["stress"].reshape(grains, 3, 3)
assert abs(points["pressure"] - stress.trace(axis1=1, axis2=2) / 3).max() <= 1e-12 * abs(stress).max()
grid = read(f"{folder}/contacts_{scan}.hdf")
assert grid.GetNumberOfCells() == contacts and grid.GetNumberOfPoints() == 2 * contacts, grid
cells = arrays(grid.GetCellData())
assert set(cells) == {"grain", "partner", "force", "force_magnitude", "normal_force", "tangential_force", "overlap"}, cells
whole = (cells["normal_force"] ** 2 + cells["tangential_force"] ** 2) ** 0.5
assert abs(whole - cells["force_magnitude"]).max() <= 1e-9 * whole.max()
assert cells["force"].shape == (contacts, 3) and cells["force"][-1, 2] == force_z
line = grid.GetCell(contacts - 1)
ends = [line.GetPoints().GetPoint(i) for i in range(2)]
assert line.GetCellType() == 3 and line.GetNumberOfPoints() == 2
assert cells["partner"][-1] == -6 and ends[1][2] == plate_z and ends[0][:2] == ends[1][:2], ends
field = arrays(grid.GetFieldData())
assert field["plate_z"][0] == plate_z, field

grid = read(f"{folder}/forces_{scan}.hdf")
assert grid.GetNumberOfPoints() == grid.GetNumberOfCells() == contacts, grid
assert (arrays(grid.GetPointData())["force"] == cells["force"]).all()
grid = read(f"{folder}/walls_{scan}.hdf")
assert [grid.GetCell(i).GetNumberOfPoints() for i in range(6)] == 6 * [4], grid
assert grid.GetBounds()[4] == 0 and grid.GetCell(5).GetBounds()[4:] == (plate_z, plate_z), grid.GetBounds()
