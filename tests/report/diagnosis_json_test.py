"""diagnosis.json is read as it is documented, and refused with the place of what is invalid."""
import json
import math
import pathlib
import tempfile
import unittest

from diagnosis_samples import VERDICTS, bare, entry, of, sample, with_texts

from mcdem.errors import InputError
from mcdem.report.diagnosis import diagnosis_of, read_diagnosis

LATER = ("explanation", "check_first", "missing_bins", "refinements", "next", "packings", "contact_laws")


def changed(path, value):
    """The document of an effect with another value there; KeyError: without it."""
    d = sample("effect")
    place = d
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    if value is KeyError:
        del place[path[-1]]
    return json.dumps(d).encode()


# Document, what the message contains.
INVALID = [
    (changed(["ranking"], KeyError), "; ranking: is missing"),
    (changed(["ranking", 3, "score"], KeyError), "; ranking[3].score: is missing"),
    (changed(["verdict"], "perhaps"), "; unknown verdict: perhaps"),
    (changed(["verdict"], None), "; verdict: must be a text, got null"),
    (changed(["cells", 3, "z_score"], "six"), "; cells[3].z_score: must be a number, got a text"),
    (changed(["cells", 3, "z_score"], True), "; cells[3].z_score: must be a number, got true or false"),
    (changed(["cells", 3], []), "; cells[3]: must be an object, got a list"),
    (changed(["gap", "detected"], 1), "; gap.detected: must be true or false, got a number"),
    (changed(["shrink", "interval"], [1]), "; shrink.interval: must be a list of 2, got 1"),
    (changed(["shrink", "metrics", "Rtop"], [1, "a"]), "; shrink.metrics.Rtop[1]: must be a number, got a text"),
    (changed(["missing_bins", 0, "bins"], 1.5), "; missing_bins[0].bins: must be a whole number, got 1.5"),
    (changed(["provenance"], []), "; provenance: must be an object, got a list"),
    (changed(["not_measured"], ["\ud800"]), "; not_measured[0]: must be Unicode"),
    (changed(["provenance"], {"\ud800": "a"}), "; provenance: must be Unicode"),
    (b'{"verdict":', "; parse error at line 1"),
    (b"", "; parse error at line 1"),
    (b"[]", "; the document: must be an object, got a list"),
    (b'{"verdict": "caf\xe9"}', "; parse error at byte 16: invalid UTF-8"),
    (b'{"seconds": NaN}', "; parse error: NaN is not a finite number"),
    (b'{"seconds": 1e999}', "; parse error: 1e999 is not a finite number"),
    (b'{"seconds": ' + b"9" * 5000 + b"}", "; parse error: 99999999999999999999 is not a finite number"),
    (b"[" * 100000, "; parse error: too many lists within one another"),
]


class Reading(unittest.TestCase):
    def test_values_are_those_of_the_file(self):
        d = sample("effect")
        read = of(d)
        self.assertEqual((read.verdict, len(read.cells), read.seconds), ("effect", 250, 1834.2))
        self.assertEqual(read.where[0].displacement_mm, tuple(d["where"][0]["displacement_mm"]))
        self.assertEqual(read.causes[0].confirmed_score, 44.1)
        self.assertEqual(read.shrink.metrics["Rtop"], (0.874, 0.991))
        self.assertEqual(read.shrink.top_force[20].displacement_mm, 30)
        self.assertEqual(read.missing_bins[0].share, 0.5)
        self.assertAlmostEqual(read.explanation.remainder, 0.21)
        self.assertEqual(read.provenance, d["provenance"])

    def test_null_is_what_it_means(self):
        d = sample("effect")
        d["causes"][0] |= {"amplitude": None, "amplitude_error": None, "confirmed_score": None}
        d["where"] = [entry("x", None, [1, None], 1, None)]
        d["where_threshold"] = None
        read = of(d)
        self.assertTrue(math.isnan(read.causes[0].amplitude) and math.isnan(read.where[0].z_score_refitted))
        self.assertEqual((read.causes[0].amplitude_error, read.causes[0].confirmed_score), (math.inf, None))
        self.assertEqual((read.where[0].phase, read.where[0].region, read.where_threshold), ("", None, 0))
        self.assertFalse(read.detection_limits[12].is_finite)

    def test_files_of_earlier_versions_are_read(self):
        d = sample("effect")
        for key in LATER:
            del d[key]
        for one in d["cells"] + d["where"]:
            del one["difference"]
        read = of(d)
        self.assertEqual([getattr(read, key) for key in LATER], [None, *[()] * (len(LATER) - 1)])
        self.assertEqual(read.cells[0].difference, 0)

    def test_any_text_is_kept(self):
        for hostile in ('"}]\n\\ <x> \x01', "粒子 µ", "\U0001f600"):
            self.assertEqual(of(with_texts(sample("group"), hostile)).causes[0].effect, hostile)

    def test_every_verdict_is_known(self):
        for verdict in VERDICTS:
            self.assertEqual(of(bare(verdict)).verdict, verdict)

    def test_invalid_documents_are_refused_with_the_place(self):
        for content, part in INVALID:
            with self.subTest(part), self.assertRaises(InputError) as caught:
                diagnosis_of(content, "out/diagnosis.json")
            message, = caught.exception.problems
            self.assertTrue(message.startswith("out/diagnosis.json: must be a diagnosis.json that `mcdem diagnose` wrote; "), message)
            self.assertIn(part, message)

    def test_errors_name_the_file(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "diagnosis.json"
            with self.assertRaisesRegex(InputError, f"^{file}: no such file"):
                read_diagnosis(file)
            file.write_text("{}")
            with self.assertRaisesRegex(InputError, f"^{file}: "):
                read_diagnosis(file)


if __name__ == "__main__":
    unittest.main()
