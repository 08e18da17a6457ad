"""The progress of long commands, with an artificial clock."""
import contextlib
import io
import re
import sys
import unittest
from collections.abc import Iterator

from mcdem.progress import Progress, StageProgress, duration_text


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


@contextlib.contextmanager
def told() -> Iterator[list[str]]:
    """What is written to standard error, as one text when the context ends."""
    kept, texts = sys.stderr, list[str]()
    raw = io.BytesIO()
    sys.stderr = io.TextIOWrapper(raw, newline="")
    try:
        yield texts
    finally:
        sys.stderr.flush()
        texts.append(raw.getvalue().decode())
        sys.stderr = kept


class Lines(unittest.TestCase):
    def shown(self, *moments: tuple[float, float]) -> list[str]:
        """Lines after these times and fractions."""
        clock = Clock()
        with told() as texts, Progress(False, clock) as progress:
            for clock.now, fraction in moments:
                progress.show(fraction)
        return texts[0].splitlines()

    def test_appear_every_tenth_or_ten_seconds(self) -> None:
        lines = self.shown(*((0.02 * k, k / 1000 + 1e-9) for k in range(1000)))
        self.assertEqual(lines[:2], ["mcdem: 10 % done, 18 s left", "mcdem: 20 % done, 16 s left"])
        self.assertEqual(len(lines), 9)  # the tenth would coincide with the end

    def test_slow_work_is_reported_and_fast_work_is_not_verbose(self) -> None:
        slow = self.shown(*((k, k / 1000) for k in range(31)))
        self.assertEqual((slow[0], len(slow)), ("mcdem: 1 % done, 16 min 30 s left", 3))
        self.assertEqual(self.shown(*((0, k / 100) for k in range(101))), [])

    def test_time_left_of_resumed_work_counts_from_its_start(self) -> None:
        self.assertEqual(self.shown((0, 0.5), (10, 0.6)), ["mcdem: 60 % done, 40 s left"])

    def test_stages_are_named_once(self) -> None:
        with told() as texts, StageProgress() as stages:
            for stage, fraction in (("library", 0.1), ("library", 1), ("baseline", 0.5)):
                stages.show(stage, fraction)
        self.assertEqual(texts[0], "mcdem: library\nmcdem: baseline\n")


class Bar(unittest.TestCase):
    def test_is_redrawn_and_removed(self) -> None:
        clock = Clock()
        with told() as texts, Progress(True, clock) as progress:
            progress.show(0)
            progress.show(0.001)  # too soon
            clock.now = 2
            progress.show(0.5)
        self.assertTrue(re.fullmatch(r"\r\[-+\]   0 %\x1b\[K\r\[(#+)(-+)\]  50 %, 2 s left\x1b\[K\r\x1b\[K", texts[0]), repr(texts[0]))


class Duration(unittest.TestCase):
    def test_has_at_most_two_units(self) -> None:
        for seconds, text in ((0.4, "0 s"), (59.4, "59 s"), (60, "1 min 00 s"), (3725, "1 h 02 min")):
            self.assertEqual(duration_text(seconds), text)


if __name__ == "__main__":
    unittest.main()
