"""What the example scripts share: finding and opening the file of a run."""
import pathlib
import sys

import h5py


def open_run(path):
    """Opens RUN, a result folder or a run.h5, with h5py."""
    file = pathlib.Path(path)
    if file.is_dir():
        file = file / "run.h5"
    if not file.is_file():
        sys.exit(f"{path}: no run there; give the folder of a finished run (it holds run.h5) or the file")
    try:
        run = h5py.File(file)
        run["observables"]
    except (OSError, KeyError) as error:
        sys.exit(f"{file}: not a result of mcdem: {error}")
    return run


def label(run, replica):
    """What sets `replica` (such as "replica_00003") apart in its run."""
    return run["particles"][replica].attrs["label"].decode()


def displacement(run, replica):
    """How far the plate is below its start at each scan [m]."""
    plate_start = run["particles"][replica]["box"].attrs["edges"][2]
    return plate_start - run["observables"][replica]["plate_z"]


def arguments(what, default_picture=None):
    """RUN and OUT.png from the command line."""
    names = "RUN" + (" [OUT.png]" if default_picture else "")
    most = 3 if default_picture else 2
    if not 2 <= len(sys.argv) <= most or sys.argv[1] in ("-h", "--help"):
        sys.exit(f"usage: {pathlib.Path(sys.argv[0]).name} {names}\n{what}")
    return sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else default_picture
