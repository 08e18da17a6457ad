"""`cmake --install` into an empty prefix: program, manual, module, and a project that embeds the engine.

install_test.py SOURCE BUILD CMAKE [PYTHON]; exit code 77: no errors, but man or groff is missing
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

from installed import arguments, check_described, check_module, check_program, check_run_paths, environment_without_source, run


def check_manual(prefix):
    """Checks that man reports no warnings for any page; false if man is missing."""
    text = (prefix / "share/man/man1/mcdem-run.1").read_text()
    for part in (".TH MCDEM\\-RUN 1", "\\-\\-out DIR", "\\-\\-resume", "mcdem run scenes/small.toml".replace("-", "\\-")):
        assert part in text, part
    if not shutil.which("man") or not shutil.which("groff"):
        return False
    for page in sorted((prefix / "share/man/man1").iterdir()):
        done = subprocess.run(["man", "--warnings", "-l", str(page)], text=True, capture_output=True,
                              env=environment_without_source(MANWIDTH=100, MANPAGER="cat"))
        assert done.returncode == 0 and not done.stderr, f"{page.name}: {done.stderr}"
        assert "NAME" in done.stdout, page.name
    return True


def check_embedding(source, cmake, prefix, folder):
    """An external project that uses only the prefix."""
    run(cmake, "-S", source / "tests/install/outside", "-B", folder / "outside", f"-DCMAKE_PREFIX_PATH={prefix}")
    run(cmake, "--build", folder / "outside")
    said = run(folder / "outside/outside", prefix / "share/mcdem/scenes/small.toml", folder / "embedded",
               env=environment_without_source())
    assert " scans" in said and " 0 scans" not in said, said


def check_no_source(source, prefix):
    """Installed files must not contain paths of the build."""
    for file in (prefix / "lib/cmake/mcdem").iterdir():
        assert str(source) not in file.read_text(), f"{file}: names {source}"


def main():
    source, build, cmake, python = arguments()
    with tempfile.TemporaryDirectory(prefix="mcdem-install-") as name:
        folder = pathlib.Path(name)
        prefix = folder / "prefix"
        run(cmake, "--install", build, "--prefix", prefix)
        check_program(prefix, folder)
        check_described(prefix)
        rendered = check_manual(prefix)
        check_no_source(source, prefix)
        check_run_paths(prefix)
        if python:
            check_module(python, prefix)
        check_embedding(source, cmake, prefix, folder)
    if not rendered:
        print("skipped: man pages were not rendered: man-db or groff-base is not installed")
        sys.exit(77)


if __name__ == "__main__":
    main()
