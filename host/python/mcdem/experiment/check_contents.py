"""Summary of the available data."""
from collections.abc import Iterator

import numpy as np

from ..results.names import Phase, Wall
from ..results.parameters import Parameters, without_quotes
from ..results.recording import Recording
from .container import container_words
from .experiment import Experiment
from .findings import CONTACTS, GRAINS, PLATE, SETTINGS, TOPOLOGY, Finding, Findings, contacts_of, mean_diameter, note, positions_of

SHOWN_BY = {"position": "relaxation", "force": "creep", "stress": "relaxation"}  # by a hold that keeps it


def describe(experiment: Experiment) -> Findings:
    recording = experiment.recording
    yield _plate(recording)
    yield from _programme(recording)
    if len(recording.diameter):
        smallest, mean, largest = 1e3 * recording.diameter.min(), 1e3 * mean_diameter(recording), 1e3 * recording.diameter.max()
        yield note(GRAINS, f"{len(recording.diameter)} grains of {smallest:.4g} to {largest:.4g} mm, {mean:.4g} mm on average, in "
                           f"{sum(1 for _ in positions_of(recording))} of {len(recording.scans)} frames")
    yield from _contacts(recording)
    if len(of_pairs := experiment.topology):
        frames = len(np.unique(of_pairs[:, 0]))
        ends = len(of_pairs) + int((of_pairs[:, 2] >= 0).sum())
        yield note(TOPOLOGY, f"{len(of_pairs)} contacts without forces in {frames} of {len(recording.scans)} frames, "
                             f"{ends / frames / len(recording.diameter):.3g} of each grain")
    yield from _settings(experiment)


def _plate(recording: Recording) -> Finding:
    scans = recording.scans
    loading, z, force = int((scans.phase == Phase.load).sum()), scans.plate_z, scans.top_force
    return note(PLATE, f"frames: {loading} of loading, {len(scans) - loading} of unloading, cycles {scans.cycle[0]} to {scans.cycle[-1]}; "
                       f"plate at {z.max():.6g} to {z.min():.6g} m, displacements {1e3 * recording.displacement.min():.4g} to "
                       f"{1e3 * recording.displacement.max():.4g} mm; top force {force.min():.4g} to {force.max():.4g} N")


def _stages(parameters: Parameters) -> Iterator[tuple[str, str, str]]:
    """Kind, `keep` and `time` of each stage of a programme."""
    number = 1
    while (stage := f"programme.{number}.stage") in parameters:
        keep, time = (parameters.get(f"programme.{number}.{key}", "") for key in ("keep", "time"))
        yield without_quotes(parameters[stage]), without_quotes(keep) or "position", time
        number += 1


def _programme(recording: Recording) -> Findings:
    stages = list(_stages(recording.parameters))
    if not stages:
        return
    time = recording.scans.time
    text = f"a programme of {len(stages)} stages in {time[-1] - time[0]:.4g} s"
    for kept, shown in SHOWN_BY.items():
        if times := [f"{float(time):.4g}" for kind, keep, time in stages if kind == "hold" and keep == kept]:
            text += f"; {kept} held for {', '.join(times)} s, which shows {shown}"
    yield note(PLATE, text)


def _contacts(recording: Recording) -> Findings:
    frames = [frame.contacts for frame in contacts_of(recording)]
    if not frames:
        return
    touched = {-1 - int(partner) for contacts in frames for partner in np.unique(contacts.partner[contacts.is_wall])}
    names = ", ".join(recording.box.wall_name(Wall(wall)) for wall in sorted(touched)) or "no wall"
    yield note(CONTACTS, f"{sum(map(len, frames))} contacts in {len(frames)} of {len(recording.scans)} frames, between grains and with "
                         f"{names}")
    yield note(CONTACTS, "each contact is listed once, so it cannot be checked that both sides agree")


def _settings(experiment: Experiment) -> Findings:
    errors = experiment.measurement
    yield note(SETTINGS, f"{container_words(experiment.recording.box)}; errors of {1e3 * errors.position_error:.3g} mm in positions, "
                         f"{1e3 * errors.diameter_error:.3g} mm in diameters, {100 * errors.force_error:.3g} % in forces; contacts seen "
                         f"from {1e3 * errors.force_threshold:.3g} mN on")
    sigma = {key: f" +- {value:.3g}" for key, value in experiment.uncertainty.items()}
    if known := [f"{key} = {value:.6g}{sigma.get(key, '')}" for key, value in sorted(experiment.materials.items())]:
        yield note(SETTINGS, ", ".join(known))
