"""Compares runs of scripts/matrix: FOLDER holds COMPILER-PRECISION-THREADS/run.h5.

One or two threads: the same file. GCC or Clang, float or double: the same forces except for rounding errors, which
rearrangements amplify. Measured with GCC 12 and Clang 14: no difference between compilers (the kernels are compiled by
PoCL), 1.2e-5 between precisions.
"""
import itertools
import pathlib
import sys

import h5py
import numpy as np

MOST_APART = {"compilers": 1e-4, "precisions": 1e-3}  # RMS over the scans, relative to the largest top force


def top_forces(file):
    """Top force of [replica][scan] in N."""
    forces = []
    with h5py.File(file) as run:
        def visit(_, group):
            if isinstance(group, h5py.Dataset) and group.dtype.names and "wall_force" in group.dtype.names:
                forces.append(group["wall_force"][:, 5, 2])
        run.visititems(visit)
    assert forces, f"{file}: no observables"
    return forces


def apart(one, other):
    return max(np.sqrt(np.mean((a - b) ** 2)) / np.abs(a).max() for a, b in zip(top_forces(one), top_forces(other), strict=True))


def main():
    folder = pathlib.Path(sys.argv[1])
    run = {(c, p, t): folder / f"{c}-{p}-{t}/run.h5"
           for c, p, t in itertools.product(("gcc", "clang"), ("float", "double"), ("1", "2"))}
    problems = []
    for c, p in itertools.product(("gcc", "clang"), ("float", "double")):
        if run[c, p, "1"].read_bytes() != run[c, p, "2"].read_bytes():
            problems.append(f"{c}, {p}: one thread and two differ")
    pairs = {"compilers": [(("gcc", p, "1"), ("clang", p, "1")) for p in ("float", "double")],
             "precisions": [((c, "double", "1"), (c, "float", "1")) for c in ("gcc", "clang")]}
    for kind, list_ in pairs.items():
        for one, other in list_:
            difference = apart(run[one], run[other])
            print(f"{' '.join(one[:2])} and {' '.join(other[:2])}: top forces {difference:.1e} apart")
            if not difference <= MOST_APART[kind]:
                problems.append(f"{one} and {other}: {difference:.1e} apart, {MOST_APART[kind]:.0e} at most")
    sys.exit("\n".join(problems) or None)


if __name__ == "__main__":
    main()
