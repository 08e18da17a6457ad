"""ASE reads the extended XYZ files of an export, and their values agree with the run.

xyz_test.py PROGRAM SOURCE; exit code 77: no ASE.
"""
import sys

import numpy as np

from exported import Exported, arguments, missing, scan_of, skip

if missing(sys.executable, "ase.io"):
    skip("the Python module ase is not there (Debian: python3-ase)")
import ase.io  # noqa: E402

NINE_DIGITS = 1e-8


def close(found, expected):
    return np.allclose(found, expected, rtol=NINE_DIGITS, atol=1e-12)


def check_frame(frame, file, replica, scan):
    position, contacts, row = scan_of(file, replica, scan)
    force = contacts["force"].astype(float)
    total, walls = np.zeros(len(position)), np.zeros((len(position), 3))
    np.add.at(total, contacts["grain"], np.linalg.norm(force, axis=1))
    between = contacts["partner"] >= 0
    np.add.at(total, contacts["partner"][between], np.linalg.norm(force[between], axis=1))
    np.add.at(walls, contacts["grain"][~between], force[~between])
    count = np.bincount(contacts["grain"], minlength=len(position)) + np.bincount(contacts["partner"][between],
                                                                                 minlength=len(position))
    assert close(frame.positions, position) and close(frame.arrays["radius"], file[f"particles/{replica}/diameter"][:] / 2)
    assert (frame.arrays["id"] == np.arange(len(position))).all()
    assert close(frame.arrays["force_magnitude"], total) and close(frame.arrays["wall_force"], walls)
    assert (frame.arrays["coordination_number"] == count).all()
    assert frame.info["frame"] == scan and frame.info["phase"] == ("load", "unload")[row["phase"]]
    assert close(frame.info["Time"], row["time"]) and close(frame.info["plate_z"], row["plate_z"])
    assert close(frame.info["top_force"], row["wall_force"][5, 2]) and not frame.pbc.any()
    assert close(frame.cell.lengths(), file[f"particles/{replica}/box"].attrs["edges"])


program, source, _ = arguments()
exported = Exported(program, source, "xyz")
with exported.open() as file:
    for replica in file["observables"]:
        frames = ase.io.read(next(exported.view.glob(f"{replica}*.xyz")), index=":")
        assert len(frames) == len(file[f"observables/{replica}"]), len(frames)
        assert frames[0].info["label"] == file[f"particles/{replica}"].attrs["label"].decode()
        for scan, frame in enumerate(frames):
            check_frame(frame, file, replica, scan)

mixed = Exported(program, source, "xyz", "two_species.toml")
with mixed.open() as file:
    replica = next(iter(file["observables"]))
    names = [name.decode() for name in file[f"particles/{replica}/species_names"]]
    frame = ase.io.read(next(mixed.view.glob(f"{replica}*.xyz")))
    assert list(frame.arrays["element"]) == [names[one] for one in file[f"particles/{replica}/species"]]
    assert len(set(frame.arrays["element"])) == 2
