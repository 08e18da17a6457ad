"""Sources are formatted by clang-format (.clang-format).

format_test.py SOURCE_FOLDER; skipped (77) if clang-format 14 is missing: other versions format differently.
"""
import pathlib
import shutil
import subprocess
import sys

FOLDERS = ("host", "kernels", "tests", "bench")
ENDINGS = {".cpp", ".h", ".cl"}


def main():
    root = pathlib.Path(sys.argv[1])
    program = shutil.which("clang-format-14") or shutil.which("clang-format")
    version = subprocess.run([program, "--version"], capture_output=True, text=True).stdout if program else ""
    if " 14." not in version:
        print("skipped: clang-format 14 is not there (Debian package clang-format)")
        return 77
    files = [str(file) for folder in FOLDERS for file in sorted((root / folder).rglob("*"))
             if file.suffix in ENDINGS and file.is_file()]
    assert len(files) > 100, len(files)
    done = subprocess.run([program, "--dry-run", "-Werror", *files], capture_output=True, text=True)
    wrong = sorted({line.split(":")[0] for line in done.stderr.splitlines() if "error:" in line})
    print("\n".join(f"{file}: is not formatted; run `clang-format -i` on it" for file in wrong)
          or f"{len(files)} files as clang-format writes them")
    return 1 if wrong or done.returncode != 0 else 0


sys.exit(main())
