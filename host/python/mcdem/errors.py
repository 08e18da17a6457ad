"""Errors that are reported to the user (host/core/errors.h)."""
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from . import Run

INTERRUPTED = 130  # exit code of the program


class InputError(ValueError):
    """Invalid user input (exit code 2). Contains all problems: where, what must be, what was got."""

    def __init__(self, problems: str | Sequence[str]) -> None:
        self.problems = [problems] if isinstance(problems, str) else list(problems)
        super().__init__("\n".join(self.problems))


class RunError(RuntimeError):
    """The work failed although the input was valid (exit code 1)."""

    run: "Run | None" = None  # where all replicas of a run stopped early: what they recorded until then


class DeviceError(RunError):
    """OpenCL or the device failed."""
