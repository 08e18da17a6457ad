"""scripts/wheel: its wheel and PoCL from PyPI run a scene where nothing is installed but Python.

wheel_test.py SOURCE BUILD PYTHON; exit code 77 if the module was not built for Debian's Python, or without PyPI.
"""
import pathlib
import subprocess
import sys
import tempfile
import zipfile

from bare_root import make_root, run_in
from installed import arguments, run


def check_contents(wheel):
    """It contains the libraries that a system may not have, and names the systems that have the others."""
    assert "-manylinux_" in wheel.name, wheel
    names = zipfile.ZipFile(wheel).namelist()
    for needed in ("mcdem.libs/libOpenCL", "mcdem.libs/libhdf5", "mcdem/bin/mcdem", "mcdem/_engine", "mcdem/linker/ld"):
        assert any(name.startswith(needed) for name in names), f"{wheel}: no {needed}"
    assert any(name.endswith("licenses/SOURCES") for name in names), wheel


def download(tools, wheel, folder):
    """The packages that it needs, for the same Python, by this machine's settings of pip."""
    done = subprocess.run([tools / "bin/pip", "download", "--quiet", "--only-binary", ":all:", "--dest", folder, f"{wheel}[cpu]"], text=True,
                          capture_output=True, check=False)
    if done.returncode != 0:
        print(f"skipped: pip cannot download what mcdem needs: {done.stderr}")
        sys.exit(77)


# A run that is ended after its first checkpoint: it stops and can be resumed.
STOPPED = """
env/bin/mcdem run /compression.toml --out long --no-figures --set output.checkpoint_minutes=1e-6 &
until [ -e long/checkpoint.h5 ]; do kill -0 $! || exit 1; sleep 0.1; done
kill $!
wait $!
echo "exit code $?"
"""


def main():
    source, build, _, python = arguments()
    if python != "/usr/bin/python3" or not pathlib.Path("/etc/debian_version").exists():
        print("skipped: needs the Python module for Debian's Python")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="mcdem-wheel-") as name:
        folder = pathlib.Path(name)
        folder.chmod(0o755)
        wheel = pathlib.Path(run(source / "scripts/wheel", build, folder / "wheel").split()[-1])
        check_contents(wheel)
        root = folder / "root"
        root.mkdir()
        make_root(root)
        download(build / "wheel-tools", wheel, root / "wheels")
        for scene in ("small.toml", "compression.toml"):
            (root / scene).write_text((source / "scenes" / scene).read_text())
        run_in(root, "python3", "-m", "venv", "env")
        run_in(root, "env/bin/pip", "install", "--quiet", "--no-index", "--no-compile", "--find-links", "/wheels", "mcdem[cpu]")
        said = run_in(root, "env/bin/mcdem", "run", "/small.toml", "--out", "small")
        assert "first use of pthread" in said and "2 of 2 replicas done" in said and "small/top_force.png" in said, said
        said = run_in(root, "sh", "-c", STOPPED)
        assert "exit code 130" in said and "--resume" in said, said
        said = run_in(root, "env/bin/python3", "-c", "import mcdem; print(mcdem.devices(), len(mcdem.read('small')))")
        assert "pthread" in said and said.split()[-1] == "2", said


if __name__ == "__main__":
    main()
