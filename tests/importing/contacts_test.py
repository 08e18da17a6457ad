"""Contacts that a table lists twice, in other frames than the grains, or by magnitude only: imported correctly, or
refused."""
import copy
import unittest

import numpy as np

from lab import Contact, ImportCase, Style, lab_contacts, mapped
from mcdem.importing.guess import mapping_of
from mcdem.importing.mapping import Guess, mapping_text


class Contacts(ImportCase):
    def mapping(self, **entries):
        """The mapping of the laboratory's tables with these entries for contacts."""
        mapping = mapping_of(self.guess(self.write_lab()))
        for key, word in entries.items():
            next(table for table in mapping if table.role == "contacts")[key] = Guess([word])
        return mapping_text(mapping)

    def problems_with_each_pair_again(self, change, mapping):
        """The table of contacts in which each pair is listed a second time, with this change."""
        listed = copy.deepcopy(self.truth)
        for scan in listed.scans:
            scan.contacts += [change(contact) for contact in scan.contacts if not contact.is_wall]
        self.write("kontakte.csv", lab_contacts(listed))
        return self.problems_of(lambda: self.imported(self.by_mapping(mapping)))

    def test_forces_of_two_sides_must_be_opposite(self):
        both = self.mapping(sides="both")

        def turned(factor):
            return lambda c: Contact(c.partner, c.grain, c.point, factor * c.force)

        self.assertEqual(self.problems_with_each_pair_again(turned(-1), both), [])
        self.assertEqual(self.problems_with_each_pair_again(turned(-0.7), both), [], "errors of measurement")
        for factor in (1, 0.0001, -0.45, -2.2):
            self.expect_one(self.problems_with_each_pair_again(turned(factor), both),
                            "the forces of a contact's two sides must be opposite, got")
        self.expect_one(self.problems_with_each_pair_again(turned(-1), self.mapping(sides="one")),
                        'got it from its other side too: write `sides = "both"`')

    def test_rows_of_the_same_direction_are_no_sides(self):
        for sides in ("both", "one"):
            self.expect_one(self.problems_with_each_pair_again(copy.deepcopy, self.mapping(sides=sides)),
                            "got it again in the same direction or in another table: make one row of rows of normal and tangential parts")

    def test_a_contact_of_two_tables_is_refused(self):
        mapping = self.mapping()
        contacts = mapping[mapping.rindex("\n[[table]]"):]
        self.expect_one(self.problems_of(lambda: self.imported(self.by_mapping(mapping + contacts))), "or in another table")

    def test_frames_without_contacts_count_in_the_order(self):
        rows = []
        for scan in self.truth.scans:
            scan.contacts = [c for c in scan.contacts if c.partner == -6] if scan.frame % 2 else []
            of_grain = {c.grain: c for c in scan.contacts}
            for i in range(36):
                c = of_grain.get(i, Contact(i, -6, np.zeros(3), np.zeros(3)))
                rows.append((str(100 + scan.frame), str(i + 1), *(f"{x:.12g}" for x in (*c.point, *c.force))))
        text = Style(";", ".").table(["step", "Nr", "x", "y", "z", "fx", "fy", "fz"], rows)
        rest = mapping_text(mapping_of(self.guess(self.write_lab()[:2])))
        self.expect_truth(self.by_mapping(rest + mapped(
            "contacts", self.write("plate_forces.csv", text), frame="step", frames_by="order", grain="Nr", partner="plate", where="fz",
            x="x", y="y", z="z", fx="fx", fy="fy", fz="fz", force_on="grain", length_unit="m", force_unit="N")))

    def test_sizes_take_their_direction_from_their_own_frame(self):
        files = self.write_lab()
        for scan in self.truth.scans:
            scan.contacts = [contact for contact in scan.contacts if not contact.is_wall]
        self.write("kontakte.csv", Style(",", ".").table(["frame", "id1", "id2", "fn_N"], (
            (scan.frame, c.grain + 1, c.partner + 1, f"{np.linalg.norm(c.force):.12g}") for scan in self.truth.scans for c in scan.contacts)))
        self.expect_import(files, contacts={"frames_by": "order"})  # 0, 1, .. beside half seconds


if __name__ == "__main__":
    unittest.main()
