"""scenes/compression.toml with each of six contact models against an experiment of another packing that has no effect: diagnosed with
all candidates and default numbers, no gap is found, and what cannot be told is named.

diagnosis_models_test.py MCDEM FOLDER [MODEL ..]; all six models where none is named.
"""
import json
import pathlib
import subprocess
import sys

SCENE = pathlib.Path(__file__).resolve().parents[1] / "scenes" / "compression.toml"
MODELS = ["independent", "point_force_on_sphere", "sphere_to_sphere", "elastic_half_space", "mc_dem", "elastic_sphere"]
MIN_CELLS = 100  # of 312 that are compared


def diagnosed(mcdem, folder, model):
    place = folder / model
    place.mkdir(parents=True, exist_ok=True)
    with open(place / "log.txt", "a") as log:
        def run(*words):
            subprocess.run([mcdem, *words], cwd=place, stdout=log, stderr=log, check=True)
        contacts = ["--set", f"contact.model={model}"]
        if not (place / "experiment").exists():
            run("run", SCENE, *contacts, "--set", "packing.seed=7", "--set", "protocol.scan_at_start=true", "--out", "reality",
                "--no-figures")
            run("experiment", "from-run", "reality", "--out", "experiment")
        run("diagnose", SCENE, *contacts, "--experiment", "experiment", "--out", "diagnosis")
    return json.loads((place / "diagnosis" / "diagnosis.json").read_text())


def main():
    mcdem, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    failed = []
    for model in sys.argv[3:] or MODELS:
        told = diagnosed(mcdem, folder, model)
        print(f"{model}: {told['sentence']} {told['seconds']:.0f} s, {len(told['cells'])} cells", flush=True)
        for note in told["not_testable"]:
            print(f"    {note}")
        tried = {cause["effect"] for cause in told["ranking"]}
        if told["verdict"] != "no_gap" or len(told["cells"]) < MIN_CELLS or not {"friction", "adhesion", "plate_tilt"} <= tried:
            failed.append(model)
    if failed:
        sys.exit(f"not as expected: {', '.join(failed)}")


main()
