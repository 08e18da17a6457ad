"""Reads drawn figures back from axes and files; shared by the tests of figures."""
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

import numpy as np

TESTS = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(TESTS), str(TESTS.parent / "host/python")]
import matplotlib  # noqa: E402

matplotlib.use("agg")
from mcdem import figures  # noqa: E402

KINDS = ("pdf", "png", "svg")
MILLIMETRE = 1 / 25.4


class Program:
    def __init__(self, file, folder):
        self.file, self.folder = pathlib.Path(file).resolve(), pathlib.Path(folder)

    def run(self, *words, **environment):
        return subprocess.run([self.file, *words], cwd=self.folder, capture_output=True, text=True, timeout=500, env=environment or None)

    def __call__(self, *words):
        done = self.run(*words)
        assert done.returncode == 0, (words, done.stdout, done.stderr)
        return done.stdout


def lines_of(axes, colour, linestyle):
    """x and y of the nonempty lines with this colour and style; for markers, linestyle is "None"."""
    return [line.get_xydata().T for line in axes.lines
            if line.get_color() == colour and line.get_linestyle() == linestyle and len(line.get_xdata())]


def bars_of(axes, colour):
    """Ends of vertical error bars: x, low and high."""
    found = []
    for bars in axes.collections:
        if isinstance(bars, matplotlib.collections.LineCollection) and matplotlib.colors.same_color(bars.get_color(), colour):
            found += [(ends[0][0], ends[0][1], ends[1][1]) for ends in bars.get_segments()]
    return np.array(found).T


def bands_of(axes, colour):
    """Corner points of the bands with this colour."""
    return [band.get_paths()[0].vertices for band in axes.collections
            if isinstance(band, matplotlib.collections.PolyCollection)
            and matplotlib.colors.same_color(band.get_facecolor()[0][:3], colour)]


def words_of(axes):
    """Labels of the key, from top to bottom."""
    return [text.get_text() for text in axes.get_legend().get_texts()]


def texts_of_svg(file):
    return ["".join(text.itertext()) for text in xml.etree.ElementTree.parse(file).iter("{http://www.w3.org/2000/svg}text")]


def main():
    """Runs the tests of the calling module with the program named on the command line."""
    import unittest
    test = sys.modules["__main__"]
    test.PROGRAM = sys.argv.pop(1)
    unittest.main(test, verbosity=2)
