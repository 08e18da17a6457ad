"""The README holds: its table is the one that scripts/quickstart prints; its files, commands and options exist.

readme_test.py SOURCE_FOLDER PROGRAM
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

TOLERANCE = 0.01  # last bits differ between processors, and contacts in a packing multiply such differences


def rows(text):
    """The table of top forces: title and rows, as lists of cells."""
    lines = text[re.search(r"^ *model +top force", text, re.MULTILINE).start():].split("\n")
    table = []
    for line in lines:
        if not line.strip():
            break
        if "─" not in line:
            table.append(re.split(r"  +", line.strip()))
    return table


def differs(stated, printed):
    try:
        return abs(float(stated) - float(printed)) > TOLERANCE * abs(float(printed))
    except ValueError:
        return stated != printed


def wrong_table(readme, quickstart, source, program):
    """Runs the scene of scripts/quickstart, without its figures."""
    scene = re.search(r"^build/mcdem run (\S+) --out \S+$", quickstart, re.MULTILINE)[1]
    with tempfile.TemporaryDirectory(prefix="mcdem-readme-") as folder:
        subprocess.run([program, "run", source / scene, "--out", f"{folder}/run", "--no-figures"], stdout=subprocess.DEVNULL, check=True)
        printed = rows(subprocess.run([program, "table", f"{folder}/run"], text=True, stdout=subprocess.PIPE, check=True).stdout)
    stated = rows(readme)
    if len(stated) != len(printed):
        yield f"the table has {len(stated) - 1} models, the run {len(printed) - 1}"
    for here, there in zip(stated, printed):
        if len(here) != len(there) or any(map(differs, here, there)):
            yield f"the table states {here}, the run prints {there}"


def missing_files(readme, source):
    for path in sorted(set(re.findall(r"\b(?:scripts|scenes|host|kernels|bench|tests|examples)/[\w./-]*\w", readme))):
        if not (source / path).exists():
            yield f"{path}: does not exist"
        elif path.startswith("scripts/") and path.count(".") == 0 and not os.access(source / path, os.X_OK):
            yield f"{path}: is not executable"


def commands(readme):
    """The subcommands of each command in a block of code, and its options."""
    for language, block in re.findall(r"^```(\w*)\n(.*?)^```", readme, re.DOTALL | re.MULTILINE):
        for line in block.replace("\\\n", " ").splitlines() if language != "python" else []:
            words = line.split("#")[0].split()
            if "mcdem" not in words:
                continue
            words = words[words.index("mcdem"):]
            if words[1:2] == ["distribute"]:
                yield ["distribute"], []
                words = words[1:]
            names = words[1:3] if words[1:2] == ["experiment"] else words[1:2]
            yield names, [word for word in words if word.startswith("--")]


def missing_options(readme, program):
    for names, options in commands(readme):
        told = subprocess.run([program, *names, "--help"], text=True, stdout=subprocess.PIPE, check=True).stdout
        if f"Usage: mcdem {' '.join(names)} " not in told:  # an unknown command gets the general help
            yield f"mcdem {' '.join(names)}: is no command"
        for option in options:
            if not re.search(rf"{option}\b", told):
                yield f"mcdem {' '.join(names)}: has no option {option}"


def main():
    assert rows("a\n  model  top force\n  ────  ──\n  b c   1.5\n\n d") == [["model", "top force"], ["b c", "1.5"]]
    assert not differs("1.5", "1.501") and differs("1.5", "1.6") and differs("a", "b") and not differs("a", "a")
    assert list(commands("```python\nimport mcdem\n```\n\n```\nmpirun -n 8 mcdem run a --out b  # --c\n```\n")) == [(["run"], ["--out"])]
    source, program = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    readme, quickstart = (source / "README.md").read_text(), (source / "scripts" / "quickstart").read_text()
    problems = [*missing_files(readme, source), *missing_options(readme, program),
                *wrong_table(readme, quickstart, source, program)]
    print("\n".join(problems) or "the README holds")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
