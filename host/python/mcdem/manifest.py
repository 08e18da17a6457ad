"""Inputs of the work in a folder: written once, and checked by every later command (as host/ensemble/parts/manifest.h)."""
import json
import pathlib
from collections.abc import Mapping

from .errors import InputError
from .files import create_whole, read_input
from .look import Path, leads_somewhere


def manifest_file(folder: Path) -> pathlib.Path:
    """Of what does not depend on the device."""
    return pathlib.Path(folder) / "manifest.json"


def device_file(folder: Path) -> pathlib.Path:
    """Of the device. The first process that computes writes it: the one that starts the work may not have such a device."""
    return pathlib.Path(folder) / "device.json"


def read_manifest(file: Path) -> dict[str, str] | None:
    """None if the file does not exist or is damaged."""
    if not leads_somewhere(file):
        return None
    try:
        found = json.loads(read_input(file))
    except (ValueError, RecursionError) as error:
        if isinstance(error, InputError):
            raise
        return None
    if not isinstance(found, dict) or not found or not all(isinstance(value, str) for value in found.values()):
        return None
    return found


def keep_manifest(file: Path, wanted: Mapping[str, str], chosen: str = "") -> Mapping[str, str]:
    """Writes `wanted` if there is no manifest. Returns the content of the file.

    Raises InputError if it is damaged, or with all entries that differ; the entry `chosen` may differ. Raises RunError.
    """
    text = json.dumps(wanted, indent=1, sort_keys=True, ensure_ascii=False) + "\n"
    if create_whole(file, text.encode()):
        return wanted
    kept = read_manifest(file)
    if kept is None:
        raise InputError(f"{file}: is damaged: restore it from a copy, or give another folder")
    problems = [f"{pathlib.Path(file).parent}: was begun with another {name}: {kept.get(name, '')}; got {mine}: give the same, or another "
                "folder" for name, mine in sorted(wanted.items()) if kept.get(name, "") != mine and name != chosen]
    if problems:
        raise InputError(problems)
    return kept
