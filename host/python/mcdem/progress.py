"""Progress and remaining time on standard error: a bar on a terminal, otherwise lines of text (as host/cli/shell/progress.h)."""
import contextlib
import os
import sys
import time
from collections.abc import Callable

from .program import say

BAR_INTERVAL = 0.1  # between two drawings of the bar [s]
LINE_INTERVAL = 10  # a line is printed at least this often [s],
LINE_STEP = 0.1  # or after this much progress,
SHORTEST_INTERVAL = 1  # but not more often than this [s]
LONGEST_BAR = 50  # characters


def duration_text(seconds: float) -> str:
    """42 s, 3 min 20 s, 2 h 05 min."""
    s = int(seconds + 0.5)
    if s < 60:
        return f"{s} s"
    return f"{s // 60} min {s % 60:02} s" if s < 3600 else f"{s // 3600} h {s % 3600 // 60:02} min"


def has_bar() -> bool:
    """Whether standard error is a terminal that can redraw its line."""
    return sys.stderr.isatty() and os.environ.get("TERM", "dumb") != "dumb"


class Progress:
    """The completed fraction of some work. Draws only when enough has changed."""

    def __init__(self, is_bar: bool | None = None, now: Callable[[], float] = time.monotonic) -> None:
        self._is_bar, self._now = has_bar() if is_bar is None else is_bar, now
        self._first: tuple[float, float] | None = None  # time and fraction: a resumed run does not start at 0
        self._last: tuple[float, float] | None = None  # of the last drawing
        self._is_drawn = False

    def __enter__(self) -> "Progress":
        return self

    def __exit__(self, *_: object) -> None:
        self.clear()

    def show(self, fraction: float) -> None:
        moment = self._now(), min(1.0, max(0.0, fraction))
        if not self._first:
            self._first = moment
            if not self._is_bar:
                self._last = moment  # nothing to report yet
        if not self._is_due(*moment):
            return
        self._last = moment
        text = f"{int(100 * moment[1])} %"
        if self._is_bar:
            self._draw(moment[1], f" {text:>5}{self._time_left(*moment)}")
        else:
            say(f"{text} done{self._time_left(*moment)}")

    def clear(self) -> None:
        """Removes the bar before other output; the next show() draws it again."""
        if self._is_drawn:
            self._write("\r\033[K")
            self._is_drawn = False

    def _is_due(self, now: float, fraction: float) -> bool:
        if not self._last:
            return True
        waited, moved = now - self._last[0], fraction - self._last[1]
        if self._is_bar:
            return waited >= BAR_INTERVAL
        return waited >= LINE_INTERVAL or (moved >= LINE_STEP and waited >= SHORTEST_INTERVAL)

    def _time_left(self, now: float, fraction: float) -> str:
        """Estimate from the speed since the start; empty while it is too uncertain."""
        assert self._first
        seconds, done = now - self._first[0], fraction - self._first[1]
        return f", {duration_text(seconds * (1 - fraction) / done)} left" if done >= 0.005 and seconds >= 1 else ""

    def _draw(self, fraction: float, text: str) -> None:
        width = min(LONGEST_BAR, max(0, _columns() - len(text) - 3))
        full = int(fraction * width)
        self._write(f"\r[{'#' * full}{'-' * (width - full)}]{text}\033[K")  # \033[K: clears the rest of the line
        self._is_drawn = True

    @staticmethod
    def _write(text: str) -> None:
        """With control characters, which the stream itself replaces (program.Shown)."""
        with contextlib.suppress(OSError):
            sys.stderr.flush()
            sys.stderr.buffer.write(text.encode())
            sys.stderr.buffer.flush()


class StageProgress:
    """Progress of work in several named stages, one after the other."""

    def __init__(self) -> None:
        self._stage = ""
        self._progress = Progress()

    def __enter__(self) -> "StageProgress":
        return self

    def __exit__(self, *_: object) -> None:
        self.clear()

    def show(self, stage: str, fraction: float) -> None:
        if stage != self._stage:
            self.clear()
            say(stage)
            self._stage, self._progress = stage, Progress()
        self._progress.show(fraction)

    def clear(self) -> None:
        self._progress.clear()


def _columns() -> int:
    try:
        return os.get_terminal_size(sys.stderr.fileno()).columns or 80
    except (OSError, ValueError):
        return 80
