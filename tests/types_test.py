"""The types of the Python package hold: mypy --strict on the rooms that have them.

types_test.py SOURCE_FOLDER; exit code 77: no errors, but mypy is not installed
"""
import importlib.util
import pathlib
import subprocess
import sys

ROOMS = ("results", "experiment", "importing", "observe", "calibration", "diagnosis", "convergence", "report", "figures", "challenge", "commands",
         "checked_json.py", "command.py", "comparing.py", "diagnosing.py", "errors.py", "files.py", "json_text.py", "look.py", "manifest.py",
         "number_text.py", "outputs.py", "parts.py", "problems.py", "program.py", "progress.py", "toml.py", "toml_lines.py",
         "warn.py")


def main():
    if not importlib.util.find_spec("mypy"):
        print("skipped: mypy is not there (Debian package mypy)")
        return 77
    words = ["--strict", "--ignore-missing-imports", "--follow-imports=silent", "--cache-dir=/dev/null"]
    return subprocess.run([sys.executable, "-m", "mypy", *words, *(f"mcdem/{room}" for room in ROOMS)],
                          cwd=pathlib.Path(sys.argv[1]) / "host/python").returncode


if __name__ == "__main__":
    sys.exit(main())
