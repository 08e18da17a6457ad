"""Refinements of a scene's numerics: which keys change, and what reduces the error."""
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

Changes = dict[str, float | str | bool]  # of keys of the scene
Parameters = Mapping[str, Any]  # key -> value of a replica; None: not set

WIDEST_SKIN = 2.0  # largest numerics.skin of a scene
WITHOUT_STOPS = "protocol.stop_at_scans = false, with a slow plate: runs then save the time of the stops"


@dataclass(frozen=True)
class Step:
    """`remaining`: the fraction of the error that remains after it, from the order of the method."""

    remaining: float
    changes: Changes


@dataclass(frozen=True)
class Refinement:
    """`remedy`: what reduces the error by {factor}, of which {square} is the square; empty: nothing does."""

    cause: str
    remedy: str
    steps: tuple[Step, ...]


def _slower(p: Parameters, factor: float) -> Changes:
    """With the plate slower by `factor` throughout; stages without a speed of their own have that of the plate."""
    changes: Changes = {key: p[key] * factor for key in ("plate.speed", "protocol.rate_tolerance")}
    stage = 1
    while (key := f"programme.{stage}.speed") in p:
        if p[key] is not None:
            changes[key] = p[key] * factor
        stage += 1
    return changes


def _remedy_of_speed(p: Parameters) -> str:
    if p["protocol.rate_tolerance"] > 0:
        return f"protocol.rate_tolerance = {p['protocol.rate_tolerance']:.2g} / {{factor:.2g}}, runs {{factor:.2g}} times as long"
    stages = " and the speeds of stages likewise" if "programme.1.stage" in p else ""
    return (f"plate.speed = {p['plate.speed']:.2g} / {{factor:.2g}}{stages}, runs {{factor:.2g}} times as long, or set "
            "protocol.rate_tolerance, which slows the plate only when necessary")


def _of_stops(p: Parameters) -> list[Refinement]:
    settled: Changes = {"protocol.settle_unbalanced_force": p["protocol.settle_unbalanced_force"] / 10,
                        "protocol.settle_time": p["protocol.settle_time"] * 4}
    # A plate that does not stop must not pause.
    return [Refinement("settling", WITHOUT_STOPS, (Step(0, settled),)),
            Refinement("stops at scans", WITHOUT_STOPS, (Step(0, {"protocol.stop_at_scans": False, "protocol.pause": 0.0}),))]


def refinements_of(p: Parameters) -> list[Refinement]:
    """For a replica with these parameters.

    Forces depend on inertia through the square root of the density. The error of Verlet is quadratic in the time step, but that of the
    damping is linear, which is assumed here.
    """
    density, time_step, skin = p["grains.density"], p["numerics.time_step"], p["numerics.skin"]
    refinements = [
        Refinement("plate speed", _remedy_of_speed(p), tuple(Step(part, _slower(p, part)) for part in (0.5, 0.25, 0.125))),
        Refinement("inertia", f"grains.density = {density:.3g} / {{square:.2g}}, runs {{factor:.2g}} times as long",
                   (Step(0.5, {"grains.density": density / 4}),)),
        Refinement("time step", f"numerics.time_step = {time_step:.2g} / {{factor:.2g}}, runs {{factor:.2g}} times as long",
                   (Step(0.5, {"numerics.time_step": time_step / 2}),))]
    if p["protocol.stop_at_scans"]:
        refinements += _of_stops(p)
    if p["numerics.precision"] == "float":
        refinements.append(Refinement("precision", "numerics.precision = double, runs twice as long",
                                      (Step(0, {"numerics.precision": "double"}),)))
    # A correct list has no influence, whatever its margin; wider ones may not fit into the container's period.
    is_periodic = p["container.shape"] in ("periodic", "cell")
    wider = 0.8 if is_periodic or 1.25 * skin > WIDEST_SKIN else 1.25
    return [*refinements, Refinement("list margin", "", (Step(0, {"numerics.skin": skin * wider}),))]
