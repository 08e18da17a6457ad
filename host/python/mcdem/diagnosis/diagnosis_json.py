"""Diagnoses as JSON; host/python/mcdem/diagnosis/DIAGNOSIS_OUTPUT.md describes the keys, mcdem.report.diagnosis reads them."""
from dataclasses import replace

from ..checked_json import json_of
from ..json_text import json_text
from .diagnosis_types import Diagnosis


def diagnosis_json(diagnosis: Diagnosis) -> str:
    """Indented JSON with keys in the documented order and a final line feed. Numbers that are not finite become null; what was
    invalid UTF-8 becomes replacement characters."""
    return json_text(json_of(Diagnosis, replace(diagnosis, provenance=dict(sorted(diagnosis.provenance.items())))))
