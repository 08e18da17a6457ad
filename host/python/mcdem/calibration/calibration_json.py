"""Calibrations as JSON."""
from typing import Any

from ..json_text import finite, json_text
from .scene_calibration import SceneCalibration


def calibration_document(result: SceneCalibration, scene: str, reference: str, program: str) -> dict[str, Any]:
    """`scene`: its text; `reference`: label of its setting; `program`: its version. Numbers that are not finite are None."""
    found, unit = result.found, result.unit
    key = "youngs_modulus_Pa" if result.of_modulus else "gamma"
    rounds = [{key: (unit * one.values).tolist(), "top_force_N": one.top_force.tolist(), "estimate": unit * one.root,
               "standard_error": unit * one.standard_error} for one in found.rounds]
    numbers = {key: unit * found.value, f"{key}_standard_error": unit * result.standard_error,
               f"{key}_standard_error_of_fit": unit * found.standard_error, f"runs_away_at_{key}": unit * found.runs_away_at,
               "target_top_force_N": result.target.value, "target_standard_error_N": result.target.standard_error,
               "displacement_m": result.displacement}
    document: dict[str, Any] = finite({
        "contact_model": result.model.value, "converged": found.converged, "replicas": result.replicas, "reference": reference,
        "scene": scene, "program": program, "rounds": rounds, **numbers})
    return document


def calibration_json(document: dict[str, Any]) -> str:
    """The text of calibration.json."""
    return json_text(document, sort_keys=True)
