"""The simulations of a diagnosis's library, as parts for several processes."""
import pathlib
from collections.abc import Callable

from ..look import Path, is_there
from ..manifest import device_file, keep_manifest, read_manifest
from ..outputs import remove_temporaries
from .simulations import Simulations

DEVICE = "device"  # entry of its manifest


class LibraryParts:
    """Nothing is missing if the library's file exists. When all parts exist, a diagnosis builds the library without simulating."""

    def __init__(self, simulations: Simulations, folder: pathlib.Path, library: Path | None) -> None:
        """`folder`: that of the diagnosis, on which a shared lock is held."""
        self._simulations, self._folder = simulations, folder
        self._is_needed = library is None or not is_there(library)
        for place in (folder, folder / "simulations"):  # of killed processes; others lock theirs
            remove_temporaries(place)

    def count(self) -> int:
        return self._simulations.count_parts() if self._is_needed else 0

    def missing(self) -> list[int]:
        return missing_parts(self._simulations, self._folder) if self._is_needed else []

    def compute(self, part: int, progress: Callable[[float], object]) -> None:
        expect_device(self._simulations, self._folder)
        self._simulations.compute_part(part, progress)

    def merge(self) -> bool:
        return True


def missing_parts(simulations: Simulations, folder: Path) -> list[int]:
    """Those of the device that computes in the folder; all of them if none has begun."""
    return simulations.missing_parts((read_manifest(device_file(folder)) or {}).get(DEVICE, ""))


def expect_device(simulations: Simulations, folder: Path) -> None:
    """Raises InputError if the work in the folder was begun with another device."""
    keep_manifest(device_file(folder), {DEVICE: simulations.device})
