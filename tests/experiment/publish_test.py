"""An experiment is in the folder of --out as a whole or not at all, whatever fails or is killed. publish_test.py"""
import contextlib
import errno
import fcntl
import os
import pathlib
import re
import signal
import stat
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

from recordings import recording_of

from mcdem import files
from mcdem.errors import InputError, RunError
from mcdem.experiment import publish as published
from mcdem.experiment.experiment import Experiment
from mcdem.experiment.publish import expect_free, publish, read_back, work_folder
from mcdem.files import write_whole
from mcdem.experiment.write import experiment_files, sums_text, write_files
from mcdem.results.recording import Box

JOURNAL = ".experiment-unfinished"
NAMES = ["SHA256SUMS", "plate.csv", "experiment.toml"]  # in the order in which they are moved
# Holds a work folder for --out until it is ended.
HOLDS = """import os, signal, sys, time
from mcdem.experiment.publish import work_folder
from mcdem.program import end_at_once
signal.signal(signal.SIGTERM, end_at_once)
with work_folder(sys.argv[1]) as folder:
    print(folder, flush=True)
    time.sleep(1000)
"""


def small():
    return Experiment("small", recording_of("small", Box(0.1, 0.1), 0.1, [], plate_z=[0.1, 0.09], top_force=[0, 1]))


class Folders(unittest.TestCase):
    def setUp(self):
        self.place = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="mcdem-test-")))
        self.enterContext(contextlib.chdir(self.place))

    def publish(self, out="lab", settle=lambda work: None):
        with work_folder(out) as folder:
            work = folder / "experiment"
            work.mkdir()
            contents = experiment_files(small(), False)
            write_files(work, {"SHA256SUMS": sums_text(contents).encode(), **contents})
            settle(work)
            publish(work, out)

    def make_folder(self):
        pathlib.Path("lab").mkdir()
        pathlib.Path("lab/notes").write_text("mine")

    def expect_refused(self, problem, call, *arguments, kind=InputError):
        with self.assertRaises(kind) as refused:
            call(*arguments)
        self.assertEqual(str(refused.exception), problem)

    def expect_names(self, *names, folder="lab"):
        self.assertEqual(sorted(os.listdir(folder)), sorted(names))


class Published(Folders):
    def test_a_new_folder_appears_as_a_whole(self):
        with mock.patch("os.rename", wraps=os.rename) as rename:
            self.publish("deep/lab/")
        self.assertEqual([call.args[1].name for call in rename.call_args_list], ["lab"])
        self.expect_names(*NAMES, folder="deep/lab")
        self.expect_names("lab", folder="deep")
        self.assertEqual(stat.S_IMODE(os.stat("deep/lab").st_mode), stat.S_IMODE(os.stat("deep").st_mode))

    def test_in_a_folder_that_exists_the_settings_come_last(self):
        self.make_folder()
        with mock.patch("os.rename", wraps=os.rename) as rename:
            self.publish(settle=lambda work: self.assertEqual(work.parents[1], self.place / "lab", "the same file system"))
        self.assertEqual([call.args[1].name for call in rename.call_args_list], NAMES)
        self.expect_names("notes", *NAMES)

    def test_the_mapping_that_is_there_stays(self):
        self.make_folder()
        pathlib.Path("lab/mapping.toml").write_text("mine")
        self.publish(settle=lambda work: (work / "mapping.toml").write_text("another"))
        self.expect_names("notes", "mapping.toml", *NAMES)
        self.assertEqual(pathlib.Path("lab/mapping.toml").read_text(), "mine")

    def test_problems_name_the_files_that_would_have_been_written(self):
        with work_folder("lab") as folder:
            write_files(folder, {"experiment.toml": b"[box]\nsize = [1, 1]\n", "plate.csv": b"frame\n"})
            with self.assertRaises(InputError) as refused:
                read_back(folder, "./lab/", "Problems:")
        self.assertEqual(refused.exception.problems[0], "Problems:")
        self.assertTrue(refused.exception.problems[1].startswith("lab/plate.csv:1: the header must name "), refused.exception.problems)


class Refused(Folders):
    def test_folders_with_other_data(self):
        pathlib.Path("file").touch()
        for name in ("experiment.toml", "run.h5", "checkpoint.h5", "plate.csv", "grains.csv.gz"):
            with self.subTest(name), tempfile.TemporaryDirectory(dir=".", prefix="taken") as taken:
                out = os.path.basename(taken)
                (self.place / out / name).touch()
                other = name in ("experiment.toml", "run.h5", "checkpoint.h5")
                problem = f"--out: {out} holds another experiment or run: name another folder" if other else (
                    f"--out: {out} already contains {name}, which would become part of this experiment: choose another folder, or remove "
                    "the file first")
                self.expect_refused(problem, expect_free, out)
                with contextlib.suppress(InputError):
                    self.publish(out)
                self.expect_names(name, folder=out)
        self.expect_refused("--out: file must be a folder, got a file", expect_free, "file")
        self.expect_refused("--out: file/x/lab must be a folder, got a file in its path, file", expect_free, "file/x/lab")
        expect_free("new/folder")
        expect_free(".")

    def test_folders_that_cannot_be_made(self):
        os.symlink("nothing", "lab")
        expect_free("lab")
        with self.assertRaisesRegex(RunError, "^.*/lab: must be a folder, is a link to nothing that is there: remove it$"):
            self.publish()
        with self.assertRaisesRegex(RunError, "^/proc/nowhere: cannot be written: "):
            self.publish("/proc/nowhere")


class Failing(Folders):
    """The k-th rename, creation of a file, flush or removal fails."""

    CALLS = ("rename", "replace", "fsync", "unlink")

    @contextlib.contextmanager
    def failing(self, at):
        """Raises OSError in the call with this number; gives a list whose length is the number of calls."""
        calls = []

        def wrapped(function):
            def call(*arguments, **more):
                calls.append(function)
                if len(calls) == at:
                    raise OSError(errno.EIO, os.strerror(errno.EIO))
                return function(*arguments, **more)

            return call

        with contextlib.ExitStack() as patches:
            for name in self.CALLS:
                patches.enter_context(mock.patch(f"os.{name}", wrapped(getattr(os, name))))
            yield calls

    def check(self, before):
        with self.failing(0) as calls:
            self.publish()
        steps = len(calls)
        self.assertGreater(steps, 8)
        for step in range(1, steps + 1):
            with self.subTest(step):
                subprocess.run(["rm", "-rf", "lab"], check=True)
                before()
                kept = os.listdir("lab") if os.path.exists("lab") else []
                failed = False
                with self.failing(step):
                    try:
                        self.publish()
                    except (OSError, RunError) as error:
                        failed = True
                        self.assertIn("Input/output error", str(error))
                left = os.listdir("lab") if os.path.exists("lab") else []
                self.assertEqual(sorted(left), sorted(kept if failed else [*kept, *NAMES]))
                if failed:
                    expect_free("lab")
                    self.publish()
                    self.expect_names(*kept, *NAMES)

    def test_leaves_no_part_of_a_new_folder(self):
        self.check(lambda: None)
        self.expect_names("lab", folder=".")

    def test_leaves_no_part_in_a_folder_that_exists(self):
        subprocess.run(["rm", "-rf", "lab"], check=True)
        self.make_folder()
        self.check(self.make_folder)
        self.expect_names("lab", folder=".")

    def test_a_new_folder_that_cannot_be_made_durable_and_not_be_undone_is_named(self):
        rename = os.rename
        with mock.patch.object(published, "sync_folder", side_effect=RunError(".: cannot be written: gone")), \
             mock.patch("os.rename", side_effect=lambda old, new: rename(old, new) if new.name == "lab" else self.fail_with(OSError())):
            with self.assertRaisesRegex(RunError, "gone; the experiment is there, whole, but a power cut may remove it: check it by "
                                        "`mcdem experiment check .*/lab`$"):
                self.publish()
        self.expect_names(*NAMES)

    def test_files_that_cannot_be_removed_after_a_failure_are_named(self):
        self.make_folder()
        rename = os.rename
        with mock.patch("os.rename", side_effect=lambda old, new: self.fail_with(OSError(errno.EIO, "gone")) if new.name == "plate.csv"
                        else rename(old, new)), \
             mock.patch.object(published, "_remove_listed", side_effect=OSError("kept")), \
             self.assertRaisesRegex(RunError, r"plate\.csv: cannot be written: gone; files of it are left in .*/lab: give the same command "
                                    "again, which removes them$"):
            self.publish()
        self.expect_names("notes", "SHA256SUMS", JOURNAL)
        expect_free("lab")
        self.expect_names("notes")

    def fail_with(self, error):
        raise error


class Killed(Folders):
    def leave(self, moved):
        """What a command leaves that is killed after it has moved some files."""
        self.make_folder()
        files_ = experiment_files(small(), False)
        for name in moved:
            pathlib.Path("lab", name).write_bytes(files_[name])
        pathlib.Path("lab", JOURNAL).write_text(sums_text(files_))

    def test_what_was_moved_is_removed_by_the_next_command(self):
        for moved in ([], ["plate.csv"], ["plate.csv", "experiment.toml"]):
            self.leave(moved)
            expect_free("lab")
            self.expect_names("notes")
            self.publish()
            self.expect_names("notes", *NAMES)
            subprocess.run(["rm", "-r", "lab"], check=True)

    def test_files_of_others_are_kept(self):
        self.leave(["plate.csv"])
        with open("lab/plate.csv", "a") as table:
            table.write("changed")
        self.expect_refused("--out: lab already contains plate.csv, which would become part of this experiment: choose another folder, or "
                            "remove the file first", expect_free, "lab")
        self.expect_names("notes", "plate.csv")

    def test_a_journal_of_others_removes_nothing_else(self):
        self.make_folder()
        pathlib.Path("outside").write_bytes(b"x")
        os.symlink("../outside", "lab/link")
        sums = sums_text({name: b"x" for name in ("../outside", "/", "..", "", "link", "a\0b")})
        pathlib.Path("lab", JOURNAL).write_bytes(sums.encode() + b"\n\xff short\n" + b"0" * 64 + b"  notes\n")
        expect_free("lab")
        self.expect_names("notes", "link")
        self.assertTrue(pathlib.Path("outside").exists())

    def test_a_journal_in_use_is_left_alone(self):
        self.leave(["plate.csv"])
        descriptor = os.open("lab", os.O_RDONLY)
        self.addCleanup(os.close, descriptor)
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        self.expect_refused("lab: another program is writing there: wait for it, or give another folder", expect_free, "lab")
        self.expect_names("notes", "plate.csv", JOURNAL)

    def holder(self, out):
        process = subprocess.Popen([sys.executable, "-c", HOLDS, out], stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        self.addCleanup(process.stdout.close)
        folder = pathlib.Path(process.stdout.readline().strip())
        self.assertRegex(str(folder.relative_to(self.place)), f"^{re.escape(out)}\\.[0-9a-f]{{16}}\\.tmp$")
        self.assertEqual(stat.S_IMODE(folder.stat().st_mode), 0o700)
        return process, folder

    def test_a_work_folder_is_removed_by_the_next_command_for_the_same_folder(self):
        running, kept = self.holder("lab")
        killed, left = self.holder("lab")
        os.kill(killed.pid, signal.SIGKILL)
        killed.wait()
        self.publish("other")
        self.assertTrue(left.exists())
        self.publish()
        self.assertFalse(left.exists())
        self.assertTrue(kept.exists(), "its program is running")
        running.terminate()
        self.assertEqual(running.wait(), 130)
        self.expect_names("lab", "other", folder=".")

    def test_a_work_folder_is_known_to_those_who_end_the_command(self):
        with work_folder("lab") as folder:
            self.assertIn(folder, files.unfinished)
        self.assertNotIn(folder, files.unfinished)
        self.assertFalse(folder.exists())


class TemporaryFiles(unittest.TestCase):
    def test_one_that_another_process_took_for_abandoned_is_made_again(self):
        """Before it was locked."""
        removed = []

        def removes_the_first(out, how):
            if not removed:
                removed.append(out.name)
                os.unlink(out.name)

        with tempfile.TemporaryDirectory() as folder, mock.patch("mcdem.files.fcntl.flock", removes_the_first):
            write_whole(os.path.join(folder, "a"), b"whole")
            self.assertEqual((os.listdir(folder), len(removed)), (["a"], 1))
            self.assertEqual(pathlib.Path(folder, "a").read_bytes(), b"whole")


if __name__ == "__main__":
    unittest.main()
