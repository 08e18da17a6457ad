"""What `mcdem export` starts (host/cli/run/export.cpp)."""
import argparse

from . import export, for_ovito, for_paraview


def main():
    parser = argparse.ArgumentParser(prog="mcdem export", allow_abbrev=False)
    parser.add_argument("--vtk", action="store_true")
    parser.add_argument("--xyz", action="store_true")
    parser.add_argument("--replica", type=int, action="append", default=[])
    parser.add_argument("--scan", type=int, action="append", default=[])
    parser.add_argument("run")
    parser.add_argument("out")
    to = parser.parse_args()
    files = export(to.run, to.out, vtk=to.vtk, xyz=to.xyz, replicas=to.replica, scans=to.scan)
    guides = [for_paraview.GUIDE_NAME] * to.vtk + [for_ovito.GUIDE_NAME] * to.xyz
    print(f"{files} files in {to.out}; how to view them: {', '.join(f'{to.out}/{guide}' for guide in guides)}")


if __name__ == "__main__":
    main()
