"""Shared by the tests of installed files: commands, and checks of an installed program."""
import os
import pathlib
import subprocess
import sys


def run(*words, **more):
    """Runs a command and returns its output; if it fails, ends the test with all output."""
    done = subprocess.run([str(word) for word in words], text=True, capture_output=True, **more)
    if done.returncode != 0:
        sys.exit(f"exit code {done.returncode}: {' '.join(map(str, words))}\n{done.stdout}{done.stderr}")
    return done.stdout


def environment_without_source(**more):
    """An environment without the kernels and modules of the build tree."""
    kept = {name: value for name, value in os.environ.items() if name not in ("MCDEM_KERNELS", "PYTHONPATH")}
    return {**kept, **{name: str(value) for name, value in more.items()}}


def check_program(prefix, folder):
    """Checks the version, and a short run of an installed scene."""
    program, scene = prefix / "bin/mcdem", prefix / "share/mcdem/scenes/small.toml"
    environment = environment_without_source()
    assert run(program, "--version", env=environment).startswith("mcdem "), program
    run(program, "run", scene, "--out", folder / "run", "--no-figures", "--set", "packing.count=30",
        "--set", "protocol.scans_per_stroke=2", env=environment, cwd=folder)
    assert (folder / "run/run.h5").is_file()


def check_described(prefix):
    """Completions are in the folders that the shells search, and belong to this program."""
    for shell, file in {"bash": "bash-completion/completions/mcdem", "zsh": "zsh/vendor-completions/_mcdem",
                        "fish": "fish/vendor_completions.d/mcdem.fish"}.items():
        text = (prefix / "share" / file).read_text()
        assert text and text == run(prefix / "bin/mcdem", "completion", shell), file


def check_module(python, prefix):
    """The module is installed for the interpreter for which it was built."""
    modules = sorted(prefix.glob("lib/python3*/*-packages/mcdem/_engine*.so"))
    assert len(modules) == 1, f"{prefix}: {modules}"
    site = modules[0].parent.parent
    said = run(python, "-c", "import mcdem; print(mcdem.__file__, len(mcdem.Scene()))",
               env=environment_without_source(PYTHONPATH=site))
    assert said.split() == [str(site / "mcdem/__init__.py"), "1"], said
    assert (site / "mcdem/py.typed").exists() and (site / "mcdem/__init__.pyi").exists()


def is_linked(file):
    """Whether it is a program or a shared library: ELF of type EXEC or DYN, in the byte order of this machine."""
    with open(file, "rb") as start:
        head = start.read(18)
    return head[:4] == b"\x7fELF" and int.from_bytes(head[16:18], sys.byteorder) in (2, 3)


def check_run_paths(folder):
    """No linked file searches libraries in the current folder: entries of its run path are absolute, or relative to the file itself."""
    files = [file for file in sorted(folder.rglob("*")) if file.is_file() and not file.is_symlink() and is_linked(file)]
    assert files, f"{folder}: nothing is linked there"
    for file in files:
        for line in run("readelf", "-d", "-W", file).splitlines():
            if "RPATH" in line or "RUNPATH" in line:
                path = line[line.index("[") + 1:line.rindex("]")]
                assert all(entry.startswith(("/", "$ORIGIN")) for entry in path.split(":")), f"{file}: run path [{path}]"
    return files


def arguments():
    """SOURCE BUILD CMAKE PYTHON; PYTHON is empty if the module was not built."""
    source, build = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    return source, build, sys.argv[3], sys.argv[4] if len(sys.argv) > 4 else ""
