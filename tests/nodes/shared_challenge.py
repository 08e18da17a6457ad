"""What the tests of a challenge that many work at share: a small one, its answers by one process, and a worker killed."""
import json
import os
import pathlib
import shutil
import signal

from shared_runs import claim_of, files_in, wait_until

SCENE = pathlib.Path(__file__).resolve().parents[1] / "ensemble" / "tiny_challenge.toml"


def command_of(out):
    return ["challenge", "run", "challenge", "--scene", "tiny.toml", "--library", f"{out}.json", "--out", out,
            "--candidates", "friction,force_bias", "--library-packings", "8", "--library-replicates", "2",
            "--replicates", "3", "--confirmations", "2"]


def run_alone(place):
    """Makes the challenge, and answers it."""
    shutil.copy(SCENE, place.path / "tiny.toml")
    place.run([place.mcdem, "challenge", "make", "tiny.toml", "--out", "challenge", "--truth", "truth.json", "--seed",
               "3", "--effects", "friction,force_bias", "--none", "3", "--per-effect", "1", "--pairs", "0", "--unknown",
               "0", "--outside", "0", "--packings", "2"])
    place.run([place.mcdem, *command_of("alone")])


def kill_a_worker(place, out):
    """kill -9 of one that diagnoses a case."""
    def victim():
        claims = map(claim_of, files_in(place.path / out / "claims", "case*.claim-*"))
        return next((claim["process"] for claim in claims if claim.get("state") == "held"), None)

    os.kill(wait_until(victim, "a case that is diagnosed"), signal.SIGKILL)


def answers(folder):
    """All files of a challenge's answers; of the diagnoses without the time that each took."""
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
    # The last worker may end a little later than who waits for the answers.
    wait_until(lambda: not (place.path / out / "claims").exists(), "an end of the claims")
