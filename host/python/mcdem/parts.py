"""Work that is divided into parts, which any process can compute in any order (host/ensemble/README.md): options, and what they do."""
import argparse
import contextlib
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any, Protocol

from .commands.command_line import whole_in
from .errors import DeviceError, RunError
from .look import Path
from .program import end_at_once, handle_signals, message_of, raise_when_interrupted, say
from .progress import Progress

MAX_TRIES = 3  # passes in which no part is finished
MAX_SHARES = 1_000_000
MAX_WORKERS = 100_000
GO_ON = "run the same command again to continue"


class PartedWork(Protocol):
    """Parts are deterministic, and their results are moved into place by a rename: if two processes compute the same part, the results
    are bit-identical. Parts are not claimed; scheduling is left to the caller."""

    def count(self) -> int:
        """Number of all parts."""

    def missing(self) -> list[int]:
        """Numbers of the missing parts that can be computed now, from 0; empty when all are computed."""

    def compute(self, part: int, progress: Callable[[float], object]) -> None:
        """Computes a part, unless a complete one exists. `progress` is told the completed fraction of the part. Raises InputError,
        RunError, KeyboardInterrupt."""

    def merge(self) -> bool:
        """Merges the parts when none is missing. Returns False if one is damaged; it is then missing again."""


@dataclass(frozen=True)
class Share:
    """The parts k with k % of == number - 1."""
    number: int
    of: int


@dataclass(frozen=True)
class SharedWork:
    """The work of a command in the folder `out`."""
    out: Path
    # Starts or continues the work for a number of expected workers. The context holds the lock on the folder. Raises InputError if the
    # content of the folder, or another program that uses it, is incompatible.
    begin: Callable[[int], AbstractContextManager[PartedWork]]
    report: Callable[[], int]  # called after the merge, without the lock: reports to the user, returns the exit code


def share_of(text: str) -> Share:
    """Of I/N, as in 3/8."""
    found = re.fullmatch(r"(\d{1,9})/(\d{1,9})", text, re.ASCII)
    share = Share(*map(int, found.groups())) if found else None
    if not share or not 1 <= share.number <= share.of <= MAX_SHARES:
        raise argparse.ArgumentTypeError(f"must be I/N, the I-th of N shares of the parts, as in 3/8; got '{text}'")
    return share


def one_device(text: str) -> str:
    if text == "all":
        raise argparse.ArgumentTypeError("start the command by `mcdem distribute`, which uses every device of one kind, as in: "
                                         "mcdem distribute run ..")
    return text


class Replaced(argparse.Action):
    """An option of earlier versions, whose use ends with the remedy."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        parser.error(f"{self.option_strings[0]}: start one process per task with --part I/N, then one with --merge, or use "
                     "`mcdem distribute` (host/ensemble/README.md)")


def add_sharing_options(parser: argparse.ArgumentParser) -> None:
    """Adds --part, --missing, --merge and --workers, and --device with its meaning here."""
    parser.add_argument("--device", metavar="DEVICE", type=one_device, default="",
                        help="Number or part of the name of a device, as `mcdem devices` lists them")
    group = parser.add_argument_group("Many devices and nodes")
    one_of = group.add_mutually_exclusive_group()
    one_of.add_argument("--part", metavar="I/N", type=share_of,
                        help="Compute only the I-th of N shares of the work: one process each, anywhere")
    one_of.add_argument("--missing", action="store_true", help="List the parts that can be computed now, as --part takes them")
    one_of.add_argument("--merge", action="store_true", help="Merge the parts, or report how many are missing")
    group.add_argument("--workers", metavar="N", type=whole_in(1, MAX_WORKERS),
                       help="Number of processes among which the work is divided; default: N of --part")
    for name in ("--mpi", "--slurm"):
        parser.add_argument(name, action=Replaced, nargs=0, help=argparse.SUPPRESS)


def is_shared(options: argparse.Namespace) -> bool:
    """Whether the command line requests work in parts."""
    return bool(options.part or options.missing or options.merge)


@contextlib.contextmanager
def interruptible(kept: str = GO_ON) -> Iterator[None]:
    """Work that a signal ends with KeyboardInterrupt; `kept` tells what then remains. Imports must have been done before."""
    raise_when_interrupted()
    try:
        yield
    except KeyboardInterrupt:
        say(f"interrupted; {kept}")
        raise
    finally:
        handle_signals(end_at_once)


def share(work: SharedWork, options: argparse.Namespace) -> int:
    """Computes a share, lists what is missing, or merges, as the options say; otherwise computes all that is missing and merges.
    Returns the exit code."""
    workers = max(options.workers or 1, options.part.of if options.part else 1)
    with work.begin(workers) as parts:
        if options.missing:
            for part in parts.missing():
                print(f"{part + 1}/{parts.count()}")
            return 0
        code = _compute_or_merge(work, parts, options)
    return work.report() if code is None else code


def _compute_or_merge(work: SharedWork, parts: PartedWork, options: argparse.Namespace) -> int | None:
    """None: everything is merged and must be reported."""
    kept = f"results are kept in {work.out}; "
    try:
        with interruptible(kept + GO_ON):
            if options.part:
                return _compute_share(work, parts, options.part)
            if options.merge:
                return _merge_only(work, parts)
            _compute_until_done(work, parts, lambda: _left_to_compute(parts))
            return None
    except DeviceError as error:
        say(message_of(error))
        say(f"{kept}{GO_ON}")
        return 1


def _compute_share(work: SharedWork, parts: PartedWork, own: Share) -> int:
    _compute_until_done(work, parts, lambda: [part for part in parts.missing() if part % own.of == own.number - 1])
    if others := parts.missing():
        say(f"share {own.number}/{own.of} is done; parts that are still missing: {len(others)} of {parts.count()}")
    return 0


def _merge_only(work: SharedWork, parts: PartedWork) -> int | None:
    left = _left_to_compute(parts)
    if not left:
        return None
    verb, them = ("is", "it") if len(left) == 1 else ("are", "them")
    say(f"{work.out}: {len(left)} of {parts.count()} parts {verb} missing; the command without --merge computes {them}")
    return 1


def _left_to_compute(parts: PartedWork) -> list[int]:
    """The missing parts. If none is missing they are merged; the result is empty after the merge. A damaged part counts as missing."""
    while not (left := parts.missing()) and not parts.merge():
        pass
    return left


def _compute_until_done(work: SharedWork, parts: PartedWork, left: Callable[[], list[int]]) -> None:
    """Computes what `left` returns until that is nothing."""
    before, tries = list[int](), 0
    while now := left():
        tries = tries + 1 if now == before else 0
        if tries == MAX_TRIES:
            raise RunError(f"{work.out}: no part could be finished: fix the errors above first")
        _compute(parts, now)
        before = now


def _compute(parts: PartedWork, numbers: Sequence[int]) -> None:
    with Progress() as progress:
        def after(done: int) -> Callable[[float], None]:
            return lambda fraction: progress.show((done + fraction) / len(numbers))

        for done, part in enumerate(numbers):
            parts.compute(part, after(done))
