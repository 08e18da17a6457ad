"""Data of a report in addition to scans: provenance of the runs, and packings for the 3D view."""
import hashlib
import os
import pathlib
from collections.abc import Sequence

from ..look import is_there
from ..observe.replicas import Setting
from ..results import Run
from ..results.folder import result_files
from .labels import words_for
from .packing_view import PackingLimits, ShownPacking, numbers_of_scan, scans_shown
from .run_page import RunOrigin


def diagnosis_file(path: str) -> str | None:
    """diagnosis.json in the folder of a diagnosis, or the file itself; otherwise nothing."""
    if pathlib.Path(path).suffix == ".json":
        return path
    file = os.path.join(path, "diagnosis.json")
    return file if is_there(file) else None


def origins_of(paths: Sequence[str], runs: Sequence[Run]) -> list[RunOrigin]:
    """Provenance of the runs in order, with the SHA-256 of every result file."""
    return [RunOrigin(path, run, [(os.path.basename(file), _digest(file)) for file in result_files(path)])
            for path, run in zip(paths, runs, strict=True)]


def _digest(file: str) -> str:
    with open(file, "rb") as content:
        return hashlib.file_digest(content, "sha256").hexdigest()


def shown_packings(settings: Sequence[Setting], limits: PackingLimits) -> tuple[list[ShownPacking], list[str]]:
    """The first replica of every setting with as many scans as fit, and notes on what is left out."""
    recordings = [setting.replicas[0] for setting in settings]
    numbers = 0
    for one in recordings:
        grains = len(one.diameter)
        shown, contacts = min(grains, limits.max_grains), max(map(len, one.scans.contacts), default=0)
        numbers += numbers_of_scan(shown, contacts * shown // max(1, grains))
    packings = [ShownPacking(words_for(setting.label), one, scans_shown(one, numbers, limits))
                for setting, one in zip(settings, recordings, strict=True)]
    return packings, _notes([(one.label, _left_out(one, limits.max_grains)) for one in packings
                             if one.rows and len(one.recording.scans.position[one.rows[0]])])


def _left_out(packing: ShownPacking, max_grains: int) -> str:
    """What of the packing is not displayed; empty if all is."""
    scans, grains = len(packing.recording.scans), len(packing.recording.diameter)
    return ", ".join(words for is_left_out, words in (
        (len(packing.rows) < scans, f"{len(packing.rows)} of {scans} scans, evenly spread (--scans shows more)"),
        (grains > max_grains, f"the {max_grains} grains of {grains} nearest to the middle plane")) if is_left_out)


def _notes(left_out: Sequence[tuple[str, str]]) -> list[str]:
    """A note for each incomplete packing, or a common note if it is the same for all."""
    words = [words for _, words in left_out]
    if len(words) > 1 and len(set(words)) == 1:
        return [f"Shown of every packing: {words[0]}."] if words[0] else []
    return [f"Shown of {label}: {words}." for label, words in left_out if words]
