"""What is at a path, as host/core/look.h: a path that cannot be looked at raises OSError, and is never "nothing there".

os.path.exists, isfile and their like take every error for "no".
"""
import os
import stat


def _mode(path, follow_links=True):
    try:
        return os.stat(path, follow_symlinks=follow_links).st_mode
    except (FileNotFoundError, NotADirectoryError):
        return None


def is_there(path):
    """Whether there is anything at the path; a link to nothing counts."""
    return _mode(path, follow_links=False) is not None


def is_file(path):
    mode = _mode(path)
    return mode is not None and stat.S_ISREG(mode)


def is_folder(path):
    mode = _mode(path)
    return mode is not None and stat.S_ISDIR(mode)


def is_link(path):
    mode = _mode(path, follow_links=False)
    return mode is not None and stat.S_ISLNK(mode)
