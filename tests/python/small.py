"""A small, fast scene as keyword arguments of mcdem.Scene, and tests with a folder of their own."""
import pathlib
import tempfile
import unittest

SMALL = {
    "name": "small",
    "box": {"size_x": 0.06, "size_y": 0.06},
    "packing": {"count": 30, "packing_fraction": 0.5},
    "plate": {"start": 0.088, "end": 0.078},
    "protocol": {"scans_per_stroke": 4, "settle_time": 0.02, "relax_time": 0.02},
}
MODELS = {"batch": {"vary": {"contact.model": ["independent", "elastic_sphere"]}}}


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="mcdem-python-")))
