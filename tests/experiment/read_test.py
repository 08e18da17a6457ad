"""Experiment folders as recordings, and what is told of tables that contradict themselves. read_test.py"""
import math
import pathlib
from unittest import main

import numpy as np
from numpy.testing import assert_array_equal
from small_folder import SMALL, STAGES, TABLES, FolderCase

from mcdem.errors import InputError, RunError
from mcdem.experiment.plate import set_forces
from mcdem.experiment.read import read_experiment, read_experiments
from mcdem.experiment.topology import with_listed_contacts
from mcdem.experiment.write import write_experiment
from mcdem.results import Phase, Wall

PERIODIC = ("[box]", '[container]\nshape = "periodic"\n[box]')
CYLINDER = ("[box]\nsize = [0.04, 0.03]", '[container]\nshape = "cylinder"\nradius = 0.025')
# file, a text there, another one, beginning of the first problem
SPOILED = (
    ("plate.csv", "top_force_N", "force", "1: the header must name top_force_N once, got it 0 times"),
    ("plate.csv", "cycle", "frame", "1: the header must name frame once, got it 2 times"),
    ("plate.csv", "0.022", "22", "2: plate_z_m must be in metres: 22 is more than 20 times the box's width of 0.04 m; divide by 1000"),
    ("plate.csv", "0.022", "-0.022", "2: plate_z_m must be > 0 [m], the height of the plate over the floor, got -0.022"),
    ("plate.csv", "2,0,unload", "3,0,unload", "4: frame must be 2, got 3: frames count from 0"),
    ("plate.csv", "0,0,load", "0,1,load", "3: cycle must not fall, got 0 after 1"),
    ("plate.csv", "unload", "release", '4: phase must be one of load, unload, got "release"'),
    ("plate.csv", "0.4", "400", "3: top_force_N must be in newtons: 400 is a pressure beyond Young's modulus, 23300 Pa; divide"),
    ("plate.csv", "0.4", "-400", "3: top_force_N must be in newtons: -400 is"),
    ("plate.csv", "0.4", "nan", '3: top_force_N must be a finite number, got "nan"'),
    ("plate.csv", "0.4", "", '3: top_force_N must be a finite number, got ""'),
    ("plate.csv", ",0.4", "", "3: must have 5 columns as the header, got 4"),
    ("plate.csv", "1,0,load", "1.5,0,load", '3: frame must be a whole number from 0 on, got "1.5"'),
    ("grains.csv", "0,1,0.03", "0,2,0.03", "3: grain must be 0 to 1, got 2: grains count from 0, the same in every frame"),
    ("grains.csv", "0,1,0.03", "0,0,0.03", "3: grain 0 is there twice in frame 0"),
    ("grains.csv", "1,1,0.0305,0.015,0.0095,0.02\n", "", "4: frame 1 must list all 2 grains, but grain 1 is missing: add it, or leave"),
    ("grains.csv", "1,1,0.0305", "0,1,0.0305", "5: frames must be in order, got 0 after 1: sort the rows by frame"),
    ("grains.csv", "1,1,0.0305", "7,1,0.0305", "5: frame must be one of plate.csv, 0 to 2, got 7"),
    ("grains.csv", "0.01,0.02\n", "0.01,20\n", "2: diameter_m must be in metres: 20 is more than the box's width of 0.04 m; divide"),
    ("grains.csv", "0.01,0.02\n", "0.01,0\n", "2: diameter_m must be > 0 [m], got 0"),
    ("grains.csv", "0,0,0.01", "0,0,10", "2: centres must lie in the box of 40 by 30 mm below the plate at 0.022 m, got 10, 0.015, 0.01 m"),
    ("grains.csv", "0.015,0.01,", "0.015,10,", "2: centres must lie in the box of 40 by 30 mm"),
    ("grains.csv", "0.015,0.01,", "0.015,-0.01,", "2: centres must lie in the box"),
    ("grains.csv", "0.0095,0.02\n", "0.0095,0.03\n", "4: grain 0 must be as large as in frame 0, 0.02 m, got 0.03: number the grains"),
    ("grains.csv", "1,1,0.0305", "1,0,0.0305", "5: grain 0 is there twice in frame 1"),
    ("grains.csv", "0,0,0.01", "1,0,0.01", "2: the first frame must be 0, which says what grains there are, got 1"),
    ("grains.csv", "0,0,0.01", "0,0,inf", '2: x_m must be a finite number, got "inf"'),
    ("contacts.csv", "1,0,floor", "1,5,floor", "3: grain must be a grain of grains.csv, 0 to 1, got 5: there is no grain for this force"),
    ("contacts.csv", "1,1,0,", "1,1,9,", "2: partner must be a grain of grains.csv, 0 to 1, got 9"),
    ("contacts.csv", "1,1,0,", "1,1,1,", "2: grain 1 cannot touch itself"),
    ("contacts.csv", "1,1,0,", "1,1,-5,", '2: partner must be a whole number from 0 on, got "-5"'),
    ("contacts.csv", "floor", "bottom", "3: partner must be a grain's number or one of x_min, x_max, y_min, y_max, floor, plate, got"),
    ("contacts.csv", "floor", "side", "3: partner must be a grain's number or one of x_min"),
    ("contacts.csv", "1,1,floor", "1,0,floor", "4: this contact is there twice in frame 1, first in line 3: list each pair once"),
    ("contacts.csv", "1,0,floor", "1,0,1", "3: this contact is there twice in frame 1, first in line 2"),
    ("contacts.csv", "0,0,0.2", "0,0,200", "3: fx_N, fy_N and fz_N must be in newtons: 200 is more than such grains can carry; divide"),
    ("contacts.csv", "0.015,0.0095,0.03", "0.015,9.5,0.03", "2: x_m, y_m and z_m must lie in the box of 0.04 by 0.03 m, got 0.02, 0.015"),
    ("contacts.csv", "0,0,0.2", "0,0,NaN", '3: fz_N must be a finite number, got "NaN"'),
    ("contacts.csv", "1,1,floor", "0,1,floor", "4: frames must be in order, got 0 after 1"),
    ("contacts.csv", "1,0,floor", "3,0,floor", "3: frame must be one of plate.csv, 0 to 2, got 3"),
    ("contacts.csv", "1,1,0,0.02", "1,1,0,20", "2: x_m, y_m and z_m must lie in the box"))
PROGRAMME = STAGES + "scans = 2\n"  # of the last hold
ROWS = """frame,cycle,phase,plate_z_m,top_force_N,set_force_N,time_s
0,0,load,0.022,0,,0.1
1,0,load,0.019,0.4,,1.1
2,0,load,0.019,0.3,,1.6
3,0,load,0.019,0.25,,3.1
4,0,unload,0.021,0.1,0.1,4
5,0,unload,0.0209,0.1,0.1,6
6,0,unload,0.02085,0.1,0.1,8
"""
IN_ORDER = "state the stages in their order, with their scans"
OF_STAGE = "of [[programme]] in experiment.toml"


class Values(FolderCase):
    def test_settings_and_the_plate(self):
        one = self.read()
        recording, scans = one.recording, one.recording.scans
        self.assertEqual((one.name, recording.label), ("two grains", "two grains"))
        self.assertEqual((recording.box.size_x, recording.box.size_y), (0.04, 0.03))
        self.assertEqual(recording.plate_start, 0.022)  # the highest position, if none is given
        self.assertEqual((one.materials["grains.youngs_modulus"], one.measurement.force_threshold), (23300, 0.005))  # settings_test.py
        self.assertEqual((scans.frame.tolist(), scans.cycle.tolist()), ([0, 1, 2], [0, 0, 0]))
        self.assertEqual(scans.phase.tolist(), [Phase.load, Phase.load, Phase.unload])
        self.assertEqual(scans.top_force.tolist(), [0, 0.4, 0.01])
        self.assertEqual(recording.displacement[1], 0.022 - 0.019)
        self.assertTrue(np.isnan([scans.time, scans.elastic_energy, scans.packing_fraction]).all())

    def test_averages_use_only_contacts_above_the_threshold(self):
        scans = self.read().recording.scans
        self.assertEqual(list(map(len, scans.contacts)), [0, 5, 0])
        assert_array_equal(scans.coordination_number, [math.nan, (2 + 3) / 2, math.nan])  # not the one at x_min, below 5 mN
        self.assertAlmostEqual(scans.mean_force[1], (0.05 + 0.2 + 0.3 + 0.2) / 4, 15)
        self.assertAlmostEqual(scans.branch_length[1], 0.0305 - 0.0095, 15)
        self.assertTrue(np.isnan(scans.contacts[1].overlap).all())
        self.assertEqual(scans.wall_force[1, Wall.floor].tolist(), [0, 0, -0.5])
        self.assertEqual(scans.wall_force[1, Wall.x_min].tolist(), [-0.004, 0, 0])
        self.assertEqual(scans.wall_force[1, Wall.plate, 2], 0.4)  # from the gauge, not from the contacts
        self.assertTrue(np.isnan(scans.wall_force[1, Wall.x_max]).all())  # no contact with this wall was measured
        self.assertTrue(np.isnan(scans.wall_force[2, Wall.floor]).all())

    def test_a_contact_from_the_other_side_is_reversed(self):
        contacts = self.read().recording.scans.contacts[1]
        self.assertEqual((contacts.grain.tolist(), contacts.partner.tolist()), ([0, 0, 1, 0, 0], [1, -5, -5, -6, -1]))
        self.assertEqual(contacts.force[0].tolist(), [-0.03, 0, -0.04])
        self.assertEqual(contacts.point[0].tolist(), [0.02, 0.015, 0.0095])

    def test_frames_and_grains_in_any_place(self):
        self.texts["grains.csv"] = ("frame,grain,x_m,y_m,z_m,diameter_m\n0,1,0.03,0.015,0.01,0.021\n0,0,0.01,0.015,0.01,0.02\n"
                                    "2,0,0.011,0.015,0.01,0.02\n2,1,0.031,0.015,0.01,0.02\n")
        recording = self.read().recording
        self.assertEqual(recording.diameter.tolist(), [0.02, 0.021])  # of frame 0
        self.assertEqual([len(one) for one in recording.scans.position], [2, 0, 2])
        self.assertEqual(recording.scans.position[0][:, 0].tolist(), [0.01, 0.03])
        self.assertEqual(recording.scans.position[2][:, 0].tolist(), [0.011, 0.031])
        self.assertTrue(math.isnan(recording.scans.branch_length[1]))

    def test_the_plate_alone_is_sufficient(self):
        self.texts = {"plate.csv": SMALL["plate.csv"], "experiment.toml": "[box]\nsize = [0.04, 0.03]\n"}
        one = self.read()
        self.assertEqual((one.name, len(one.recording.scans), len(one.recording.diameter)), ("lab", 3, 0))

    def test_grains_without_contacts(self):
        del self.texts["contacts.csv"]
        self.assertEqual([len(one) for one in self.read().recording.scans.position], [2, 2, 0])

    def test_listed_contacts_count_where_forces_are_missing(self):
        self.texts["topology.csv"] = "frame,grain,partner\n1,1,0\n1,0,floor\n1,0,1\n2,0,1\n"
        forced = with_listed_contacts(self.read()).scans.contacts
        self.assertTrue(len(forced[1]) == 5 and np.isfinite(forced[1].force).all())
        del self.texts["contacts.csv"]
        frames = with_listed_contacts(self.read()).scans.contacts
        self.assertEqual([list(zip(one.grain, one.partner)) for one in frames], [[], [(0, -1 - Wall.floor), (0, 1)], [(0, 1)]])
        self.assertTrue(all(np.isnan(one.force).all() for one in frames))

    def test_a_cylinder_has_a_side(self):
        self.replace("experiment.toml", *CYLINDER)
        self.replace("contacts.csv", "x_min", "side")
        recording = self.read().recording
        self.assertEqual((recording.box.size_x, recording.scans.contacts[1].partner.tolist()), (0.05, [1, -5, -5, -6, -1]))
        self.replace("grains.csv", "0,0,0.01,0.015", "0,0,0.01,0.05")
        self.assertTrue(self.problems()[0].startswith("grains.csv:2: centres must lie in the cylinder with a radius of 25 mm below the"))

    def test_in_a_periodic_container_grains_do_not_jump(self):
        self.replace("experiment.toml", *PERIODIC)
        self.replace("contacts.csv", "1,0,x_min,0,0.015,0.0095,0.004,0,0\n", "")
        self.replace("grains.csv", "1,0,0.0095,0.015", "1,0,-0.015,0.044")
        self.texts["grains.csv"] += "2,0,0,0.014,0.01,0.02\n2,1,0.0305,0.015,0.01,0.02\n"
        position = self.read().recording.scans.position
        np.testing.assert_allclose([one[0] for one in position], [[0.01, 0.015, 0.01], [0.025, 0.014, 0.0095], [0.04, 0.014, 0.01]])
        self.replace("grains.csv", "2,0,0", "2,0,0.9")
        self.assertTrue(self.problems()[0].startswith("grains.csv:6: centres must lie in the periodic container of 40 by 30 mm below"))

    def test_several_experiments_are_named_by_their_folders(self):
        self.write()
        other = self.place / "other"
        self.folder.rename(other)
        self.write()
        self.assertEqual([one.name for one in read_experiments([self.folder, str(other)], "--experiment")], [str(self.folder), str(other)])
        self.assertEqual([one.name for one in read_experiments([self.folder], "--experiment")], ["two grains"])
        for folders, told in (([], "experiment: must name one folder or more, got none"),
                              ([other, f"{other}/"], f"experiment: {other} is given twice")):
            with self.assertRaises(InputError) as refused:
                read_experiments(folders, "experiment")
            self.assertEqual(refused.exception.problems, [told])


class Problems(FolderCase):
    def test_each_is_told_with_its_line_and_remedy(self):
        for name, old, new, told in SPOILED:
            with self.subTest(name, old=old, new=new):
                self.texts = dict(SMALL)
                self.replace(name, old, new)
                self.assertTrue(self.problems()[0].startswith(f"{name}:{told}"), self.problems())

    def test_all_are_told_at_once_up_to_a_limit(self):
        self.replace("experiment.toml", "0.5", "0.7")
        self.replace("plate.csv", "unload", "up")
        self.replace("contacts.csv", "floor", "roof")
        self.assertEqual([problem.split(": ")[0] for problem in self.problems()], ["experiment.toml:6", "plate.csv:4", "contacts.csv:3"])
        self.texts["plate.csv"] = SMALL["plate.csv"].split("\n")[0] + "\n" + "".join(f"{row},0,load,0.02,?\n" for row in range(100))
        told = self.problems()
        self.assertEqual((len(told), told[-1]), (21, ".. and 82 more"))

    def test_a_column_in_millimetres_is_told_once(self):
        for name in TABLES:
            self.texts = dict(SMALL)
            header, *rows = SMALL[name].splitlines()
            lengths = [place for place, column in enumerate(header.split(",")) if column.endswith("_m")]
            scaled = [",".join(str(float(word) * 1000) if place in lengths else word for place, word in enumerate(row.split(",")))
                      for row in rows]
            self.texts[name] = "\n".join([header, *scaled])
            self.assertEqual(len(self.problems()), 2 if name == "grains.csv" else 1, self.problems())  # centres and diameters

    def test_of_a_frame_are_told_where_it_ends(self):
        self.replace("plate.csv", "2,0,unload", "2,0,up")
        self.texts["grains.csv"] = ("frame,grain,x_m,y_m,z_m,diameter_m\n0,0,0.01,0.015,0.01,0.02\n0,0,0.03,0.015,0.01,0.02\n"
                                    "1,1,x,0.015,0.01,0.02\n1,0,0.03,0.015,1,0.02\n2,3,0.03,0.015,0.01,0.02\n1\n")
        self.assertEqual([problem.split(": ", 1)[1].split(",")[0] for problem in self.problems()], [
            "phase must be one of load", "x_m must be a finite number", "grain 0 is there twice in frame 0",
            "frame 0 must list all 2 grains", "centres must lie in the box of 40 by 30 mm below the plate at 0.019 m",
            "frame 1 must list all 2 grains",
            "must have 6 columns as the header", "grain must be 0 to 1", "frame 2 must list all 2 grains"])

    def test_of_a_wrong_row_nothing_more_is_told(self):
        for name, old, new in (("grains.csv", "1,1,0.0305,0.015,0.0095,0.02", "1,1,0.0305,0.015,0.0095,0.05"),
                               ("grains.csv", "1,1,0.0305,0.015,0.0095,0.02", "1,1,0.0305,0.015,0.0095,-0.02"),
                               ("contacts.csv", "1,1,0,0.02", "1,1,9,20"), ("contacts.csv", "1,1,0,0.02", "1,9,0,20"),
                               ("contacts.csv", "1,1,0,0.02", "2,1,0,x")):
            with self.subTest(new):
                self.texts = dict(SMALL)
                self.replace(name, old, new)
                self.assertEqual(len(self.problems()), 1, self.problems())

    def test_contacts_that_are_there_three_times(self):
        pair, wall = SMALL["contacts.csv"].splitlines()[1:4:2]
        self.texts["contacts.csv"] += "\n".join([pair.replace("1,1,0", "1,0,1"), wall, pair])
        self.assertEqual([problem.split(":")[1:] for problem in self.problems()], [
            [line, f" this contact is there twice in frame 1, first in line {first}", " list each pair once"]
            for line, first in (("7", 2), ("9", 7), ("8", 4))])

    def test_missing_files(self):
        del self.texts["grains.csv"]
        self.assertEqual(self.problems(), ["contacts.csv: needs grains.csv with the grains of frame 0: contacts name them"])
        del self.texts["contacts.csv"], self.texts["plate.csv"]
        self.assertEqual(self.problems(), [f"{self.folder}: must hold plate.csv or plate.csv.gz: the plate's position and force by frame"])
        del self.texts["experiment.toml"]
        self.assertEqual(self.problems(), [f"{self.folder}: is not an experiment: it contains no experiment.toml"])

    def test_too_many_rows_of_the_plate(self):
        self.texts["plate.csv"] = SMALL["plate.csv"] + "0,0,load,0.02,0\n" * 1_000_000
        self.assertEqual(self.problems(), ["plate.csv:1000002: must have at most 1000000 frames"])

    def test_what_is_not_a_folder(self):
        self.write()
        for folder, told in ((self.folder / "nowhere", "got nothing there"), (self.folder / "plate.csv", "got a file")):
            with self.assertRaises(InputError) as refused:
                read_experiment(folder)
            self.assertEqual(refused.exception.problems, [f"{folder}: must be an experiment's folder, {told}"])
        (self.folder / "loop").symlink_to("loop")
        for folder in (self.folder / "loop", pathlib.Path("x" * 5000)):
            with self.assertRaisesRegex(RunError, f"^{folder}: cannot be looked at: "):
                read_experiment(folder)

    def test_the_settings_must_be_a_small_file(self):
        self.texts["experiment.toml"] = "\n" * 1_000_001
        self.assertEqual(self.problems(), ["experiment.toml: must be a text of at most 1 MB that can be read"])

    def test_huge_numbers_are_no_failures(self):
        for old, new in (("0.0095,0.03,0,0.04", "0.0095,1e300,0,1e300"), ("0.02,0.015,0.0095", "1e308,-1e308,1e308")):
            self.texts = dict(SMALL)
            self.replace("experiment.toml", "youngs_modulus = 23300.0\n", "")
            self.replace("contacts.csv", old, new)
            self.problems()
        self.replace("grains.csv", "0.01,0.02", "1e308,1e308")
        self.assertTrue(self.problems())


class Programmes(FolderCase):
    def setUp(self):
        super().setUp()
        self.texts["experiment.toml"] += PROGRAMME
        self.texts["plate.csv"] = ROWS

    def test_are_read_with_their_times(self):
        recording = self.read().recording
        self.assertTrue(recording.has_programme)
        self.assertEqual((recording.value("programme.2.stage"), recording.value("programme.2.scan_at")), ("hold", [0.5, 2.0]))
        self.assertEqual(recording.value("programme.4.keep"), "force")
        self.assertEqual(recording.scans.time[3], 3.1)
        self.assertEqual(set_forces(recording), [None, None, None, None, 0.1, 0.1, 0.1])

    def test_are_read_back_as_written(self):
        self.texts["experiment.toml"] += '[[programme]]\nstage = "repeat"\nstages = 2\ntimes = 2\n'
        self.texts["plate.csv"] += "7,0,unload,0.0211,0.1,0.1,9\n8,0,unload,0.0211,0.1,0.1,11\n9,0,unload,0.0211,0.1,0.1,13\n"
        one = self.read()
        write_experiment(self.place / "other", one)
        back = read_experiment(self.place / "other")
        self.assertEqual(back.recording.parameters, one.recording.parameters)
        assert_array_equal(back.recording.scans.time, one.recording.scans.time)

    def test_a_hold_keeps_the_force_at_which_it_begins(self):
        self.replace("experiment.toml", "[[programme]]\nforce = 0.1\n", "")
        self.replace("plate.csv", "4,0,unload,0.021,0.1,0.1,4\n5,0,unload,0.0209,0.1,0.1,6\n6,0,unload,0.02085,0.1,0.1,8",
                     "4,0,unload,0.021,0.25,0.25,5\n5,0,unload,0.0209,0.25,,7")
        recording = self.read().recording
        self.assertEqual(set_forces(recording), [None, None, None, None, 0.25, 0.25])

    def test_times_are_needed_and_must_rise(self):
        self.replace("plate.csv", ",time_s", ",t")
        self.assertEqual(self.problems(), ["plate.csv:1: the header must name time_s where experiment.toml states a [[programme]]: when "
                                           "each row was measured [s]"])
        self.texts["plate.csv"] = ROWS
        self.replace("plate.csv", "0.3,,1.6", "0.3,,1.1")
        self.replace("plate.csv", "0.25,,3.1", "0.25,x,y")
        self.replace("plate.csv", "0.1,0.1,4", "0.1,0.1,1")
        self.assertEqual(self.problems(), [
            "plate.csv:4: time_s must rise from row to row, got 1.1 after 1.1: sort the rows by time",
            'plate.csv:5: time_s must be a finite number, got "y": correct it, or leave the row out',
            'plate.csv:5: set_force_N must be a finite number, got "x": correct it, or leave the row out',
            "plate.csv:6: time_s must rise from row to row, got 1 after 1.1: sort the rows by time"])

    def test_rows_must_be_the_scans_of_the_stages(self):
        for old, new, told in (
                ("6,0,unload,0.02085,0.1,0.1,8\n", "", ": must have 7 rows, one of the packing at rest and one for each of the 6 scans "
                 f"{OF_STAGE}, got 6: state the scans of its stages as they were measured (scans, scan_at)"),
                ("load,0.019,0.3", "load,0.0215,0.3",
                 f":4: plate_z_m must be near 0.019 m, which stage 2 {OF_STAGE} sets, got 0.0215: {IN_ORDER}"),
                ("0.3,,1.6", "0.3,0.3,1.6", f":4: set_force_N must be empty, got 0.3: stage 2 {OF_STAGE} sets a position"),
                ("0.25,,3.1", "0.25,,2.6", f":5: time_s must be 1.5 s after the row before, as stage 2 {OF_STAGE} holds, got 1 s: state "
                 "when the hold was scanned (time, scans, scan_at)"),
                ("0.1,0.1,4", "0.1,0.2,4", f":6: set_force_N must be 0.1 N, which stage 3 {OF_STAGE} sets, got 0.2: {IN_ORDER}"),
                ("unload,0.021,0.1", "unload,0.021,0.3",
                 f":6: top_force_N must be near 0.1 N, which stage 3 {OF_STAGE} sets, got 0.3: {IN_ORDER}")):
            with self.subTest(old=old, new=new):
                self.texts["plate.csv"] = ROWS
                self.replace("plate.csv", old, new)
                self.assertEqual(self.problems(), ["plate.csv" + told])



if __name__ == "__main__":
    main()
