"""What names say is not overruled by numbers; a plate that sticks; tables with empty cells at the end of rows."""
import unittest
from dataclasses import replace

import numpy as np

from lab import ImportCase, Style
from mcdem.importing.guess import read_import_tables
from mcdem.importing.mapping import Known
from mcdem.importing.names import column_name
from mcdem.importing.read_mapping import parse_mapping

VOXEL = 1.25e-4  # [m]


class Centres(ImportCase):
    """The first frame in voxels, without contacts."""

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


class NamedCentres(Centres):
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
        self.expect_among(self.unclear(self.guess_with(["grain_id", "modulus", "poisson", "density", "yield"], lambda i, d: d)), "role must be confirmed")
        tables = self.guess_with(["grain_id", "strain", "p_kPa", "q_kPa", "porosity"], lambda i, d: d)
        self.assertEqual([table.role for table in tables], ["plate", "unused"])
        tables = self.guess_with(["a", "z_vox", "y_vox", "b", "c"], lambda i, d: d)  # z stands where x would be
        self.assertEqual([table.role for table in tables], ["plate", "unused"])
        self.expect_among(self.unclear(tables), "role must be confirmed")


class Sizes(Centres):
    def test_of_a_biased_image_are_doubted_and_a_factor_is_proposed(self):
        """Inscribed radii 20 % too small: 1.2 to the left out 3 % of overlap."""
        for bias, factor in ((0.8, 1.2), (1.4, 0.7)):
            with self.subTest(bias=bias):
                tables = self.guess_with(["id", "x_vox", "y_vox", "z_vox", "radius_vox"], lambda i, d: 0.5 * bias * d)
                self.expect_among(self.unclear(tables), "size_factor must be confirmed")
                self.assertAlmostEqual(self.of(tables, "grains").number("size_factor"), factor, delta=0.03)
                text = self.accepted(tables, (f'size_factor = "{self.of(tables, "grains").word("size_factor")}"', f'size_factor = "{1 / bias}"'))
                found = self.imported(self.by_mapping(text)).grains.diameter_m
                np.testing.assert_allclose(sorted(found), sorted(self.truth.diameter), rtol=1e-8)

    def test_of_touching_grains_are_not_doubted(self):
        tables = self.guess_with(["id", "x_vox", "y_vox", "z_vox", "radius_vox"], lambda i, d: 0.5 * d)
        self.assertNotIn("size_factor", self.of(tables, "grains"))


class Margins(Centres):
    def test_below_the_packing_are_asked_for(self):
        """A quarter of a diameter."""
        for scan in self.truth.scans:
            scan.position[:, 2] += 40 * VOXEL
        tables = self.guess_with(["id", "x_vox", "y_vox", "z_vox", "radius_vox"], lambda i, d: 0.5 * d)
        self.expect_among(self.unclear(tables), "origin_z must be confirmed", "a margin below it")
        lowest = min(self.truth.scans[0].position[:, 2] - self.truth.diameter / 2) / VOXEL
        self.assertAlmostEqual(self.of(tables, "grains").number("origin_z"), lowest, places=4)
        self.assertFalse([line for line in self.unclear(tables) if "force_unit" in line])


class Voxels(Centres):
    """The option --voxel-size together with a mapping."""

    def test_of_the_option_replace_those_of_the_mapping(self):
        text = self.accepted(self.guess_with(["id", "x_vox", "y_vox", "z_vox", "radius_vox"], lambda i, d: 0.5 * d))
        without = text.replace(f'voxel_size = "{VOXEL}"', "#")
        self.assertNotEqual(without, text)
        self.expect_one(self.problems_of(lambda: parse_mapping(without, "m")), "voxel_size must be stated")
        for mapping in (text, without):
            tables = read_import_tables(parse_mapping(mapping, "m", Known(voxel_size=2 * VOXEL).stated), (), "m")
            self.assertEqual([table.map.word("voxel_size") for table in tables], ["", "0.00025"])


class Quantities(ImportCase):
    """A plate's pressures are forces over the area, with the unit that the name says; percentages are no forces."""

    PRESSURES = {"load_kPa": 1e3, "Load [MPa]": 1e6, "Kraft (bar)": 1e5, "force in N/mm2": 1e6, "force (N/mm^2)": 1e6, "load_mbar": 100, "force psi": 6894.757293168361,
                 "Applied Pressure (PSI)": 6894.757293168361, "Druckspannung [N/cm²]": 1e4, "sigma_zz [kPa]": 1e3}

    def plate(self, name, value=1.0):
        self.write("kraft.csv", Style(",", ".").table(["height_mm", name], ((1e3 * s.plate_z, value * s.top_force) for s in self.truth.scans)))
        return self.guess([self.path("kraft.csv")])

    def test_of_names(self):
        for name, base, quantity in (("pressure_Pa", "pressure", "a pressure"), ("axial stress", "axialstress", "a pressure"),
                                     ("Spannung [N/mm²]", "spannung", "a pressure"), ("strain_%", "strain", "a fraction"), ("x_bar", "xbar", ""),
                                     ("Axial strain", "axialstrain", "a fraction"), ("Porosity", "porosity", "a fraction"), ("sigma (mPa)", "sigma", ""),
                                     ("z-vox", "z", "a length"), ("force_N", "force", "a force"), ("Kraft/kN", "kraft", "a force"), ("Guete", "guete", "")):
            with self.subTest(name):
                self.assertEqual((column_name(name).base, column_name(name).quantity), (base, quantity))

    def expect_forces(self, tables, factor):
        np.testing.assert_allclose(self.imported(tables).plate.top_force_N, [factor * s.top_force for s in self.truth.scans], rtol=1e-8)

    def test_of_pressures_are_multiplied_by_the_section_of_the_container(self):
        for name, pascals in self.PRESSURES.items():
            with self.subTest(name):
                tables = self.plate(name)
                self.assertEqual(self.unclear(tables), [])
                self.expect_forces(tables, pascals * 0.06 * 0.08)
        self.known = replace(self.known, shape="cylinder", box=(0.06, 0.06))
        self.expect_forces(self.plate("load_kPa"), 1e3 * np.pi * 0.03**2)
        self.known = replace(self.known, area=0.002)
        self.expect_forces(self.plate("load_kPa"), 2)
        self.known = replace(self.known, area=np.nan, box=(0, 0))
        self.expect_among(self.unclear(self.plate("load_kPa")), 'area must be confirmed, got "?1": --area')

    def test_of_pressures_without_a_unit_are_asked_for(self):
        for name in ("Druck", "axial stress", "Pressure"):
            tables = self.plate(name)
            self.expect_one(self.unclear(tables), 'force_unit must be confirmed, got "?kPa": the name says a pressure')
            text = self.accepted(tables, ('force_unit = "kPa"', 'force_unit = "N"'))
            self.expect_one(self.problems_of(lambda: self.imported(self.by_mapping(text))), f'"{name}" must be a force, got another quantity')

    def test_that_are_no_forces_are_refused_also_when_confirmed(self):
        tables = self.plate("force [%]")
        self.expect_among(self.unclear(tables), "force_unit must be confirmed", "and no force: multiply by the")
        text = self.accepted(tables)
        self.expect_one(self.problems_of(lambda: self.imported(self.by_mapping(text))), '"force [%]" must be a force, got another quantity')


class Heights(ImportCase):
    """A plate's height from what engineers measure in its place."""

    START = 0.0605  # [m] of the first row
    AREA, SOLID = 0.06 * 0.08, 1.5e-4  # [m2], [m3]

    def setUp(self):
        super().setUp()
        self.known = replace(self.known, plate_start=self.START)

    def guess_with(self, name, of):
        rows = ((of(s.plate_z), s.top_force) for s in self.truth.scans)
        self.write("kraft.csv", Style(",", ".").table([name, "force_N"], rows))
        return self.guess([self.path("kraft.csv")])

    def part(self, z):
        """The grains' part of the volume."""
        return self.SOLID / (self.AREA * z)

    def ways(self):
        return {"strain [%]": lambda z: 100 * (1 - z / self.START), "Strain (mm/mm)": lambda z: 1 - z / self.START, "relative density": self.part,
                "void_ratio": lambda z: 1 / self.part(z) - 1, "porosity": lambda z: 1 - self.part(z), "Volume fraction [%]": lambda z: 100 * self.part(z)}

    def test_follow_from_plate_start_or_the_volume_of_the_grains(self):
        for name, of in self.ways().items():
            with self.subTest(name):
                self.expect_tables_of_plate(self.guess_with(name, of))
        self.known = replace(self.known, plate_start=np.nan, solid_volume=self.SOLID)
        for name, of in list(self.ways().items())[2:]:
            with self.subTest(name):
                self.expect_tables_of_plate(self.guess_with(name, of))

    def expect_tables_of_plate(self, tables):
        self.assertEqual(self.unclear(tables), [])
        np.testing.assert_allclose(self.imported(tables).plate.plate_z_m, [s.plate_z for s in self.truth.scans], atol=1e-9)

    def test_need_one_of_the_two(self):
        self.known = replace(self.known, plate_start=np.nan)
        for name, of in self.ways().items():
            with self.subTest(name):
                tables = self.guess_with(name, of)
                self.expect_one(self.problems_of(lambda: self.imported(tables)), "counts downwards from plate.start, which must be given [m]")

    def test_of_a_strain_without_a_unit_are_asked_for(self):
        self.expect_one(self.unclear(self.guess_with("axial strain", lambda z: 1 - z / self.START)), 'ratio_unit must be confirmed, got "?1"')
        self.assertEqual(self.of(self.guess_with("axial strain", lambda z: 100 - 100 * z / self.START), "plate")["ratio_unit"].word, "%")  # above 1

    def test_are_refused_where_no_grains_or_more_than_all_volume_are_left(self):
        for name, value in (("porosity", 1.0), ("relative density", 0.0), ("void_ratio", -0.1)):
            tables = self.guess_with(name, lambda z: value if z < 0.056 else 0.5)
            self.expect_one(self.problems_of(lambda: self.imported(self.by_mapping(self.accepted(tables)))), "must leave grains a part > 0 and <= 1")

    def test_are_no_strains_taken_for_a_length(self):
        text = self.accepted(self.guess_with("strain [%]", self.ways()["strain [%]"]), ('strain = "strain [%]"', 'displacement = "strain [%]"\nlength_unit = "mm"'))
        self.expect_among(self.problems_of(lambda: self.imported(self.by_mapping(text))), '"strain [%]" must be a length, got another quantity')

    def test_and_forces_of_an_oedometer_come_from_p_and_q(self):
        rows = ((1 - s.plate_z / self.START, s.top_force - 2, 3.0, 0.4) for s in self.truth.scans)
        self.write("oedometer.dat", "# e_a p q n\n" + "".join(" ".join(f"{value:.9g}" for value in row) + "\n" for row in rows))
        tables = self.guess([self.path("oedometer.dat")])
        self.assertEqual([tables[0].role, *(tables[0].map.word(key) for key in ("strain", "mean_stress", "deviator_stress"))], ["plate", "e_a", "p", "q"])
        self.assertEqual(sorted(line.split()[1] for line in self.unclear(tables)), ["force_unit", "ratio_unit"])
        plate = self.imported(self.by_mapping(self.accepted(tables))).plate
        np.testing.assert_allclose(plate.top_force_N, [1e3 * self.AREA * s.top_force for s in self.truth.scans], rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(plate.plate_z_m, [s.plate_z for s in self.truth.scans], atol=1e-9)


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

    def test_may_be_pulled_farther_than_it_was_pressed(self):
        _, tables = self.guess_stroke(0.12, 0.3)
        self.write("plate.csv", "displacement_mm,force_N\n0,0\n0.5,0.05\n1,0.12\n0,-0.2\n-1,-0.3\n-2,-0.3\n-3,0\n")
        plate = self.imported(self.by_mapping(self.accepted(tables))).plate
        np.testing.assert_allclose(plate.plate_z_m, 0.027 - 1e-3 * np.array([0, 0.5, 1, 0, -1, -2, -3]))
        text = self.accepted(tables, ('displacement = "displacement_mm"', 'displacement = "-displacement_mm"'))
        self.write("plate.csv", "displacement_mm,force_N\n0,0\n0.5,0.05\n1,0.12\n0.01,0\n")
        self.expect_among(self.problems_of(lambda: self.imported(self.by_mapping(text))), "the plate must go down from plate.start")

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
