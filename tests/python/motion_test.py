"""Initial velocities and spins of a packing, and forces along prescribed paths: what is kept, and what is refused."""
import unittest

import numpy as np

import mcdem
from small import Folder

HEADER = "x_m,y_m,z_m,diameter_m,vx_m_s,vy_m_s,vz_m_s,spin_x_1_s,spin_y_1_s,spin_z_1_s\n"
FREE = "0.02,0.02,0.02,0.01,0.1,0,0.05,0,3,1\n0.05,0.05,0.05,0.01,0,-0.2,0,-2,0,0\n"
HITTING = FREE + "0.0314,0.02,0.02,0.01,-0.3,0.02,0,0,0,5\n"  # 1.4 mm before the first grain


class Packed(Folder):
    def write(self, text):
        file = self.folder / f"packing{len(list(self.folder.iterdir()))}.csv"
        file.write_text(text)
        return str(file)

    def scene(self, text, **more):
        tables = {"container": {"size_x": 0.1, "size_y": 0.1}, "plate": {"start": 0.1, "end": 0.05},
                  "grains": {"excess_density": 0}, "contact": {"model": "mc_dem"}, "packing": {"file": self.write(text)},
                  "protocol": {"relax_time": 0, "settle_drag": 0}, "numerics": {"precision": "double"},
                  "programme": [{"stage": "hold", "time": 0.02, "scans": 10}]}
        for table, keys in more.items():
            tables[table] = tables[table] | keys if isinstance(keys, dict) and table in tables else keys
        return mcdem.Scene(**tables)


class InitialMotion(Packed):
    def test_free_grains_keep_their_velocities_and_spins(self):
        for protocol in ({}, {"rate_tolerance": 0}):
            recording = mcdem.simulate(self.scene(HEADER + FREE, protocol=protocol))[0]
            time = recording.scans["time"]
            for s in range(len(recording)):
                moved = recording.positions(s) - [[0.02, 0.02, 0.02], [0.05, 0.05, 0.05]]
                np.testing.assert_allclose(moved, time[s] * np.array([[0.1, 0, 0.05], [0, -0.2, 0]]), rtol=1e-11, atol=1e-15)
                np.testing.assert_allclose(recording.rotations(s), time[s] * np.array([[0, 3, 1], [-2, 0, 0]]), rtol=1e-6, atol=1e-12)

    def test_grains_without_columns_start_at_rest(self):
        rows = "x_m,y_m,z_m,diameter_m\n0.02,0.02,0.02,0.01\n0.05,0.05,0.05,0.01\n"
        recording = mcdem.simulate(self.scene(rows))[0]
        np.testing.assert_array_equal(recording.scans["kinetic_energy"], 0)

    def test_the_relaxation_removes_motion(self):
        relaxed = mcdem.simulate(self.scene(HEADER + FREE, protocol={"relax_time": 0.3, "settle_drag": 1e6}))[0]
        self.assertLess(relaxed.scans["kinetic_energy"][0], 1e-20)

    def test_spins_alone_are_used(self):
        text = "x_m,y_m,z_m,diameter_m,spin_x_1_s,spin_y_1_s,spin_z_1_s\n0.02,0.02,0.02,0.01,1,2,3\n"
        recording = mcdem.simulate(self.scene(text))[0]
        np.testing.assert_allclose(recording.rotations(9), [recording.scans["time"][9] * np.array([1, 2, 3])], rtol=1e-6)
        np.testing.assert_array_equal(recording.positions(9), [[0.02, 0.02, 0.02]])

    def test_bits_are_the_same_alone_and_in_a_batch(self):
        alone = mcdem.simulate(self.scene(HEADER + HITTING, grains={"friction": 0.3}))[0]
        batch = mcdem.simulate(self.scene(HEADER + HITTING, batch={"vary": {"grains.friction": [0, 0.3, 0.5, 0.7, 0.9, 1]}}))
        together = next(one for one in batch if one.parameters["grains.friction"] == 0.3)
        self.assertGreater(max(len(alone.contacts(s)) for s in range(len(alone))), 0)
        for s in range(len(alone)):
            self.assertEqual(alone.positions(s).tobytes(), together.positions(s).tobytes())
            self.assertEqual(alone.rotations(s).tobytes(), together.rotations(s).tobytes())

    def test_a_checkpoint_does_not_fit_another_motion(self):
        file = self.folder / "same.csv"

        def run(text, resume):
            file.write_text(HEADER + text)
            scene = self.scene(HEADER + FREE, packing={"file": str(file)}, programme=[{"stage": "hold", "time": 20, "scans": 10}])

            def stop(fraction):
                if fraction > 0.2:
                    raise InterruptedError
            mcdem.run(scene, self.folder / "out", resume=resume, progress=stop)

        with self.assertRaises(InterruptedError):
            run(FREE, False)
        with self.assertRaisesRegex(ValueError, "packing"):
            run(FREE.replace("0.1,0,0.05,0,3", "0.1,0,0.05,0,4"), True)

    def test_wrong_columns_are_refused(self):
        for packing, message in ((HEADER.replace("vy_m_s", "vy") + FREE, "must name vx_m_s, vy_m_s and vz_m_s together"),
                                 (HEADER + FREE.replace(",0.1,0,0.05", ",1e9,0,0.05"), "initial velocities, and spins .* must be at most"),
                                 (HEADER + FREE.replace("0,3,1", "0,1e9,1"), "initial velocities, and spins .* must be at most")):
            with self.assertRaisesRegex(ValueError, message):
                mcdem.simulate(self.scene(packing))


class Paths(Packed):
    PAIR = "x_m,y_m,z_m,diameter_m\n0.03,0.05,0.05,0.01\n0.06,0.05,0.05,0.01\n"
    POSITION = np.tile([[0.045, 0.05, 0.05], [0.0548, 0.05, 0.05]], (5, 1, 1))
    TIME = np.linspace(0, 4e-4, 5)

    def along(self, *path, text=PAIR, **more):
        return mcdem.forces_along(self.scene(text, **more), *path)

    def test_forces_balance_and_have_shapes(self):
        force, torque = self.along(self.TIME, self.POSITION)
        self.assertEqual((force.shape, torque.shape), ((5, 2, 3), (5, 2, 3)))
        self.assertLess(force[0, 0, 0], -1e-6)
        np.testing.assert_array_equal(force[:, 0], -force[:, 1])
        np.testing.assert_array_equal(torque, 0)

    def test_velocities_are_those_of_the_path_unless_given(self):
        moving = self.POSITION + np.arange(5)[:, None, None] * np.array([[2e-6, 0, 0], [0, 0, 0]])
        given = np.zeros((5, 2, 3))
        given[:, 0, 0] = 0.02
        derived, stated = self.along(self.TIME, moving)[0], self.along(self.TIME, moving, given)[0]
        np.testing.assert_allclose(derived, stated, rtol=1e-9, atol=1e-15)
        still = self.along(self.TIME, moving, 0 * given)[0]
        self.assertGreater(np.abs(derived - still).max(), 1e-3 * np.abs(still).max())  # damping

    def test_lists_and_float_arrays_are_taken(self):
        force = self.along(list(self.TIME), self.POSITION.tolist())[0]
        np.testing.assert_array_equal(force, self.along(self.TIME, self.POSITION)[0])

    def test_periodic_images_and_walls_are_met(self):
        across = np.tile([[0.0002, 0.05, 0.0049], [0.0904, 0.05, 0.05]], (3, 1, 1))
        across[:, 1] = [0.0904, 0.05, 0.0049]
        force, _ = self.along(self.TIME[:3], across, container={"size_x": 0.1, "size_y": 0.1, "shape": "periodic"})
        self.assertGreater(force[0, 0, 0], 1e-6)
        self.assertGreater(force[0, 0, 2], 1e-6)  # from the floor

    def test_adhesion_across_a_gap_counts(self):
        apart = self.POSITION.copy()
        apart[:, 1, 0] = 0.05501  # a gap of 0.01 mm; adhesion reaches 0.01 R* = 0.025 mm
        still = self.along(self.TIME, apart)[0]
        pulled = self.along(self.TIME, apart, effects={"adhesion": 1e-3})[0]
        np.testing.assert_array_equal(still, 0)
        self.assertGreater(pulled[0, 0, 0], 0)

    def test_wrong_paths_are_refused(self):
        def refused(message, *path, **more):
            with self.assertRaisesRegex(ValueError, message):
                self.along(*path, **more)

        time, position = self.TIME, self.POSITION
        refused(r"time: must have the shape \(T,\)", time[:, None], position)
        refused(r"time: must have the shape \(T,\)", [], position[:0])
        refused(r"position: must have the shape \(5, 2, 3\).*got \(4, 2, 3\)", time, position[1:])
        refused(r"position: must have the shape", time, position[:, :, :2])
        refused(r"position: must have the shape", time, position[:, :1])
        refused(r"velocity: must have the shape", time, position, position[1:])
        refused(r"spin: must have the shape", time, position, None, position[0])
        refused(r"time\[2\]: must be at least", time[[0, 1, 1, 2, 3]], position)
        refused(r"time\[1\]: must be at least", time[::-1], position)
        refused(r"time\[3\]: must be finite", [0, 1, 2, np.inf, 4], position)
        for name, place in (("position", 0), ("velocity", 1), ("spin", 2)):
            vectors = [position.copy(), 0 * position, 0 * position]
            vectors[place][3, 1, 2] = np.nan
            refused(rf"{name}\[3, 1\]: must be finite", time, *vectors)
        far = position.copy()
        far[2:, 0, 1] -= 0.002
        refused(r"position\[2, 0\]: must be at most .* m from the row before", time, far)
        refused(r"position\[0\]: the centre of grain 0 must be in the box", time, position - [0.06, 0, 0])
        deep = position.copy()
        deep[:, 1, 0] = 0.0495
        refused("row 0 of the path: a corrected overlap passed 0.5", time, deep)
        refused("one replica, got 2", time, position, batch={"vary": {"grains.friction": [0, 1]}})
        refused("effects.rolling_resistance: must be 0", time, position, effects={"rolling_resistance": 0.1})
        with self.assertRaises(TypeError):
            self.along(time, "here")


if __name__ == "__main__":
    unittest.main()
