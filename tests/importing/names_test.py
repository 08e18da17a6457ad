"""What names say is not overruled by numbers; a plate that sticks; tables with empty cells at the end of rows."""
import unittest

import numpy as np

from lab import ImportCase, Style
from mcdem.importing.mapping import Known
from mcdem.importing.names import column_name

VOXEL = 1.25e-4  # [m]


class Centres(ImportCase):
    def setUp(self):
        super().setUp()
        self.known = Known(box=self.known.box, youngs_modulus=23300, poisson_ratio=0.5, voxel_size=VOXEL)
        for scan in self.truth.scans:
            scan.contacts = []

    def guess_with(self, names, size):
        """Large numbers of grains in no order beside the centres: with them as a coordinate, grains seem to touch as well."""
        numbers = np.random.default_rng(1).permutation(np.arange(1000, 30000))[:36]
        rows = [[str(numbers[i]), *at / VOXEL, size(i, d) / VOXEL] for s in self.truth.scans[:1]
                for i, (at, d) in enumerate(zip(s.position, self.truth.diameter))]
        self.write("grains.csv", Style(",", ".").table(names, rows))
        self.write("kraft.csv", Style(",", ".").table(["height_mm", "force_N"], ((1e3 * s.plate_z, s.top_force) for s in self.truth.scans)))
        return self.guess([self.path("kraft.csv"), self.path("grains.csv")])

    def test_that_are_named_are_those_though_the_size_is_not(self):
        for names in (["grain_id", "x_vox", "y_vox", "z_vox", "max_distance_value_vox"], ["ID", "x-vox", "y-vox", "z-vox", "inscribed_vox"],
                      ["label", "comX [px]", "comY [px]", "comZ [px]", "size [px]"]):
            for size in (lambda i, d: 0.4 * d * (i != 7), lambda i, d: d, lambda i, d: 0.5 * d):
                with self.subTest(names=names, size=size(0, 1)):
                    tables = self.guess_with(names, size)
                    grains = self.of(tables, "grains")
                    self.assertEqual([grains.word(key) for key in ("grain", "x", "y", "z")], names[:4])
                    self.assertEqual([grains[key].certainty for key in ("grain", "x", "y", "z")], ["sure"] * 4)
                    key = "diameter" if size(0, 1) == 1 else "radius"
                    self.expect_among(self.unclear(tables), f'{key} must be confirmed, got "?{names[4]}"', "no name says it")

    def test_are_no_columns_named_otherwise(self):
        tables = self.guess_with(["grain_id", "a", "y_vox", "z_vox", "d"], lambda i, d: d)
        grains = self.of(tables, "grains")
        self.assertEqual([grains.word(key) for key in ("grain", "x", "y", "z", "diameter")], ["grain_id", "a", "y_vox", "z_vox", "d"])
        tables = self.guess_with(["a", "z_vox", "y_vox", "b", "c"], lambda i, d: d)  # z stands where x would be
        self.assertEqual([table.role for table in tables], ["plate", "unused"])
        self.expect_among(self.unclear(tables), "role must be confirmed")


class Quantities(ImportCase):
    NO_FORCE = ("load_kPa", "Load [MPa]", "Kraft (bar)", "force in N/mm2", "force (N/mm^2)", "load_mbar", "force psi", "force [%]")

    def plate(self, name, value=1.0):
        self.write("kraft.csv", Style(",", ".").table(["height_mm", name], ((1e3 * s.plate_z, value * s.top_force) for s in self.truth.scans)))
        return self.guess([self.path("kraft.csv")])

    def test_of_names(self):
        for name, base, quantity in (("pressure_Pa", "pressure", "a pressure"), ("axial stress", "axialstress", "a pressure"),
                                     ("Spannung [N/mm²]", "spannung", "a pressure"), ("strain_%", "strain", "a fraction"), ("x_bar", "xbar", ""),
                                     ("z-vox", "z", "a length"), ("force_N", "force", "a force"), ("Kraft/kN", "kraft", "a force"), ("Guete", "guete", "")):
            with self.subTest(name):
                self.assertEqual((column_name(name).base, column_name(name).quantity), (base, quantity))

    def test_other_than_forces_are_refused_also_when_confirmed(self):
        for name in self.NO_FORCE:
            with self.subTest(name):
                tables = self.plate(name)
                self.expect_among(self.unclear(tables), "force_unit must be confirmed", "and no force: multiply by the")
                text = self.accepted(tables)
                self.expect_one(self.problems_of(lambda: self.imported(self.by_mapping(text))), f'"{name}" must be a force, got another quantity')

    def test_named_as_pressures_have_a_remedy_and_no_force_is_guessed(self):
        for name in ("pressure_Pa", "Druck", "sigma_zz [kPa]"):
            with self.subTest(name):
                tables = self.plate(name)
                self.assertNotIn("top_force", self.of(tables, "plate"))
                self.expect_among(self.unclear(tables), 'role must be confirmed, got "?plate": no column is named as top_force, which a plate',
                                  "multiply by the area that it acts on")
                text = self.accepted(tables, ("# top_force =", f'top_force = "{name}"  #')) + 'force_unit = "N"\nforce_sign = "+"\n'
                self.expect_among(self.problems_of(lambda: self.imported(self.by_mapping(text))), f'"{name}" must be a force')


class Sticking(ImportCase):
    """A plate that is pressed to 1 mm and pulled back beyond its start, with a force that grows to `pull` [N]."""

    def guess_stroke(self, push, pull, way=1, sign=1, head="displacement_mm,force_N", start=0.0):
        down = [(i / 10, push * (i / 10) ** 1.5) for i in range(11)]
        up = [(i / 10, push - (push + pull) * min(1, (10 - i) / 14)) for i in range(9, -10, -1)]
        rows = "".join(f"{start + way * d:.6g},{sign * f:.6g}\n" for d, f in (down + up if pull else down + down[-2::-1]))
        self.write("plate.csv", f"{head}\n{rows}")
        self.known = Known(box=(0.05, 0.05), plate_start=0.027, youngs_modulus=5000)
        tables = self.guess([self.path("plate.csv")])
        return self.of(tables, "plate"), tables

    def test_has_a_question_and_the_right_proposal(self):
        for push in (0.12, 0.01):
            for sign, named in ((1, "+"), (-1, "-")):
                for way, word in ((1, "displacement_mm"), (-1, "-displacement_mm")):
                    with self.subTest(push=push, sign=sign, way=way):
                        plate, tables = self.guess_stroke(push, 0.3, way, sign)
                        self.assertEqual((plate.word("displacement"), plate["displacement"].certainty), (word, "unclear"))
                        self.assertEqual((plate.word("force_sign"), plate["force_sign"].certainty), (named, "unclear"))
                        self.expect_among(self.unclear(tables), "displacement must be confirmed", "a plate that sticks is pulled")

    def test_has_one_as_a_height_too(self):
        for way, word in ((-1, "height_mm"), (1, "-height_mm")):
            plate, _ = self.guess_stroke(0.12, 0.3, way, head="height_mm,force_N", start=27)
            self.assertEqual((plate.word("plate_z"), plate["plate_z"].certainty), (word, "unclear"))

    def test_is_not_suspected_of_a_plate_that_only_presses(self):
        for sign, named in ((1, "+"), (-1, "-")):
            for way, word in ((1, "displacement_mm"), (-1, "-displacement_mm")):
                for pull in (0, 0.005):  # an error of the zero
                    plate, tables = self.guess_stroke(0.12, pull, way, sign)
                    self.assertEqual((plate.word("displacement"), plate.word("force_sign")), (word, named))
                    self.assertEqual(self.unclear(tables), [])


class Remedies(ImportCase):
    def length_unit(self, start):
        self.write("plate.csv", "Standard travel,Standard force\n0,0\n1,0.1\n2,0.3\n3,0.6\n")
        self.known = Known(box=(0.05, 0.05), plate_start=start, youngs_modulus=5000)
        return self.of(self.guess([self.path("plate.csv")]), "plate")["length_unit"]

    def test_are_not_proposed_where_they_were_followed(self):
        unknown, known = self.length_unit(np.nan), self.length_unit(0.027)
        self.assertIn("plate.start is not known", unknown.why)
        self.assertNotIn("plate.start is not known", known.why)
        self.assertEqual((known.word, known.certainty), ("mm", "unclear"))  # in cm the plate would pass the floor


class LastColumns(ImportCase):
    def frames_of(self, text):
        self.write("plate.csv", text)
        part = self.guess([self.path("plate.csv")])[0].parts[0]
        return part.columns, [[repr(float(x)) for x in part.numbers(c)] for c in range(len(part.columns))]

    def test_that_are_empty_in_the_first_row_are_columns(self):
        rows = [["0.0", "1.0", "2.0"], ["0.0", "0.1", "0.3"], ["nan", "nan", "1.0"]]
        for text in ("d,load,Trigger\n0,0,\n1,0.1,\n2,0.3,1\n", "d;load;Trigger\r\n0;0;\r\n1;0,1;\r\n2;0,3;1\r\n", "d\tload\tTrigger\n0\t0\t\n1\t0.1\t\n2\t0.3\t1\n",
                     "# d,load,Trigger\n0,0,\n1,0.1,\n2,0.3,1\n", '"d","load","Trigger"\n"0","0",""\n"1","0.1",""\n"2","0.3","1"\n'):
            with self.subTest(text):
                self.assertEqual(self.frames_of(text), (["d", "load", "Trigger"], rows))
        self.assertEqual(self.frames_of("d,load,Trigger\nmm,N,\n0,0,\n1,0.1,\n2,0.3,1\n"), (["d [mm]", "load [N]", "Trigger"], rows))
        self.assertEqual(self.frames_of("0,0,\n1,0.1,\n2,0.3,1\n"), (["column 1", "column 2", "column 3"], rows))
        self.assertEqual(self.frames_of("d,load,a,b\n0,0,,\n1,0.1,,2\n")[0], ["d", "load", "a", "b"])

    def test_are_none_where_every_line_only_ends_in_a_separator(self):
        rows = [["0.0", "1.0"], ["0.0", "0.1"]]
        for text in ("d,load,\n0,0,\n1,0.1,\n", "d,load\n0,0,\n1,0.1,\n"):
            self.assertEqual(self.frames_of(text), (["d", "load"], rows))


if __name__ == "__main__":
    unittest.main()
