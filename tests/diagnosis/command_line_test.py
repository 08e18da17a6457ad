"""Command lines of diagnoses: commands of two words, numbers in their ranges, what a shell completes."""
import argparse
import contextlib
import io
import math
import unittest
from unittest import mock

from mcdem.commands import COMMANDS, PROGRAM_COMMANDS
from mcdem.commands.command_line import command_of, module_of, number_in, parser_of, run_command, subcommands, whole_in
from mcdem.errors import InputError


def said_by(*words):
    """Exit code, output and messages."""
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as messages:
        try:
            code = run_command(words)
        except SystemExit as end:
            code = end.code
    return code, out.getvalue(), messages.getvalue()


class Words(unittest.TestCase):
    def test_choose_a_command_and_its_arguments(self):
        for words, command, arguments in ((["diagnose", "a", "run"], "diagnose", ["a", "run"]), (["nothing", "x"], "nothing", ["x"]),
                                          (["challenge", "run", "a"], "challenge run", ["a"]), (["challenge"], "challenge", [])):
            self.assertEqual(command_of(words), (command, arguments))

    def test_every_command_has_help_with_its_text_and_an_example(self):
        for command, about in COMMANDS.items():
            if command not in PROGRAM_COMMANDS:
                code, out, _ = said_by(*command.split(), "--help")
                self.assertEqual((code, out.splitlines()[0].split(" [-h]")[0]), (0, f"Usage: mcdem {command}"))
                self.assertIn(about, " ".join(out.split()))
                self.assertIn(f"mcdem {command} ", out.split("\noptions:\n")[1])
        for command in ("experiment", "challenge"):
            for name in subcommands(command):
                self.assertIn(f"  {name:12}{COMMANDS[f'{command} {name}']}\n", said_by(command, "-h")[1])

    def test_without_a_subcommand_are_refused(self):
        for words, problem in ((["challenge"], "A subcommand is required"), (["challenge", "win"], "there is no command win"),
                               (["experiment", "--no"], "there is no option --no")):
            code, _, messages = said_by(*words)
            self.assertEqual((code, messages), (2, f"mcdem: {problem}\nmcdem: `mcdem {words[0]} --help` tells more\n"))

    def test_that_are_no_command_of_python_start_the_program(self):
        for words in ([], ["run", "s", "--out", "o"], ["--help"], ["nothing"]):
            with mock.patch("os.execv", side_effect=SystemExit) as start, mock.patch.dict("os.environ", MCDEM_PROGRAM="/x/mcdem"):
                said_by(*words)
            start.assert_called_once_with("/x/mcdem", ["/x/mcdem", *words])

    def test_of_a_distributed_command_are_its_own(self):
        for words, problem in (([], "a command is needed: run, challenge run or diagnose, with its options"),
                               (["--bogus", "run"], "a command is needed: .*; got --bogus run"), (["table", "a"], "a command is needed"),
                               (["run", "s", "--part", "1/2"], "--part: cannot be given here"), (["run", "--device=0"], "--device=0: cannot")):
            with self.assertRaisesRegex(InputError, problem):
                run_command(["distribute", *words])
        self.assertIn("--tries: must be a whole number from 1 to 100, got 0", said_by("distribute", "--tries", "0", "run")[2])
        words = ["diagnose", "s", "--experiment", "e", "--tries", "7"]
        with mock.patch("mcdem.distributed.compute") as compute:
            self.assertEqual(run_command(["distribute", "--tries", "2", *words]), 0)
        compute.assert_called_once_with(words, client=None, tries=2)

    def test_of_a_challenge_are_checked(self):
        for words, problem in ((["make", "s", "--out", "o", "--truth", ""], "--truth: must be a path, got nothing"),
                               (["score", "a", "b", "--truth", ""], "--truth: must be a path, got nothing"),
                               (["run", "a", "--scene", "s", "--library", "l", "--out", "o", "--library-packings", "0"],
                                "--library-packings: must be a whole number from 1 to 10000, got 0")):
            code, _, messages = said_by("challenge", *words)
            self.assertEqual((code, messages.splitlines()[0]), (2, f"mcdem: {problem}"))

    def test_are_completed(self):
        for words, out in ((["diagnose", "--ref"], "--refine\tIf the scene is not"), (["diagnose", "--experiment", ""], ":folders\n"),
                           (["challenge", "run", "--library", ""], ":files\n"), (["challenge", "run", "--mp"], ""),
                           (["challenge", "run", "--library-pai"], "--library-pairs\t"), (["experiment", "ch"], "check\tReport which"),
                           (["experiment", "check", ""], ":files\n"), (["completion", "z"], "zsh\n"), (["experiment", "none", "x"], "")):
            code, said, _ = said_by("complete", *words)
            self.assertEqual((code, said[:len(out) or 1]), (0, out), words)


class Options(unittest.TestCase):
    def test_have_the_documented_defaults(self):
        cases = (("diagnose s --experiment e --experiment f --out o --candidates a,b --candidates c",
                  {"replicates": 32, "pairs": 8, "confirmations": 8, "refine": 4, "seed": 1, "library": None,
                   "experiments": ["e", "f"], "candidates": ["a", "b", "c"], "overrides": []}),
                 ("challenge run c --scene s --library l --out o --set a=1 --set b=2",
                  {"replicates": 8, "confirmations": 4, "library_packings": 16, "library_replicates": 4, "library_pairs": 1,
                   "seed": 1, "candidates": [], "SCENE": "s", "overrides": ["a=1", "b=2"]}))
        for line, wanted in cases:
            command, arguments = command_of(line.split())
            found = vars(parser_of(command, module_of(command)).parse_intermixed_args(arguments))
            self.assertEqual({name: found[name] for name in wanted}, wanted)

    def test_name_what_is_missing_or_out_of_range(self):
        given = ["diagnose", "s", "--experiment", "e", "--out", "o"]
        for words, problem in ((["diagnose", "s", "--out", "o"], "--experiment is required"),
                               ([*given, "--out="], "--out: must be a path, got nothing"),
                               ([*given, "--replicates", "7"], "--replicates: must be a whole number from 8 to 10000, got 7"),
                               ([*given, "--refine", "65"], "--refine: must be a number from 1 to 64, got 65"),
                               ([*given, "--part", "1/2", "--merge"], "--merge excludes --part")):
            code, _, messages = said_by(*words)
            self.assertEqual((code, messages.splitlines()[0]), (2, f"mcdem: {problem}"))

    def test_numbers_are_whole_and_finite(self):
        self.assertEqual([whole_in(0, 2**64 - 1)(text) for text in ("0", "+7", "18446744073709551615")], [0, 7, 2**64 - 1])
        self.assertEqual([number_in(1, 64)(text) for text in ("1", "6.4e1", "2.5")], [1, 64, 2.5])
        for convert, texts in ((whole_in(0, 2**64 - 1), ("18446744073709551616", "-1", "1.0", "", "٣", "1" * 5000)),
                               (number_in(1, math.inf), ("nan", "inf", "0.99", "x", "1_0"))):
            for text in texts:
                with self.subTest(text[:9]), self.assertRaises(argparse.ArgumentTypeError):
                    convert(text)


if __name__ == "__main__":
    unittest.main()
