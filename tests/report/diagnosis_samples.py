"""Artificial diagnoses as in diagnosis.json, one for each verdict, of the size and with the scatter of real ones."""
import functools
import json
import math
import random
import statistics

from mcdem.diagnosis.diagnosis_types import Diagnosis, Verdict
from mcdem.report.diagnosis import diagnosis_of

__all__ = ["OBSERVABLES", "VERDICTS", "bare", "cause", "cell", "entry", "fit", "missing", "of", "packing", "sample", "with_texts"]

VERDICTS = tuple(map(str, Verdict))
OBSERVABLES = (
    "top_force floor_force side_force plate_couple_x plate_couple_y coordination_number weak_contacts mean_force force_spread weak_forces "
    "strong_forces force_anisotropy vertical_gradient non_affine attraction friction_ratio friction_high wall_friction_ratio "
    "torque_imbalance gap_contacts overlap_offset overlap_slope overlap_curvature cross_contact grain_scatter").split()
DISPLACEMENTS = (6, 12, 18, 24, 30)  # [mm]

# Effect, unit, smallest detectable amplitude, what calibration absorbs.
CANDIDATES = (
    ("adhesion", "J/m2", 8e-5, 0.12), ("bulge_contacts", "", 0.15, 0.31), ("friction", "", 0.012, 0.2), ("wall_friction", "", 0.02, 0.05),
    ("friction_history", "", 0.4, 0.08), ("viscoelasticity", "", 0.03, 0.1), ("stiffening", "", 0.25, 0.64), ("plasticity", "", 0.02, 0.22),
    ("buoyancy", "kg/m3", 4, 0.02), ("diameter_error", "m", 5e-5, 0.85), ("polydispersity", "m", 8e-5, 0.07),
    ("modulus_scatter", "", 0.08, 0.04), ("rolling_resistance", "", None, 0), ("plate_tilt", "", 0.004, 0.01),
    ("plate_compliance", "m/N", 2e-5, 0.93), ("force_bias", "relative", 0.02, 0.97), ("force_threshold", "N", 1e-3, 0.3),
    ("position_bias", "relative", None, 1))
ALIKE = ("diameter_error", "plate_compliance", "force_bias")


def of(document) -> Diagnosis:
    return diagnosis_of(json.dumps(document).encode(), "here")


def cell(observable, phase, displacement_mm, z_score, z_score_refitted):
    return {"observable": observable, "phase": phase, "displacement_mm": displacement_mm, "z_score": z_score,
            "z_score_refitted": z_score_refitted, "difference": 0}


def entry(observable, phase, displacement_mm, z_score, z_score_refitted, region=None, force_class=None, difference=0.):
    return {"observable": observable, "phase": phase, "displacement_mm": displacement_mm, "region": region, "z_score": z_score,
            "z_score_refitted": z_score_refitted, "force_class": force_class, "difference": difference}


def cause(effect, amplitude=0., error=0., unit="", group=(), **others):
    return {"effect": effect, "amplitude": amplitude, "unit": unit, "confidence": 0., "group": list(group), "amplitude_error": error,
            "at_limit": False, "explained": 0., "score": 0., "confirmed_score": None} | others


def fit(name, shift, error, prior, unit, at_bound):
    return {"name": name, "shift": shift, "error": error, "prior": prior, "unit": unit, "at_bound": at_bound}


def missing(what, bins, of_bins, for_all):
    return {"of": what, "bins": bins, "of_bins": of_bins, "share": bins / of_bins, "for_all": for_all}


def packing(experiment, gap_p, amplitude, error, agreement_p, differs):
    return {"experiment": experiment, "gap_p": gap_p, "amplitude": amplitude, "amplitude_error": error, "agreement_p": agreement_p,
            "differs": differs}


def contact_law(phase, displacement, exponent):
    overlap = [0.05, 0.1, 0.15]
    return {"phase": phase, "displacement_mm": displacement, "overlap": overlap, "change": [(x / 0.1)**(exponent - 1.5) - 1 for x in overlap],
            "change_error": [0.02, 0.01, 0.03], "exponent": exponent, "exponent_error": 0.02}


def bare(verdict="no_gap"):
    """Nothing but a verdict."""
    lists = ("where", "causes", "detection_limits", "not_measured", "cells", "ranking", "nuisances", "check_first", "missing_bins",
             "not_testable", "refinements", "next", "packings", "contact_laws")
    return {"verdict": verdict, "gap": {"detected": False, "p_value": 1., "p_omnibus": 1., "p_directed": 1.}, "explanation": None,
            "shrink": None, "seconds": 0., "where_threshold": 0., "provenance": {}} | {name: [] for name in lists}


def signature(number, phase, displacement):
    """Fraction of an effect in each observable."""
    strength = 7 * math.sin(2.3 * number) * math.exp(-0.25 * (number % 6))
    return strength * (1 if phase == "unload" else 0.55) * math.sqrt(displacement / 30)


def add_cells(d, strength, left):
    uniform, normal = random.Random(7), statistics.NormalDist()
    d["where_threshold"] = 3.9
    for number, observable in enumerate(OBSERVABLES):
        for phase in ("load", "unload"):
            for displacement in DISPLACEMENTS:
                shape, scatter = signature(number, phase, displacement), normal.inv_cdf(uniform.random())
                z, refitted = strength * shape + scatter, left * shape + scatter
                d["cells"].append(cell(observable, phase, displacement, z, refitted))
                if abs(z) >= d["where_threshold"]:
                    d["where"].append(entry(observable, phase, [displacement - 3, displacement + 3], z, refitted))


def add_ranking(d, best_score, probability, explained):
    for c, (effect, unit, limit, absorbed) in enumerate(CANDIDATES):
        fall, size = math.exp(-0.45 * c), limit or 0.01
        group = list(ALIKE) if effect in ALIKE else [effect]
        d["ranking"].append(cause(
            effect, size * (-1 if c % 5 == 3 else 1) * (0.3 + 3 * fall), size * (0.3 + 0.05 * c), unit, group,
            confidence=probability * math.exp(-2.2 * c), explained=explained * fall, score=best_score * fall))
        d["detection_limits"].append({"effect": effect, "minimum_amplitude": limit, "absorbed_by_calibration": absorbed, "unit": unit,
                                      "group": group})


def top_force(fraction):
    rows = []
    for i in range(21):
        strain = max(0., i * 1.5 - 4) / 26
        measured, before = 15 * strain**1.5 - 0.35 * strain, 13.1 * strain**1.5
        rows.append({"displacement_mm": i * 1.5, "experiment_N": measured, "before_N": before,
                     "after_N": before + fraction * (measured - before)})
    return rows


def explain(d, reduction):
    d["explanation"] = {"reduction": reduction, "simulated": True, "held_out": True, "placebo": 0.12, "needed": 0.6,
                        "remainder": 1 - reduction, "remainder_p": 2e-6, "leaves_more_than_noise": True, "without": ""}
    fraction = reduction + 0.02
    d["shrink"] = {
        "held_out": "unloading, and loading above 18 mm", "before": 412.6, "after": 412.6 * (1 - fraction), "fraction": fraction,
        "interval": [fraction - 0.15, fraction + 0.12], "placebo": 0.12,
        "metrics": {"Rtop": [0.874, 0.991], "errf": [0.812, 0.143], "errZ": [0.421, 0.187], "bhat": [0.0312, 0.0089]},
        "confirmed": fraction - 0.02, "fitted_displacement_mm": [0, 18], "top_force": top_force(fraction)}


def common(verdict):
    detected = verdict != "no_gap"
    p_value, omnibus, directed = (0.004, 0.013, 0.002) if detected else (0.44, 0.61, 0.22)
    return bare(verdict) | {
        "gap": {"detected": detected, "p_value": p_value, "p_omnibus": omnibus, "p_directed": directed},
        "not_measured": ["forces on the side walls: would tell friction at the walls from friction between grains",
                         "diameters of single grains: would tell their scatter from that of moduli"],
        "not_testable": ["cross_contact: the scene's contact model has it already", "asphericity: grains are spheres"],
        "seconds": 1834.2,
        "provenance": {"scene": "hydrogel.toml", "experiment": "packing_1", "program": "mcdem 0.1.0", "device": "pthread-CPU", "seed": "17",
                       "experiment_sha256": "5f70bf18a086007016e948b04aed3b82103a36bea41755b6cddfaf10ace3c6ef"},
        "nuisances": [fit("modulus", 180, 120, 500, "Pa", False), fit("gamma", -0.021, 0.014, 0.05, "", False),
                      fit("friction", 0.003, 0.004, 0.01, "", False), fit("strain_offset", 1.2e-4, 0.6e-4, 3e-4, "m", False)],
        "next": [{"what": "measure 3 more packings and diagnose each, to distinguish adhesion from friction", "power": 0.83},
                 {"what": "press a second cycle", "power": None}]}


# Strength of the gap and what recalibration leaves of it; best score, probability and explained part; reduction.
SIZES = {"no_gap": ((0, 0), (1.8, 0.2, 0.01), None), "effect": ((1, 0.8), (46.3, 0.87, 0.78), 0.79),
         "group": ((0.8, 0.6), (18.2, 0.42, 0.71), 0.64), "unknown_effect": ((1.2, 1.1), (12.4, 0.35, 0.21), 0.07),
         "not_converged": ((0.9, 0.7), (30, 0.8, 0.5), 0.85), "calibration_suspect": ((0.9, 0.05), (2.1, 0.3, 0.04), 0.90)}


def sample(verdict):
    """25 observables at 5 displacements of loading and of unloading, 18 candidates."""
    return json.loads(_sample(verdict))


@functools.cache
def _sample(verdict):
    d = common(verdict)
    cells, ranking, reduction = SIZES[verdict]
    add_cells(d, *cells)
    add_ranking(d, *ranking)
    if reduction:
        explain(d, reduction)
    first = d["ranking"][0]
    if verdict == "effect":
        first["confirmed_score"] = 44.1
        d["packings"] = [packing("packing_1", 0.003, 2.6e-4, 3e-5, 0.31, False), packing("packing_2", 0.02, 2.2e-4, 3e-5, 0.31, False)]
        d["contact_laws"] = [contact_law("load", 18, 1.6), contact_law("load", 29.4, 1.65), contact_law("unload", 29.4, 1.4)]
        d["missing_bins"] = [missing("friction", 4, 8, False), missing("modulus", 1, 9, True)]
    elif verdict == "group":
        for c in range(3):
            d["ranking"][c] |= {"group": ["adhesion", "bulge_contacts", "friction"], "score": 18.2 - 0.4 * c, "confidence": 0.37 - 0.06 * c}
            d["detection_limits"][c]["group"] = d["ranking"][c]["group"]
    elif verdict == "not_converged":
        first |= {"effect": "plate_speed", "unit": "", "group": ["plate_speed"]}
        speed = {"effect": "plate_speed", "key": "plate.speed", "unit": "m/s"}
        d["refinements"] = [speed | {"was": 0.1, "to": 0.025, "done": True}, speed | {"was": 0.025, "to": 0.0125, "done": False}]
    elif verdict == "calibration_suspect":
        d["nuisances"][0] = fit("modulus", 2300, 200, 500, "Pa", True)
    if verdict not in ("no_gap", "calibration_suspect"):
        d["causes"] = d["ranking"][:3 if verdict == "group" else 1]
    return json.dumps(d)


def with_texts(d, text):
    """Replaces every text by `text`."""
    keys = {"where": ("observable", "region", "force_class"), "causes": ("effect", "unit"), "ranking": ("effect", "unit"),
            "nuisances": ("name", "unit"), "check_first": ("name", "unit"), "missing_bins": ("of",), "detection_limits": ("effect", "unit"),
            "next": ("what",), "packings": ("experiment",), "refinements": ("effect", "key", "unit")}
    d = json.loads(json.dumps(d))
    for part, names in keys.items():
        for one in d[part]:
            one |= dict.fromkeys(names, text) | ({"group": [text, text]} if "group" in one else {})
    for one in d["cells"]:
        one["observable"] = text if one["observable"] == "top_force" else one["observable"]
    d["not_measured"] = d["not_testable"] = [text]
    if d["shrink"]:
        d["shrink"]["held_out"] = text
        d["shrink"]["metrics"][text] = [1, 2]
    d["provenance"][text] = text
    return d
