"""What `mcdem export` starts (host/cli/run/export.cpp), which has checked the run and locked the folder."""
import argparse
import os
import pathlib

from ..errors import InputError
from . import export, vtk, xyz


def main():
    parser = argparse.ArgumentParser(prog="mcdem export", allow_abbrev=False)
    parser.add_argument("--vtk", dest="formats", action="append_const", const=vtk)
    parser.add_argument("--xyz", dest="formats", action="append_const", const=xyz)
    parser.add_argument("--replica", type=int, action="append", default=[])
    parser.add_argument("--scan", type=int, action="append", default=[])
    parser.add_argument("out")
    parser.add_argument("files", nargs="+")
    to = parser.parse_args()
    try:
        count = export(to.files, pathlib.Path(to.out), to.formats, to.replica, to.scan)
    except FileNotFoundError:
        if all(map(os.path.exists, to.files)):
            raise
        raise InputError(f"{os.path.dirname(to.files[0])}: the run has ended meanwhile: repeat the command") from None
    print(f"{count} files in {to.out}; how to view them: {', '.join(f'{to.out}/{form.GUIDE_NAME}' for form in to.formats)}")


if __name__ == "__main__":
    main()
