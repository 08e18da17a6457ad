"""The Python module: scenes, runs, arrays and errors."""
import gc
import os
import pickle
import re
import signal
import sys
import threading
import time
import unittest
import warnings
import weakref

import h5py
import numpy as np

import mcdem
from small import MODELS, SMALL, Folder


class Scenes(Folder):
    def test_is_pickled_for_other_processes(self):
        scene = mcdem.Scene({"grains.friction": 0.2, "batch.replicas": 2})
        (self.folder / "run.v2.toml").write_text(scene.text)
        dotted = mcdem.Scene.read(self.folder / "run.v2.toml")
        self.assertEqual(pickle.loads(pickle.dumps(dotted)).name, dotted.name)
        copy = pickle.loads(pickle.dumps(scene))
        self.assertEqual((copy.name, copy.text, copy.labels, copy.parameters), (scene.name, scene.text, scene.labels, scene.parameters))

    def test_tables_nested_dotted_and_from_text_are_one_scene(self):
        nested = mcdem.Scene({"grains": {"friction": 0.25}}, **SMALL)
        dotted = mcdem.Scene({"grains.friction": np.float64(0.25)}, **SMALL)
        parsed = mcdem.Scene.parse(nested.text)
        self.assertEqual(nested.parameters, dotted.parameters)
        self.assertEqual(nested.parameters, parsed.parameters)
        self.assertEqual(nested.parameters[0]["grains.friction"], 0.25)
        self.assertEqual(nested.name, "small")

    def test_values_of_every_type_arrive(self):
        scene = mcdem.Scene(name='a "b"\\\u00e9', packing={"count": np.int32(514), "seed": 7},
                            output={"positions": False, "contacts": np.bool_(True)}, plate={"end": np.float32(0.125)},
                            batch={"vary": {"grains.friction": np.array([0.0, 0.1, 1 / 3])}})
        self.assertEqual(scene.name, 'a "b"\\\u00e9')
        self.assertEqual([one["grains.friction"] for one in scene.parameters], [0, 0.1, 1 / 3])
        self.assertEqual(scene.parameters[0]["plate.end"], 0.125)
        self.assertEqual(scene.parameters[0]["packing.count"], 514)
        self.assertEqual(len(scene), 3)
        self.assertEqual(len(scene.labels), 3)

    def test_numbers_of_other_types_are_those_of_python(self):
        class Loud(float):  # as NumPy 2 prints its numbers
            def __repr__(self):
                return f"np.float64({float(self)})"

        scene = mcdem.Scene.parse("", set={"contact.gamma": Loud(1.25), "protocol.scan_at_start": np.True_,
                                           "packing.count": np.array(400), "grains.friction": np.float64(0.5)})
        parameters = scene.parameters[0]
        self.assertEqual([parameters[key] for key in ("contact.gamma", "protocol.scan_at_start", "packing.count", "grains.friction")],
                         [1.25, True, 400, 0.5])
        varied = mcdem.Scene(batch={"vary": {"contact.gamma": np.linspace(1, 1.5, 3), "protocol.scan_at_start": [np.False_, np.True_]}})
        self.assertEqual({one["contact.gamma"] for one in varied.parameters}, {1, 1.25, 1.5})
        self.assertEqual({one["protocol.scan_at_start"] for one in varied.parameters}, {False, True})

    def test_recursive_or_too_deeply_nested_values_are_refused(self):
        holds_itself = {}
        holds_itself["grains"] = holds_itself
        listed = []
        listed.append(listed)
        deep = {}
        for _ in range(100_000):
            deep = {"grains": deep}
        for bad in (holds_itself, {"grains": {"friction": listed}}, deep, {"batch.vary": {"a": [holds_itself]}}):
            with self.assertRaisesRegex(ValueError, "nested less deeply"):
                mcdem.Scene(bad)
        with self.assertRaisesRegex(ValueError, "nested less deeply"):
            mcdem.Scene.parse("", set={"grains.friction": listed})
        while deep:  # releases the levels one by one; otherwise Python would recurse too deeply
            deep = deep.popitem()[1]

    def test_files_are_read_and_overridden(self):
        file = self.folder / "soft.toml"
        file.write_text("[grains]\nfriction = 0.1\n")
        scene = mcdem.Scene.read(file, set={"grains": {"friction": 0.5}, "contact.model": "mc_dem"})
        self.assertEqual(scene.parameters[0]["grains.friction"], 0.5)
        self.assertEqual(scene.parameters[0]["contact.model"], "mc_dem")

    def test_every_problem_is_a_line_of_one_value_error(self):
        file = self.folder / "bad.toml"
        file.write_text("[grains]\nfriction = -1\nyoungs_modulus = true\n")
        with self.assertRaises(ValueError) as raised:
            mcdem.Scene.read(file)
        problems = str(raised.exception).splitlines()
        self.assertEqual(len(problems), 2)
        self.assertTrue(problems[0].startswith(f"{file}:2: grains.friction must be "), problems[0])
        with self.assertRaisesRegex(ValueError, "grains.colour"):
            mcdem.Scene(grains={"colour": 1})
        with self.assertRaisesRegex(ValueError, "grains.friction must be a finite number.*None"):
            mcdem.Scene(grains={"friction": None})
        with self.assertRaisesRegex(ValueError, "--set grains.friction"):
            mcdem.Scene.parse("", set={"grains.friction": -1})


class Arrays(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.run_ = mcdem.simulate(mcdem.Scene(SMALL, **MODELS))

    def expect_stress(self, recording, scan):
        """The sum over the grains, computed from positions and contacts."""
        position, volume = recording.positions(scan), np.pi / 6 * recording.diameter**3
        sums = np.zeros((30, 3, 3))
        for contact in recording.contacts(scan):
            for grain, sign in ((contact["grain"], 1), (contact["partner"], -1)):
                if grain >= 0:
                    sums[grain] -= sign * np.outer(contact["point"] - position[grain], contact["force"])
        of_grains = recording.grain_stress(scan)
        np.testing.assert_allclose(of_grains, sums / volume[:, None, None], rtol=1e-9, atol=1e-9 * np.abs(of_grains).max())
        whole = recording.box[0] * recording.box[1] * recording.scans["plate_z"][scan]
        np.testing.assert_allclose(recording.stress[scan], sums.sum(0) / whole, rtol=1e-9, atol=1e-9)
        self.assertAlmostEqual(np.trace(recording.fabric[scan]), 1)

    def test_shapes_and_meaning(self):
        recording = self.run_["elastic_sphere"]
        scans = recording.scans
        self.assertEqual(len(self.run_), 2)
        self.assertEqual([one.label for one in self.run_], ["independent", "elastic_sphere"])
        self.assertEqual(scans.shape, (len(recording),))
        self.assertEqual(recording.diameter.shape, (30,))
        self.assertTrue(np.array_equal(recording.top_force, recording.wall_force[:, 5, 2]))
        self.assertEqual(recording.wall_force.shape, (len(recording), 6, 3))
        self.assertTrue((np.diff(scans["frame"]) == 1).all())
        self.expect_stress(recording, int(np.argmax(recording.top_force)))
        self.assertGreater(recording.top_force.max(), 0)
        last = int(np.argmax(recording.top_force))
        position, contacts = recording.positions(last), recording.contacts(last)
        self.assertEqual(position.shape, (30, 3))
        self.assertTrue((position[:, 0] > 0).all() and (position[:, 0] < recording.box[0]).all())
        plate = contacts["partner"] == -6
        self.assertAlmostEqual(-contacts["force"][plate, 2].sum(), recording.top_force[last], delta=1e-4)
        between = contacts["partner"] >= 0
        distance = np.linalg.norm(position[contacts["grain"][between]] - position[contacts["partner"][between]], axis=1)
        self.assertLess(distance.max(), recording.diameter.max() * 1.05)
        rotation = recording.rotations(last)
        self.assertEqual(rotation.shape, (30, 3))
        self.assertTrue((np.linalg.norm(rotation, axis=1) > 0).all() and (np.abs(rotation) <= np.pi).all())
        self.assertTrue(np.array_equal(recording.positions(-1), recording.positions(len(recording) - 1)))

    def test_scans_are_a_pandas_table(self):
        import pandas
        scans = self.run_[0].scans
        table = pandas.DataFrame(scans)
        self.assertEqual(list(table.columns), list(scans.dtype.names))
        self.assertTrue((table["plate_z"] == scans["plate_z"]).all())

    def test_parameters_have_types(self):
        parameters = self.run_["elastic_sphere"].parameters
        self.assertEqual(parameters["packing.count"], 30)
        self.assertIs(type(parameters["packing.count"]), int)
        self.assertIs(type(parameters["contact.gamma"]), float)
        self.assertIs(parameters["output.positions"], True)
        self.assertEqual(parameters["contact.model"], "elastic_sphere")
        self.assertIsNone(parameters["packing.file"])

    def test_memory_is_shared_not_copied(self):
        recording = self.run_[0]
        for array in (lambda r: r.scans, lambda r: r.top_force, lambda r: r.diameter, lambda r: r.positions(1),
                      lambda r: r.contacts(2)):
            first, second = array(recording), array(self.run_[0])
            self.assertEqual(first.__array_interface__["data"][0], second.__array_interface__["data"][0])
            self.assertTrue(np.shares_memory(first, second))
            self.assertFalse(first.flags.owndata)
            self.assertFalse(first.flags.writeable)
            self.assertIs(first.base, recording)
        self.assertTrue(np.shares_memory(recording.top_force, recording.scans))

    def test_arrays_stay_valid_and_free_the_run_after_use(self):
        run = mcdem.simulate(mcdem.Scene(SMALL))
        position, before = run[0].positions(1), run[0].positions(1).copy()
        alive, owner = weakref.ref(run), weakref.ref(position.base)
        del run
        gc.collect()
        self.assertIsNone(alive())
        filler = [np.full(position.shape, 7.0) for _ in range(200)]  # would reuse freed memory
        self.assertTrue(np.array_equal(position, before), len(filler))
        self.assertIsNotNone(owner())
        del position
        gc.collect()
        self.assertIsNone(owner())

    def test_what_is_not_there_is_an_error(self):
        with self.assertRaises(IndexError):
            self.run_[2]
        with self.assertRaises(KeyError):
            self.run_["soft"]
        with self.assertRaises(IndexError):
            self.run_[0].positions(99)
        self.assertIsNone(self.run_[0].failure)


class Runs(Folder):
    def test_a_run_is_written_and_read_as_h5py_reads_it(self):
        told = []
        run = mcdem.run(mcdem.Scene(SMALL, **MODELS), self.folder / "out", progress=told.append)
        again = mcdem.read(self.folder / "out")
        self.assertEqual(told, sorted(told))
        self.assertEqual(told[-1], 1)
        with h5py.File(self.folder / "out/run.h5") as file:
            for number, recording in enumerate(again):
                table = file[f"observables/replica_{number:05}"][:]
                for name in table.dtype.names:
                    held = getattr(recording, name) if name in ("wall_force", "stress", "fabric", "strain") else recording.scans[name]
                    self.assertTrue(np.array_equal(table[name], held, equal_nan=True), name)
                stored = file[f"contacts/replica_{number:05}/contact"][:]
                contacts = np.concatenate([recording.contacts(s) for s in range(len(recording))])
                for name in stored.dtype.names:
                    self.assertTrue(np.array_equal(stored[name], contacts[name]), name)
                stored = file[f"particles/replica_{number:05}/position/value"][:]
                self.assertTrue(np.array_equal(stored, [recording.positions(s) for s in range(len(recording))]))
        self.assertEqual(run.scene, again.scene)
        self.assertEqual(mcdem.read(self.folder / "out", what="observables")[0].positions(0).shape, (0, 3))

    def test_simulate_and_run_agree(self):
        scene = mcdem.Scene(SMALL)
        self.assertTrue(np.array_equal(mcdem.simulate(scene)[0].top_force,
                                       mcdem.run(scene, self.folder / "out")[0].top_force))

    def test_an_interrupted_run_can_be_resumed(self):
        scene = mcdem.Scene(SMALL)
        asked = []

        def interrupt_once(fraction):
            if not asked and fraction > 0.2:
                asked.append(fraction)
                os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            mcdem.run(scene, self.folder / "out", progress=interrupt_once)
        self.assertFalse((self.folder / "out/run.h5").exists())
        with self.assertRaisesRegex(ValueError, "resume"):
            mcdem.run(scene, self.folder / "out")
        told = []
        run = mcdem.run(scene, self.folder / "out", resume=True, progress=told.append)
        self.assertGreater(told[0], 0.1)
        self.assertTrue(np.array_equal(run[0].top_force, mcdem.simulate(scene)[0].top_force))
        with self.assertRaises(KeyboardInterrupt):
            asked.clear()
            mcdem.simulate(scene, progress=interrupt_once)

    def test_exceptions_of_callbacks_are_passed_on(self):
        def refuse(fraction):
            raise LookupError(f"at {fraction:.0%}")

        with self.assertRaisesRegex(LookupError, "at "):
            mcdem.simulate(mcdem.Scene(SMALL), progress=refuse)
        with self.assertRaisesRegex(LookupError, "at "):
            mcdem.run(mcdem.Scene(SMALL), self.folder / "out", progress=refuse)

    def test_opencl_is_refused_in_a_forked_child(self):
        mcdem.simulate(mcdem.Scene(SMALL))
        for call in (lambda: mcdem.simulate(mcdem.Scene(SMALL)), lambda: mcdem.run(mcdem.Scene(SMALL), self.folder / "out"),
                     mcdem.devices):
            child = os.fork()
            if child == 0:
                signal.alarm(60)
                try:
                    call()
                except RuntimeError as error:
                    os._exit(0 if "spawn" in str(error) else 2)
                os._exit(3)
            self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 0)

    def test_other_threads_run_during_a_simulation(self):
        counts, done = [0], threading.Event()

        def count():
            while not done.is_set():
                counts[0] += 1
                time.sleep(0)

        scene = mcdem.Scene(SMALL)
        thread = threading.Thread(target=count)
        thread.start()
        usual = sys.getswitchinterval()
        sys.setswitchinterval(1e6)  # no forced thread switches: the thread runs only if the simulation releases the lock
        try:
            at_start = counts[0]
            mcdem.simulate(scene)
            at_end = counts[0]
        finally:
            sys.setswitchinterval(usual)
        done.set()
        thread.join()
        self.assertGreater(at_end, at_start)

    def test_errors(self):
        with self.assertRaisesRegex(ValueError, "got nothing there"):
            mcdem.read(self.folder / "nowhere")
        with self.assertRaisesRegex(ValueError, "what: must be one of"):
            mcdem.read(self.folder, what="all")
        with self.assertRaisesRegex(ValueError, "no such device|device"):
            mcdem.simulate(mcdem.Scene(SMALL), device="abacus")
        (self.folder / "file").touch()
        with self.assertRaisesRegex(RuntimeError, "file"):
            mcdem.run(mcdem.Scene(SMALL), self.folder / "file/below")

    def test_compare_and_calibrate(self):
        run = mcdem.simulate(mcdem.Scene(SMALL, **MODELS))
        independent, sphere = mcdem.compare(run, run, setting="elastic_sphere")
        self.assertEqual((independent["setting"], sphere["setting"]), ("independent", "elastic_sphere"))
        self.assertEqual((sphere["Rtop"], sphere["errf"]), (1, 0))
        force = [run[name].top_force.max() for name in ("independent", "elastic_sphere")]
        self.assertAlmostEqual(independent["Rtop"], force[0] / force[1], delta=1e-12)
        self.assertIsNone(independent["Rtop_standard_error"])
        with self.assertRaisesRegex(ValueError, "choose one with setting, of independent, elastic_sphere"):
            mcdem.compare(run, run)
        told = []
        found = mcdem.calibrate(mcdem.Scene(SMALL), run, setting="elastic_sphere", rounds=2, batch=4, progress=told.append)
        self.assertAlmostEqual(found["target_top_force_N"], force[1], delta=1e-12)
        self.assertTrue(0.5 < found["gamma"] < 1.5 and told)
        found = mcdem.calibrate(mcdem.Scene(SMALL), run, setting="elastic_sphere", rounds=1, batch=4, model="elastic_sphere")
        self.assertAlmostEqual(found["youngs_modulus_Pa"] / 23.3e3, 1, delta=0.2)
        self.assertNotIn("gamma", found)
        with self.assertRaisesRegex(ValueError, "rubber"):
            mcdem.calibrate(mcdem.Scene(SMALL), run, setting="elastic_sphere", model="rubber")

    def test_where_all_replicas_fail_the_run_fails(self):
        # far beyond the range of a half space: the corrections run away
        scene = mcdem.Scene(SMALL, plate={"start": 0.088, "end": 0.03}, contact={"model": "mc_dem", "gamma": 1.8},
                            protocol=SMALL["protocol"] | {"scans_per_stroke": 20})
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            with self.assertRaisesRegex(RuntimeError, "all replicas stopped early") as raised:
                mcdem.simulate(scene)
        partial, = raised.exception.run  # what was recorded until then
        self.assertTrue(partial.failure and 0 < len(partial.scans) and np.isfinite(partial.top_force).all())
        self.assertTrue(any("stopped at step" in str(one.message) for one in said))

    def test_a_failure_says_where_and_why(self):
        scene = mcdem.Scene(SMALL, plate={"start": 0.088, "end": 0.038},
                            batch={"vary": {"contact.model": ["independent", "mc_dem"]}}, contact={"gamma": 1.8})
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            run = mcdem.simulate(scene)
        failure = run["mc_dem"].failure
        self.assertRegex(repr(failure), f"^<mcdem.Failure at step {failure.step}.*: .*{re.escape(failure.cause[-20:])}>$")
        self.assertIsNone(run["independent"].failure)

    def test_devices(self):
        devices = mcdem.devices()
        self.assertEqual([one["index"] for one in devices], list(range(len(devices))))
        self.assertTrue(all(one["compute_units"] > 0 for one in devices))


if __name__ == "__main__":
    unittest.main()
