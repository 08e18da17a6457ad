"""Every Python example in the documentation works: the ```python blocks are run in order, in one empty folder.

readme_examples.py SOURCE PROGRAM; PROGRAM runs the ```sh blocks of host/python/README.md between them.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

MODULE = "host/python/README.md"
DOCUMENTS = ["README.md", MODULE, "host/io/README.md"]
TESTED_ELSEWHERE = {"CONTRIBUTING.md"}  # diagnosis/contributing_test.py, report/run_values_test.py


def blocks(source, document):
    text = (pathlib.Path(source) / document).read_text()
    return re.findall(r"^```(python|sh)\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


def examples(source, document=MODULE):
    return [code for language, code in blocks(source, document) if language == "python"]


def documents_with_examples(source):
    """Markdown files of the source folder, without build folders and output."""
    folders = [one for one in source.iterdir() if one.is_dir() and not re.match(r"\.|build|out|shared", one.name)]
    found = [*source.glob("*.md"), *(file for folder in folders for file in folder.rglob("*.md"))]
    return {str(file.relative_to(source)) for file in found if re.search("^```py", file.read_text(), re.MULTILINE)}


def run_document(source, document, names):
    for language, code in blocks(source, document):
        if language == "python":
            exec(compile(code, document, "exec"), names)
        elif document == MODULE:
            for line in code.splitlines():
                if line.startswith("mcdem "):
                    subprocess.run(line, shell=True, check=True)


def check_reader(names):
    """Compares values read by h5py with those of the module."""
    names["run"].close()
    recording = names["mcdem"].read("DIR")[0]
    assert (names["top_force"] == recording.top_force).all()
    assert len(names["last"]) == len(recording.contacts(len(recording.scans) - 1)) > 0
    assert names["keys"]["packing.count"] == "60", names["keys"]


def main():
    source, program = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    os.environ["PATH"] = f"{program.parent}:{os.environ['PATH']}"
    assert documents_with_examples(source) == {*DOCUMENTS, *TESTED_ELSEWHERE}, documents_with_examples(source)
    names = {}
    with tempfile.TemporaryDirectory(prefix="mcdem-readme-") as folder:
        os.chdir(folder)
        os.environ["MPLCONFIGDIR"] = folder
        os.symlink(source / "scenes", "scenes")
        os.symlink("results", "DIR")  # the run of host/python/README.md under its name in host/io/README.md
        for document in DOCUMENTS:
            run_document(source, document, names)
        check_reader(names)


if __name__ == "__main__":
    main()
