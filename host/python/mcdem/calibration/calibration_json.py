"""Calibrations as JSON."""
import json
import math
import re
from typing import Any

from ..results.recording import Floats
from .scene_calibration import SceneCalibration


def calibration_document(result: SceneCalibration, scene: str, reference: str, program: str) -> dict[str, Any]:
    """`scene`: its text; `reference`: label of its setting; `program`: its version. Numbers that are not finite are None."""
    found, unit = result.found, result.unit
    key = "youngs_modulus_Pa" if result.of_modulus else "gamma"
    rounds = [{key: _numbers(unit * one.values), "top_force_N": _numbers(one.top_force), "estimate": _number(unit * one.root),
               "standard_error": _number(unit * one.standard_error)} for one in found.rounds]
    numbers = {key: unit * found.value, f"{key}_standard_error": unit * result.standard_error,
               f"{key}_standard_error_of_fit": unit * found.standard_error, f"runs_away_at_{key}": unit * found.runs_away_at,
               "target_top_force_N": result.target.value, "target_standard_error_N": result.target.standard_error,
               "displacement_m": result.displacement}
    return {"contact_model": result.model.value, "converged": found.converged, "replicas": result.replicas, "reference": reference,
            "scene": scene, "program": program, "rounds": rounds} | {name: _number(value) for name, value in numbers.items()}


def calibration_json(document: dict[str, Any]) -> str:
    """The text of calibration.json; what was invalid UTF-8 becomes replacement characters."""
    return re.sub("[\ud800-\udfff]", "\ufffd", json.dumps(document, indent=2, sort_keys=True, ensure_ascii=False, allow_nan=False)) + "\n"


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _numbers(values: Floats) -> list[float | None]:
    return [_number(value) for value in values.tolist()]
