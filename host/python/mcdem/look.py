"""What is at a path, as host/core/look.h: a path that cannot be looked at raises OSError, and is never "nothing there".

os.path.exists, isfile and their like take every error for "no".
"""
import os
import stat

Path = str | os.PathLike[str]


def _mode(path: Path, follow_links: bool = True) -> int | None:
    try:
        return os.stat(path, follow_symlinks=follow_links).st_mode
    except (FileNotFoundError, NotADirectoryError):
        return None


def is_there(path: Path) -> bool:
    """Whether there is anything at the path; a link to nothing counts."""
    return _mode(path, follow_links=False) is not None


def leads_somewhere(path: Path) -> bool:
    """Whether there is anything at the path, or where a link there leads."""
    return _mode(path) is not None


def is_file(path: Path) -> bool:
    mode = _mode(path)
    return mode is not None and stat.S_ISREG(mode)


def is_folder(path: Path) -> bool:
    mode = _mode(path)
    return mode is not None and stat.S_ISDIR(mode)


def is_link(path: Path) -> bool:
    mode = _mode(path, follow_links=False)
    return mode is not None and stat.S_ISLNK(mode)
