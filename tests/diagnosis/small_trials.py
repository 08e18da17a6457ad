"""Trials that run quickly: 18 grains, three scans."""
import functools
import pathlib
import tempfile

import numpy as np

from mcdem import _engine as engine
from mcdem.diagnosis.model import Model
from mcdem.diagnosis.plan import Packing, Plan
from mcdem.diagnosis.trials import Comparison, ObservationStore, Observer, Trial
from mcdem.experiment.experiment import Experiment, Measurement
from mcdem.experiment.instrument import Instrument
from mcdem.observe.grid import Grid

TEXT = """name = "small"
[box]
size_x = 0.06
size_y = 0.06
[packing]
count = 18
packing_fraction = 0.52
[plate]
start = 0.06
end = 0.05
[protocol]
scans_per_stroke = 3
stop_at_scans = false
rate_tolerance = 0
settle_time = 0.02
relax_time = 0.02
[contact]
model = "independent"
friction_law = "saturated"
"""
MEASUREMENT = Measurement(1e-5, 1e-5, 0.01, 1e-4)


def scene(**settings):
    """`settings`: keys with __ for the dot."""
    return engine.Scene.parse(TEXT, set={key.replace("__", "."): value for key, value in settings.items()})


def model(**settings):
    return Model(scene(**settings), {}, Instrument(MEASUREMENT), 0.0215)


@functools.cache
def packing():
    return engine.make_packings(scene())[0]


@functools.cache
def device():
    return engine.Device()


class Small:
    """Trials of one model with a store of their own in a temporary folder."""

    def __init__(self, test):
        kept = tempfile.TemporaryDirectory(prefix="mcdem-trials-")
        test.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name) / "simulations"
        self.store, self.model = ObservationStore(self.folder), model()
        self.comparison = Comparison(Grid([0.0066, 0.0098], 0.005, 0.01), self.model.material(), 0)

    def trial(self, seed=1, model=None):
        return Trial(model or self.model, packing(), 1e-5, 1e-5, seed)

    def observer(self, comparison=None):
        return Observer(device().description, self.store, comparison or self.comparison, device())

    def observe(self, *trials, comparison=None, **how):
        return self.observer(comparison).observe(trials, **how)

    def files(self):
        return len(list(self.folder.iterdir()))

    def plan(self, **more):
        """Of an experiment of which only the measurement counts."""
        facts = dict(experiments=[Experiment("x", None, measurement=MEASUREMENT)], packings=[Packing(self.model, [packing()])], comparison=self.comparison,
                     candidates=[], hindered=[], nuisances=[], replicates=3, pairs=2, seed=1)
        return Plan(**facts | more)


def mirrored():
    """The same grains with x from the other side."""
    made = engine.simulate_starts(device(), [(scene(protocol__scan_at_start=True), packing(), 0, 0, 1)], scans=1)
    position = np.array(next(iter(made)).positions(0))
    position[:, 0] = 0.06 - position[:, 0]
    return engine.Packing(position, packing().diameter)
