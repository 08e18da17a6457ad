"""Tables of laboratories and other programs are split into named columns, whatever their format; errors are
reported."""
import gzip
import io
import math
import os
import unittest

import numpy as np

from lab import ImportCase
from mcdem.importing.tables import parse_table, read_table
from mcdem.importing.text import Form

TWO_FRAMES = ("ITEM: UNITS\nsi\nITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
              "ITEM: ATOMS id x y z diameter \n2 0.2 0.2 0.2 0.02 \n1 0.1 0.2 0.3 0.01 \n"
              "ITEM: TIMESTEP\n200\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
              "ITEM: ATOMS id x y z diameter \n1 0.4 0.5 0.6 0.01 \n")
VTK = "# vtk DataFile Version 3.0.\ncomment\nASCII\n\nDATASET POLYDATA\n"


def table(text, form=None):
    return parse_table(text if isinstance(text, bytes) else text.encode(), "t", form)


def values(read):
    return np.column_stack([read.numbers(c) for c in range(len(read.columns))]).tolist()


class Tables(ImportCase):
    def problems(self, text, form=None):
        return self.problems_of(lambda: table(text, form))

    def expect_table(self, text, columns):
        """Columns x and F with the values 1.5, 2 and 2.5, -4, within the given text."""
        read = table(text)
        self.assertEqual(read.columns, columns)
        self.assertEqual(values(read), [[1.5, 2], [2.5, -4]])


class Text(Tables):
    def test_is_cut_however_it_is_written(self):
        for text in ("x,F\n1.5,2\n2.5,-4\n", "\ufeffx;F\r\n1,5;2\r\n2,5;-4\r\n", "x\tF\n1.5\t2\n2.5\t-4",
                     "  x   F\n\n  1.5  2\n# later\n  2.5 -4.0e0\n", "x F\n1,5 2,0\n2,5 -4\n", '"x","F"\n"1.5",2\n2.5,-4\n',
                     "x;F;\n1,5;2;\n2,5;-4;\n", "# x F\n1.5 2\n2.5 -4\n", "Probe: 3\nDatum;gestern\nx;F\n1,5;2\n2,5;-4\n",
                     "Probe;17;a\nLast;0,5;N\nx;F\n1,5;2\n2,5;-4\n", "Vorkraft;0,5\nx;F\n1,5;2\n2,5;-4\n",
                     "Vorkraft,0.5\n\n# later\nx,F\n1.5,2\n2.5,-4\n"):
            self.expect_table(text, ["x", "F"])
        self.expect_table("1.5,2\n2.5,-4\n", ["column 1", "column 2"])
        self.expect_table("x;F\n[mm];[mN]\n1,5;2\n2,5;-4\n", ["x [mm]", "F [mN]"])
        self.expect_table("a [1];b [2]\nx [mm];F [mN]\n1,5;2\n2,5;-4\n", ["x [mm]", "F [mN]"])
        self.expect_table("Probe;Sand\nVorkraft;0,5\nWeg;3 mm\nx;F\n[mm];[N]\n1,5;2\n2,5;-4\n", ["x [mm]", "F [N]"])
        self.expect_table("H\xf6he [\xb5m];F\n1,5;2\n2,5;-4\n".encode("latin-1"), ["H\xf6he [\xb5m]", "F"])
        for name in ("?", "-F", "x"):
            self.expect_table(f"x;{name}\n1,5;2\n2,5;-4\n", ["x", "column 2"])
        self.assertEqual(table("load;0,5;a\nload;1,5;b\npause;here;c\nunload;2;d\n").rows, 4, "a row like those below")
        self.assertEqual(table("x;F\nnan;0,5\na;b\n1,5;2\n").rows, 3, "nothing is no word")

    def test_can_be_cut_as_stated(self):
        read = table("a b;c\n1 2;3\n", Form(" ", "."))
        self.assertEqual(read.columns, ["a", "b;c"])
        self.assertEqual(read.text(0, 1), "2;3")
        self.assertTrue(math.isnan(read.numbers(1)[0]))

    def test_number_forms_of_python_alone_are_not_numbers(self):
        read = table("x,F\n5,6\n1_000,2\n0x10,7\n1e999,\u0663\n")
        self.assertEqual(str(values(read)), "[[5.0, 6.0], [nan, 2.0], [nan, 7.0], [nan, nan]]")

    def test_rows_know_their_lines(self):
        read = table("x,F\n# remark\n\n1,2\n3,4\n")
        self.assertEqual([read.where(0), read.where(1)], ["t:4", "t:5"])

    def test_invalid_files_are_reported(self):
        self.assertEqual(self.problems(""), ["t: must have at least one row with a number in it, got none"])
        self.expect_one(self.problems("a,b\nc,d\n"), "at least one row")
        self.assertEqual(self.problems("a,b\n1,2\n1,2,3\n1\n"), ["t:3: must have 2 columns as the first row, got 3",
                                                                 "t:4: must have 2 columns as the first row, got 1"])
        self.expect_one(self.problems("a,b\n1,2\n\0"), "got zero bytes: save it as text in UTF-8")
        self.assertEqual(len(self.problems("a,b\n1,2\n" + 10000 * "," + 1000 * "\n")), 1)

    def test_separators_of_thousands_are_refused(self):
        for cell in ("1.306", "-12.345", "1.306.217", "3.217,5"):
            self.expect_one(self.problems(f"x;F\n0,5;1,5\n1,5;{cell}\n"), f't:3: numbers must have no separators of thousands, got "{cell}')
        self.expect_one(self.problems('x,F\n0.5,1.5\n1.5,"1,306"\n'), "thousands")
        self.assertEqual(values(table("x;F\n0,5;1,5\n1,5;0.306\n"))[1][1], 0.306)

    def test_commas_that_part_thousands_are_seen_by_the_whole_table(self):
        for separator in (";", "\t"):
            text = f"x{separator}F\n1,306{separator}2\n"
            self.assertFalse(table(text).decimal_clear)
            self.assertTrue(table(text + f"0,5{separator}3\n").decimal_clear)
            text += 200 * f"1,306{separator}2\n"
            self.assertEqual(self.problems(text + f"1{separator}2.5\n"), [
                't:2: numbers must have one decimal mark and no separators of thousands, got "1,306" beside "2.5" in line 203: write '
                "the table with points only"])
            self.expect_one(self.problems(text + f"0,5{separator}2.5\n"), "t:2: numbers must have")
        self.assertEqual(values(table("x;F\n0,5;2\n1,306;3\n"))[1][0], 1.306)
        self.expect_one(self.problems("x;F\n1,306;2.5\n", Form(";", ",")), "must have one decimal mark")

    def test_yades_formats_name_their_columns(self):
        self.assertEqual(table("#format x_y_z_r\n1\t2\t3\t0.5\n").columns, ["x", "y", "z", "r"])
        self.assertEqual(table("#format id_x_y_z_r_matId\n7\t1\t2\t3\t0.5\t0\n").columns, ["id", "x", "y", "z", "r", "matId"])
        self.assertEqual(table("#format x_y_z_r_attrs\n# x y z r dist v_x\n1\t2\t3\t0.5\t9\t8\n").columns, ["x", "y", "z", "r", "dist", "v_x"])

    def test_lines_of_any_blanks_are_no_rows(self):
        for blank in ("\f", "\v", "\x1c", "\u00a0", "\u2028", "\u3000", "\x85 "):
            for separator in (" ", ",", "\t"):
                text = f"x,F\n{blank}\n1.5,2\n{blank}\n2.5,-4\n{blank}\n".replace(",", separator)
                self.expect_table(text, ["x", "F"])

    def test_a_long_cell_is_an_error_with_its_line(self):
        """Its length does not matter for the time: 60 digits of a cell that is no number took as long as the whole table."""
        rows = "x,F\n1.5,2\n2.5,-4\n"
        self.assertEqual(values(table(rows + "1" * 10_000 + ",1\n"))[2][1], 1)
        for cell in ("1" * 5_000_000 + "x", "1." + "1" * 5_000_000 + "e"):
            self.expect_one(self.problems(rows + f"3,{cell}\n"), "t:4: column 2 must have at most 10000 characters, got \"")
        self.expect_one(self.problems("x," + "F" * 20_000 + "\n1,2\n"), "t:1: column 2 must have at most 10000 characters, got \"FF")


class Dump(Tables):
    def test_has_frames_of_rows(self):
        read = table(TWO_FRAMES)
        self.assertEqual(read.format, "dump")
        self.assertEqual(read.columns, ["id", "x", "y", "z", "diameter"])
        self.assertEqual(read.frames, [(100, 0), (200, 2)])
        self.assertEqual(read.numbers(1)[2], 0.4)
        self.assertEqual(read.where(2), "t:23")
        local = table("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ENTRIES\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
                      "ITEM: ENTRIES c_1[1] c_1[2] c_2 \n1 2 0.5 \n")
        self.assertEqual(local.columns, ["c_1[1]", "c_1[2]", "c_2"])

    def test_invalid_files_are_reported(self):
        def spoiled(wrong, right):
            self.assertIn(wrong, TWO_FRAMES)
            return self.problems(TWO_FRAMES.replace(wrong, right, 1))

        self.assertEqual(spoiled("\n2 0.2 0.2 0.2 0.02 ", ""), ["t:11: must have the 2 rows that the frame promises, got 1; truncated?"])
        self.assertEqual(spoiled("0.2 0.02 ", "0.02"), ["t:12: must have 5 columns as line 11 says, got 4"])
        self.expect_among(spoiled("\n100\n", "\nx\n"), 't:4: the timestep must be a whole number >= 0, got "x"')
        self.expect_among(spoiled("\n2\nITEM", "\n-2\nITEM"), "t:6: the number of rows must be a whole number >= 0")
        self.assertEqual(spoiled("ITEM: ATOMS id x y z diameter \n1", "ITEM: ATOMS id y x z diameter \n1"),
                         ["t:22: the columns must be those of the first frame, id x y z diameter, got id y x z diameter"])
        self.assertEqual(self.problems("ITEM: TIMESTEP\n1\n"), ["t: must hold at least one frame, got none"])
        self.expect_one(self.problems("ITEM: ATOMS id\n1\n"), 't:1: "ITEM: TIMESTEP" must come before')

    def test_data_files_are_in_the_order_of_their_ids(self):
        text = "title\n\n2 atoms\n1 atom types\n\nAtoms # sphere\n\n2 1 0.02 1000 0.4 0.5 0.6 0 0 0\n1 1 0.01 1000 0.1 0.2 0.3 0 0 0\n\nVelocities\n\n1 0 0 0\n"
        read = table(text)
        self.assertEqual(read.columns, ["x", "y", "z", "diameter"])
        self.assertEqual(values(read), [[0.1, 0.2, 0.3, 0.01], [0.4, 0.5, 0.6, 0.02]])
        self.expect_one(self.problems(text.replace("2 atoms", "3 atoms")), "must have the 3 atoms that it promises, at least 1, got 2")
        self.expect_one(self.problems(text.replace("0.02 1000", "x 1000")), "t:8: an atom must have 7 columns")

    def test_extended_xyz_is_read_by_ase(self):
        frame = '2\nLattice="1 0 0 0 1 0 0 0 1" Properties=species:S:1:pos:R:3:id:I:1:radius:R:1:v:R:3 step={}\nX 1 2 3 7 0.5 0 0 1\nX 4 5 6 8 0.6 0 0 2\n'
        read = table(frame.format(10) + frame.format(20))
        self.assertEqual(read.columns, ["x", "y", "z", "id", "radius", "v_x", "v_y", "v_z"])
        self.assertEqual(read.frames, [(10, 0), (20, 2)])
        self.assertEqual(values(read)[3], [4, 5, 6, 8, 0.6, 0, 0, 2])
        self.expect_one(self.problems(frame.format(10).replace("4 5 6", "4 5 six")), "t: must be extended xyz that ASE reads")


class Vtk(Tables):
    def test_points_and_lines_are_rows(self):
        spheres = table(VTK + "POINTS 2 double\n1 2 3\n4 5 6\n\nPOINT_DATA 2\nSCALARS radius double 1\nLOOKUP_TABLE default\n0.5\n0.6\n"
                        "\nVECTORS v double\n1 0 0\n0 7 0\n")
        self.assertEqual(spheres.columns, ["x", "y", "z", "radius", "v_x", "v_y", "v_z"])
        self.assertEqual(values(spheres)[1], [4, 5, 6, 0.6, 0, 7, 0])
        self.assertEqual(spheres.where(1), "t:8")
        contacts = table(VTK + "POINTS 2 double\n1 2 3\n4 5 6\nLINES 1 3\n2 0 1\n\nCELL_DATA 1\n\nSCALARS fn double 1\n"
                         "LOOKUP_TABLE default\n9\n")
        self.assertEqual(contacts.columns, ["x1", "y1", "z1", "x2", "y2", "z2", "fn"])
        self.assertEqual(values(contacts), [[1, 2, 3, 4, 5, 6, 9]])

    def test_invalid_files_are_reported(self):
        self.assertEqual(self.problems("# vtk DataFile Version 3.0\nc\nBINARY\n"), ["t:3: the format must be ASCII: write the file as text"])
        self.assertEqual(self.problems(VTK), ["t: must hold POINTS, got none"])
        self.expect_one(self.problems(VTK + "POINTS 2 double\n1 2 3\n"), "t:6: 6 numbers must follow, got 3; truncated?")
        self.expect_one(self.problems(VTK + "POINTS 99999999999 double\n1 2 3\n"), "299999999997 numbers must follow, got 3")
        self.expect_one(self.problems(VTK + "POINTS many double\n1 2 3\n"), 't:6: a section must say how many there are, got "many"')
        self.expect_among(self.problems(VTK + "POINTS 1 double\n1 2 3\nLINES 1 3\n2 0 1\n"), "t: line 0 must join two of the 1 points")
        self.expect_one(self.problems(VTK + "POINTS 1 double\n1 2 3\nPOINT_DATA 2\nSCALARS r double\n1\n2\n"),
                        "r must have 1 rows, as the points or lines, got 2")
        self.expect_one(self.problems(VTK + "CELLS 1 9\n"), "t:6: must be one of POINTS")

    def test_unstructured_grids_are_read_by_meshio(self):
        import meshio

        mesh = meshio.Mesh([[1, 2, 3], [4, 5, 6.0]], [("vertex", [[0], [1]])], point_data={"radius": [0.5, 0.6], "v": [[0, 0, 1], [0, 0, 2.0]]})
        for name in ("grid.vtk", "grid.vtu"):
            mesh.write(self.path(name))
            read = read_table(self.path(name))
            self.assertEqual(read.columns, ["x", "y", "z", "radius", "v_x", "v_y", "v_z"])
            self.assertEqual(values(read)[1], [4, 5, 6, 0.6, 0, 0, 2])
        with open(self.path("grid.vtu"), "rb") as whole:
            self.expect_one(self.problems(whole.read()[:300]), "t: must be a VTK file that meshio reads")
        for kind in ("PolyData", "ImageData"):  # for which meshio ends the program
            self.expect_one(self.problems(f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="0.1"></VTKFile>'),
                            f't: must be an UnstructuredGrid (.vtu), got "{kind}": save it in ParaView as')
        self.expect_one(self.problems('<VTKFile type="UnstructuredGrid" version="9.7"></VTKFile>'),
                        "t: must be a VTK file that meshio reads, got: \"Unknown VTU file version '9.7'")

    def test_a_frame_of_xyz_has_a_finite_number(self):
        frame = 'Properties=species:S:1:pos:R:3:radius:R:1 frame='
        for number in ("nan", "inf", "-inf"):
            self.expect_one(self.problems(f"2\n{frame}{number}\nH 0 0 0 1\nH 0 0 1 1\n"),
                            f"t: must be extended xyz that ASE reads, got: \"the step of a frame must be a finite number, got {number}")


class Packed(Tables):
    def test_may_be_packed(self):
        out = io.BytesIO()
        with gzip.GzipFile(fileobj=out, mode="wb") as stream:
            stream.write(b"x,F\n1.5,2\n2.5,-4\n")
        file = self.write("t.csv.gz", out.getvalue())
        self.assertEqual(values(read_table(file)), [[1.5, 2], [2.5, -4]])
        os.truncate(file, os.path.getsize(file) - 4)
        self.expect_one(self.problems_of(lambda: read_table(file)), "cannot be unpacked")
        self.expect_one(self.problems_of(lambda: read_table(self.path("none"))), "got no such file")
        self.expect_one(self.problems_of(lambda: read_table(self.folder)), "got something that is not a file")


if __name__ == "__main__":
    unittest.main()
