"""Tables of an experiment: rows and words that are read, and files that are not. tables_test.py"""
import errno
import functools
import gzip
import math
import os
import random
import tracemalloc
import unittest
from unittest import mock

import numpy as np
from small_folder import SMALL, TABLES, FolderCase

from mcdem.errors import RunError
from mcdem.experiment import table as tables
from mcdem.experiment.row_problems import RowProblems
from mcdem.experiment.table import NUMBER, NUMBER_OR_NOTHING, WHOLE, WRONG, read_table
from mcdem.problems import Problems

GZIP = functools.partial(gzip.compress, mtime=0)


class Words(unittest.TestCase):
    def test_numbers(self):
        words = ["1", " -2.5\t", "+1e-2", ".5", "5.", "007", "1e400", "nan", "inf", "", "x", "1_0", "1 2", "٣", "0x1", "1e"]
        expected = [1, -2.5, 0.01, 0.5, 5, 7] + [math.nan] * 10
        np.testing.assert_array_equal(NUMBER.values(words, False), expected)
        np.testing.assert_array_equal(NUMBER.values(words[:9], True), expected[:9])
        values = NUMBER_OR_NOTHING.values(["", " ", "2", "inf", "x"], True)
        np.testing.assert_array_equal(values, [math.inf, math.inf, 2, math.nan, math.nan])

    def test_whole_numbers(self):
        words = ["0", " 12\t", "+3", "-0", "007", "2000000000", "2000000001", "-1", "+-1", "1.0", "1e3", "", "9" * 5000, "1_0", "٣"]
        self.assertEqual(WHOLE.values(words, True).tolist(), [0, 12, 3, 0, 7, 2_000_000_000] + [WRONG] * 9)


class Rows(FolderCase):
    def table(self, text, block=tables.BLOCK):
        """Its rows in words: line, a, b, problems."""
        file, problems = self.place / "t.csv", Problems()
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
        with mock.patch.object(tables, "BLOCK", block):
            self.read = read_table(file, {"a": WHOLE, "b": NUMBER}, {"c": NUMBER}, 1 << 20, problems)
        if self.read is not None:
            found = RowProblems(self.read)
            found.add_wrong(*self.read.values)
            found.report(problems)
            self.columns = {name: values.tolist() for name, values in self.read.values.items()}
            self.lines = self.read.line.tolist()
        return [line.replace(f"{file}", "t") for line in problems.lines()]

    def test_columns_may_have_any_order_and_others_are_ignored(self):
        self.assertEqual(self.table("x, b ,c,a\n,0.5,3,1\nfoo,1e-3,4,2"), [])
        self.assertEqual((self.columns, self.lines), ({"a": [1, 2], "b": [0.5, 1e-3], "c": [3, 4]}, [2, 3]))

    def test_comments_empty_lines_quotes_and_line_ends(self):
        for end in ("\n", "\r\n"):
            for block in (1, 7, 20, tables.BLOCK):
                text = "\ufeff\n # by hand\n\t\n\"a\",\" b \"\n1,2\n\n#3,4\n 5 ,\t6\n\"7\", \" 8 \"\n \n9,10\n\n".replace("\n", end)
                self.assertEqual(self.table(text, block), [])
                self.assertEqual((self.columns, self.lines), ({"a": [1, 5, 7, 9], "b": [2, 6, 8, 10]}, [5, 8, 9, 11]), (end, block))

    def test_blanks_before_the_header(self):
        for begin in ("\n  ", "# by hand\n \t", "\r\n\r\n"):
            self.assertEqual(self.table(f"{begin}a,b\n1,2\n"), [])
            self.assertEqual(self.columns, {"a": [1], "b": [2]}, begin)

    def test_blocks_of_any_size_give_the_same(self):
        rows = [f"{k},{1 / (k + 1)!r}" for k in range(50)]
        for block in (1, 13, 100, 1000):
            self.assertEqual(self.table("\n".join(["a,b", *rows, ""]), block), [])
            self.assertEqual((self.columns["a"], self.lines), (list(range(50)), list(range(2, 52))), block)
            self.assertEqual(self.columns["b"], [1 / (k + 1) for k in range(50)])

    def test_problems_are_told_in_the_order_of_the_lines(self):
        text, remedy = "a,b\n1,x\n1\n-1,y\n1,2,3\n2,3\nz,\"4\"\"\n", ": correct it, or leave the row out"
        for block in (1, 11, tables.BLOCK):
            self.assertEqual(self.table(text, block), [
                f't:2: b must be a finite number, got "x"{remedy}', "t:3: must have 2 columns as the header, got 1",
                't:4: a must be a whole number from 0 on, got "-1"',
                f't:4: b must be a finite number, got "y"{remedy}', "t:5: must have 2 columns as the header, got 3",
                't:7: a must be a whole number from 0 on, got "z"',
                f't:7: b must be a finite number, got "4""{remedy}'], block)

    def test_a_row_with_a_column_too_many_does_not_repair_the_next_one(self):
        self.assertEqual(self.table("a,b\n1,2,3\n4\n5,6\n"), ["t:2: must have 2 columns as the header, got 3",
                                                              "t:3: must have 2 columns as the header, got 1"])
        self.assertEqual(self.columns["a"], [5])

    def test_all_problems_are_counted(self):
        for rows in ("x,y\n" * 1000, "x\n" * 2000):
            for block in (100, tables.BLOCK):
                told = self.table("a,b\n1,2\n" + rows, block)
                self.assertEqual((len(told), told[-1]), (21, ".. and 1980 more"))
                self.assertLessEqual(max(map(len, (self.read.others, *self.read.words.values()))), 20)

    def test_words_for_messages_are_short_and_without_control_characters(self):
        told = self.table("a,b\n1,\x1b[31m\n2," + "9" * 100_000 + "x\n3,\xff\n")
        self.assertEqual(told[0], 't:2: b must be a finite number, got "?[31m": correct it, or leave the row out')
        self.assertEqual(told[1], f't:3: b must be a finite number, got "{"9" * 80}..": correct it, or leave the row out')
        self.assertEqual(len(self.table(b"a,b\n1,\xff\xfe\n\xc3,1\n")), 2)
        self.assertEqual(len(self.table("a,b\n1,٣\n1,1_0\n1,2\n", 7)), 2)

    def test_the_header(self):
        for header, told in (("a", "1: the header must name b once, got it 0 times: the columns are a,b,c"),
                             ("a,b,a", "1: the header must name a once, got it 2 times: the columns are a,b,c"),
                             ("a,b,c,c", "1: the header must name c once, got it 2 times: the columns are a,b,c"),
                             ("\n#x\na;b", "3: columns must be separated by commas: export the table with commas, and decimal points"),
                             ("a\tb", "1: columns must be separated by commas: export the table with commas, and decimal points")):
            self.assertEqual(self.table(header + "\n1,2\n"), ["t:" + told])


class Files(FolderCase):
    def pack(self, name, packed):
        """Replaces a table by a compressed one."""
        (self.folder / name).unlink()
        (self.folder / f"{name}.gz").write_bytes(packed)

    def test_an_empty_table(self):
        for name in TABLES:
            header = SMALL[name].split("\n")[0]
            for nothing in ("", "\n\n", "# later\n", "# later", " \t\r\n", "\ufeff"):
                self.texts = SMALL | {name: nothing}
                self.assertEqual(self.problems(), [f"{name}: is empty: it must begin with the header {header}"])
            for end in ("", "\n", "\r\n# end\r\n"):
                self.texts = SMALL | {name: header + end}
                self.assertEqual(self.problems(), [f"{name}: must have at least one row, got none: add rows, or leave the file out"])

    def test_bytes_that_are_no_table(self):
        junk = random.Random(1).randbytes(100_000).replace(b"\0", b"")
        for name in TABLES:
            self.texts = SMALL | {name: junk}
            self.assertTrue(self.problems()[0].startswith(f"{name}:"))
            for zeros in (SMALL[name].encode() + b"\0", b"\xff\xfe" + SMALL[name].encode("utf-16-le")):  # also as spreadsheets save it
                self.texts = SMALL | {name: zeros}
                self.assertEqual(self.problems(), [f"{name}: holds zero bytes and is no table: save it as text in UTF-8"])
        for text, line in ((b"x" * 20_000_000, 4), (b"\n" + b"x" * 17_000_000 + b"\n\n", 5), (b"0," * 9_000_000 + b"\n1", 4)):
            self.texts = SMALL | {"plate.csv": SMALL["plate.csv"].encode()[:-len("2,0,unload,0.021,0.01\n")] + text}
            self.assertEqual(self.problems(), [f"plate.csv: line {line} has more than 16 million characters: is this a table?"])
        self.texts = SMALL | {"plate.csv": SMALL["plate.csv"] + "#" * 16_000_000}
        self.assertEqual(self.problems(), [])

    def test_compressed_tables(self):
        for name in TABLES:
            whole = GZIP(self.texts[name].encode())
            self.write()
            self.pack(name, whole)
            self.assertEqual(self.problems_there(), [])
            flipped = bytearray(whole)
            flipped[len(whole) // 2] ^= 0x10
            for damaged in (whole[:-1], whole[:-9], whole[:len(whole) // 2], bytes(flipped), whole[:5] + b"x", whole + b"more"):
                (self.folder / f"{name}.gz").write_bytes(damaged)
                told, = self.problems_there()
                self.assertRegex(told, rf"^{name}\.gz: cannot be unpacked \(.+\): pack it again with gzip$")

    def test_too_large_tables_are_not_read(self):
        for name in TABLES:
            self.write()
            os.truncate(self.folder / name, 10 << 30)  # a sparse file that would take minutes to read
            self.assertEqual(self.problems_there(), [
                f"{name}: is larger than an experiment's table may be: leave out frames, or split it into several experiments (10737418240 "
                "bytes, at most 1073741824)"])

    def test_too_large_compressed_tables_are_read_up_to_the_limit(self):
        self.write()
        self.pack("plate.csv", GZIP(self.texts["plate.csv"].encode() + b"\n" * 4_000_000))
        self.assertEqual(self.problems_there(), [])
        for largest in (3_900_000, 10_000):
            tracemalloc.start()
            told, = self.problems_there(largest)
            self.assertTrue(told.startswith("plate.csv.gz: is larger than an experiment's"), told)
            self.assertLess(tracemalloc.get_traced_memory()[1], 1_000_000 + 4 * largest)
            tracemalloc.stop()

    def test_tables_that_are_no_files(self):
        for name in (*TABLES, "experiment.toml"):
            file = self.folder / name
            for put in (lambda: file.symlink_to("nowhere"), lambda: file.symlink_to("/dev/zero"), file.mkdir, lambda: os.mkfifo(file)):
                self.write()
                file.unlink()
                put()
                told, = self.problems_there()
                self.assertTrue(told.startswith(f"{name}: must be a "), told)
            self.write()
            file.unlink()
            file.symlink_to(file)  # a loop says nothing of what is there
            with self.assertRaisesRegex(RunError, f"{name}: cannot be looked at: Too many levels of symbolic links; the file may be"):
                self.problems_there()

    def test_a_table_that_is_there_twice(self):
        self.texts["plate.csv.gz"] = ""
        self.assertEqual(self.problems(), ["plate.csv: is there twice, plain and as .gz: remove the one that is out of date"])

    def test_a_table_that_cannot_be_read(self):
        refused = PermissionError(errno.EACCES, "Permission denied", "lab/grains.csv")
        with mock.patch.object(tables, "read_input", side_effect=refused):
            with self.assertRaisesRegex(RunError, "^lab/grains.csv: cannot be read: Permission denied; the file may be intact"):
                self.problems()

    def test_random_damage_gives_problems_or_data(self):
        signs = random.Random(2)
        for _ in range(400):
            self.texts = dict(SMALL)
            for name in SMALL:
                text = bytearray(SMALL[name].encode())
                for _ in range(2):
                    at = signs.randrange(len(text))
                    text[at:at + signs.choice((0, 1, 1, 30))] = signs.choice((b"", b"%c" % signs.randrange(256), text[at // 2:at // 2 + 20],
                                                                              b"%c" % signs.choice(b"0179.,-+eEnN\n\r\"#=[]; \t\x80\xff")))
                self.texts[name] = bytes(text)
            self.problems()  # any other exception fails the test


if __name__ == "__main__":
    unittest.main()
