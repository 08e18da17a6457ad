"""A small experiment folder as texts, so that a test can change one line."""
import pathlib
import shutil
import tempfile
import unittest

from mcdem.errors import InputError
from mcdem.experiment.read import read_experiment
from mcdem.experiment.table import LARGEST_TABLE

# Two grains side by side on the floor of a box 40 mm wide, compressed by the plate in three frames.
SMALL = {
    "experiment.toml": """name = "two grains"
[box]
size = [0.04, 0.03]
[grains]
youngs_modulus = 23300.0
poisson_ratio = 0.5
friction = 0.03
[walls]
youngs_modulus = 50e6
[uncertainty]
youngs_modulus = 500.0
walls.youngs_modulus = 1e6
[measurement]
position_error = 1e-4
force_threshold = 0.005
""",
    "plate.csv": """frame,cycle,phase,plate_z_m,top_force_N
0,0,load,0.022,0
1,0,load,0.019,0.4
2,0,unload,0.021,0.01
""",
    "grains.csv": """frame,grain,x_m,y_m,z_m,diameter_m
0,0,0.01,0.015,0.01,0.02
0,1,0.03,0.015,0.01,0.02
1,0,0.0095,0.015,0.0095,0.02
1,1,0.0305,0.015,0.0095,0.02
""",
    "contacts.csv": """frame,grain,partner,x_m,y_m,z_m,fx_N,fy_N,fz_N
1,1,0,0.02,0.015,0.0095,0.03,0,0.04
1,0,floor,0.0095,0.015,0,0,0,0.2
1,1,floor,0.0305,0.015,0,0,0,0.3
1,0,plate,0.0095,0.015,0.019,0,0,-0.2
1,0,x_min,0,0.015,0.0095,0.004,0,0
"""}
# Down to 19 mm and a hold there, then up to 0.1 N and a hold there.
STAGES = """[plate]
start = 0.022
[[programme]]
position = 0.019
[[programme]]
stage = "hold"
time = 2.0
scan_at = [0.5, 2.0]
[[programme]]
force = 0.1
[[programme]]
stage = "hold"
keep = "force"
time = 4
"""
TABLES = ("plate.csv", "grains.csv", "contacts.csv")


class FolderCase(unittest.TestCase):
    def setUp(self):
        self.place = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="mcdem-test-")))
        self.folder = self.place / "lab"
        self.texts = dict(SMALL)

    def replace(self, name, old, new):
        """The first `old` in a file."""
        self.assertIn(old, self.texts[name])
        self.texts[name] = self.texts[name].replace(old, new, 1)

    def write(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir()
        for name, text in self.texts.items():
            (self.folder / name).write_bytes(text if isinstance(text, bytes) else text.encode())

    def read(self):
        self.write()
        return read_experiment(self.folder)

    def problems(self):
        """Of the texts, without the folder's path; none if they are read."""
        self.write()
        return self.problems_there()

    def problems_there(self, largest=LARGEST_TABLE):
        """Of the files that are in the folder."""
        try:
            read_experiment(self.folder, largest)
        except InputError as error:
            return [problem.replace(f"{self.folder}/", "") for problem in error.problems]
        return []
