"""Work in parts: what --part, --missing and --merge do, the manifest and the lock of its folder."""
import argparse
import contextlib
import io
import json
import os
import pathlib
import signal
import tempfile
import unittest
from collections.abc import Callable, Iterator

from mcdem import parts
from mcdem.errors import DeviceError, InputError, RunError
from mcdem.manifest import keep_manifest, read_manifest
from mcdem.outputs import output_folder


class Work:
    """Parts that are numbers; `fails` raises in a part, `damaged` ones are lost once when they are merged."""

    def __init__(self, count: int, damaged: tuple[int, ...] = (), fails: Callable[[int], None] = lambda part: None) -> None:
        self.done: list[int] = []
        self.order: list[int] = []
        self.is_locked = False
        self._count, self._damaged, self._fails = count, set(damaged), fails

    def count(self) -> int:
        return self._count

    def missing(self) -> list[int]:
        return [part for part in range(self._count) if part not in self.done]

    def compute(self, part: int, progress: Callable[[float], object]) -> None:
        assert self.is_locked
        self._fails(part)
        progress(1)
        self.order.append(part)
        self.done.append(part)

    def merge(self) -> bool:
        lost, self._damaged = self._damaged, set()
        self.done = [part for part in self.done if part not in lost]
        return not lost

    @contextlib.contextmanager
    def begin(self, workers: int) -> Iterator["Work"]:
        self.workers, self.is_locked = workers, True
        yield self
        self.is_locked = False


def interrupted(part: int) -> None:
    if part == 1:
        signal.raise_signal(signal.SIGTERM)


def failing(part: int) -> None:
    raise DeviceError("OpenCL: clFinish failed")


class Sharing(unittest.TestCase):
    def share(self, work: Work, *words: str) -> tuple[int, str, str]:
        """Exit code, output and messages."""
        parser = argparse.ArgumentParser()
        parts.add_sharing_options(parser)

        def report() -> int:
            self.assertFalse(work.is_locked)
            print("reported")
            return 0

        self.messages = io.StringIO()
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(self.messages):
            code = parts.share(parts.SharedWork("out", work.begin, report), parser.parse_args(words))
        return code, out.getvalue(), self.messages.getvalue()

    def test_shares_and_a_merge_are_the_whole_work(self) -> None:
        work = Work(5)
        self.assertEqual(self.share(work, "--missing"), (0, "1/5\n2/5\n3/5\n4/5\n5/5\n", ""))
        self.assertEqual(self.share(work, "--part", "2/2"),
                         (0, "", "mcdem: share 2/2 is done; parts that are still missing: 3 of 5\n"))
        self.assertEqual((work.order, work.workers), ([1, 3], 2))
        self.assertEqual(self.share(work, "--merge"),
                         (1, "", "mcdem: out: 3 of 5 parts are missing; the command without --merge computes them\n"))
        self.assertEqual(self.share(work, "--part", "1/2", "--workers", "7"), (0, "", ""))
        self.assertEqual((work.order, work.workers), ([1, 3, 0, 2, 4], 7))
        self.assertEqual(self.share(work, "--missing"), (0, "", ""))
        self.assertEqual(self.share(work, "--merge"), (0, "reported\n", ""))

    def test_one_process_computes_and_merges_all(self) -> None:
        self.assertEqual(self.share(Work(3)), (0, "reported\n", ""))

    def test_a_damaged_part_is_computed_again(self) -> None:
        work = Work(3, damaged=(1,))
        self.assertEqual(self.share(work), (0, "reported\n", ""))
        self.assertEqual(work.order, [0, 1, 2, 1])
        work = Work(1, damaged=(0,))
        work.done = [0]
        self.assertEqual(self.share(work, "--merge")[0], 1)

    def test_a_signal_ends_it_and_the_same_command_continues(self) -> None:
        work = Work(3, fails=interrupted)
        with self.assertRaises(KeyboardInterrupt):
            self.share(work)
        self.assertEqual(work.order, [0])
        self.assertEqual(self.messages.getvalue(), "mcdem: interrupted; results are kept in out; run the same command again to continue\n")

    def test_a_device_that_fails_costs_no_results(self) -> None:
        code, _, messages = self.share(Work(2, fails=failing))
        self.assertEqual((code, messages.splitlines()), (1, ["mcdem: OpenCL: clFinish failed",
                                                             "mcdem: results are kept in out; run the same command again to continue"]))

    def test_gives_up_when_no_part_is_finished(self) -> None:
        work = Work(2)
        work.compute = lambda part, progress: work.order.append(part)  # type: ignore[method-assign]
        with self.assertRaisesRegex(RunError, "out: no part could be finished: fix the errors above first"):
            self.share(work)
        self.assertEqual(len(work.order), 2 * parts.MAX_TRIES)


class Options(unittest.TestCase):
    def test_refused(self) -> None:
        shares = ("3", "0/8", "9/8", "1/", "/8", "1/8x", "-1/8", "1/99999999999999999999", "1/1000001")
        cases = [([f"--part={text}"], f"must be I/N, the I-th of N shares of the parts, as in 3/8; got '{text}'") for text in shares]
        cases += [([how], "start one process per task with --part I/N") for how in ("--mpi", "--slurm")]
        cases += [(["--device", "all"], "mcdem distribute run"), (["--part", "1/2", "--merge"], "--part"),
                  (["--missing", "--merge"], "--missing"), (["--workers", "0"], "from 1 to 100000")]
        for words, problem in cases:
            parser = argparse.ArgumentParser()
            parts.add_sharing_options(parser)
            with self.subTest(words), self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()) as messages:
                parser.parse_args(words)
            self.assertIn(problem, messages.getvalue())


class InAFolder(unittest.TestCase):
    def setUp(self) -> None:
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)


class Manifest(InAFolder):
    def setUp(self) -> None:
        super().setUp()
        self.file = self.folder / "manifest.json"

    def test_is_written_once_and_compared(self) -> None:
        wanted = {"scene": "é", "program": "1", "device": "a"}
        self.assertIsNone(read_manifest(self.file))
        self.assertEqual(keep_manifest(self.file, wanted), wanted)
        self.assertEqual(self.file.read_bytes().decode(), '{\n "device": "a",\n "program": "1",\n "scene": "é"\n}\n')
        self.assertEqual(keep_manifest(self.file, wanted), wanted)
        self.assertEqual(keep_manifest(self.file, wanted | {"device": "b"}, chosen="device"), wanted)
        with self.assertRaises(InputError) as refused:
            keep_manifest(self.file, {"program": "2", "device": "b", "seed": "1"})
        self.assertEqual([problem.removeprefix(f"{self.folder}: was begun with another ") for problem in refused.exception.problems],
                         [f"{text}: give the same, or another folder" for text in ("device: a; got b", "program: 1; got 2", "seed: ; got 1")])
        self.assertEqual(read_manifest(self.file), wanted)

    def test_that_is_damaged_is_refused(self) -> None:
        for content in (b"", b"{", b"[]", b"{}", b'{"a": 1}', b'{"a": "\xff"}', b"[" * 100_000):
            self.file.write_bytes(content)
            self.assertIsNone(read_manifest(self.file), content[:9])
            with self.assertRaisesRegex(InputError, "manifest.json: is damaged"):
                keep_manifest(self.file, {"a": "1"})
            self.assertEqual(self.file.read_bytes(), content)
        self.assertEqual(os.listdir(self.folder), ["manifest.json"])

    def test_keeps_what_json_would_escape(self) -> None:
        odd = {'a"\n': "\\ \x01"}
        keep_manifest(self.file, odd)
        self.assertEqual((read_manifest(self.file), json.loads(self.file.read_bytes())), (odd, odd))


class Lock(InAFolder):
    def test_is_alone_or_shared(self) -> None:
        alone, not_shared, shared = ("another program is writing there: wait for it", "writing there alone, which cannot be shared",
                                     "other programs share work there: wait for them")
        for first, second, problem in ((False, False, alone), (False, True, not_shared), (True, False, shared), (True, True, None)):
            with self.subTest(f"{first}, {second}"), output_folder(self.folder, first), \
                    contextlib.nullcontext() if problem is None else self.assertRaisesRegex(InputError, problem), \
                    output_folder(self.folder, second):
                self.assertIsNone(problem)


if __name__ == "__main__":
    unittest.main()
