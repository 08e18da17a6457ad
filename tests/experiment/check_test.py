"""A lattice of spheres in equilibrium has no warnings. Then one property at a time is made wrong."""
import re
import sys
import types
import unittest
from dataclasses import replace
from unittest import mock

import numpy as np
from lattice import (DENSITY, DIAMETER, SIDE, WEIGHT, WIDTH, Measurement, Wall, first_scans, force_at, lattice, truth, with_measurement,
                     with_recording, with_scans, without_contacts)

from mcdem.experiment.check import Severity, check_experiment
from mcdem.results import NO_CONTACTS, Box, ContainerShape, Phase

NOTE, MISSING, ODD = Severity
NOWHERE = np.zeros((0, 3))


def texts(experiment, severity):
    return [finding.text for finding in check_experiment(experiment) if finding.severity == severity]


def scans(experiment):
    return experiment.recording.scans


def changed(change):
    """A spoiling that changes arrays and returns the same experiment."""
    def spoil(experiment):
        change(scans(experiment))
        return experiment
    return spoil


def exchange(values, i, j):
    values[[i, j]] = values[[j, i]]


def set_top_force(frame, value):
    return changed(lambda s: s.wall_force[:, Wall.plate, 2].__setitem__(frame, value))


def scale_top_force(factor):
    return changed(lambda s: s.wall_force.__imul__(factor))


def lift(attribute, distance):
    return changed(lambda s: [values.__iadd__(distance) for values in getattr(s, attribute)])


def scale_forces(factor, of=lambda one: one.grain >= 0):
    """The forces of some contacts, in all frames."""
    def scale(s):
        for one in s.contacts:
            one.force[of(one)] *= factor
    return changed(scale)


def rename_wall(contacts, old, new):
    contacts.partner[contacts.partner == -1 - old] = -1 - new


def drop_wall(wall):
    return lambda e: without_contacts(e, lambda contacts: contacts.partner == -1 - wall)


def widen_box(e):
    e = drop_wall(Wall.x_max)(drop_wall(Wall.y_max)(e))
    return with_recording(e, box=Box(3 * WIDTH, 3 * WIDTH))


def swap_numbers(e):
    exchange(scans(e).position[8], 31, 32)
    return without_contacts(e, lambda contacts: contacts.grain >= 0, [8])


def push_into_wall(e):
    scans(e).position[3][0, 0] = e.recording.diameter[0] / 2 - 0.007
    return e


def without_grains(e):
    return with_recording(with_scans(without_positions(without_contacts(e, lambda contacts: contacts.grain >= 0), range(len(scans(e))))),
                          diameter=np.zeros(0))


def without_positions(e, frames):
    return with_scans(e, position=tuple(NOWHERE if s in frames else one for s, one in enumerate(scans(e).position)))


def name_another_partner(s):
    one = s.contacts[4]
    one.partner[(one.grain == 62) & (one.partner == 63)] = 64


def weaken_a_contact(s):
    s.contacts[4].force[7] *= 0.003 / np.linalg.norm(s.contacts[4].force[7])


def too_large_to_square(s):
    for one in s.contacts:
        one.force[:, 0] = 1e300
        one.force[::2] = 0


def half_of_the_vertical(contacts):
    return (contacts.partner == contacts.grain + SIDE**2) & (contacts.grain // SIDE**2 % 2 == 0)


def without_key(name, key):
    return lambda e: replace(e, **{name: {one: value for one, value in getattr(e, name).items() if one != key}})


def begins_with_cycle_1(s):
    s.cycle[:] = 1


SPOILT = {
    "plate": [
        (ODD, changed(lambda s: s.plate_z.__setitem__(3, s.plate_z[2] + 150e-6)), "against its phase"),  # of a stroke of 10 mm
        (ODD, changed(lambda s: exchange(s.plate_z, 2, 3)),
         "the plate goes against its phase: 1 in 1 frame, first in frame 3: 0.092 m after 0.0895 m in phase load"),
        (ODD, changed(lambda s: s.phase.__setitem__(0, Phase.unload)),
         "a cycle is one loading and then one unloading: 2 in 2 frames, first in frame 0: unload of cycle 0"),
        (ODD, changed(begins_with_cycle_1), "cycles are left out: 1 in 1 frame, first in frame 0: cycle 1 follows -1"),
        (ODD, changed(lambda s: s.cycle[5:].__iadd__(2)), "cycles are left out: 1 in 1 frame, first in frame 5: cycle 2 follows 0"),
        (ODD, lambda e: with_recording(e, plate_start=0.09), "plate.start, 0.09 m, is below the plate of frame 0, 0.097 m"),
        (ODD, lambda e: with_recording(e, plate_start=0.2),
         "plate.start, 0.2 m, is more than the whole stroke above the plate's highest position, 0.097 m"),
        (ODD, set_top_force(5, -1),
         "the top force is negative, though the grains press the plate up: 1 in 1 frame, first in frame 5: -1 N"),
        (ODD, set_top_force(4, 0.5), "the top force falls before loading ends, from 3.52 to 0.5 N"),
        (ODD, changed(lambda s: s.plate_z.__iadd__(4e-3)),
         "the plate carries a force above the highest grain: is plate.start right, and do these frames of the grains belong to these rows "
         "of the plate? 9 in 9 frames, first in frame 0: 3."),
        (ODD, changed(lambda s: [one[:, 2].__iadd__(3e-3) for one in s.position]), "the top force is 0."),
        (ODD, scale_top_force(1000),
         "times that of Hertz's law from the overlaps with the plate: are its unit, plate.start, the height of the grains and their "
         "modulus right, and do the frames of the grains belong to these rows of the plate?"),
        (ODD, set_top_force(3, 0),
         "the plate overlaps with grains as under load, but measures hardly any force: are plate.start and the height of the grains right? "
         "1 in 1 frame, first in frame 3: 0 N"),
        (ODD, without_grains, "frame 0, at plate.start, carries 11 % of the largest top force, 0.538 N: is plate.start the height at which"),
        (MISSING, lambda e: with_recording(e, plate_start=0.098), "the packing at rest before the first stroke: frame 0 is 1 mm below"),
        (MISSING, lambda e: first_scans(e, 5), "unloading: viscoelasticity"),
        (MISSING, lambda e: first_scans(e, 8), "frames of unloading, there are only 3: "),
    ],
    "grains": [
        (ODD, lambda e: with_measurement(e, position_error=0.0), "position_error is zero: "),
        (ODD, lambda e: with_measurement(e, diameter_error=0.0), "diameter_error is zero: "),
        (ODD, lambda e: replace(e, measurement=Measurement()),
         "position_error, diameter_error, force_error, force_threshold are zero: noise that is not stated is taken for a gap"),
        (ODD, lambda e: with_measurement(e, diameter_error=2e-3), "positions or diameters are known to 0.1 of a diameter only"),
        (ODD, widen_box, "the grains fill 0.064 of the box"),
        (ODD, lambda e: with_recording(e, diameter=e.recording.diameter / 2), "are diameters radii"),
        (ODD, lambda e: with_recording(e, diameter=e.recording.diameter * 1.25),
         "the grains have 1.13 times the volume of the box below the plate: are diameters too large"),
        (ODD, push_into_wall,
         "grains reach into a wall by more than half their radius: 1 in 1 frame, first in frame 3: grain 0 by 7 mm in x_min"),
        (ODD, changed(lambda s: s.position[3][62].__iadd__((0.008, 0, 0))),
         "grains overlap by more than 0.3 of their radii together: 1 in 1 frame, first in frame 3: grains 62 and 63 by 8."),
        (ODD, swap_numbers, "grains jump by most of a diameter from frame to frame, are they numbered consistently? 2 in 1 frame, first in "
                            "frame 8: grain 31 by 19."),
        (MISSING, lambda e: without_positions(e, [2]), "positions in 1 of 9 frames"),
        (MISSING, lambda e: with_recording(without_positions(e, range(9)), diameter=np.zeros(0)), "diameters and positions"),
    ],
    "contacts": [
        (ODD, lambda e: with_measurement(e, force_error=0.0), "force_error is zero"),
        (ODD, changed(name_another_partner), "contacts of grains that do not touch, are grains and frames numbered as in grains.csv? 1 in "
                                             "1 frame, first in frame 4: grains 62 and 64, 1"),
        (ODD, changed(lambda s: s.contacts[4].point[7].__iadd__((0, 0.05, 0))),
         "contact points away from their grain: 1 in 1 frame, first in frame 4: grain 35 and x_min, "),
        (ODD, changed(weaken_a_contact),
         "forces below the stated threshold of 13.5 mN: 1 in 1 frame, first in frame 4: grain 35 and x_min, 3 mN"),
        (ODD, lambda e: with_measurement(e, force_threshold=4e-3), "the threshold is higher than the stated 4 mN"),
        (ODD, lambda e: e.materials.update({"grains.youngs_modulus": 23.3}) or e, "times those of Hertz at the measured overlaps"),
        (ODD, scale_top_force(2), "the contacts with the plate add up to 0."),
        (ODD, scale_forces(-1), "contacts above three thresholds many pull their grain: the force must be that on `grain`, by `partner`: "),
        (ODD, scale_forces(-1), "the contacts with the plate add up to -"),
        (ODD, scale_forces(-1, lambda one: np.isin(one.partner, (-1 - Wall.floor, -1 - Wall.plate))), "many pull their grain"),
        (ODD, changed(lambda s: [rename_wall(one, Wall.y_max, Wall.y_min) for one in s.contacts]),
         "contacts of grains that do not touch, are grains and frames numbered as in grains.csv? 225 in 9 frames, first in frame 0: grain 20 "
         "and y_min, 76."),
        (ODD, changed(too_large_to_square), "forces below the stated threshold of 13.5 mN: 2025 in 9 frames"),
        (ODD, lambda e: without_contacts(e, half_of_the_vertical, [4]),
         "forces on the grains do not cancel, was the packing at rest, are contacts left out? Frames: 1 in 1 frame, first in frame 4: "),
    ],
    "left out": [
        (MISSING, lambda e: with_recording(with_scans(without_positions(e, range(9)), contacts=(NO_CONTACTS,) * 9), diameter=np.zeros(0)),
         "contact forces: of the packing only the top force"),
        (MISSING, lambda e: without_positions(with_scans(e, contacts=(NO_CONTACTS,) * 9), range(1, 9)), "contact forces: of the packing only the top"),
        (MISSING, lambda e: without_positions(with_scans(e, contacts=(NO_CONTACTS,) * 9), range(1, 9)), "positions in 8 of 9 frames: simulations start"),
        (MISSING, lambda e: with_scans(e, contacts=(NO_CONTACTS,) * 9), "contact forces: of the packing the top force is compared, who touches (by"),
        (MISSING, lambda e: replace(with_scans(e, contacts=(NO_CONTACTS,) * 9), topology=np.zeros((1, 3), int)), "who touches (as listed)"),
        (MISSING, lambda e: without_contacts(e, lambda one: one.grain >= 0, [3]), "contacts in 1 of 9 frames under load"),
        (MISSING, drop_wall(Wall.plate), "contacts with plate: tilt of the plate"),
        (MISSING, drop_wall(Wall.floor), "contacts with floor: the part of the load"),
        (MISSING, drop_wall(Wall.y_min), "contacts with y_min: the side force"),
        (MISSING, without_key("materials", "walls.friction"),
         "walls.friction: a diagnosis warns if a stated value is not that of the scene"),
        (MISSING, without_key("uncertainty", "grains.friction"), "[uncertainty] of grains.friction: "),
    ],
}


# A change after which nothing odd is said of it.
ALLOWED = (
    (changed(lambda s: s.plate_z.__setitem__(3, s.plate_z[2] + 50e-6)), "against its phase"),  # noise, of a stroke of 10 mm
    (changed(lambda s: [one[31].__iadd__((0.0035 * n, 0, 0)) for n, one in enumerate(s.position)]), "grains jump"),  # slow motion
    # Weak contacts at a weakly loaded plate may be missing.
    (lambda e: scale_forces(0.01, lambda one: one.partner == -1 - Wall.plate)(set_top_force(slice(None), 0.5)(e)), "add up to"),
    (scale_forces(-1, lambda one: one.force[:, 2] == 0), "many pull their grain"),  # along x and y: at most three thresholds
    # Contacts with walls may be unknown.
    (lambda e: with_measurement(without_contacts(e, lambda one: one.partner < 0), force_threshold=1e-3), "do not cancel"),
    (set_top_force([0, 1, 2, 6, 7, 8], 0.1), "that of Hertz's law"))  # frames with little load do not count


class Lattice(unittest.TestCase):
    def odd(self, experiment):
        return "\n".join(texts(experiment, ODD))

    def test_a_packing_at_rest_has_no_warnings(self):
        self.assertEqual(self.odd(lattice()), "")
        lacking = texts(lattice(), MISSING)
        self.assertEqual([text[:26] for text in lacking], ["tangential forces at walls", "tangential forces between "])

    def test_notes_list_the_available_data(self):
        found = check_experiment(lattice())
        self.assertEqual(sorted(found, key=lambda one: one.severity), found)
        text = "\n".join(texts(lattice(), NOTE))
        count = sum(map(len, scans(lattice()).contacts))
        for part in ("frames: 5 of loading, 4 of unloading, cycles 0 to 0; plate at 0.097 to 0.087 m", "displacements 0 to 10 mm",
                     "125 grains of 19.", " mm on average, in 9 of 9 frames",
                     f"{count} contacts in 9 of 9 frames, between grains and with x_min, x_max, y_min, y_max, floor, plate",
                     "box of 96.5 by 96.5 mm; errors of 0.1 mm in positions, 0.05 mm in diameters, 5 % in forces; contacts seen",
                     " from 13.5 mN on",
                     "grains.excess_density = 100 +- 0.01, grains.friction = 0.1 +- 0.01, ", "grains.youngs_modulus = 23300 +- 0.01",
                     "do not cancel (median)"):
            self.assertIn(part, text)

    def test_a_wrong_property_is_reported(self):
        before = {severity: texts(lattice(), severity) for severity in Severity}
        for group, cases in SPOILT.items():
            for severity, spoil, found in cases:
                with self.subTest(group, found=found):
                    after = texts(spoil(lattice()), severity)
                    self.assertIn(found, "\n".join(text for text in after if text not in before[severity]))

    def test_what_is_allowed_is_not_odd(self):
        for change, absent in ALLOWED:
            with self.subTest(absent):
                self.assertNotIn(absent, self.odd(change(lattice())))

    def test_weight_is_part_of_the_balance(self):
        """Without noise all forces including the weight cancel, up to rounding of the sum."""
        def balance(density):
            experiment = with_recording(lattice(), scans=truth([SIDE * 0.019]).scans, diameter=np.full(SIDE**3, DIAMETER))
            experiment.materials["grains.excess_density"] = density
            note, = (text for text in texts(experiment, NOTE) if "do not cancel" in text)
            return float(note.partition("bulk, ")[2].split()[0])
        self.assertLess(balance(DENSITY), 1e-9)
        total = np.sqrt(4 * force_at(WIDTH / SIDE)**2 + 2 * (force_at(0.019) + 2.5 * WEIGHT)**2)
        self.assertAlmostEqual(balance(0), 100 * WEIGHT / total, delta=0.2)

    def test_the_plate_may_move_both_ways_in_a_hold(self):
        experiment = lattice()
        scans(experiment).plate_z[[2, 3]] = scans(experiment).plate_z[[3, 2]]
        stages = [{"stage": "move"}, {"stage": "hold", "keep": '"force"', "time": "2.5"}, {"stage": "hold", "time": "0.75"},
                  {"stage": "hold", "keep": "position", "time": "1.0"}]
        keys = {f"programme.{n}.{key}": value for n, stage in enumerate(stages, 1) for key, value in stage.items()}
        held = with_recording(experiment, parameters=keys)
        scans(held).time[:] = np.arange(1, 10)
        engine = types.ModuleType("mcdem._engine")
        engine.scan_places = mock.Mock(return_value=[{"held": n == 2} for n in range(8)])
        with mock.patch.dict(sys.modules, {"mcdem._engine": engine}), mock.patch("mcdem._engine", engine, create=True):
            self.assertNotIn("against its phase", self.odd(held))
            self.assertIn("a programme of 4 stages in 8 s; position held for 0.75, 1 s, which shows relaxation; force held for 2.5 s, "
                          "which shows creep", texts(held, NOTE))
        engine.scan_places.assert_called_with(held.recording.parameters, held.recording.plate_start)
        self.assertIn("against its phase", self.odd(experiment))

    def test_forces_are_compared_with_those_of_hertz(self):
        experiment = lattice()
        experiment.materials["grains.youngs_modulus"] = 233
        for before in ("the top force is", "at the highest load forces are"):
            ratio = float(re.search(f"{before} (\\S+) times th", self.odd(experiment))[1])
            self.assertAlmostEqual(ratio, 100, delta=15)

    def test_tangential_forces_are_reported(self):
        experiment = lattice()
        for contacts in scans(experiment).contacts:
            contacts.force[contacts.partner != -1 - Wall.x_min] += 0.002
        self.assertEqual(texts(experiment, MISSING), [])


class OtherContainers(unittest.TestCase):
    def test_walls_of_a_cylinder_are_named(self):
        experiment = without_contacts(lattice(), lambda one: np.isin(one.partner, (-1 - Wall.x_max, -1 - Wall.y_min, -1 - Wall.y_max)))
        experiment = with_recording(experiment, box=Box(WIDTH, WIDTH, ContainerShape.cylinder))
        found = "\n".join(finding.text for finding in check_experiment(experiment))
        self.assertIn("cylinder with a radius of 48.25 mm", found)
        self.assertIn("between grains and with side, floor, plate", found)
        depth = 1e3 * (DIAMETER / 2 + 2 * np.sqrt(2) * WIDTH / SIDE - WIDTH / 2)  # of a corner's grain
        self.assertIn(f"in 9 frames, first in frame 0: grain 0 by {depth:.2g}.", found)

    def test_a_periodic_container_joins_its_sides(self):
        """A grain that has left through one side meets those at the other."""
        e = without_contacts(lattice(), lambda one: one.partner < -1 - Wall.x_min)
        e = drop_wall(Wall.x_min)(with_recording(e, box=Box(WIDTH, WIDTH, ContainerShape.periodic)))
        self.assertEqual(self.overlaps(e), [])
        scans(e).position[3][0] += (-0.008, 0, 0)
        scans(e).position[3][4] -= (3 * WIDTH, 0, 0)
        self.assertRegex(self.overlaps(e)[0], "^grains overlap by more than 0.3 of their radii together: 1 in 1 frame, first in frame 3: "
                                              r"grains 0 and 4 by 8\.")
        self.assertIn("periodic container of 96.5 by 96.5 mm", "\n".join(texts(e, NOTE)))

    def overlaps(self, experiment):
        return [text for text in texts(experiment, ODD) if "overlap by" in text]


if __name__ == "__main__":
    unittest.main()
