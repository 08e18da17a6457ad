"""Checks what an experiment contains, what is missing, and where it is inconsistent."""
import numpy as np

from .check_contacts import check_balance, check_contacts
from .check_contents import describe
from .check_grains import check_grains
from .check_missing import find_missing
from .check_plate import check_errors, check_plate, check_plate_load
from .experiment import Experiment
from .findings import Finding, Severity

__all__ = ["Finding", "Severity", "check_experiment"]
CHECKS = (describe, find_missing, check_errors, check_plate, check_grains, check_contacts, check_plate_load, check_balance)


def check_experiment(experiment: Experiment) -> list[Finding]:
    """By severity.

    Finds nothing odd in the measured result of a simulation that settled at every scan and whose stated diameters and moduli are true.
    Missing data limit all conclusions.
    """
    with np.errstate(all="ignore"):  # numbers in files can be huge
        found = [finding for check in CHECKS for finding in check(experiment)]
    return sorted(found, key=lambda finding: finding.severity)
