"""A root with nothing but Python, a shell and the C library, from the files of installed Debian packages, to run commands in."""
import os
import re
import shutil
import subprocess
import sys

from installed import run

PACKAGES = ["base-files", "coreutils", "dash", "libgcc-s1", "libstdc++6", "python3", "python3-venv"]
# What would help mcdem: its libraries, compilers and linkers, the package manager.
UNWANTED = re.compile(r"libOpenCL|libhdf5|libpocl|libLLVM|libhwloc|^(gcc|cc|c\+\+|clang|ld|as|make|cmake|apt-get|pip3?)$")
MOUNTED = ("proc", "sys", "dev")


def files_of_packages():
    """The files and links of the packages and of all that they depend on."""
    names = re.findall(r"^Inst (\S+)", run("apt-get", "-s", "--no-install-recommends", "-o", "Dir::State::status=/dev/null", "install",
                                           *PACKAGES), re.MULTILINE)
    listed = run("dpkg-query", "-L", *names).split("\n")
    return [file for file in listed if not file.startswith("/usr/share/doc/") and (os.path.islink(file) or os.path.isfile(file))]


def make_root(root):
    """Makes the root; /bin, /lib, .. are links into /usr as on this system."""
    for name in ("bin", "lib", "lib64", "sbin"):
        (root / "usr" / name).mkdir(parents=True)
        (root / name).symlink_to(f"usr/{name}")
    for name in (*MOUNTED, "tmp", "home"):
        (root / name).mkdir()
    for name in ("tmp", "home"):
        os.chmod(root / name, 0o1777)
    for file in files_of_packages():
        target = root / file[1:]
        target.parent.mkdir(parents=True, exist_ok=True)
        if not os.path.lexists(target):
            shutil.copy2(file, target, follow_symlinks=False)
    unwanted = [file for file in root.rglob("*") if UNWANTED.search(file.name) and not file.is_dir()]
    assert not unwanted, unwanted


def run_in(root, *words):
    """Runs a command there, without rights, with an empty environment, in /home; returns its output."""
    mounts = "".join(f'mount --rbind /{name} "$0/{name}" && ' for name in MOUNTED)
    user = ["--userspec=1000:1000"] if os.geteuid() == 0 else []
    alone = ["unshare", "--mount", "--propagation", "private", *([] if user else ["--map-root-user"])]
    environment = ["/usr/bin/env", "-i", "HOME=/home", "PATH=/usr/bin:/bin", "LC_ALL=C.UTF-8"]
    inside = ["/bin/sh", "-c", 'cd /home && exec "$@"', "sh", *map(str, words)]
    done = subprocess.run([*alone, "sh", "-c", mounts + 'exec chroot "$@"', root, *user, root, *environment, *inside], text=True,
                          capture_output=True, check=False)
    if done.returncode != 0:
        sys.exit(f"exit code {done.returncode}: {' '.join(map(str, words))}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr
