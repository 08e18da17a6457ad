"""Replicas of one setting: recordings that differ only in the seed of their packing."""
import re
from collections.abc import Sequence
from dataclasses import dataclass

from ..results.names import ContactModel
from ..results.parameters import Parameters, keys_that_vary, value_of, without_quotes
from ..results.recording import Recording, Run

Replicas = Sequence[Recording]
SEED, MODEL, DISCARD, THRESHOLD = "packing.seed", "contact.model", "protocol.discard", "protocol.force_threshold"  # scene keys


@dataclass(frozen=True, eq=False)
class Setting:
    """`label` distinguishes it from the run's other settings: "mc_dem", "gamma=1.2"."""

    label: str
    replicas: Replicas


def group_by_setting(run: Run) -> list[Setting]:
    """The run's settings in order of first appearance."""
    groups: dict[frozenset[tuple[str, str]], list[Recording]] = {}
    for recording in run.recordings:
        groups.setdefault(frozenset(without_seed(recording.parameters).items()), []).append(recording)
    parameters = [without_seed(replicas[0].parameters) for replicas in groups.values()]
    varying = keys_that_vary(parameters)
    labels = [_common_label(replicas) for replicas in groups.values()]
    if "" in labels or len(set(labels)) < len(labels):
        labels = [_label_of(mine, varying) for mine in parameters]
    return [Setting(label or without_quotes(value_of(mine, MODEL)) or run.name, tuple(replicas))
            for label, mine, replicas in zip(labels, parameters, groups.values(), strict=True)]


def without_seed(parameters: Parameters) -> Parameters:
    return {key: value for key, value in parameters.items() if key != SEED}


def _common_label(replicas: Replicas) -> str:
    """Common label of all without the number of the copy " #2"; empty if labels differ."""
    labels = {re.sub(r" #[0-9]+\Z", "", one.label) if one.parameters else "" for one in replicas}
    return labels.pop() if len(labels) == 1 else ""


def _label_of(parameters: Parameters, varying: Sequence[str]) -> str:
    """ "gamma=1" for every key that varies; the model comes first."""
    model = [without_quotes(value_of(parameters, MODEL))] if MODEL in varying else []
    values = [f"{key.rpartition('.')[2]}={without_quotes(value_of(parameters, key)) or 'none'}" for key in varying if key != MODEL]
    return ", ".join([one for one in model if one] + values)


def seed_of(recording: Recording) -> str:
    """Parameter `packing.seed`; empty if unknown (measured data)."""
    return value_of(recording.parameters, SEED)


def seeds_of(replicas: Replicas) -> list[str]:
    return [seed_of(recording) for recording in replicas]


def model_of(replicas: Replicas) -> ContactModel | None:
    """Parameter `contact.model`, if it is known and the same for all."""
    models = {recording.model for recording in replicas}
    return models.pop() if len(models) == 1 else None


def discard_of(recording: Recording) -> int:
    """Parameter `protocol.discard`: number of first cycles that metrics ignore; 0 if unknown."""
    number = re.match("[0-9]+", value_of(recording.parameters, DISCARD))
    return int(number[0]) if number and int(number[0]) < 2**31 else 0
