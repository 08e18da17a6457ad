"""Every example in Python of host/python/README.md and README.md works: the ```python blocks of each are run in their
order, in one empty folder.

readme_examples.py SOURCE PROGRAM; PROGRAM runs the blocks ```sh of the former between them.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile


def blocks(source, document="host/python/README.md"):
    text = (pathlib.Path(source) / document).read_text()
    return re.findall(r"^```(python|sh)\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


def examples(source):
    return [code for language, code in blocks(source) if language == "python"]


def main():
    source, program = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    os.environ["PATH"] = f"{program.parent}:{os.environ['PATH']}"
    first = [block for block in blocks(source, "README.md") if block[0] == "python"]
    names = {}
    assert first and len(examples(source)) >= 3
    with tempfile.TemporaryDirectory(prefix="mcdem-readme-") as folder:
        os.chdir(folder)
        os.environ["MPLCONFIGDIR"] = folder
        os.symlink(source / "scenes", "scenes")
        for language, code in first + blocks(source):
            if language == "python":
                exec(compile(code, "README.md", "exec"), names)
            else:
                for line in code.splitlines():
                    if line.startswith("mcdem "):
                        subprocess.run(line, shell=True, check=True)


if __name__ == "__main__":
    main()
