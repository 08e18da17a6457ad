"""Command line of a study, and what mcdem.converge refuses. command_line_test.py"""
import contextlib
import io
import unittest

from mcdem.commands import converge as command
from mcdem.commands.command_line import parser_of
from mcdem.convergence.converge import converge
from mcdem.errors import InputError


class Options(unittest.TestCase):
    def parsed(self, *words):
        with contextlib.redirect_stderr(io.StringIO()) as messages, contextlib.suppress(SystemExit):
            return vars(parser_of("converge", command).parse_intermixed_args(["s", "--out", "o", *words]))
        return messages.getvalue().splitlines()[0]

    def test_have_the_documented_defaults(self):
        self.assertEqual(self.parsed("--set", "a=1"), {
            "SCENE": "s", "out": "o", "overrides": ["a=1"], "replicas": 32, "jitter": 0, "force_limit": 0.005, "sd_limit": 0.5, "seed": 1,
            "device": ""})

    def test_are_checked(self):
        for words, problem in ((["--replicas", "7"], "--replicas: must be a whole number from 8 to 10000, got 7"),
                               (["--jitter", "2"], "--jitter: must be a number from 0 to 1, got 2"),
                               (["--force-limit", "0"], "--force-limit: must be a number > 0, got 0"),
                               (["--sd-limit", "x"], "--sd-limit: must be a number > 0, got x"),
                               (["--out="], "--out: must be a path, got nothing")):
            self.assertEqual(self.parsed(*words), f"mcdem: {problem}")


class Arguments(unittest.TestCase):
    def test_are_checked_together(self):
        with self.assertRaises(InputError) as refused:
            converge(None, "/nowhere", replicas=7, force_limit=0, sd_limit=-1, jitter=2)
        self.assertEqual(refused.exception.problems, ["replicas: must be 8 or more, got 7", "force_limit: must be above 0, got 0",
                                                      "sd_limit: must be above 0, got -1", "jitter: must be between 0 and 1, got 2"])


if __name__ == "__main__":
    unittest.main()
