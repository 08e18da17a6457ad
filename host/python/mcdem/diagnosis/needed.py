"""Whether an experiment can be diagnosed, before anything is simulated."""
from dataclasses import replace

from ..experiment.experiment import Experiment
from ..observe.observation import MIN_BINS, compared_forces
from ..results.names import Phase
from ..results.recording import NO_CONTACTS, NO_VECTORS


def needed_to_diagnose(experiment: Experiment) -> list[str]:
    """Data that `mcdem diagnose` needs and the experiment lacks, each with a remedy; empty if it can be diagnosed."""
    scans, errors, needed = experiment.recording.scans, experiment.measurement, []
    if not experiment.recording.has_start and (any(map(len, scans.position)) or any(map(len, scans.contacts))):
        needed.append("grains.csv must have the positions of frame 0, from which simulations start, as it has those of other frames or "
                      "contacts.csv has forces (a row: 0,grain,x_m,y_m,z_m,diameter_m); without any positions and contact forces the force "
                      "on the plate is compared with packings that are drawn")
    if not ((scans.phase == Phase.load) & (scans.plate_z < experiment.recording.plate_start)).any():
        needed.append("plate.csv must have loading frames below plate.start")
    else:
        needed += _missing_forces(experiment)
    if experiment.recording.has_start and not errors.position_error > 0:
        needed.append("experiment.toml must state how well positions are known: replicates of the packing are moved by it, and without it "
                      "they have no scatter to compare a gap with; add to [measurement] a line such as `position_error = 1e-4 # [m]`")
    if any(map(len, scans.contacts)) and not errors.force_error > 0:
        needed.append("experiment.toml must state how well the forces of contacts.csv are known: simulated ones are read with that error "
                      "too; add to [measurement] a line such as `force_error = 0.05 # relative`")
    return [f"{experiment.name}: {text}" for text in needed]


def _missing_forces(experiment: Experiment) -> list[str]:
    """Points of the comparison without a force on the plate."""
    recording, count = experiment.recording, len(experiment.recording.scans)
    scans = replace(recording.scans, position=(NO_VECTORS,) * count, contacts=(NO_CONTACTS,) * count)
    displacements, known = compared_forces(replace(recording, scans=scans))
    if known >= MIN_BINS:
        return []
    places = ", ".join(f"{1e3 * displacement:.3g}" for displacement in displacements)
    return [f"plate.csv must have frames with a force above 0 around {places} mm of displacement, where it is compared while loading and "
            f"unloading: {known} of these {2 * len(displacements)} places have one, and {MIN_BINS} are needed"]
