"""What the project needs: CMake names all missing libraries at once with their packages, and environment.yml and the image agree with it.

needed_test.py SOURCE CMAKE
"""
import pathlib
import re
import subprocess
import sys
import tempfile

SECTIONS = {"files", "post", "environment", "runscript"}  # of scripts/apptainer.def


def rows(source):
    """Part -> rows of scripts/packages.txt: names in Debian and, if the project cannot be built or used without it, Fedora and conda-forge."""
    parts = {"run": []}
    for line in (source / "scripts/packages.txt").read_text().splitlines()[2:]:
        part = re.match(r"# (\w+):", line)
        if part:
            parts[part[1]] = []
        elif line:
            parts[list(parts)[-1]].append(line.split())
    return parts


def check_missing(source, cmake, packages):
    """Configures without some libraries: the message names them, and their packages in every system."""
    missing = {"OpenCL": "ocl-icd-opencl-dev", "HDF5": "libhdf5-dev", "CLI11": "libcli11-dev", "GTest": "libgtest-dev"}
    with tempfile.TemporaryDirectory() as build:
        done = subprocess.run([cmake, "-S", source, "-B", build, *(f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in missing),
                               "-DMCDEM_OPENCL_CPP=OFF"], text=True, capture_output=True, check=False)
    assert done.returncode != 0, done.stdout
    said = " ".join(done.stderr.split())
    for name in missing:
        assert name in said[said.index("Not found:"):said.index("Their packages")], said
    for debian in (*missing.values(), "opencl-clhpp-headers"):
        for name in next(row for row in packages if row[0] == debian):
            assert f" {name} " in said, f"{name} is not in: {said}"
    assert "libfmt-dev" not in said, said


def check_environment(source, packages):
    """environment.yml lists the names in conda-forge, and what pip needs to build."""
    lines = (source / "environment.yml").read_text().split("dependencies:\n")[1].splitlines()
    names = {re.fullmatch(r"  - ([a-z0-9_-]+)(>=[0-9.]+)?", line)[1] for line in lines}
    wanted = {row[2] for row in packages} - {"ccache"} | {"pip", "scikit-build-core"}
    assert names == wanted, f"environment.yml: {sorted(names ^ wanted)}"
    required = re.search(r"requires = \[(.*)\]", (source / "pyproject.toml").read_text())[1]
    assert all(re.match(r"[a-z0-9-]+", name)[0] in names for name in re.findall(r'"(.*?)"', required)), required


def check_image(source):
    """Sections that Apptainer knows, with commands that a shell understands and packages of Debian's archive."""
    head, *sections = re.split(r"^%", (source / "scripts/apptainer.def").read_text(), flags=re.MULTILINE)
    assert re.search(r"^Bootstrap: docker\nFrom: debian:12-slim\n", head, re.MULTILINE), head
    scripts = dict(section.split("\n", 1) for section in sections)
    assert set(scripts) == SECTIONS, set(scripts)
    for name in SECTIONS - {"files"}:
        subprocess.run(["sh", "-n"], input=scripts[name], text=True, check=True)
    installed = re.search(r"apt-get install (.*)", scripts["post"])[1].split()
    known = {row[0] for part in rows(source).values() for row in part}
    assert all(name.startswith("--") or name in known for name in installed), installed


def main():
    source, cmake = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
    parts = rows(source)
    packages = parts["run"] + parts["python"]
    assert packages and all(len(row) == 3 for row in packages), "scripts/packages.txt: a name in Debian, Fedora and conda-forge"
    check_environment(source, packages)
    check_image(source)
    check_missing(source, cmake, packages + parts["check"])


if __name__ == "__main__":
    main()
