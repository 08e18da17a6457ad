"""The course of a testing machine's record: moves, holds, the point of contact and the tare; thinned to the scans of a programme."""
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from .arrays import Floats

TOLERANCE = 0.01  # of the stroke: smaller deviations from straight moves are noise
SLOW = 0.1  # of the speed of the moves beside it: a hold
SHORT = 0.1  # of the stroke: parts of a move, with the speed of its beginning and end
OTHER_SPEED = 1.5  # ratio of the speeds of two moves in the same direction
STEADY, LOADED = 0.03, 0.1  # of the largest force: its range while it is held, and the least force that is held
NOTABLE = 0.2
MOST_CORNERS = 2000
FIT_UP_TO = 0.5  # of the rise of the force: from the part below it the point of contact is found
EXPONENTS = (1.0, 2.0)  # of the force over the displacement: 3/2 by Hertz's law, larger where more grains come into contact
FIRST_SCAN = 0.01  # of a hold, over its duration: relaxation is fast at first
CLEAR_FIT, SMALL_TARE = 0.05, 0.05  # of the rise of the force: error of the fit, and force before the contact


@dataclass
class Leg:
    """A move, a hold of the position or of the force ("creep"), from row `first` to row `last`."""

    kind: str
    first: int
    last: int


@dataclass
class Course:
    """Rows of a record [s], [m], [N] without those of equal times, and its legs."""

    time: Floats
    z: Floats
    force: Floats
    legs: list[Leg] = field(default_factory=list)

    @property
    def stroke(self) -> float:
        return float(np.ptp(self.z))

    def change(self, leg: Leg) -> float:
        return float(self.z[leg.last] - self.z[leg.first])

    def duration(self, leg: Leg) -> float:
        return float(self.time[leg.last] - self.time[leg.first])

    def speed(self, leg: Leg) -> float:
        return abs(self.change(leg)) / self.duration(leg)

    def steady_speed(self, move: Leg) -> float:
        """Without its beginning and its end."""
        rows, z = np.arange(len(self.z)), self.z[move.first]
        ends = [np.interp(row_at(self, move, z + part * self.change(move)), rows, self.time) for part in (0.1, 0.9)]
        return 0.8 * abs(self.change(move)) / float(ends[1] - ends[0]) if ends[1] > ends[0] else self.speed(move)

    def first_load(self) -> Leg | None:
        """The first move downwards that makes a notable part of the largest force."""
        least = self.force[0] + NOTABLE * (self.force.max() - self.force[0])
        return next((leg for leg in self.legs if leg.kind == "move" and self.change(leg) < 0
                     and self.force[leg.first:leg.last + 1].max() >= least), None)


@dataclass
class Contact:
    row: float  # a fraction lies between two rows
    tare: float  # force before it
    error: float  # of the fit, over the rise of the force


def _corners(time: Floats, z: Floats) -> list[int]:
    """Rows between which z is a straight line of the time within the tolerance (Ramer, Douglas and Peucker), at most MOST_CORNERS."""
    found, open_ = {0, len(z) - 1}, [(0, len(z) - 1)]
    tolerance = TOLERANCE * np.ptp(z)
    while open_ and len(found) < MOST_CORNERS:
        a, b = open_.pop(0)
        along = (time[a:b + 1] - time[a]) / (time[b] - time[a])
        off = np.abs(z[a:b + 1] - z[a] - along * (z[b] - z[a]))
        if off.max() > tolerance:
            middle = a + int(np.argmax(off))
            found.add(middle)
            open_ += [(a, middle), (middle, b)]
    return sorted(found)


def _is_steady(force: Floats, largest: float) -> bool:
    low, middle, high = np.percentile(force, (2, 50, 98))
    return bool(high - low <= STEADY * largest and abs(middle) >= LOADED * largest)


def _joined(legs: list[Leg], alike: Callable[[Leg, Leg], bool]) -> list[Leg]:
    joined = list[Leg]()
    for leg in legs:
        if joined and alike(joined[-1], leg):
            joined[-1] = Leg(min(joined[-1].kind, leg.kind), joined[-1].first, leg.last)
        else:
            joined.append(leg)
    return joined


def course_of(time: Floats, z: Floats, force: Floats) -> Course:
    """The legs of a record; time must not fall. Of rows with the same time the last one counts: machines repeat it before they start."""
    kept = np.append(np.diff(time) > 0, True)
    course = Course(time[kept], z[kept], force[kept])
    if len(course.z) < 3 or not course.stroke > 0:
        return course
    corners, band, largest = _corners(course.time, course.z), 2 * TOLERANCE * course.stroke, np.abs(course.force).max()
    legs = [Leg("move", a, b) for a, b in zip(corners, corners[1:])]
    speeds = [course.speed(leg) for leg in legs]
    for i, leg in enumerate(legs):
        if abs(course.change(leg)) <= band and speeds[i] < SLOW * max(speeds[max(i - 1, 0):i + 2]):
            leg.kind = "hold"
    for i, leg in enumerate(legs):  # a force that is kept while the plate moves
        slow = speeds[i] < SLOW * max(speeds) and course.duration(leg) > 5 * band / max(speeds)
        if leg.kind == "move" and slow and abs(course.change(leg)) > band and _is_steady(course.force[leg.first:leg.last + 1], largest):
            leg.kind = "creep"
    legs = _joined(legs, lambda a, b: a.kind == b.kind != "move" or {a.kind, b.kind} == {"creep", "hold"} and _is_steady(
        course.force[a.first:b.last + 1], largest))
    course.legs = _joined(legs, lambda a, b: a.kind == b.kind == "move" and course.change(a) * course.change(b) > 0 and (
        min(abs(course.change(a)), abs(course.change(b))) < SHORT * course.stroke
        or max(course.speed(a), course.speed(b)) < OTHER_SPEED * min(course.speed(a), course.speed(b))))
    _sharpen(course)
    return course


def _sharpen(course: Course) -> None:
    """Holds begin and end where the plate comes to and leaves their height: the force is largest there."""
    for before, leg, after in zip([None, *course.legs], course.legs, [*course.legs[1:], None]):
        if leg.kind == "hold":
            first, last = before.first if before else leg.first, after.last if after else leg.last
            at = first + np.flatnonzero(np.abs(course.z[first:last + 1] - np.median(course.z[leg.first:leg.last + 1])) <= TOLERANCE / 2 * course.stroke)
            if len(at) and before and after and before.first < at[0] < at[-1] < after.last:
                leg.first, leg.last = int(at[0]), int(at[-1])
                before.last, after.first = leg.first, leg.last


def contact_of(course: Course) -> Contact | None:
    """Where the force of the first move downwards begins: tare + k max(d - c, 0)^m is fitted to its lower half, robustly (soft L1).

    None if it does not rise.
    """
    leg = course.first_load()
    if leg is None:
        return None
    rows = slice(leg.first, leg.last + 1)
    before = course.force[:leg.first + 3]
    tare, down, force = float(np.median(before)), course.z[leg.first] - course.z[rows], course.force[rows]
    rise = float(force.max() - tare)
    low = np.flatnonzero(force[:int(np.argmax(force)) + 1] - tare < FIT_UP_TO * rise)
    if not rise > 0 or len(low) < 3 or not down[low[-1] + 1] > 0:
        return None
    end = int(low[-1]) + 2
    d, f = down[:end] / down[end - 1], (force[:end] - tare) / rise
    begin = np.clip(d[np.flatnonzero(f <= 0.05)[-1]], 0, 0.94)
    fit = least_squares(lambda p: p[0] * np.maximum(d - p[1], 0) ** p[2] + p[3] - f, (FIT_UP_TO, begin, 1.5, 0.0), loss="soft_l1",
                        f_scale=0.01, bounds=([0, 0, EXPONENTS[0], -0.1], [np.inf, 0.95, EXPONENTS[1], 0.1]))
    error = float(np.sqrt(np.mean((fit.x[0] * np.maximum(d - fit.x[1], 0) ** fit.x[2] + fit.x[3] - f) ** 2)))
    reached = int(np.argmax(d > fit.x[1]))
    if fit.x[1] > 0.02:  # the approach tells the tare
        tare += rise * float(fit.x[3])
    between = (fit.x[1] - d[reached - 1]) / (d[reached] - d[reached - 1]) if reached else 0.0
    return Contact(leg.first + max(reached - 1 + between, 0), tare, error)


def row_at(course: Course, leg: Leg, level: float) -> float:
    """The first row of a move, with a fraction, at which z reaches the level."""
    way = 1 if course.change(leg) > 0 else -1
    z = np.maximum.accumulate(way * course.z[leg.first:leg.last + 1])
    after = min(int(np.searchsorted(z, way * level)), len(z) - 1)
    if after == 0:
        return float(leg.first)
    return leg.first + after - 1 + min(float((way * level - z[after - 1]) / (z[after] - z[after - 1])), 1.0)


@dataclass
class Scans:
    """Of the programme: rows of the record, with fractions, and the phase (1: unload) and cycle of each; its stages."""

    row: list[float]
    unloads: list[int]
    cycle: list[int]
    stages: list[dict[str, Any]] = field(default_factory=list)


def _rounded(value: float) -> float:
    """With six digits."""
    return float(f"{value:.6g}")


def thinned(course: Course, contact: float, count: int) -> Scans:
    """The scans of a programme that begins in row `contact`, the zero of the displacement, with at most `count` scans in each stage: in a move
    at equal distances, in a hold at growing intervals. The plate is not followed above the height of contact."""
    rows, top = np.arange(len(course.z)), float(np.interp(contact, np.arange(len(course.z)), course.z))
    scans, at, unloads, cycle = Scans([contact], [0], [0]), top, 0, 0

    def add(found: Sequence[float], stage: dict[str, Any]) -> None:
        scans.row.extend(found)
        scans.unloads.extend([unloads] * len(found))
        scans.cycle.extend([cycle] * len(found))
        scans.stages.append(stage)

    for leg in course.legs:
        if leg.last <= contact:
            continue
        target = min(float(course.z[leg.last]), top)
        if leg.kind == "move":
            if (steps := int(abs(target - at) / (TOLERANCE * course.stroke))) == 0:
                continue
            way = int(target > at)
            cycle, unloads = cycle + int(unloads > way), way
            levels = at + (target - at) * np.arange(1, min(count, steps) + 1) / min(count, steps)
            add([row_at(course, leg, level) for level in levels], {"position": target, "speed": _rounded(course.steady_speed(leg)), "scans": len(levels)})
            at = target
        elif course.z[leg.first] <= top and scans.stages:
            step, end = float(np.max(np.diff(course.time[leg.first:leg.last + 1]))), _rounded(course.duration(leg))
            times = np.geomspace(max(FIRST_SCAN, step / end) * end, end, count) if count > 1 and step < end else np.array([end])
            times = np.append([_rounded(one) for one in times[:-1]], end)
            add([float(np.interp(course.time[leg.first] + one, course.time, rows)) for one in times],
                {"stage": "hold", **({"keep": "force"} if leg.kind == "creep" else {}), "time": end, "scan_at": times.tolist()})
            at = target if leg.kind == "creep" else at
    scans.stages = _folded(scans.stages, TOLERANCE * course.stroke)
    return scans


def _alike(a: dict[str, Any], b: dict[str, Any], tolerance: float) -> bool:
    def near(key: str, most: float) -> bool:
        return bool(abs(a.get(key, 0) - b.get(key, 0)) <= most)

    if a.keys() != b.keys() or a.get("scans") != b.get("scans") or a.get("keep") != b.get("keep"):
        return False
    return near("position", 2 * tolerance) and near("time", 0.02 * a.get("time", 0))


def _folded(stages: list[dict[str, Any]], tolerance: float) -> list[dict[str, Any]]:
    """With repeats in place of stages that are there again, such as those of cycles."""
    folded, i = list[dict[str, Any]](), 0
    while i < len(stages):
        for size in range(2, 9):
            times = 1
            while all(_alike(a, b, tolerance) for a, b in zip(stages[i:i + size], stages[i + times * size:i + (times + 1) * size], strict=False)) \
                    and i + (times + 1) * size <= len(stages):
                times += 1
            if times > 1:
                folded += [*stages[i:i + size], {"stage": "repeat", "stages": size, "times": times}]
                i += times * size
                break
        else:
            folded.append(stages[i])
            i += 1
    return folded
