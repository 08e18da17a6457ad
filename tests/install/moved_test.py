"""An installed program finds its files after it was moved.

moved_test.py SOURCE BUILD CMAKE [PYTHON]
"""
import pathlib
import subprocess
import tempfile

from installed import arguments, run

DIAGNOSIS = """{"verdict": "no_gap", "gap": {"detected": false, "p_value": 0.5, "p_omnibus": 0.5, "p_directed": 0.5},
"where": [], "causes": [], "shrink": null, "detection_limits": [], "not_measured": [], "seconds": 1, "sentence": "",
"where_threshold": null, "cells": [], "ranking": [], "nuisances": [], "not_testable": [], "provenance": {}}"""


def report(program, folder):
    return subprocess.run([program, "report", "diagnosis.json", "--out", "page.html"], cwd=folder, text=True,
                          capture_output=True, timeout=60)


def main():
    _, build, cmake, _ = arguments()
    with tempfile.TemporaryDirectory(prefix="mcdem-install-") as name:
        folder = pathlib.Path(name)
        run(cmake, "--install", build, "--prefix", folder / "there")
        (folder / "diagnosis.json").write_text(DIAGNOSIS)
        (folder / "there").rename(folder / "elsewhere")
        program = folder / "elsewhere/bin/mcdem"
        done = report(program, folder)
        assert done.returncode == 0 and (folder / "page.html").exists(), done.stderr


if __name__ == "__main__":
    main()
