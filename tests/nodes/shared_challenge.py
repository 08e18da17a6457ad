"""Shared by the tests of distributed challenges: a small challenge, its answers by a single process, and a killed
process."""
import json
import pathlib
import shutil

from shared_runs import Hold

SCENE = pathlib.Path(__file__).resolve().parents[1] / "ensemble" / "tiny_challenge.toml"


def command_of(out):
    return ["challenge", "run", "challenge", "--scene", "tiny.toml", "--library", f"{out}.json", "--out", out,
            "--candidates", "friction,force_bias", "--library-packings", "8", "--library-replicates", "2",
            "--replicates", "3", "--confirmations", "2"]


def run_alone(place):
    """Makes the challenge and answers it with a single process."""
    shutil.copy(SCENE, place.path / "tiny.toml")
    place.run([place.mcdem, "challenge", "make", "tiny.toml", "--out", "challenge", "--truth", "truth.json", "--seed",
               "3", "--effects", "friction,force_bias", "--none", "3", "--per-effect", "1", "--pairs", "0", "--unknown",
               "0", "--outside", "0", "--packings", "2"])
    place.run([place.mcdem, *command_of("alone")])


def hold(place, out):
    """Blocks a process that diagnoses a case."""
    return Hold(place, launches=0, only_one=True, after=place.path / out / "library.json")


def answers(folder):
    """All files of a challenge's answers; diagnoses without their run times."""
    found = {}
    for file in sorted(folder.rglob("*.json")):
        text = file.read_text()
        if file.parent == folder and file.name.startswith("case"):
            found[file.name] = {key: value for key, value in json.loads(text).items() if key != "seconds"}
        else:
            found[str(file.relative_to(folder))] = text
    found["simulations"] = {file.name: file.read_bytes() for file in sorted((folder / "simulations").iterdir())}
    return found


def expect_like_alone(place, out):
    expected, got = (answers(place.path / name) for name in ("alone", out))
    assert expected.keys() == got.keys(), expected.keys() ^ got.keys()
    differing = [name for name in expected if expected[name] != got[name]]
    assert len(expected) > 10 and not differing, differing
