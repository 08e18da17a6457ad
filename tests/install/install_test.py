"""`cmake --install` into an empty prefix: program, module, and a project that embeds the engine; the program also after a move.

install_test.py SOURCE BUILD CMAKE [PYTHON]
"""
import pathlib
import tempfile

from installed import arguments, check_described, check_module, check_program, check_run_paths, environment_without_source, run


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


def check_moved(prefix, folder):
    """The program finds its files and the Python package after the whole prefix was moved."""
    prefix.rename(folder / "elsewhere")
    run(folder / "elsewhere/bin/mcdem", "report", folder / "run", "--out", folder / "page.html", env=environment_without_source())
    assert (folder / "page.html").exists()


def main():
    source, build, cmake, python = arguments()
    with tempfile.TemporaryDirectory(prefix="mcdem-install-") as name:
        folder = pathlib.Path(name)
        prefix = folder / "prefix"
        run(cmake, "--install", build, "--prefix", prefix)
        check_program(prefix, folder)
        check_described(prefix)
        check_no_source(source, prefix)
        check_run_paths(prefix)
        if python:
            check_module(python, prefix)
        check_embedding(source, cmake, prefix, folder)
        check_moved(prefix, folder)
        assert build / "mcdem" in check_run_paths(build)


if __name__ == "__main__":
    main()
