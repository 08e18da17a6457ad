"""Starts a command of the program that is written in Python: python3 -E -s -B start.py MODULE ARGUMENT.. (host/cli/shell/python_program.h).

No code comes from the current folder or from that of another user: of PYTHONPATH only absolute folders are searched, and the user's
site-packages only if they are the user's. The other variables PYTHON.. are not read (-E).
"""
# Older Pythons, also Python 2, must understand this file to say that they are too old; nothing of the package is imported before.
import sys

OLDEST = (3, 11)

# A script's own folder is first in the search path; its modules would hide those of Python.
sys.path[:] = [folder for folder in sys.path if folder not in ("", __file__.rpartition("/")[0])]

if sys.version_info < OLDEST:
    sys.stderr.write("mcdem: %s is Python %s, but Python %s or later is needed: install one, or name it by MCDEM_PYTHON\n"
                     % (sys.executable, sys.version.split()[0], ".".join(map(str, OLDEST))))
    sys.exit(1)

import os
import site


def named_folders():
    """Of PYTHONPATH. An empty or relative entry means a folder relative to the current one, and is left out."""
    return [folder for folder in os.environ.get("PYTHONPATH", "").split(os.pathsep) if folder.startswith("/")]


def is_own(folder):
    """Whether it is a folder of this user, in which nobody else may write."""
    try:
        there = os.stat(folder)
    except OSError:
        return False
    return folder.startswith("/") and there.st_uid == os.geteuid() and not there.st_mode & 0o002


def user_folders():
    """What pip installs for the user alone; none in a virtual environment that does not include the system's packages."""
    if sys.flags.no_site or os.environ.get("PYTHONNOUSERSITE") or sys.base_prefix not in site.PREFIXES:
        return []
    folder = site.getusersitepackages()
    before = set(sys.path)
    if is_own(folder):
        site.addsitedir(folder)
    return [added for added in sys.path if added not in before]


def set_search_path(package):
    """The package's folder, those that are named, Python's own, the user's, and those of installed packages."""
    named, users = named_folders(), user_folders()
    others = [folder for folder in sys.path if folder not in users]
    installed = [folder for folder in others if folder.endswith("-packages")]
    sys.path[:] = [package] + named + [folder for folder in others if folder not in installed] + users + installed
    os.environ["PYTHONPATH"] = os.pathsep.join(named)  # for other processes
    os.environ["PYTHONSAFEPATH"] = "1"


if __name__ == "__main__":
    set_search_path(os.path.dirname(os.path.dirname(__file__)))
    # The matrices are small: threads of OpenBLAS would only wait for one another, on a busy machine many times longer than they compute.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from mcdem.program import main
    sys.exit(main())
