"""Random changes (reproducible) of tables and mappings: they are imported or give an input error, never a traceback."""
import random
import sys
import time
import unittest
import warnings

from lab import ImportCase, Style, dump_of_contacts, dump_of_grains, lab_contacts, lab_grains, lab_plate, plain_plate
from mcdem.errors import InputError
from mcdem.importing.assemble import write_tables
from mcdem.importing.guess import mapping_of, wrong_rows
from mcdem.importing.mapping import mapping_text
from mcdem.importing.read_mapping import parse_mapping
from programs_test import vtk_of_interactions, vtk_of_spheres

ROUNDS = int(sys.argv.pop()) if len(sys.argv) > 1 and sys.argv[-1].isdigit() else 150
SPICE = [b"nan", b"-1", b"1e308", b"-1e308", b"1e-320", b"999999999999999999999", b"?", b"\xff", b"\x00", b"\n", b";", b",", b"\t", b'"', b"",
         b" ", b"ITEM: ", b"# ", b"0", b"2147483648", b"[[table]]", b"= ", b"z", b"_", b"\xe2\x80\xa8", b"\x0c", b"voxel", b"frame", b"-",
         b"\n\x0c\n", b"\n\xc2\xa0\n", b"\x1c", b"\x85", b"inf", b"frame=nan", b"frame=-1e400", b"3" * 30_000, b"[1 2]", b"\x1b]0;a\x07"]


def xyz_of_grains(truth):
    frames = []
    for scan in truth.scans:
        rows = "".join(f"X {x} {y} {z} {d / 2}\n" for (x, y, z), d in zip(scan.position, truth.diameter))
        frames.append(f"{len(truth.diameter)}\nProperties=species:S:1:pos:R:3:radius:R:1 frame={scan.frame}\n{rows}")
    return "".join(frames)


def mutated(text, draw):
    text = bytearray(text)
    for _ in range(draw.choice((1, 1, 2, 5, 20))):
        at = draw.randrange(len(text) + 1)
        lines = bytes(text).split(b"\n")
        what = draw.randrange(7)
        if what == 0:
            text[at:at + draw.randrange(1, 6)] = draw.choice(SPICE)
        elif what == 1 and text:
            text[at % len(text)] = draw.randrange(256)
        elif what == 2:
            del text[at:]
        elif what == 3:
            line = draw.randrange(len(lines))
            text = bytearray(b"\n".join(lines[:line] + [lines[draw.randrange(len(lines))]] * draw.randrange(3) + lines[line:]))
        elif what == 4:
            del lines[draw.randrange(len(lines))]
            text = bytearray(b"\n".join(lines))
        elif what == 5:
            line = draw.randrange(len(lines))
            cells = lines[line].split(b";")
            cells[draw.randrange(len(cells))] = draw.choice(SPICE)
            text = bytearray(b"\n".join(lines[:line] + [b";".join(cells)] + lines[line + 1:]))
        else:
            text = bytearray(bytes(text).replace(draw.choice((b".", b",", b"1", b"mm", b"x")), draw.choice(SPICE)))
    return bytes(text)


class Hostile(ImportCase):
    def setUp(self):
        super().setUp()
        self.truth.scans = self.truth.scans[:3]
        self.draw = random.Random(20)
        # Overflows of damaged numbers are refused later; warnings about them are ignored.
        kept = warnings.catch_warnings()
        kept.__enter__()
        self.addCleanup(kept.__exit__, None, None, None)
        warnings.simplefilter("ignore", RuntimeWarning)

    def sources(self):
        plain = Style(",", ".", False)
        scan = self.truth.scans[1]
        return [
            {"kraft.csv": lab_plate(self.truth), "koerner.csv": lab_grains(self.truth), "kontakte.csv": lab_contacts(self.truth)},
            {"p.csv": lab_plate(self.truth, plain), "g.csv": lab_grains(self.truth, plain), "c.csv": lab_contacts(self.truth, plain)},
            {"plate.csv": plain_plate(self.truth), "g.dump": dump_of_grains(self.truth), "c.dump": dump_of_contacts(self.truth, False),
             "w.dump": dump_of_contacts(self.truth, True)},
            {"plate.csv": plain_plate(self.truth, ",", ""), "s_0.vtk": vtk_of_spheres(self.truth, scan), "i_0.vtk": vtk_of_interactions(scan)},
            {"plate.csv": plain_plate(self.truth, ",", "frame", 1), "a.csv": "label,centroid-0,centroid-1,centroid-2\n" + "".join(
                f"{i},{z},{y},{x}\n" for i, (x, y, z) in enumerate(400 * scan.position))},
            {"plate.csv": plain_plate(self.truth, ",", "frame", 1), "g.xyz": xyz_of_grains(self.truth)},
            {"plate.txt": plain_plate(self.truth, ",", "frame", 1).replace(",", " "), "g.txt": lab_grains(self.truth, plain).replace(",", "  ")},
        ]

    def expect_positions(self, error):
        """Each problem has a position, except the last one, which may count the rest."""
        self.assertTrue(error.problems and all(": " in problem or problem.startswith(".. and ") for problem in error.problems), error)

    def import_all(self, files):
        """As the command does."""
        tables = self.guess(files)
        text = mapping_text(mapping_of(tables))
        wrong_rows(tables)
        for accept in (False, True):
            try:
                imported = self.imported(self.by_mapping(text.replace('"?', '"') if accept else text))
                write_tables(imported, self.folder)
            except InputError:
                pass

    def test_tables(self):
        for number in range(ROUNDS):
            texts = self.draw.choice(self.sources())
            spoiled = self.draw.choice(list(texts))
            files = [self.write(name, mutated(text.encode(), self.draw) if name == spoiled else text) for name, text in texts.items()]
            with self.subTest(round=number, file=spoiled):
                try:
                    self.import_all(files)
                except InputError as error:
                    self.expect_positions(error)

    def test_mappings(self):
        text = mapping_text(mapping_of(self.guess(self.write_lab()))).encode()
        for number in range(ROUNDS):
            with self.subTest(round=number):
                try:
                    changed = mutated(text, self.draw).decode("utf-8", "replace")
                    parse_mapping(changed, "m")
                    self.imported(self.by_mapping(changed))
                except InputError as error:
                    self.expect_positions(error)


    def test_long_mappings_are_refused_in_seconds(self):
        for text in ("a" + ".a" * 200_000 + "=1", "[" + "a." * 200_000 + "a]", "".join(f"k{n}=1\n" for n in range(40_000)),
                     "x=1" + "0" * 500_000):
            with self.subTest(text[:10]):
                start = time.monotonic()
                with self.assertRaises(InputError):
                    parse_mapping(text, "mapping.toml")
                self.assertLess(time.monotonic() - start, 10)


if __name__ == "__main__":
    unittest.main()
