"""Every command in the documentation works: runs the ```sh blocks of the documents in order.

documented_commands_test.py SOURCE_FOLDER FOLDER_OF_PROGRAM DOCUMENT..

Runs the lines of each block that begin with `mcdem` or `python3 examples/`, all in one temporary folder that has the
same layout as the source folder. A command must end with exit code 0. Lines that end with `# long`, and commands on
data that is not available (folder data/), are skipped.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

TIME_LIMIT = 600  # seconds for one command; the longest takes 20 s on an idle core, and other checks run beside this test
# Options added to commands that contain this, so that they take less time: the packing of tests/ensemble/tiny_challenge.toml, and the fewest
# runs of a diagnosis.
SMALLER = {"scenes/challenge.toml": "--set packing.count=64 --set packing.packing_fraction=0.59 --set box.size_x=0.083 --set box.size_y=0.083 "
                                    "--set plate.start=0.0835 --set plate.end=0.0685",
           "mcdem diagnose": "--replicates 8 --pairs 2 --confirmations 2"}


def commands(text):
    """The commands of a document, with continued lines joined."""
    for block in re.findall(r"^```sh\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
        for line in block.replace("\\\n", " ").splitlines():
            line = line.strip().removeprefix("$ ")
            if re.match(r"(mcdem|python3 examples/)", line):
                yield line


def is_left_out(command):
    return command.endswith("# long") or re.search(r"\bdata/", command)


def smaller(command):
    """The command with the options of SMALLER, which replace its own, before its comment."""
    words, comment, text = command.partition("#")
    return " ".join([words, *(options for part, options in SMALLER.items() if part in words)]) + f"  {comment}{text}".rstrip()


def working_folder(source, folder):
    for name in ("scenes", "examples", "host", "README.md"):
        if (source / name).exists():
            (folder / name).symlink_to(source / name)


def failures(source, program, document, folder):
    # Debian's modules are installed only for its own Python.
    environment = dict(os.environ, PATH=f"{program}:/usr/bin:{os.environ['PATH']}", MPLCONFIGDIR=str(folder))
    for command in commands(document.read_text()):
        where = document.relative_to(source)
        if is_left_out(command):
            print(f"{where}: left out: {command}")
            continue
        print(f"{where}: {command}", flush=True)
        try:
            done = subprocess.run(["bash", "-c", smaller(command)], cwd=folder, env=environment, timeout=TIME_LIMIT)
            if done.returncode != 0:
                yield f"{where}: exit code {done.returncode}: {command}"
        except subprocess.TimeoutExpired:
            yield f"{where}: longer than {TIME_LIMIT} s, say `# long`: {command}"


def main():
    assert list(commands("```sh\nmcdem a \\\n  b\nls\n$ mcdem c  # long\n```\n```toml\nmcdem d\n```\n")) == [
        "mcdem a    b", "mcdem c  # long"]
    assert smaller("mcdem diagnose a  # b") == f"mcdem diagnose a   {SMALLER['mcdem diagnose']}  # b" and smaller("mcdem a") == "mcdem a"
    source, program = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    problems = []
    with tempfile.TemporaryDirectory(prefix="mcdem-docs-") as name:
        folder = pathlib.Path(name)
        working_folder(source, folder)
        for document in (source / word for word in sys.argv[3:]):
            if document.exists():
                problems += failures(source, program, document, folder)
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
