"""A small run, and commands on it as a user gives them."""
import atexit
import contextlib
import functools
import io
import pathlib
import shutil
import tempfile
import unittest
from dataclasses import dataclass

import mcdem
from mcdem.commands.command_line import run_command
from mcdem.program import exit_code_of

SMALL = """name = "small"
[box]
size_x = 0.06
size_y = 0.06
[packing]
count = 30
packing_fraction = 0.5
[plate]
start = 0.088
end = 0.078
[protocol]
scans_per_stroke = 4
stop_at_scans = true
rate_tolerance = 0
settle_time = 0.02
relax_time = 0.02
[batch.vary]
"contact.model" = ["independent", "elastic_sphere"]
"""
# Instead of strokes: stages with a hold of the position, and a hold of the force at that moment.
STAGES = SMALL.replace("scans_per_stroke = 4\n", "") + """
[[programme]]
strain = 0.1
scans = 3
[[programme]]
stage = "hold"
time = 0.02
scan_at = [0.01, 0.02]
[[programme]]
force = 0.2
scans = 2
[[programme]]
stage = "hold"
keep = "force"
time = 0.02
"""
AT_REST = ("protocol.scan_at_start", True)  # starts with a scan of the packing at rest


@functools.cache
def made_run(scene, settings):
    """A result folder, made once in a process."""
    folder = tempfile.mkdtemp(prefix="mcdem-test-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    mcdem.run(mcdem.Scene.parse(scene, set=dict(settings)), folder)
    return folder


@dataclass
class Finished:
    code: int
    out: str
    err: str


def mcdem_command(*words):
    """What a command of the program does with these words."""
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
        try:
            code = run_command([str(word) for word in words])
        except SystemExit as end:
            code = end.code
        except (Exception, KeyboardInterrupt) as error:
            code = exit_code_of(error)
    return Finished(code, out.getvalue(), err.getvalue())


class CommandCase(unittest.TestCase):
    """Commands are given in a folder with small.toml."""

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="mcdem-test-")))
        self.enterContext(contextlib.chdir(self.folder))
        (self.folder / "small.toml").write_text(SMALL)

    def run_small(self, *settings, scene=SMALL):
        """A run of the small scene in the folder "a", with the settings (key, value)."""
        shutil.copytree(made_run(scene, settings), self.folder / "a", dirs_exist_ok=True)

    def done(self, *words):
        finished = mcdem_command(*words)
        self.assertEqual(finished.code, 0, finished.err)
        return finished

    def refused(self, words, *parts):
        """Bad input: all of these parts are in the messages, nothing in the output."""
        finished = mcdem_command(*words)
        self.assertEqual((finished.code, finished.out), (2, ""), finished.err)
        self.assertTrue(all(line.startswith("mcdem: ") for line in finished.err.splitlines()), finished.err)
        for part in parts:
            self.assertIn(part, finished.err)
        return finished
