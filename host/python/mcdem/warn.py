"""Warnings to users of the package."""
import sys
import warnings


def warn_user(text: str) -> None:
    """A RuntimeWarning that names the line of the user that called the package."""
    warnings.warn(text, RuntimeWarning, stacklevel=_levels_up_to_the_user())


def _levels_up_to_the_user() -> int:
    """From the caller of this function."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back and frame.f_globals.get("__name__", "").startswith(f"{__package__}."):
        level, frame = level + 1, frame.f_back
    return level
