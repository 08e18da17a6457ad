"""Atomic file writes."""
import fcntl
import os
import pathlib
import secrets


def write_whole(file, content):
    """Writes bytes to a temporary file, flushes it to disk and renames it. An OSError names the file."""
    file = pathlib.Path(file)
    temporary = file.with_name(f"{file.name}.{secrets.token_hex(8)}.tmp")
    try:
        with open(temporary, "xb") as out:
            fcntl.flock(out, fcntl.LOCK_EX)  # others remove only unlocked files (host/core/atomic_file.cpp)
            out.write(content)
            out.flush()
            os.fsync(out.fileno())
        os.replace(temporary, file)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(file)) from error
    finally:
        temporary.unlink(missing_ok=True)
