"""Result files: known values, damaged and foreign files, folders. read_run_test.py"""
import os
import pathlib
import random
import sys
import tempfile
import unittest

import h5py
import numpy as np
import written

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "host/python"))
from mcdem.errors import InputError, RunError  # noqa: E402
from mcdem.results import Box, ContactModel, ContainerShape, FrictionLaw, Phase, read_run  # noqa: E402

R = "replica_00000"


class Case(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        self.file = self.folder / "run.h5"

    def assert_fails(self, words, path=None, error=InputError):
        with self.assertRaises(error) as raised:
            read_run(path or self.file, contacts=True, positions=True)
        self.assertIn(words, str(raised.exception))
        self.assertIn(self.folder.name, str(raised.exception))

    def damage(self, change):
        written.write_run(self.file)
        with h5py.File(self.file, "r+") as run:
            change(run)


class Values(Case):
    def test_everything_is_read(self):
        written.write_run(self.file, replicas=2)
        for path in (self.file, self.folder):
            run = read_run(path, contacts=True, positions=True)
            self.assertEqual((run.name, run.scene, run.precision, len(run.recordings)), ("made by hand", 'name = "made"', "float", 2))
            one = run.recordings[1]
            self.assertEqual((one.label, one.box, one.plate_start), ("mc_dem #2", Box(0.05, 0.06, ContainerShape.cylinder), 0.1))
            self.assertEqual((one.model, one.friction_law, one.value("grains.friction"), one.value("packing.seed"), one.value("no.key")),
                             (ContactModel.mc_dem, FrictionLaw.mindlin, 0.25, 2, None))
            np.testing.assert_allclose(one.displacement, [0.01, 0.02, 0.015])
            self.assertEqual(one.scans.top_force.tolist(), [1.25, 3.5, 2.0])
            self.assertEqual([Phase(phase).name for phase in one.scans.phase], ["load", "load", "unload"])
            self.assertEqual(one.scans.stress[2].ravel().tolist(), list(range(9)))
            self.assertEqual([len(contacts) for contacts in one.scans.contacts], [2, 0, 3])
            self.assertEqual(one.scans.contacts[2].partner.tolist(), [2, 3, -5])
            self.assertEqual(one.scans.contacts[2].force[:, 2].tolist(), [3, 4, 5])
            self.assertEqual([len(position) for position in one.scans.position], [4, 0, 4])
            self.assertEqual(one.scans.position[2][1].tolist(), [15, 16, 17])
            self.assertEqual(one.scans.knows_contacts.tolist(), [True, True, True])

    def test_only_what_is_wanted_is_read(self):
        written.write_run(self.file)
        scans = read_run(self.file).recordings[0].scans
        self.assertEqual([len(one) for one in scans.contacts + scans.position + scans.rotation], [0] * 9)
        self.assertEqual(scans.knows_contacts.tolist(), [False, True, False])
        self.damage(lambda run: run.__delitem__(f"contacts/{R}/contact"))
        self.assertEqual(len(read_run(self.file, positions=True).recordings[0].scans), 3)

    def test_files_of_earlier_versions(self):
        def change(run):
            kept = [name for name in written.SCAN.names if name not in ("rate_error", "max_overlap", "stress", "fabric", "strain", "wall_work")]
            rows = np.zeros(written.SCANS, [(name, written.SCAN[name]) for name in kept])
            for name in kept:
                rows[name] = written.scans()[name]
            del run[f"observables/{R}"], run[f"particles/{R}/rotation"], run[f"particles/{R}/box"].attrs["shape"]
            run[f"observables/{R}"] = rows
        self.damage(change)
        one = read_run(self.file, positions=True).recordings[0]
        self.assertEqual(one.box.shape, ContainerShape.box)
        self.assertTrue(np.isnan(one.scans.stress).all() and np.isnan(one.scans.wall_work).all())
        self.assertEqual(one.scans.strain.tolist(), [[0] * 6] * 3)
        self.assertEqual([len(rotation) for rotation in one.scans.rotation], [0] * 3)

    def test_failures_and_species(self):
        self.damage(written.add_species_and_failure)
        one = read_run(self.file).recordings[0]
        self.assertEqual(one.failure.text(), "step 1000000000000, grain 3: why")
        self.assertEqual((one.species.tolist(), one.species_names), ([0, 1, 1, 0], ("soft", "stiff")))


class Folders(Case):
    def segments(self, *numbers):
        for number in numbers:
            written.write_run(self.folder / f"segment-{number:06}.h5")

    def test_segments_are_joined(self):
        self.segments(0, 1)
        with h5py.File(self.folder / "segment-000001.h5", "r+") as run:
            run[f"particles/{R}"].attrs.update(failure_cause=np.bytes_("why"), failure_step=5, failure_grain=-1)
        one = read_run(self.folder, contacts=True).recordings[0]
        self.assertEqual((len(one.scans), len(one.scans.contacts[5]), one.failure.text()), (6, 3, "step 5: why"))

    def test_a_missing_segment_is_named(self):
        self.segments(0, 2)
        self.assert_fails("segment-000001.h5: is missing", self.folder)

    def test_a_segment_of_another_run_is_named(self):
        self.segments(0)
        written.write_run(self.folder / "segment-000001.h5", replicas=2)
        self.assert_fails("segment-000001.h5: belongs to another run", self.folder)

    def test_nothing_to_read(self):
        self.assert_fails("holds no run", self.folder)
        self.assert_fails("got nothing there", self.folder / "nowhere")
        self.assert_fails("got nothing there", self.folder / "nowhere" / "run.h5")
        os.mkfifo(self.folder / "pipe")
        self.assert_fails("is a pipe or device", self.folder / "pipe")
        (self.folder / "parts").mkdir()
        self.assert_fails("holds parts of a run", self.folder)

    @unittest.skipIf(os.geteuid() == 0, "root may read everything")
    def test_a_file_that_may_not_be_read_is_no_damage(self):
        written.write_run(self.file)
        self.file.chmod(0)
        self.assert_fails("Permission denied; the file may be intact", error=RunError)


class Damage(Case):
    def test_truncation(self):
        written.write_run(self.file)
        whole = self.file.read_bytes()
        for tenth in range(10):
            self.file.write_bytes(whole[:len(whole) * tenth // 10])
            self.assert_fails("run.h5: cannot be opened as HDF5")

    def test_flipped_bits_and_scrambled_ranges(self):
        written.write_run(self.file)
        whole, noticed, chance = self.file.read_bytes(), 0, random.Random(11)
        before = read_run(self.file, contacts=True, positions=True).recordings[0]
        for trial in range(200):
            content = bytearray(whole)
            first, length = chance.randrange(len(whole)), 1 if trial % 2 else chance.randrange(4096)
            content[first:first + length] = chance.randbytes(length)
            self.file.write_bytes(content[:len(whole)])
            try:
                after = read_run(self.file, contacts=True, positions=True).recordings[0]
                np.testing.assert_array_equal(after.scans.wall_force, before.scans.wall_force, str(trial))
                np.testing.assert_array_equal(after.diameter, before.diameter, str(trial))
            except InputError as error:
                self.assertIn("run.h5", str(error))
                noticed += 1
        self.assertGreater(noticed, 50)

    def test_foreign_files(self):
        self.file.write_text("frame,cycle\n0,0\n")
        self.assert_fails("cannot be opened as HDF5 (file signature not found); the file is damaged or was not written by this program")
        with h5py.File(self.file, "w") as other:
            other["height"] = [1.0]
        self.assert_fails("is HDF5 but not a result of this program")
        self.damage(lambda run: run["parameters"].attrs.__setitem__("format", 2))
        self.assert_fails("has layout 2, this program reads up to 1")

    def test_missing_tables_are_named(self):
        for name in ("contacts/{}/offset", "contacts/{}/contact", "particles/{}/diameter", "particles/{}/position/value", "parameters/{}"):
            self.damage(lambda run: run.__delitem__(name.format(R)))
            self.assert_fails(f"/{name.format(R)}: cannot be found")
        self.damage(lambda run: run.__delitem__(f"observables/{R}"))
        self.assert_fails("/observables: must hold 1 replicas")

    def test_wrong_tables(self):
        for name, values, words in (
                (f"observables/{R}", [1.0, 2.0], "named fields"),
                (f"observables/{R}", np.zeros(3, [("frame", "i4")]), "must have a field 'cycle'"),
                ("parameters/scene", [1.0], "/parameters/scene: must hold texts"),
                (f"parameters/{R}", np.array([b"a", b"b", b"c"]), "must be pairs"),
                (f"contacts/{R}/offset", [0, 5], "offset must rise"),
                (f"contacts/{R}/offset", [0, 3, 2, 5], "offset must rise"),
                (f"contacts/{R}/offset", [0, 2, 2, 6], "offset must rise"),
                (f"particles/{R}/diameter", [0.02], "position/value: has rows of another size"),
                (f"particles/{R}/diameter", 0.02, "must be a table of rows"),
                (f"particles/{R}/diameter", np.full((4, 1), 0.02), "has rows of another size"),
                (f"particles/{R}/diameter", np.full(4, b"x"), "cannot be read"),
                (f"particles/{R}/position/step", [0, 3], "must be the row of a scan, 0 to 2"),
                (f"particles/{R}/position/step", [0], "one row for each of step")):
            def change(run):
                del run[name]
                run[name] = values
            self.damage(change)
            self.assert_fails(words)

    def test_impossible_values(self):
        for bad, text in ((0.0, "0"), (-0.01, "-0.01"), (np.nan, "nan"), (np.inf, "inf")):
            self.damage(lambda run: run[f"particles/{R}/diameter"].__setitem__(1, bad))
            self.assert_fails(f"/particles/{R}/diameter: must be numbers > 0 [m], got {text} for grain 1")
            for edge in range(3):
                self.damage(lambda run: run[f"particles/{R}/box"].attrs.__setitem__("edges", np.where(np.arange(3) == edge, bad, 0.1)))
                self.assert_fails("/box: edges must be 3 numbers > 0 [m]")
        self.damage(lambda run: run[f"particles/{R}/box"].attrs.__setitem__("shape", np.bytes_("ball")))
        self.assert_fails("shape must be one of box, cylinder, periodic, cell")
        for species in ([2] * 4, [-1] * 4, [0] * 3):
            self.damage(lambda run: run[f"particles/{R}"].update({"species": species, "species_names": np.array([b"a", b"b"])}))
            self.assert_fails("species: must be a species of 0 to 1 for each of the 4 grains")

    def test_impossible_rows(self):
        for table, field, value, words in (
                (f"contacts/{R}/contact", "partner", 4, "a contact of grain 1 with partner 4, but the grains are 0 to 3"),
                (f"contacts/{R}/contact", "partner", -7, "a contact of grain 1 with partner -7"),
                (f"contacts/{R}/contact", "grain", -1, "a contact of grain -1 with partner -6"),
                (f"contacts/{R}/contact", "force", np.nan, "a contact of grain 1 whose point or force is no number"),
                (f"observables/{R}", "phase", 7, "phase must be load or unload, got number 7")):
            def change(run):
                rows = run[table][()]
                rows[field][1] = value
                run[table][...] = rows
            self.damage(change)
            self.assert_fails(words)
        self.damage(lambda run: run[f"particles/{R}/position/value"].__setitem__((1, 2, 0), np.nan))
        self.assert_fails("grain 2 has a value that is no number")

    def test_attributes(self):
        for owner, name, value, words in (
                ("parameters", "replicas", 1.5, "attribute 'replicas' must be an integer"),
                ("parameters", "name", "of variable length", "attribute 'name' must be a text"),
                (f"particles/{R}", "label", 3, "attribute 'label' must be a text"),
                (f"particles/{R}/box", "edges", np.bytes_("x"), "attribute 'edges' must hold numbers"),
                (f"particles/{R}/box", "edges", np.ones(1001), "attribute 'edges' is too long")):
            self.damage(lambda run: run[owner].attrs.__setitem__(name, value))
            self.assert_fails(words)
        self.damage(lambda run: run[f"particles/{R}"].attrs.__delitem__("label"))
        self.assert_fails("attribute 'label' cannot be found")

    def test_changed_bytes_are_detected_in_every_table(self):
        """By the checksums of HDF5, which the program writes."""
        for name in (f"observables/{R}", f"contacts/{R}/contact", f"particles/{R}/diameter", f"particles/{R}/position/value",
                     f"parameters/{R}", "parameters/scene"):
            written.write_run(self.file)
            with h5py.File(self.file) as run:
                place = run[name].id.get_chunk_info(0).byte_offset
            content = bytearray(self.file.read_bytes())
            content[place] ^= 1
            self.file.write_bytes(content)
            self.assert_fails(f"/{name}: cannot be read")

    def test_nothing_outside_the_file_is_read(self):
        scene = "parameters/scene"

        def virtual(run):
            layout = h5py.VirtualLayout((1,), "S10")
            layout[:] = h5py.VirtualSource("other.h5", "x", (1,), "S10")
            run.create_virtual_dataset(scene, layout)

        (self.folder / "secret").write_bytes(b"a text of twenty byte")
        for put in (lambda run: run.__setitem__(scene, h5py.ExternalLink("other.h5", "/scene")), virtual,
                    lambda run: run.__setitem__(scene, h5py.SoftLink("/elsewhere")),
                    lambda run: run.create_dataset(scene, (1,), "S20", external=[(str(self.folder / "secret"), 0, h5py.h5f.UNLIMITED)])):
            def change(run):
                run.move(scene, "elsewhere")
                put(run)
            self.damage(change)
            self.assert_fails(f"/{scene}: lies outside this file")

    def test_a_table_that_claims_too_much_is_refused(self):
        def change(run):
            del run[f"particles/{R}/diameter"]
            run.create_dataset(f"particles/{R}/diameter", (10**12,), "f8", chunks=(1000,))
        self.damage(change)
        self.assert_fails("claims to hold more than the file can")


if __name__ == "__main__":
    unittest.main()
