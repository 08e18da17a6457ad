"""The errors that reach a user of the command line (host/core/errors.h)."""


class InputError(ValueError):
    """What the user gave is wrong (exit code 2). Carries every problem: where, what must be, what was got."""

    def __init__(self, problems):
        self.problems = [problems] if isinstance(problems, str) else list(problems)
        super().__init__("\n".join(self.problems))


class RunError(RuntimeError):
    """The work could not be done although the input was good (exit code 1)."""
