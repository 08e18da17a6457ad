"""Exports: extended XYZ, names and guides, and what is refused."""
import fcntl
import os
import unittest

import case
import numpy as np
from case import FIRST, SECOND
from synthetic import h5py, make_run, write_run

from mcdem import export


class Xyz(case.Case):
    def text(self, name):
        return (self.folder / "view" / name).read_text()

    def test_scans_without_positions_are_omitted(self):
        run = make_run(2, 4)
        for scan in [run[0].scans[1], *run[1].scans]:
            scan.position = None
        self.assertEqual(self.export(run, xyz=True), 2)
        self.assertEqual(self.text(FIRST + ".xyz").count("Lattice="), 3)
        self.assertEqual(self.text(FIRST + ".contacts.dump").count("ITEM: TIMESTEP"), 3)
        self.assertFalse((self.folder / "view" / (SECOND + ".xyz")).exists())

    def test_only_selected_scans_are_written(self):
        self.assertEqual(self.export(make_run(2, 4), xyz=True, replicas=[1], scans=[1, 3]), 2)
        self.assertEqual(self.text(SECOND + ".xyz").count("Lattice="), 2)

    def test_a_label_cannot_end_its_quotes_or_its_line(self):
        run = make_run()
        run[0].label = 'a "b"\nc'
        self.export(run, xyz=True)
        self.assertIn(' label="a \'b\' c"\nX ', self.text("replica_00000_a_b_c.xyz"))

    def test_a_species_is_a_single_word(self):
        self.export(make_run(2), xyz=True)
        words = [line.split()[0] for line in self.text(SECOND + ".xyz").splitlines()[2:]]
        self.assertEqual(words[:3], ["soft", "half_stiff", "soft"])

    def test_a_tilted_cell(self):
        run = make_run()
        run[0].shape, run[0].edges = "cell", [0.1, 0.2, 0.4]
        run[0].scans[0].row["strain"] = [0.5, 0, 0, -0.25, 0.5, 0.125]
        self.export(run, xyz=True)
        self.assertIn('Lattice="0.05 0 0 -0.05 0.2 0 0.2 0.05 0.4" Origin="0 0 0" pbc="T T T"', self.text(FIRST + ".xyz"))
        self.assertIn("ITEM: BOX BOUNDS xy xz yz pp pp pp\n-0.05 0.25 -0.05\n0 0.25 0.2\n0 0.4 0.05\n", self.text(FIRST + ".contacts.dump"))

    def test_containers(self):
        for shape, xyz, dump in (("box", "F F F", "ff ff ff"), ("cylinder", "F F F", "ff ff ff"), ("periodic", "T T F", "pp pp ff")):
            run = make_run()
            run[0].shape = shape
            self.export(run, xyz=True)
            self.assertIn(f'Lattice="0.06 0 0 0 0.06 0 0 0 0.06" Origin="0 0 0" pbc="{xyz}"', self.text(FIRST + ".xyz"))
            self.assertIn(f"ITEM: BOX BOUNDS {dump}\n0 0.06\n0 0.06\n0 0.06\n", self.text(FIRST + ".contacts.dump"))


class Names(case.Case):
    def test_the_label_is_in_shell_safe_characters(self):
        for label, name in (("mc_dem, friction=0.03 #2", "replica_00000_mc_dem_friction=0.03_2"), ("", "replica_00000"),
                            ("../$(rm -r) `x`/.", "replica_00000_.._rm_-r_x"), (300 * "a", "replica_00000_" + 80 * "a"),
                            ("µm", "replica_00000_m")):
            run = make_run()
            run[0].label = label
            self.export(run, vtk=True)
            self.assertTrue((self.folder / "view" / name).is_dir(), name)

    def test_the_guide_lists_the_replicas_with_their_differences(self):
        run = make_run(2)
        for replica, gamma in zip(run, ("1", "1.125")):
            replica.parameters = {"contact.gamma": gamma, "name": "a"}
        self.export(run, vtk=True)
        self.export(run, xyz=True, replicas=[1])
        second = f"{SECOND}  contact.gamma = 1.125\n"
        self.assertTrue((self.folder / "view/README.txt").read_text().endswith(f"\n{FIRST}  contact.gamma = 1\n{second}"))
        self.assertTrue((self.folder / "view/OVITO.txt").read_text().endswith(f":\n{second}"))


class Refused(case.Case):
    def test_folders_without_a_run(self):
        self.refused("nowhere: must be a result folder or file, got nothing there", "nowhere")
        run = self.folder / "a"
        run.mkdir()
        self.refused("holds no run", "a")
        (run / "checkpoint.h5").write_text("")
        self.refused("was stopped before it wrote results", "a")
        (run / "segment-000001.h5").write_text("")
        self.refused("segment-000000.h5: is missing", "a")
        (run / "parts").mkdir()
        self.refused("parts of a run that are not merged", "a")
        self.assertFalse((self.folder / "view").exists())

    def test_segments_of_another_run(self):
        run = make_run(scans=2)
        write_run(self.folder / "segment-000000.h5", run, 0, 1)
        run[0].label = "another"
        write_run(self.folder / "segment-000001.h5", run, 1, 2)
        self.refused("segment-000001.h5: belongs to another run", "")

    def test_files_that_are_no_results(self):
        (self.folder / "text").write_text("a text")
        self.refused("text: .*is damaged or was not written by this program", "text")
        h5py.File(self.folder / "other.h5", "w").close()
        self.refused("is HDF5 but not a result of this program", "other.h5")
        file = write_run(self.folder / "run.h5", make_run())
        with h5py.File(file, "r+") as run:
            run["parameters"].attrs["format"] = 2
        self.refused("has layout 2, this program reads up to 1", "run.h5")

    def test_damaged_tables(self):
        name = "replica_00000"

        def grain_out_of_range(run):
            rows = run[f"contacts/{name}/contact"][:]
            rows["grain"][0] = 100
            run[f"contacts/{name}/contact"][:] = rows

        def changed(run):
            rows = run[f"observables/{name}"][:]
            rows["plate_z"] += 1
            run[f"observables/{name}"][:] = rows

        def position_unknown(run):
            run[f"particles/{name}/position/value"][0, 3, 1] = np.nan

        def elsewhere(run):
            del run[f"particles/{name}/diameter"]
            run[f"particles/{name}/diameter"] = h5py.ExternalLink(self.folder / "other.h5", f"particles/{name}/diameter")

        write_run(self.folder / "other.h5", make_run())
        for damage, words in ((grain_out_of_range, "must be contacts of grains and walls that are there"), (changed, "does not have the digest"),
                              (position_unknown, "must be 3 numbers for each grain"), (elsewhere, "lies outside this file"),
                              (lambda run: run.__delitem__(f"contacts/{name}/offset"), "is damaged"),
                              (lambda run: run[f"particles/{name}/box"].attrs.__setitem__("edges", [0.1, -1, 0.1]), "3 edges > 0")):
            with h5py.File(write_run(self.folder / "run.h5", make_run()), "r+") as run:
                damage(run)
            self.refused(words, "run.h5")

    def test_output_folders(self):
        write_run(self.folder / "run.h5", make_run())
        (self.folder / "view").write_text("")
        self.refused("view: must be a folder", "run.h5")
        (self.folder / "view").unlink()
        (self.folder / "view").mkdir()
        held = os.open(self.folder / "view", os.O_RDONLY)
        fcntl.flock(held, fcntl.LOCK_EX)
        self.refused("another program is writing there", "run.h5")
        os.close(held)
        (self.folder / "view/experiment.toml").write_text("")
        self.refused("is the folder of an experiment", "run.h5")
        self.refused("choose a format: vtk, xyz or both", "run.h5", vtk=False)

    def test_a_run_without_positions(self):
        run = make_run()
        run[0].scans[0].position = None
        write_run(self.folder / "run.h5", run)
        for form in ("vtk", "xyz"):
            self.refused("has no positions to export: run with output.positions = true", "run.h5", **{form: True})

    def test_files_that_others_are_writing_are_kept(self):
        write_run(self.folder / "run.h5", make_run())
        (self.folder / "view").mkdir()
        left, written = (self.folder / f"view/{name}.0123456789abcdef.tmp" for name in ("left", "written"))
        left.write_text("")
        with open(written, "x") as out:
            fcntl.flock(out, fcntl.LOCK_EX)
            export(self.folder / "run.h5", self.folder / "view", xyz=True)
            self.assertTrue(written.exists() and not left.exists())

    def test_failed_writes_name_the_file(self):
        write_run(self.folder / "run.h5", make_run())
        (self.folder / "view").mkdir()
        (self.folder / "view" / FIRST).write_text("")
        self.refused(f"{FIRST}: cannot be written", "run.h5", RuntimeError)


if __name__ == "__main__":
    unittest.main()
