"""Tables as testing machines and spreadsheets write them, beside one table of the grains."""
import unittest

from lab import ImportCase, Style, lab_grains


def rows_of(truth, form):
    return "".join(form.format(t=0.5 * scan.frame, z=1e3 * scan.plate_z, f=scan.top_force) for scan in truth.scans)


class Machines(ImportCase):
    def setUp(self):
        super().setUp()
        for scan in self.truth.scans:
            scan.contacts = []

    def files_with(self, text, grains=None):
        """A table of the plate, and one of the grains."""
        return [self.write("machine.csv", text), self.write("grains.csv", grains or lab_grains(self.truth, Style(",", ".")))]

    def with_plate(self, text, grains=None):
        return self.guess(self.files_with(text, grains))

    def expect_all_of(self, text, grains=None):
        self.expect_import(self.files_with(text, grains))

    def test_units_of_other_columns_may_be_any(self):
        for other in ("(kPa)", "[furlong]", "°C", "μm", "[-]"):
            with self.subTest(other):
                self.expect_all_of(f"Zeit,Height,Load,Other\n(s),(mm),(N),{other}\n" + rows_of(self.truth, "{t},{z:.9g},{f:.9g},1.5\n"))

    def test_quoted_numbers_may_have_a_decimal_comma(self):
        rows = rows_of(self.truth, '"{t}","{z:.9g}","{f:.9g}"\n').replace(".", ",")
        self.expect_all_of('"Zeit [s]","Height [mm]","Load [N]"\n' + rows)

    def test_a_trigger_column_selects_the_rows_of_frames(self):
        rows = "".join(f"{0.5 * s.frame},{1e3 * s.plate_z:.9g},{s.top_force:.9g},{s.frame}\n"
                       f"{0.5 * s.frame + 0.2},{1e3 * s.plate_z - 0.1:.9g},{s.top_force:.9g},\n" for s in self.truth.scans)
        name, *grains = lab_grains(self.truth, Style(",", ".")).splitlines()
        time = name.split(",").index("Zeit [s]")
        cells = [row.split(",") for row in grains]
        frames = [",".join([*row[:time], f"{2 * float(row[time]):.0f}", *row[time + 1:]]) for row in cells]
        grains = "\n".join([name.replace("Zeit [s]", "frame"), *frames, ""])
        tables = self.with_plate("Zeit [s],Height [mm],Load [N],frame\n" + rows, grains)
        self.expect_truth(self.by_mapping(self.accepted(tables, ('frame = "Zeit [s]"', 'frame = "frame"'))))

    def test_frames_between_rows_take_the_nearest_if_the_clock_is_confirmed(self):
        rows = "".join(f"{0.5 * s.frame + late - 0.02},{1e3 * s.plate_z:.9g},{s.top_force:.9g}\n" for s in self.truth.scans for late in (0, 0.1, 0.2, 0.3))
        tables = self.with_plate("Zeit [s],Height [mm],Load [N]\n" + rows)
        self.expect_one(self.unclear(tables), 'frames_by must be confirmed, got "?nearest"')
        imported = self.imported(self.by_mapping(self.accepted(tables)))
        self.assertEqual([*imported.grains.frame.unique()], [4 * scan.frame for scan in self.truth.scans])
        of_frames = imported.plate.iloc[::4]
        self.assertEqual([*of_frames.plate_z_m.round(9)], [scan.plate_z for scan in self.truth.scans])
        early = rows[:rows.index("\n1.48") + 1]  # ends before the last frames
        self.expect_one(self.unclear(self.with_plate("Zeit [s],Height [mm],Load [N]\n" + early)), "?order")

    def test_grains_may_be_sorted_by_number(self):
        name, *rows = lab_grains(self.truth, Style(",", ".")).splitlines()
        by_number = sorted(rows, key=lambda row: int(row.split(",")[2]))
        self.expect_all_of("Zeit [s],Height [mm],Load [N]\n" + rows_of(self.truth, "{t},{z:.9g},{f:.9g}\n"), "\n".join([name, *by_number, ""]))

    def test_the_start_is_that_of_the_first_frame(self):
        """Rows of the plate's approach are left out, whatever is stated of its start."""
        text = "Zeit [s],Height [mm],Load [N]\n-2,150,0\n-1,70,0\n" + rows_of(self.truth, "{t},{z:.9g},{f:.9g}\n")
        self.assertAlmostEqual(self.imported(self.with_plate(text)).plate_start, 0.0605, 12)
        self.known.plate_start = 0.061
        self.assertEqual(self.imported(self.with_plate(text)).plate_start, 0.061)

    def test_a_unit_of_force_that_contradicts_the_overlaps_is_unclear(self):
        rows = rows_of(self.truth, "{t},{z:.9g},{f:.9g}\n")
        self.assertEqual(self.unclear(self.with_plate("Zeit [s],Height [mm],Load [N]\n" + rows)), [])
        self.expect_one(self.unclear(self.with_plate("Zeit [s],Height [mm],Load [mN]\n" + rows)), 'force_unit must be confirmed, got "?mN"')


if __name__ == "__main__":
    unittest.main()
