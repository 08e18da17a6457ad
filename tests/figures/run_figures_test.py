"""Figures of runs have the values of run.h5. run_figures_test.py PROGRAM"""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import drawn
import h5py
import matplotlib.pyplot as plt
import numpy as np
from drawn import figures

from report import page_truth as truth

COLOURS = {"Independent contacts": "#0072B2", "MC-DEM": "#D55E00"}
NAMES = ("top_force", "force_distribution", "coordination", "scaling")
PROGRAM = ""


def setUpModule():
    global folder, mcdem, settings, experiment
    folder = pathlib.Path(tempfile.mkdtemp())
    unittest.addModuleCleanup(shutil.rmtree, folder)
    mcdem = drawn.Program(PROGRAM, folder)
    (folder / "scene.toml").write_text('name = "small"' + truth.PLATE_SCENE)
    mcdem("run", "scene.toml", "--out", "run")
    mcdem("experiment", "from-run", "run", "--replica", "mc_dem #1", "--seed", "0", "--out", "reality")
    mcdem("figures", "run", "--against", "reality", "--displacement", "0.011", "--out", "against")
    with h5py.File(folder / "run/run.h5") as run:
        settings = truth.settings_of(run)
    experiment = truth.recording_of_experiment(folder / "reality")


class Curves(unittest.TestCase):
    def tearDown(self):
        plt.close("all")

    def expect_line(self, axes, name, linestyle, curve):
        line, = drawn.lines_of(axes, COLOURS[name], linestyle)
        np.testing.assert_allclose(line, (curve.x, curve.y), rtol=1e-6, atol=1e-12)

    def expect_points(self, axes, colour, curves):
        for found, curve in zip(drawn.lines_of(axes, colour, "None"), curves, strict=True):
            np.testing.assert_allclose(found, (curve.x, curve.y), rtol=1e-6, atol=1e-12)

    def test_top_force(self):
        axes = figures.top_force(folder / "run")
        for name, recordings in settings.items():
            for phase, linestyle in ((0, "-"), (1, "--")):
                self.expect_line(axes, name, linestyle, truth.curve(recordings, lambda r: r.top_force, phase))
        self.assertEqual(drawn.words_of(axes), ["MC-DEM", "Independent contacts", "loading", "unloading", "± standard error"])
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("plate displacement [mm]", "top force [N]"))

    def test_bands_are_one_standard_error(self):
        axes = figures.top_force(folder / "run")
        curve = truth.curve(settings["MC-DEM"], lambda r: r.top_force, 0)
        corners = drawn.bands_of(axes, COLOURS["MC-DEM"])[0]
        for x, y, error in zip(curve.x, curve.y, curve.error):
            at_x = corners[np.isclose(corners[:, 0], x), 1]
            self.assertAlmostEqual(at_x.max(), y + error, places=6)
            self.assertAlmostEqual(at_x.min(), max(y - error, y / 3), places=6)

    def test_force_distribution(self):
        axes = figures.force_distribution(folder / "against")
        densities = truth.distributions({**settings, "reality": [experiment]}, 11)
        for name in settings:
            self.expect_line(axes, name, "-", densities[name])
        self.expect_points(axes, "#000000", [densities["reality"]])
        self.assertEqual(axes.get_yscale(), "log")
        self.assertRegex(axes.get_legend().get_title().get_text(), r"^at 1[01]\.\d mm, unloading$")

    def test_coordination(self):
        axes = figures.coordination(folder / "run")
        for name, recordings in settings.items():
            for phase, linestyle in ((0, "-"), (1, "--")):
                self.expect_line(axes, name, linestyle, truth.curve(recordings, lambda r: truth.contacts_per_grain(r, 0), phase))

    def test_coordination_above_the_best_threshold(self):
        axes = figures.coordination(folder / "against")
        for name, recordings in settings.items():
            words, = (words for words in drawn.words_of(axes) if words.startswith(name))
            tau = truth.threshold_near(recordings, [experiment], float(re.fullmatch(r".*, tau (\S+) mN", words)[1]) * 1e-3)
            self.assertGreater(tau, 0)
            for phase, linestyle in ((0, "-"), (1, "--")):
                self.expect_line(axes, name, linestyle, truth.curve(
                    recordings, lambda r, tau=tau: truth.contacts_per_grain(r, tau), phase))

    def test_scaling(self):
        axes = figures.scaling(folder / "run")
        for name, recordings in settings.items():
            curves = [truth.scaling_curve(recordings, phase) for phase in (0, 1)]
            self.expect_points(axes, COLOURS[name], curves)
            (_, end), (_, force) = drawn.lines_of(axes, COLOURS[name], "-")[0]
            slope = truth.slope_through_zero(curves)
            self.assertAlmostEqual(force / end * 1e3 / slope, 1, places=6)
            self.assertIn(f"{name}, {slope:.0f} /m", drawn.words_of(axes))
            _, low, high = drawn.bars_of(axes, COLOURS[name])
            errors = np.concatenate([curve.error for curve in curves])
            np.testing.assert_allclose(high - low, 2 * errors, rtol=1e-6, atol=1e-12)

    def test_a_reference_is_points(self):
        axes = figures.top_force(folder / "against")
        self.expect_points(axes, "#000000", [truth.curve([experiment], lambda r: r.top_force, phase) for phase in (0, 1)])
        words = drawn.words_of(axes)
        self.assertEqual(words[2:5], ["small, mc_dem #1", "loading (points: full)", "unloading (points: open)"])
        self.assertRegex(words[0], r"^MC-DEM, Rtop \d\.\d\d$")

    def test_axes_of_the_user(self):
        _, mine = plt.subplots()
        self.assertIs(figures.top_force(folder / "run", mine), mine)
        self.assertTrue(mine.lines)

    def test_any_label_is_shown_as_it_stands(self):
        values = (folder / "run/figures.json").read_text()
        hostile = r"_$\\frac{1}$ <b>&"
        (folder / "figures.json").write_text(values.replace('"words": "MC-DEM"', f'"words": "{hostile}"'))
        axes = figures.top_force(folder)
        figures.save(axes, folder / "hostile.svg")
        self.assertIn(r" _$\frac{1}$ <b>&", drawn.texts_of_svg(folder / "hostile.svg"))

    def test_a_long_legend_is_drawn_outside_the_axes(self):
        values = (folder / "run/figures.json").read_text()
        (folder / "figures.json").write_text(values.replace('"words": "MC-DEM"', f'"words": "{"long " * 8}"'))
        axes = figures.top_force(folder)
        axes.figure.canvas.draw()
        self.assertLess(axes.get_legend().get_window_extent().y1, axes.get_window_extent().y0)


class Cells(unittest.TestCase):
    """Stresses and strains of a cell that is compressed, sheared and held."""
    @classmethod
    def setUpClass(cls):
        (folder / "cell.toml").write_text(truth.CELL_SCENE)
        mcdem("run", "cell.toml", "--out", "cell")
        with h5py.File(folder / "cell/run.h5") as run:
            cls.rows = run["observables/replica_00000"][:]
        cls.p, cls.q = truth.invariants(cls.rows)

    def tearDown(self):
        plt.close("all")

    def expect_line(self, name, x, y):
        axes = getattr(figures, name)(folder / "cell")
        line, = drawn.lines_of(axes, "#D55E00", "-")
        np.testing.assert_allclose(line, (x, y), rtol=1e-6, atol=1e-9)
        return axes

    def test_paths(self):
        self.expect_line("stress_path", self.p, self.q)
        axes = self.expect_line("cell_coordination", self.rows["packing_fraction"], self.rows["coordination_number"])
        self.assertEqual(axes.get_xlabel(), "packing fraction φ")

    def test_times(self):
        self.expect_line("pressure_time", self.rows["time"], self.p)
        self.expect_line("shear_stress_time", self.rows["time"], self.q)

    def test_every_figure_is_drawn(self):
        names = {file.stem for file in (folder / "cell").glob("*.pdf")}
        self.assertEqual(names, {"pressure_strain", "shear_stress_strain", "cell_coordination", "stress_path", "pressure_time",
                                 "volume_time", "shear_stress_time", "shear_strain_time"})


class Files(unittest.TestCase):
    def test_every_command_leaves_three_kinds(self):
        for made in ("run", "against"):
            files = {file.name for file in (folder / made).iterdir() if file.suffix[1:] in drawn.KINDS}
            self.assertEqual(files, {f"{name}.{kind}" for name in NAMES for kind in drawn.KINDS})

    def test_print_size(self):
        for name in NAMES:
            png = plt.imread(folder / f"run/{name}.png")
            self.assertAlmostEqual(png.shape[1] / 300 / drawn.MILLIMETRE, 86, delta=0.2)
            self.assertIn(b"/MediaBox [ 0 0 243.7", (folder / f"run/{name}.pdf").read_bytes())

    def test_text_is_text_and_there_is_no_title(self):
        texts = drawn.texts_of_svg(folder / "run/top_force.svg")
        for words in ("plate displacement [mm]", "top force [N]", "MC-DEM", "loading"):
            self.assertIn(words, texts)
        self.assertNotIn("Force on the plate", texts)

    def test_again_gives_the_same_bytes(self):
        before = {file: file.read_bytes() for file in (folder / "against").iterdir()}
        mcdem("figures", "run", "--against", "reality", "--displacement", "0.011", "--out", "against")
        self.assertEqual(before, {file: file.read_bytes() for file in (folder / "against").iterdir()})

    def test_a_failure_leaves_nothing(self):
        axes = figures.top_force(folder / "run")
        with self.assertRaises(ValueError):
            figures.save(axes, folder / "away.exe")
        self.assertEqual(list(folder.glob("away*")), [])

    def test_an_error_while_writing_a_figure_is_reported(self):
        limit = (folder / "run/figures.json").stat().st_size // 1024 + 2
        done = subprocess.run(["bash", "-c", f'ulimit -f {limit}; exec "$@"', "bash", mcdem.file, "figures", "run", "--out", "full"],
                              cwd=folder, capture_output=True, text=True, timeout=500)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stderr, r"full/\w+\.(pdf|png|svg): File too large")
        self.assertNotIn("Traceback", done.stderr)
        self.assertEqual(list((folder / "full").glob("*.tmp")), [])

    def test_an_invalid_figures_json_is_reported(self):
        (folder / "other").mkdir()
        with self.assertRaisesRegex(FileNotFoundError, "mcdem figures"):
            figures.top_force(folder / "other")
        (folder / "other/figures.json").write_text("{}")
        with self.assertRaisesRegex(ValueError, "must be a figures.json"):
            figures.top_force(folder / "other")
        with self.assertRaisesRegex(KeyError, "no figure where, but top_force"):
            figures.where(folder / "run")


class WithoutMatplotlib(unittest.TestCase):
    """A run succeeds and names once what to install; a command whose only purpose is a figure fails."""
    @classmethod
    def setUpClass(cls):
        bare = folder / "bare"
        bare.mkdir()
        (bare / "matplotlib.py").write_text("raise ModuleNotFoundError(\"No module named 'matplotlib'\", name='matplotlib')")
        cls.environment = {**os.environ, "PYTHONPATH": str(bare)}

    def test_run(self):
        done = mcdem.run("run", "scene.toml", "--out", "run_bare", **self.environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr.count("matplotlib"), 2, done.stderr)  # the module and its package, in one line
        self.assertRegex(done.stderr, "matplotlib.* install python3-matplotlib")
        self.assertNotIn("png", done.stdout)
        self.assertTrue((folder / "run_bare/figures.json").exists())

    def test_figures(self):
        done = mcdem.run("figures", "run", "--out", "figures_bare", **self.environment)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("install python3-matplotlib", done.stderr)

    def check_python(self, python, message):
        """Results are kept without figures, and the message says why; for figures alone it is an error."""
        environment = {**os.environ, "MCDEM_PYTHON": python}
        done = mcdem.run("run", "scene.toml", "--out", "run_alone", **environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(message, done.stderr)
        done = mcdem.run("figures", "run", "--out", "figures_bare", **environment)
        self.assertEqual(done.returncode, 1, done.stderr)
        shutil.rmtree(folder / "run_alone")

    def test_no_python(self):
        self.check_python("/nowhere/python3", "/nowhere/python3: cannot be started")

    def test_a_python_that_fails_without_a_message_is_reported(self):
        self.check_python("/bin/false", "no table and no figures: ")


if __name__ == "__main__":
    drawn.main()
