"""Shell completion, tested in the shells themselves.

completion_test.py PROGRAM; exit code 77: no errors, but a shell is not installed.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

program = pathlib.Path(sys.argv[1]).resolve()


def run(*words, **more):
    return subprocess.run(words, text=True, capture_output=True, check=True, **more).stdout


def bash(script, *words):
    """Completions of the last word by bash. compopt works only in interactive shells, so it is replaced."""
    code = ('compopt() { :; }; source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _mcdem; '
            'printf "%s\\n" "${COMPREPLY[@]}"')
    return set(run("bash", "-c", code, "bash", script, str(program), *words).split())


def fish(script, *words):
    line = " ".join((str(program), *words))
    said = run("fish", "--no-config", "-c", f"source {script}; complete -C '{line}'")
    return {one.split("\t")[0] for one in said.splitlines()}


def zsh(script, *words):
    """compadd and similar functions work only in interactive shells; _describe and the others print their arguments
    instead."""
    code = ('compdef() { :; }; compadd() { print -l -- "$@" }; _files() { print files "$@" }; _message() { :; }; '
            '_describe() { print -l -- "${(@P)@[-1]%%:*}" }; source "$1"; shift; words=("$@"); CURRENT=$#; _mcdem')
    return set(run("zsh", "-f", "-c", code, "zsh", script, str(program), *words).split())


def check(complete, script):
    assert "run" in complete(script, "ru"), complete(script, "ru")
    assert "check" in complete(script, "experiment", "ch"), complete(script, "experiment", "ch")
    assert "--resume" in complete(script, "run", "--re"), complete(script, "run", "--re")
    assert "--vtk" in complete(script, "export", "--v") and "--resume" not in complete(script, "export", "--")
    keys = complete(script, "run", "scene.toml", "--set", "grains.fr")
    assert "grains.friction=" in keys or {"grains.friction", "="} <= keys, keys
    assert {"bash", "zsh", "fish"} <= complete(script, "completion", ""), complete(script, "completion", "")


def check_all_commands(script):
    """Every command listed by the help, and every option of `run`."""
    listed = [line.split()[0] for line in run(program, "--help").split("Subcommands:")[1].split("\n\n")[0].splitlines()
              if line]
    assert len(listed) > 8 and set(listed) <= bash(script, ""), listed
    options = {word for line in run(program, "run", "--help").splitlines() if line.startswith("  -")
               for word in line.split()[0].split(",")}
    assert len(options) > 4 and options == bash(script, "run", "-"), options


def main():
    missing = []
    with tempfile.TemporaryDirectory(prefix="mcdem-completion-") as name:
        os.chdir(name)
        pathlib.Path("scene.toml").touch()
        pathlib.Path("results").mkdir()
        for shell, complete in (("bash", bash), ("fish", fish), ("zsh", zsh)):
            if not shutil.which(shell):
                missing.append(shell)
                continue
            script = str(pathlib.Path(name) / f"mcdem.{shell}")
            pathlib.Path(script).write_text(run(program, "completion", shell))
            check(complete, script)
        script = str(pathlib.Path(name) / "mcdem.bash")
        assert bash(script, "run", "sc") == {"scene.toml"}
        assert bash(script, "run", "scene.toml", "--out", "") == {"results"}
        check_all_commands(script)
    if missing:
        print(f"skipped: not installed, so not tried: {', '.join(missing)}")
        sys.exit(77)


if __name__ == "__main__":
    main()
