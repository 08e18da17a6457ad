"""Exports: extended XYZ, names and guides, and files that are there already."""
import errno
import resource
import unittest
import unittest.mock

from synthetic import FIRST, SECOND, Case, exporting, h5py, make_run, vtk, write_run, xyz

from mcdem.errors import InputError


class Xyz(Case):
    def text(self, name):
        return (self.view / name).read_text()

    def test_scans_without_positions_are_omitted(self):
        run = make_run(2, 4)
        for scan in [run[0].scans[1], *run[1].scans]:
            scan.position = None
        self.assertEqual(self.export(run, xyz), 2)
        self.assertEqual(self.text(FIRST + ".xyz").count("Lattice="), 3)
        self.assertEqual(self.text(FIRST + ".contacts.dump").count("ITEM: TIMESTEP"), 3)
        self.assertFalse((self.view / (SECOND + ".xyz")).exists())

    def test_only_selected_scans_are_written(self):
        self.assertEqual(self.export(make_run(2, 4), xyz, replicas=[1], scans=[1, 3]), 2)
        self.assertEqual(self.text(SECOND + ".xyz").count("Lattice="), 2)

    def test_a_label_cannot_end_its_quotes_or_its_line(self):
        run = make_run()
        run[0].label = 'a "b"\nc'
        self.export(run, xyz)
        self.assertIn(' label="a \'b\' c"\nX ', self.text("replica_00000_a_b_c.xyz"))

    def test_a_species_is_a_single_word(self):
        self.export(make_run(2), xyz)
        words = [line.split()[0] for line in self.text(SECOND + ".xyz").splitlines()[2:]]
        self.assertEqual(words[:3], ["soft", "half_stiff", "soft"])

    def test_different_species_have_different_words(self):
        for names, words in ((["a b", "a_b"], ["a_b_0", "a_b_1"]), (["a\u2028b", "c"], ["a_b", "c"]), (["a b", "a_b_0"], ["a_b", "a_b_0"]),
                             (["a b", "a_b", "a_b_0"], ["a_b_0_0", "a_b_1", "a_b_0_2"])):
            self.assertEqual(xyz.single_words(names), words)

    def test_a_tilted_cell(self):
        run = make_run()
        run[0].shape, run[0].edges = "cell", [0.1, 0.2, 0.4]
        run[0].scans[0].row["strain"] = [0.5, 0, 0, -0.25, 0.5, 0.125]
        self.export(run, xyz)
        self.assertIn('Lattice="0.05 0 0 -0.05 0.2 0 0.2 0.05 0.4" Origin="0 0 0" pbc="T T T"', self.text(FIRST + ".xyz"))
        self.assertIn("ITEM: BOX BOUNDS xy xz yz pp pp pp\n-0.05 0.25 -0.05\n0 0.25 0.2\n0 0.4 0.05\n", self.text(FIRST + ".contacts.dump"))

    def test_containers(self):
        for shape, pbc, bounds in (("box", "F F F", "ff ff ff"), ("cylinder", "F F F", "ff ff ff"), ("periodic", "T T F", "pp pp ff")):
            run = make_run()
            run[0].shape = shape
            self.export(run, xyz)
            self.assertIn(f'Lattice="0.06 0 0 0 0.06 0 0 0 0.06" Origin="0 0 0" pbc="{pbc}"', self.text(FIRST + ".xyz"))
            self.assertIn(f"ITEM: BOX BOUNDS {bounds}\n0 0.06\n0 0.06\n0 0.06\n", self.text(FIRST + ".contacts.dump"))


class Choice(Case):
    def test_what_is_not_there_is_refused(self):
        run = make_run(scans=3)
        run[0].scans[1].position = None
        for chosen, problem in (({"scans": [99]}, "--scan: must be among the scans of .*, got 99"), ({"scans": [1]}, "has no positions to export"),
                                ({"replicas": [7]}, "--replica: must be one of 0 to 0, got 7")):
            with self.assertRaisesRegex(InputError, problem):
                self.export(run, xyz, **chosen)


class Names(Case):
    def test_the_label_is_in_shell_safe_characters(self):
        for label, name in (("mc_dem, friction=0.03 #2", "replica_00000_mc_dem_friction=0.03_2"), ("", "replica_00000"),
                            ("../$(rm -r) `x`/.", "replica_00000_.._rm_-r_x"), (300 * "a", "replica_00000_" + 80 * "a"),
                            ("µm", "replica_00000_m")):
            run = make_run()
            run[0].label = label
            self.export(run, vtk)
            self.assertTrue((self.view / name).is_dir(), name)

    def test_the_guide_lists_the_replicas_with_their_differences(self):
        run = make_run(2)
        for replica, gamma in zip(run, ("1", "1.125")):
            replica.parameters = {"contact.gamma": gamma, "name": "a"}
        self.export(run, vtk)
        self.export(run, xyz, replicas=[1])
        second = f"{SECOND}  contact.gamma = 1.125\n"
        self.assertTrue((self.view / "README.txt").read_text().endswith(f"\n{FIRST}  contact.gamma = 1\n{second}"))
        self.assertTrue((self.view / "OVITO.txt").read_text().endswith(f":\n{second}"))


class Writing(Case):
    def test_files_of_others_are_kept(self):
        for form, name in ((vtk, "README.txt"), (vtk, f"{FIRST}/grains_000000.hdf"), (xyz, "OVITO.txt"),
                           (xyz, f"{FIRST}.xyz"), (xyz, f"{FIRST}.contacts.dump")):
            (self.view / name).parent.mkdir(exist_ok=True)
            (self.view / name).write_text("of mine")
            with self.assertRaisesRegex(ValueError, f"{name}: is not .* it is not replaced"):
                self.export(make_run(), form)
            self.assertEqual((self.view / name).read_text(), "of mine")
            (self.view / name).write_text("")
            self.export(make_run(), form)

    def test_a_failed_write_leaves_nothing_and_names_the_file(self):
        write_run(self.run / "run.h5", make_run(scans=40))
        limit = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (5_000, limit[1]))
        self.addCleanup(resource.setrlimit, resource.RLIMIT_FSIZE, limit)
        with self.assertRaisesRegex(OSError, f"File too large.*{FIRST}"):
            exporting.export(self.run, self.view, [xyz])
        self.assertEqual([file.name for file in self.view.iterdir()], ["OVITO.txt"])

    def test_of_a_damaged_run_nothing_is_written(self):
        file = self.run / "run.h5"
        for lost in ("contacts/replica_00000/offset", "observables/replica_00000", "particles/replica_00000/position/value", "parameters"):
            write_run(file, make_run(scans=4))
            with h5py.File(file, "a") as run:
                del run[lost]
            with self.assertRaisesRegex(InputError, f"^{file}: "):
                exporting.export(self.run, self.view, [xyz])
            self.assertEqual(list(self.view.iterdir()), [])

    def test_file_systems_without_locks(self):
        for error in (errno.ENOLCK, 524, errno.EOPNOTSUPP):
            with unittest.mock.patch("fcntl.flock", side_effect=OSError(error, "no locks")):
                self.assertEqual(self.export(make_run(), xyz), 2)


if __name__ == "__main__":
    unittest.main()
