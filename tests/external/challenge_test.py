"""The challenge with other codes: hidden effects are as stated, the truth is sealed, and the score is correct.

challenge_test.py MCDEM FOLDER; exit code 77 if one of the programs is missing.
"""
import copy
import hashlib
import importlib.machinery
import importlib.util
import json
import math
import pathlib
import random
import shutil
import subprocess
import sys
import tomllib

import cases
import hidden
import realities

HERE = pathlib.Path(__file__).resolve().parent


def load_challenge():
    loader = importlib.machinery.SourceFileLoader("challenge", str(HERE / "challenge"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("challenge", loader))
    loader.exec_module(module)
    return module


def scans():
    """Three grains in a row, with one contact between two of them and one with the floor; one stroke down and up."""
    grains = [(0.02, 0.03 + 0.02 * n, 0.0625, 0.01) for n in range(3)]
    contacts = [(0, 1, [0.04, 0.0625, 0.01], [0.3, 0.0, 0.4]), (2, "floor", [0.07, 0.0625, 0.0], [0.0, 0.0, 1.0])]
    return [{"height": 0.12 - 0.01 * depth, "phase": phase, "top": top, "grains": list(grains), "contacts": list(contacts)}
            for depth, phase, top in ((0, "load", 0.0), (1, "load", 2.0), (2, "load", 6.0), (1, "unload", 1.0))]


def read(name, amplitude):
    changed = copy.deepcopy(scans())
    hidden.find(name).reading(changed, amplitude, random.Random(1))
    return changed


def tops(changed):
    return [scan["top"] for scan in changed]


def test_readings():
    assert read("force_bias", 0.1)[0]["contacts"][0][3][2] == 0.4 * 1.1
    assert math.isclose(read("force_saturation", 2)[0]["contacts"][0][3][2], 0.4 / (1 + 2 * 0.5))
    dim = read("dim_walls", 0.3)[0]["contacts"]
    assert dim[0][3] == [0.3, 0.0, 0.4] and math.isclose(dim[1][3][2], 0.7)
    assert [len(scan["contacts"]) for scan in read("lost_contacts", 1)] == [1] * 4, "those at walls stay"
    fewer = read("missing_grains", 1 / 3)[0]
    assert len(fewer["grains"]) == 2 and all(i < 2 for i, *_ in fewer["contacts"])
    first, later = scans()[0]["grains"], read("swapped_labels", 2 / 3)[1]
    moved = [i for i in range(3) if later["grains"][i] != first[i]]
    assert len(moved) == 2 and sorted(later["grains"]) == first, "a pair of neighbours"
    i, j, point, _ = later["contacts"][0]
    assert math.isclose(later["grains"][i][1] + later["grains"][j][1], 2 * point[0]), "contacts stay with their grains"
    assert math.isclose(read("diameter_error", 1e-3)[0]["grains"][1][0], 0.019)
    assert read("position_bias", 0.1)[0]["grains"][0][1:] == (0.0625 - 1.1 * 0.0325, 0.0625, 0.01 * 1.1)
    assert read("height_bias", 0.1)[0]["grains"][0][1:] == (0.03, 0.0625, 0.01 * 1.1)
    edge = 0.0625 - (1 + 0.1 * (0.0325 / 0.0625)**2) * 0.0325
    assert math.isclose(read("barrel", 0.1)[0]["grains"][0][1], edge)
    mixed = [{"contacts": [(0, 1, None, [1, 0, 0]), (0, 2, None, [3, 0, 0])]}]
    hidden.find("mixed_forces").reading(mixed, 0.5, None)
    assert [force for *_, force in mixed[0]["contacts"]] == [[1.25, 0, 0], [2.75, 0, 0]]
    tilted = read("rotated_image", 0.1)[0]["grains"]
    assert math.isclose(math.dist(tilted[0][1:], tilted[2][1:]), 0.04), "a rotation"
    assert math.isclose((tilted[2][3] - tilted[0][3]) / (tilted[2][1] - tilted[0][1]), -0.1)
    moving = [{"grains": [(0.02, 0.05, 0.05, z)]} for z in (0.08, 0.04)]
    hidden.find("slow_scan").reading(moving, 0.2, None)
    assert math.isclose(moving[1]["grains"][0][3], 0.04 + 0.2 * 0.5 * 0.04), "half way up, by half of the fraction"
    assert all(map(math.isclose, tops(read("force_lag", 0.005)), [0, 1, 4, 3.5]))
    assert all(map(math.isclose, tops(read("guide_friction", 0.1)), [0, 2.6, 6.6, 0.4]))
    assert all(map(math.isclose, tops(read("gauge_drift", 0.3)), [0, 2.2, 7.2, 1.3]))
    assert all(map(math.isclose, tops(read("gauge_hysteresis", 0.15)), [0, 2, 6, 1.5]))
    assert all(map(math.isclose, tops(read("zero_drift", 0.1)), [0, 2.2, 6.4, 1.6]))
    assert all(map(math.isclose, [scan["height"] for scan in read("backlash", 1e-3)], [0.12, 0.11, 0.10, 0.111]))
    assert math.isclose(read("plate_compliance", 1e-3)[2]["height"], 0.10 - 6e-3)


def test_moduli():
    logs = [math.log(m / 23.3e3) for m in hidden.scattered_moduli("liggghts", 0.4, None)["moduli"]]
    assert abs(sum(logs)) < 1e-6 and math.isclose(math.sqrt(sum(x * x for x in logs) / 8), 0.4, rel_tol=1e-6)


def test_yade(folder):
    """Yade's contacts are the scene's: Hertz's force at these overlaps but for damping, and Coulomb's limit."""
    most = 0
    for scan in realities.simulate(folder / "yade", 1, cases.yade(friction=0.05))[::6]:
        ratios = []
        for i, j, point, force in scan["contacts"]:
            d, *centre = scan["grains"][i]
            partner, *there = (math.inf, *point) if isinstance(j, str) else scan["grains"][j]
            normal = [(a - b) / math.dist(centre, there) for a, b in zip(centre, there)]
            overlap = (d + partner) / 2 - math.dist(centre, there) if partner < math.inf else d / 2 - math.dist(centre, there)
            radius = 1 / (2 / d + 2 / partner)
            pressing = sum(f * n for f, n in zip(force, normal))
            rubbing = math.hypot(*(f - pressing * n for f, n in zip(force, normal)))
            modulus = cases.E / (1 - cases.NU**2) / (1 + (cases.E / cases.STIFF_WALL if isinstance(j, str) else 1))
            ratios.append(pressing / (4 / 3 * modulus * math.sqrt(radius * overlap) * overlap) if overlap > 2e-4 else 1)
            mu = cases.FRICTION if isinstance(j, str) else 0.05
            assert rubbing <= 1.001 * mu * pressing + 1e-9, (rubbing, pressing)
            most = max(most, rubbing / pressing)
        assert abs(sum(ratios) / len(ratios) - 1) < 2e-3, sum(ratios) / len(ratios)
    assert most > 0.049, most


def answered(challenge, kind, effects, verdict, causes=(), limit=0.01):
    listed = [{"effect": e, "group": [e], "amplitude": a, "amplitude_error": 0.01, "at_limit": False, "confidence": p} for e, a, p in causes]
    truth = challenge.Reality("", kind, tuple(challenge.Hidden(*effect) for effect in effects), (), (), 0, 0, "lammps", 5, "stroke")
    return challenge.case_of(truth,
                             {"verdict": verdict, "causes": listed, "shrink": {"fraction": 0.9, "confirmed": 0.95},
                              "detection_limits": [{"effect": n, "minimum_amplitude": limit} for n, _ in effects]})


def test_score(challenge):
    cases = [answered(challenge, *case) for case in (
        ("none", [], "no_gap"),
        ("none", [], "effect", [("friction", 0.05, 0.9)]),
        ("effect", [("friction", 0.05)], "effect", [("friction", 0.06, 0.9)]),
        ("effect", [("friction", 0.05)], "effect", [("adhesion", 0.1, 0.5)]),
        ("effect", [("friction", 0.05)], "no_gap", (), 0.04),  # not clear
        ("effect", [("adhesion", 0.5)], "unknown_effect", [("adhesion", 0.5, 0.2)]),
        ("pair", [("friction", 0.05), ("adhesion", 0.5)], "effect", [("adhesion", 0.5, 0.9), ("friction", 0.05, 0)]),
        ("pair", [("friction", 0.05), ("adhesion", 0.5)], "effect", [("adhesion", 0.5, 0.9)]),
        ("unknown", [("barrel", 0.1)], "effect", [("adhesion", 0.5, 0.8)]),
        ("unknown", [("barrel", 0.1)], "unknown_effect"),
    )]
    told = challenge.figures(cases)
    assert told["no effect: a gap is claimed"].startswith("1 of 2:")
    assert told["one clear effect: detected"].startswith("3 of 3:")
    assert told["one clear effect, detected: named first"].startswith("1 of 3:")
    assert told["two clear effects: both named"].startswith("1 of 2:")
    assert told["not in the library: an effect is named"].startswith("1 of 2: 50 % [9, 91]"), "Wilson 1927"
    assert told["an effect is named: it is right"].startswith("3 of 6:")
    named = 0.9**2 + 0.1**2 + 0.5**2 + 0.1**2 + 0.1**2 + 0.8**2
    assert told["Brier score of the named ones (of the base rate)"] == f"{named / 6:.3f} (0.250)"
    every = (named + 0.8**2) / 7
    assert told["Brier score of all leading effects (of the base rate)"] == f"{every:.3f} ({4 / 7 * 3 / 7:.3f})"
    assert told["log score of all leading effects (of the base rate)"].endswith(f" ({-(4 * math.log(4 / 7) + 3 * math.log(3 / 7)) / 7:.3f})")
    assert told["90 % interval of the amplitude holds it"].startswith("1 of 1:")
    assert told["68 % interval of the amplitude holds it"].startswith("0 of 1:"), "one error too large"
    assert challenge.rank_counts(cases) == [1, 0, 0, 0, 0], "16 % of the stated distribution are below"
    assert challenge.reliability(cases)[-1][:2] == ["0.9 to 1.0", "0.90"]
    assert challenge.reliability(cases)[-1][2].startswith("3 of 4:")


def test_sealed(mcdem, folder):
    def make(*options):
        return subprocess.run([sys.executable, HERE / "challenge", "make", "--out", folder / "made", "--truth", folder / "truth.json", "--seed", "2",
                               "--per-effect", "0", "--pairs", "0", "--per-unknown", "0", *options], capture_output=True, text=True)

    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    assert make("--none", "3").returncode == 0
    seal = hashlib.sha256((folder / "truth.json").read_bytes()).hexdigest()
    opened = json.loads((folder / "made/challenge.json").read_text())
    assert opened["sealed_sha256"] == seal and len(opened["cases"]) == 3
    assert {case["code"] for case in json.loads((folder / "truth.json").read_text())["cases"]} == {"liggghts", "lammps", "yade"}
    for case in opened["cases"]:
        place = folder / "made" / case["folder"]
        assert subprocess.run([mcdem, "experiment", "check", place], capture_output=True).returncode == 0
        assert not any(code in (place / "experiment.toml").read_text().lower() for code in realities.PROGRAMS)
    for case in json.loads((folder / "truth.json").read_text())["cases"]:
        plate = tomllib.loads((folder / "made" / case["folder"] / "experiment.toml").read_text())["plate"]
        assert math.isclose(plate["speed"], realities.SPEED / case["slower"], rel_tol=0.01), plate
        rests = realities.STROKE / realities.SCANS / plate["speed"] if case["protocol"] == "paused" else 0
        assert math.isclose(plate.get("pause", 0), rests, rel_tol=0.01), plate
    before = {path: path.stat().st_mtime_ns for path in folder.glob("made/case_*/*.csv")}
    assert make("--none", "3").returncode == 0
    assert before == {path: path.stat().st_mtime_ns for path in folder.glob("made/case_*/*.csv")}
    other = make("--none", "4")
    assert other.returncode != 0 and "another challenge" in other.stderr, other.stderr


def main():
    if missing := realities.missing_programs(realities.PROGRAMS):
        print("skipped: missing", *missing)
        return 77
    test_readings()
    test_moduli()
    test_score(load_challenge())
    test_sealed(sys.argv[1], pathlib.Path(sys.argv[2]))
    test_yade(pathlib.Path(sys.argv[2]))
    print("challenge: readings, seal and score as said")
    return 0


sys.exit(main())
