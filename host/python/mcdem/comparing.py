"""mcdem.compare: the metrics of the paper for users of Python."""
from typing import TYPE_CHECKING, Any

from .json_text import finite
from .look import Path

if TYPE_CHECKING:
    from ._engine import Run
    from .observe.compare import Comparison
    from .results import Run as PlainRun


def compare(run: "Run | PlainRun", reference: "Run | PlainRun | Path", *, setting: str = "", discard: int = 0,
            touch_force: float | None = None) -> list[dict[str, Any]]:
    """The paper's metrics of every setting of a run against a reference, one dict per setting, as `mcdem compare` prints them.

    Rtop, errf [N], errZ, bhat and tau [N] with standard errors, None where not known. `reference`: a run, a result folder, or the
    folder of an experiment, of which the first `discard` cycles are left out; `setting` chooses one of a run's. errf leaves out the
    levels at which the reference's top force does not exceed `touch_force` [N]. Raises ValueError, RuntimeError.
    """
    from .observe import compare as metrics
    from .observe.reference import reference_setting
    from .observe.replicas import group_by_setting
    from .results.engine_run import run_of
    settings = group_by_setting(run_of(run))
    against = reference_setting(reference, setting, discard, contacts=True).replicas
    return [_values(metrics.compare(one, against, touch_force)) for one in settings]


def _values(comparison: "Comparison") -> dict[str, Any]:
    values: dict[str, Any] = {"setting": comparison.setting, "replicas": comparison.replicas}
    for name in ("Rtop", "errf", "errZ", "bhat", "tau"):
        estimate = getattr(comparison, name)
        values |= {name: finite(estimate.value), f"{name}_standard_error": finite(estimate.standard_error)}
    return values | {"notes": comparison.notes}
