#!/usr/bin/env python3
"""scripts/skipped lists tests that did not run; such a test is an error unless it depends on the
kind of device or on double precision."""
import pathlib
import subprocess
import sys
import tempfile

SCRIPT = pathlib.Path(sys.argv[1]) / "scripts" / "skipped"
PASSED = '<testcase name="passes" status="run"><system-out>done</system-out></testcase>'


def skipped(name, output):
    return (f'<testcase name="{name}" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/>'
            f"<system-out>{output}</system-out></testcase>")


def run(*cases):
    with tempfile.NamedTemporaryFile("w", suffix=".xml") as file:
        file.write(f"<testsuite>{''.join(cases)}</testsuite>")
        file.flush()
        done = subprocess.run([sys.executable, SCRIPT, file.name], capture_output=True, text=True)
    return done.returncode, done.stdout


def main():
    assert run(PASSED) == (0, "")
    gtest = skipped("precise", "[ RUN ] precise\nstep_test.cpp:77: Skipped\nthe device has no double precision\n\n[ SKIPPED ] precise")
    assert run(PASSED, gtest) == (0, "did not run: precise: the device has no double precision\n")
    suite = ('<testcase name="sim.Cell" status="run"><system-out>[ RUN      ] Cell.One\n[       OK ] Cell.One (3 ms)\n'
             "[ RUN      ] Cell.Two\n/cell_test.cpp:9: Skipped\nthe tables are not here\n\n[  SKIPPED ] Cell.Two (0 ms)\n"
             "[  SKIPPED ] 1 test, listed below:\n[  SKIPPED ] Cell.Two</system-out></testcase>")
    assert run(PASSED, suite) == (1, "did not run: Cell.Two: the tables are not here\n")
    assert run(skipped("fast", "needs a GPU"))[0] == 0
    assert run(skipped("layout", "GPUs do not use the layout of CPUs"))[0] == 0
    code, said = run(gtest, skipped("slurm", "starting\nslurmctld is not installed"))
    assert code == 1 and said.splitlines()[1] == "did not run: slurm: slurmctld is not installed", said
    authors = suite.replace("the tables are not here", "the authors' data are not here (tests/README.md): input.data")
    assert run(PASSED, authors) == (0, "did not run: Cell.Two: the authors' data are not here (tests/README.md): input.data\n")
    assert run(skipped("other", "no table: the authors' data are not here"))[0] == 1
    assert run(skipped("silent", ""))[0] == 1


main()
