"""Experiments for the compiled module."""
from dataclasses import asdict

from .. import _engine
from .experiment import Experiment


def engine_experiment(experiment: Experiment) -> _engine.Experiment:
    """The same measurements as the compiled module has them (host/experiment/experiment.h)."""
    recording, scans = experiment.recording, experiment.recording.scans
    columns = ("cycle", "phase", "time", "plate_z", "wall_force", "coordination_number", "mean_force", "branch_length", "position")
    fields = {name: getattr(scans, name) for name in columns} | {
        "name": experiment.name.encode(errors="replace").decode(), "parameters": recording.parameters, "shape": recording.box.shape.value,
        "size": (recording.box.size_x, recording.box.size_y), "plate_start": recording.plate_start,
        "diameter": recording.diameter.tolist(),
        "contacts": [(one.grain, one.partner, one.point, one.force) for one in scans.contacts],
        "materials": experiment.materials, "uncertainty": experiment.uncertainty, "measurement": asdict(experiment.measurement),
        "plate_speed": experiment.plate_speed, "plate_pause": experiment.plate_pause, "plate_hold": experiment.plate_hold}
    return _engine.Experiment(fields)
