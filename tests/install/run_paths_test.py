"""Programs and libraries of the build tree take no library from the current folder.

run_paths_test.py BUILD
"""
import pathlib
import sys

from installed import check_run_paths


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    files = check_run_paths(build)
    assert build / "mcdem" in files, files
    print(len(files), "files in order")


if __name__ == "__main__":
    main()
