"""A simulation as an experiment: what an instrument reads of one replica of a run (host/python/mcdem/experiment/README.md)."""
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..errors import InputError
from ..number_text import shortest
from ..problems import to_number
from ..program import say
from ..results.engine_run import run_of
from ..results.parameters import value_of
from ..results.recording import NO_CONTACTS, NO_VECTORS, Recording, Run
from .experiment import MATERIALS, UNCERTAIN, Experiment, Measurement
from .instrument import Instrument, measured
from .plate import scan_places
from .publish import expect_free, publish, read_back, work_folder
from .write import SUMS_FILE, experiment_files, sums_text, write_files

MEASURED = ("plate", "grains", "all")  # the plate; and diameters and positions of grains; and the forces of contacts
PART_OF_A_GRAIN = 8  # errors are at most this part of the smallest diameter: with larger ones the result could not be read back


@dataclass(frozen=True)
class Options:
    run: str  # result folder or file
    out: str
    replica: str  # label or number; empty: the only one
    name: str  # of the experiment; empty: that of the run and the replica
    instrument: Instrument
    uncertainty: Sequence[str]  # "grains.youngs_modulus=500" [unit of the key]
    seed: int  # of the noise
    gzip: bool
    measure: str = "all"  # one of MEASURED

    @property
    def measurement(self) -> Measurement:
        return self.instrument.stated


def write_from_run(options: Options) -> str:
    """Writes the experiment and returns a summary. Raises InputError, RunError, OSError."""
    from .. import _engine
    expect_free(options.out)
    uncertainty = read_uncertainty(options.uncertainty)
    try:
        labels = [one.label for one in _engine.read(options.run, what="observables")]
        run = _engine.read_replica(options.run, chosen_replica(labels, options))
        truth = _whole_recording(run_of(run), options)
    except UnicodeDecodeError as error:
        raise InputError(f"{options.run}: holds a text that is not UTF-8 ({error.reason})") from error
    expect_measurable(truth, options)
    seen = measured(truth, options.instrument, options.seed)
    stated = experiment_from(seen, options.measurement, options.measure)
    experiment = replace(stated, uncertainty=uncertainty, name=options.name or stated.name)
    _write(experiment, options)
    contacts, listed = (sum(map(len, one.scans.contacts)) for one in (truth, experiment.recording))
    return (f"{options.out}: {len(truth.scans)} frames, {len(experiment.recording.diameter)} grains, {listed} of {contacts} contacts "
            "seen")


def experiment_from(seen: Recording, measurement: Measurement, measure: str = "all") -> Experiment:
    """A recording as an instrument reads it, as an experiment with its label. Materials are taken from its parameters.

    `measure`: one of MEASURED. Without positions in frame 0, only the plate remains: grains and contacts then have no identity. Raises
    InputError for a cell.
    """
    if seen.box.is_cell:
        raise InputError(f"{seen.label}: container.shape must be one with a plate, got {seen.box.shape}: an experiment is a compression "
                         "by a plate")
    values = {key: to_number(value_of(seen.parameters, key)) for key in MATERIALS}
    materials = {key: value for key, value in values.items() if value is not None}
    scans = seen.scans
    if measure == "plate" or not seen.has_start:
        scans = replace(scans, position=(NO_VECTORS,) * len(scans), contacts=(NO_CONTACTS,) * len(scans))
        seen = replace(seen, diameter=np.zeros(0), scans=scans)
    elif measure == "grains":
        seen = replace(seen, scans=replace(scans, contacts=(NO_CONTACTS,) * len(scans)))
    stated = {"plate": Measurement(), "grains": replace(measurement, force_error=0.0, force_threshold=0.0), "all": measurement}[measure]
    return Experiment(seen.label, seen, materials, measurement=stated)


def chosen_replica(labels: Sequence[str], options: Options) -> int:
    """The number of the replica that is asked for. Raises InputError."""
    wanted = options.replica
    if wanted in labels:
        return labels.index(wanted)
    if re.fullmatch(r"\+?\d{1,9}", wanted, re.ASCII) and int(wanted) < len(labels):
        return int(wanted)
    if not wanted and len(labels) == 1:
        return 0
    known = ", ".join(f"{number}: {label}" if label else f"{number}" for number, label in enumerate(labels))
    raise InputError(f"--replica: must be a number or label of {options.run}'s replicas ({known}); got {wanted or 'none'}")


def read_uncertainty(words: Sequence[str]) -> dict[str, float]:
    """From KEY=SIGMA. Raises InputError."""
    found, problems = dict[str, float](), list[str]()
    for word in words:
        key, _, number = word.partition("=")
        sigma = to_number(number)
        if key not in UNCERTAIN or sigma is None or sigma < 0:
            problems.append(f"--uncertainty: must be KEY=SIGMA with a key such as {MATERIALS[0]}, got {word}")
        else:
            found[key] = sigma
    if problems:
        raise InputError(problems)
    return found


def expect_measurable(truth: Recording, options: Options) -> None:
    """Raises InputError where an experiment of this recording could not be read back, and says what it will lack."""
    limit = truth.diameter.min() / PART_OF_A_GRAIN
    errors = {"--position-error": options.measurement.position_error, "--diameter-error": options.measurement.diameter_error}
    problems = [f"{option}: must be at most an eighth of the smallest diameter, {limit:.3g} m, got {shortest(error)}"
                for option, error in errors.items() if error > limit]
    if problems:
        raise InputError(problems)
    if truth.has_programme and not truth.box.is_cell:  # cells are refused later
        _expect_all_scans(truth)
    if truth.species_names:
        raise InputError("the run must be one of grains of one material, got one of [[species]]: experiments state one material only")
    if not truth.has_start:
        say("the run holds no positions of frame 0: grains.csv and contacts.csv are left out. Run with output.positions = true")
    elif truth.displacement[0] > 0:
        say(f"frame 0 is {1e3 * truth.displacement[0]:.3g} mm below the plate's start, not the packing at rest that a simulation should "
            "start from. Run with protocol.scan_at_start = true")


def _expect_all_scans(truth: Recording) -> None:
    """Each frame of an experiment with a programme is a scan of its stages."""
    scans, places = len(truth.scans), len(scan_places(truth))  # plus one at rest
    if scans != places + 1:
        raise InputError(f"the run must have the {places} scans of its programme and one before them, at rest, got {scans}: run it to its "
                         "end, with protocol.scan_at_start = true")


def _whole_recording(run: Run, options: Options) -> Recording:
    """The only recording, with its run's name in its label. Raises InputError."""
    found = run.recordings[0]
    truth, scans = replace(found, label=run.name + (f", {found.label}" if found.label else "")), found.scans
    if not len(truth.diameter):
        raise InputError(f"{options.run}: holds no grains of this replica")
    if not len(scans):
        raise InputError(f"{options.run}: holds no scan of this replica")
    for frame in scans.frame[~(np.isfinite(scans.top_force) & np.isfinite(scans.plate_z))].tolist():
        raise InputError(f"{options.run}: frame {frame} of this replica has a top force or plate position that is not a number")
    if truth.failure:
        say(f"{truth.label} stopped early: {truth.failure.cause}")
    return truth


def _write(experiment: Experiment, options: Options) -> None:
    """Into a folder of its own first, so that a killed call leaves no part of an experiment."""
    files = experiment_files(experiment, options.gzip)
    with work_folder(options.out) as folder:
        work = folder / "experiment"
        work.mkdir()
        write_files(work, {SUMS_FILE: sums_text(files).encode(), **files})
        # A run that was changed by others, or an instrument with extreme errors, may give data that no reader accepts.
        read_back(work, options.out, f"{options.run}: does not give a valid experiment, so nothing is written. Run the scene again, or "
                  "lower the measurement errors. Problems:")
        publish(work, options.out)
