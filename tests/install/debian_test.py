"""The Debian packages: built by CPack, unpacked into an empty root, and used there.

debian_test.py SOURCE BUILD CMAKE [PYTHON]; exit code 77 if Debian's tools are missing.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from installed import arguments, check_described, check_module, check_program, check_run_paths, run



def check_installable(files):
    """apt finds all dependencies of the packages and would install them."""
    done = subprocess.run(["apt-get", "-s", "--no-install-recommends", "install", *map(str, files)], text=True,
                          capture_output=True, env={**os.environ, "LC_ALL": "C"})
    assert done.returncode == 0, done.stdout + done.stderr
    for file in files:
        package = file.name.split("_")[0]
        assert f"Inst {package} " in done.stdout, f"{package}: {done.stdout}"


if not all(shutil.which(tool) for tool in ("dpkg-deb", "dpkg-shlibdeps", "apt-get")):
    print("skipped: dpkg-dev or apt is not installed")
    sys.exit(77)

source, build, cmake, python = arguments()
with tempfile.TemporaryDirectory(prefix="mcdem-deb-") as name:
    folder, root = pathlib.Path(name), pathlib.Path(name) / "root"
    run(pathlib.Path(cmake).parent / "cpack", "-G", "DEB", "-B", folder / "packages", "--config",
        build / "CPackConfig.cmake", cwd=build)
    packages = {run("dpkg-deb", "-f", file, "Package").strip(): file for file in (folder / "packages").glob("*.deb")}
    wanted = {"mcdem", "libmcdem-dev"} | ({"python3-mcdem"} if python else set())
    assert set(packages) == wanted, packages
    for package, file in packages.items():
        run("dpkg-deb", "-x", file, root)
        depends = run("dpkg-deb", "-f", file, "Depends")
        for library in {"mcdem": ("libhdf5", "opencl-icd", "libc6"), "python3-mcdem": ("libhdf5", "python3-numpy", "python3-scipy"),
                        "libmcdem-dev": ("libhdf5-dev",)}[package]:
            assert library in depends, f"{package}: depends on {depends}, not on {library}"
    check_installable(packages.values())
    check_run_paths(root / "usr")
    check_described(root / "usr")
    check_program(root / "usr", folder)
    if python:
        check_module(python, root / "usr")
