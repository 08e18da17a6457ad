"""No caller may crash the interpreter: threads, unusual arguments, results without the requested data."""
import os
import pathlib
import subprocess
import sys
import textwrap
import unittest
import mcdem
from small import SMALL, Folder


class Hostile(Folder):
    def test_comparisons_need_runs(self):
        run = mcdem.simulate(mcdem.Scene(SMALL))
        for one, reference in ((None, run), (run, None), (run, 5)):
            with self.assertRaises(TypeError):
                mcdem.compare(one, reference)

    def test_lists_without_end_are_refused(self):
        with self.assertRaisesRegex(ValueError, "grains.friction must be a list of at most 1000000 values"):
            mcdem.Scene.parse("", set={"grains.friction": range(10**9)})

    def test_stress_of_grains_needs_positions(self):
        mcdem.run(mcdem.Scene(SMALL, output={"positions": False}), self.folder / "bare")
        mcdem.run(mcdem.Scene(SMALL), self.folder / "whole")
        for run in (mcdem.read(self.folder / "bare"), mcdem.read(self.folder / "whole", what="contacts")):
            with self.assertRaisesRegex(ValueError, "needs the grains' positions"):
                run[0].grain_stress(2)
        with self.assertRaisesRegex(ValueError, "needs the contacts"):
            mcdem.read(self.folder / "whole", what="positions")[0].grain_stress(2)

    def test_paths_that_are_no_utf8_are_read(self):
        folder = self.folder / os.fsdecode(b"caf\xe9")
        folder.mkdir()
        (folder / "grain.csv").write_text("x_m,y_m,z_m,diameter_m\n0.03,0.03,0.01,0.02\n")
        (folder / "scene.toml").write_text(
            '[box]\nsize_x = 0.06\nsize_y = 0.06\n[packing]\nfile = "grain.csv"\n[plate]\nstart = 0.022\nend = 0.021\n'
            "[protocol]\nscans_per_stroke = 1\nrelax_time = 0.001\nsettle_time = 0.001\n")
        run = mcdem.simulate(mcdem.Scene.read(folder / "scene.toml"))
        self.assertIn(str(folder), run[0].parameters["packing.file"])

    def in_fresh_python(self, code):
        """Output of the code in a new interpreter."""
        start = f"import sys, threading, time; sys.path.insert(0, {str(pathlib.Path(__file__).parent)!r}); import mcdem; from small import SMALL\n"
        done = subprocess.run([sys.executable, "-c", start + textwrap.dedent(code)], capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_first_calls_come_from_several_threads(self):
        self.assertEqual(self.in_fresh_python("""
            found = []
            threads = [threading.Thread(target=lambda: found.append(mcdem.simulate(mcdem.Scene(SMALL))[0].top_force.tobytes()))
                       for _ in range(4)]
            for thread in threads: thread.start()
            for thread in threads: thread.join()
            print(len(found), len(set(found)))
            """), "4 1\n")

    def test_python_ends_while_a_daemon_thread_simulates(self):
        self.assertEqual(self.in_fresh_python("""
            slow = mcdem.Scene(SMALL | {"protocol": {"cycles": 1000}})
            begun = threading.Barrier(4)
            def simulate():
                parts = iter([begun.wait])
                mcdem.simulate(slow, progress=lambda part: next(parts, time.monotonic)())
            for _ in range(3): threading.Thread(target=simulate, daemon=True).start()
            begun.wait()
            time.sleep(0.1)
            print("ends")
            """), "ends\n")


if __name__ == "__main__":
    unittest.main()
