"""experiment.toml: values, problems with their lines, overrides, and the text that is written. settings_test.py"""
import math
import pathlib
import tempfile
import unittest
from dataclasses import replace

from small_folder import SMALL, STAGES

from mcdem import toml_lines
from mcdem.experiment.experiment import Measurement
from mcdem.experiment.settings import parse_settings, read_settings, settings_text
from mcdem.problems import Problems
from mcdem.results import Box, ContainerShape

TEXT = SMALL["experiment.toml"]
NO_KEY = "is not a key of an experiment: remove it, or see its README for the names"

# text of TEXT, another one, beginning of the first problem
SPOILED = (
    ("[0.04, 0.03]", "[40.0, 0.03]", "3: box.size must be > 0 and <= 20 [m], got 40: divide by 1000 if it is in millimetres"),
    ("[0.04, 0.03]", "[nan, inf]", "3: box.size must be > 0 and <= 20 [m], got nan"),
    ("[0.04, 0.03]", "[0.04]", "3: box.size must be the inner width and depth"),
    ("[0.04, 0.03]", "[0.04, true]", "3: box.size must be the inner width and depth"),
    ("size", "sizes", " box.size must be the inner width and depth"),
    ("[box]\nsize = [0.04, 0.03]", '[container]\nshape = "cylinder"\nradius = 60',
     "4: container.radius must be a number > 0 and <= 10 [m], got 60"),
    ("[box]\nsize = [0.04, 0.03]", 'container.shape = "cylinder"', " container.radius must be the inner radius of the cylinder"),
    ("[grains]", '[container]\nshape = "cylinder"\nradius = 0.02\n[grains]', f"2: box {NO_KEY}"),
    ("[grains]", '[container]\nshape = "cell"\n[grains]', '5: container.shape must be "box", "cylinder" or "periodic"'),
    ("[grains]", "container.shape = 3\n[grains]", "4: box.container " + NO_KEY),
    ("[grains]", "[plate]\nstart = 156\n[grains]", "5: plate.start must be a number > 0 and <= 100 [m], got 156"),
    ("[grains]", "[plate]\nspeed = 0\n[grains]", "5: plate.speed must be a number > 0 and <= 1000 [m/s], got 0"),
    ("0.5", "0.6", "6: grains.poisson_ratio must be a number between 0 and 0.5, got 0.6"),
    ("0.5", "nan", "6: grains.poisson_ratio must be a number between 0 and 0.5, got nan"),
    ("0.5", "true", "6: grains.poisson_ratio must be a number between 0 and 0.5, got true"),
    ("0.5", "[]", "6: grains.poisson_ratio must be a number between 0 and 0.5, got an empty list"),
    ("0.5", "{}", "6: grains.poisson_ratio must be a number between 0 and 0.5, got a table"),
    ("0.5", "1979-05-27 07:32:00Z", "6: grains.poisson_ratio must be a number between 0 and 0.5, got 1979-05-27T07:32:00Z"),
    ("23300.0", '"so\\u001bft"', '5: grains.youngs_modulus must be a number > 0 and <= 1e+13 [Pa], got "so?ft"'),
    ("friction", "fricton", f"7: grains.fricton {NO_KEY}"),
    ("friction", '"a\\u001b"', f"7: grains.a? {NO_KEY}"),
    ("walls.youngs", "wall.youngs", f"12: uncertainty.wall {NO_KEY}"),
    ("500.0", "-1.0", "11: uncertainty.youngs_modulus must be a number between 0 and 1e+15 [Pa], got -1"),
    ('"two grains"', "2", "1: name must be a text"),
    ("[grains]", "[grains", "4: must be TOML, got: Expected ']'"),
    ("0.03]", "0.03", "4: must be TOML, got: "),
    ("0.005\n", '"""0.005\n', '16: must be TOML, got: Unterminated string'),
    ("0.5", "9223372036854775808", "6: must be TOML, got a whole number that is not between -2^63 and 2^63"),
    ("0.5", "1" * 5000, "6: must be TOML, got a number or a name of more than 1000 characters"),
    ("two grains", "\udcc3(", "1: must be text in UTF-8"),
    ("[grains]", "# \udcff\n[grains]", "4: must be text in UTF-8"),
    ("[grains]", '[[programme]]\nposition = 0.019\n[grains]', "4: [[programme]] requires plate.start"),
    ("[box]", "programme = 3\n[box]", "2: programme must be a list of 1 to 100 stages ([[programme]])"),
    ("[grains]", "[[programme]]\n" * 101 + "[grains]", "4: programme must be a list of 1 to 100 stages"),
    ("[box]", "programme = [{}, 1]\n[box]", "2: programme must be a list of 1 to 100 stages"))

# of STAGES
SPOILED_STAGES = (
    ("keep =", "kept =", "28: programme.4.kept must be a key of a stage, got an unknown one (did you mean programme.4.keep?)"),
    ('keep = "force"', 'keep = "stress"', "28: programme.4.keep must be position or force in a hold of the plate, got stress"),
    ('keep = "force"', "keep = 3", "28: programme.4.keep must be one of position, force, stress, got 3"),
    ("time = 4", "time = inf", "29: programme.4.time must be a number > 0 and <= 1e+06 [s], got inf"),
    ("time = 4", "time = [1, inf]", "29: programme.4.time must be a number > 0 and <= 1e+06 [s], got a list"),
    ("time = 4", "time = 1979-05-27 07:32:00", "29: programme.4.time must be a number > 0 and <= 1e+06 [s], got 1979-05-27T07:32:00"),
    ("position = 0.019", "position = 0.05", "19: programme.1.position must keep the plate between plate.end = 0 and plate.start"),
    ("position = 0.019", "", "18: programme.1.stage must be given too: there is a stage 4"),
    ("position = 0.019", '"a.b\\n" = 3', "19: programme.1.a.b? must be a key of a stage, got an unknown one"),
    ("start = 0.022", "", "18: [[programme]] requires plate.start: its strains are relative to that height"))


def parsed(text=TEXT, *overrides, name=""):
    """The experiment without scans, and the problems."""
    problems = Problems()
    settings = parse_settings(text.encode(errors="surrogateescape"), "experiment.toml", overrides, problems, name)
    return settings, problems.lines()


def stated(experiment):
    recording = experiment.recording
    return vars(experiment) | {"recording": (recording.box, recording.parameters, repr(recording.plate_start)), "topology": experiment.topology.tolist()}


def first_problem(text, *overrides):
    return parsed(text, *overrides)[1][0]


class Settings(unittest.TestCase):
    def expect_problems(self, text, cases):
        for old, new, message in cases:
            with self.subTest(new=new[:80], message=message):
                self.assertIn(old, text)
                self.assertEqual(first_problem(text.replace(old, new, 1))[:16 + len(message)], f"experiment.toml:{message}")


class Reading(Settings):
    def test_values_are_read(self):
        settings, problems = parsed()
        self.assertEqual(problems, [])
        self.assertEqual((settings.name, settings.recording.box), ("two grains", Box(0.04, 0.03)))
        self.assertEqual(settings.materials, {"grains.youngs_modulus": 23300, "grains.poisson_ratio": 0.5, "grains.friction": 0.03,
                                              "walls.youngs_modulus": 50e6})
        self.assertEqual(settings.uncertainty, {"grains.youngs_modulus": 500, "walls.youngs_modulus": 1e6})
        self.assertEqual(settings.measurement, Measurement(position_error=1e-4, force_threshold=0.005))
        self.assertEqual(settings.recording.parameters["grains.youngs_modulus"], "23300")
        self.assertTrue(math.isnan(settings.recording.plate_start))
        self.assertEqual((settings.plate_speed, settings.plate_pause, settings.plate_hold), (None, 0, 0))

    def test_the_plate_is_read(self):
        settings, problems = parsed(TEXT + "[plate]\nstart = 1\nspeed = 1e-4\npause = 60\nhold = 300.5\n")
        self.assertEqual((settings.recording.plate_start, settings.plate_speed, settings.plate_pause, settings.plate_hold, problems),
                         (1.0, 1e-4, 60.0, 300.5, []))
        self.assertIsInstance(settings.recording.plate_start, float)

    def test_containers_are_read(self):
        cylinder, problems = parsed('container = {shape = "cylinder", radius = 0.02}')
        self.assertEqual((cylinder.recording.box, problems), (Box(0.04, 0.04, ContainerShape.cylinder), []))
        periodic, problems = parsed(TEXT + '[container]\nshape = "periodic"')
        self.assertEqual((periodic.recording.box, problems), (Box(0.04, 0.03, ContainerShape.periodic), []))

    def test_diameters_have_an_uncertainty_and_no_value(self):
        settings, problems = parsed("[box]\nsize = [1, 1]\n[uncertainty]\ndiameter = 5e-5")
        self.assertEqual((settings.uncertainty, problems), ({"grains.diameter": 5e-5}, []))
        self.assertEqual(parsed(settings_text(settings))[0].uncertainty, settings.uncertainty)
        self.assertIn("grains.diameter", parsed("[box]\nsize = [1, 1]\n[grains]\ndiameter = 0.02")[1][0])

    def test_a_full_name_of_an_uncertainty_is_read(self):
        settings, problems = parsed(TEXT.replace("walls.youngs", "grains.youngs").replace("youngs_modulus = 500.0", "friction = 0.2"))
        self.assertEqual((settings.uncertainty, problems), ({"grains.youngs_modulus": 1e6, "grains.friction": 0.2}, []))

    def test_line_ends_and_a_byte_order_mark_are_skipped(self):
        for text in ("\ufeff" + TEXT, TEXT.replace("\n", "\r\n")):
            self.assertEqual(parsed(text)[0].name, "two grains")
            self.assertEqual(parsed(text)[1], [])
            self.assertEqual(first_problem(text.replace("0.5", "7")).partition(" ")[0], "experiment.toml:6:")

    def test_the_name_is_that_of_the_folder_if_none_is_stated(self):
        self.assertEqual(parsed("", name="folder")[0].name, "folder")
        with tempfile.TemporaryDirectory() as folder:
            for inside, name in (("case", "case"), ("first.v2", "first"), (".hidden", ".hidden")):
                file = pathlib.Path(folder, inside, "experiment.toml")
                file.parent.mkdir()
                file.write_text("box.size = [0.04, 0.03]")
                self.assertEqual(read_settings(file, Problems()).name, name)

    def test_problems_have_their_lines(self):
        self.expect_problems(TEXT, SPOILED)

    def test_all_problems_are_found_at_once(self):
        problems = parsed(TEXT.replace("0.5", "0.7").replace("0.03\n", "-1\n") + "x = 1\n[y]\n[y.z]\n")[1]
        self.assertEqual([one.split(" ")[:2] for one in problems],
                         [["experiment.toml:6:", "grains.poisson_ratio"], ["experiment.toml:7:", "grains.friction"],
                          ["experiment.toml:16:", "measurement.x"], ["experiment.toml:17:", "y"]])
        many = parsed("\n".join(f"k{n} = 1" for n in range(30)) + "\n" + TEXT)[1]
        self.assertEqual((len(many), many[-1]), (21, ".. and 10 more"))

    def test_text_that_is_no_toml_is_refused(self):
        for text in ("\0" * 1000, "\udcff\udcfe\0\1", '"' + '"\\' * 300_000, '"""' + "\\" * 300_000, "x = 0x" + "f" * 99_999):
            self.assertTrue(first_problem(text).startswith("experiment.toml:1: must be "), text[:20])
        for depth in (200, 40_000, 300_000):
            name = ".".join("a" * depth)
            for text in (f"{name} = 1", f"[{name}]\nb = 1", f"[[{name}]]\nb = 1", "b = " + "[" * depth, "b = " + "{a=" * depth):
                self.assertTrue(first_problem(text).startswith("experiment.toml:1: names must have at most 100 parts"), text[:20])
        inline = ".".join("a" * 60) + " = {" + ".".join("b" * 60) + " = 1}"
        self.assertIn("nested at most 100 deep", first_problem(inline))
        wide = "\n".join(f"k{n}.a = [[{'1.5, ' * 150}]]" for n in range(150))
        self.assertIn("k0 is not a key", parsed(wide)[1][1])


class Programmes(Settings):
    def test_stages_are_read(self):
        settings, problems = parsed(TEXT + STAGES)
        self.assertEqual(problems, [])
        values = [settings.recording.parameters[f"programme.{key}"] for key in ("1.stage", "1.position", "2.scan_at", "3.force", "4.keep", "4.time")]
        self.assertEqual(values, ["move", "0.019", "[0.5, 2]", "0.1", "force", "4"])

    def test_problems_have_their_lines(self):
        self.expect_problems(TEXT + STAGES, SPOILED_STAGES)

    def test_stages_may_be_a_list_of_inline_tables(self):
        text = TEXT + "[plate]\nstart = 0.022\n"
        stages = "programme = [\n{position = 0.02},\n{scan_at = [\n0.01\n], force = 0.1, forc = 3}]\n"
        self.assertEqual(first_problem(stages + text), "experiment.toml:5: programme.2.forc must be a key of a stage, got an unknown one "
                         "(did you mean programme.2.force?)")


class Overrides(unittest.TestCase):
    def test_overrides_have_precedence(self):
        settings, problems = parsed(TEXT, "grains.friction=0.2", "name=ab c", "plate.start= 3 # m", "box={size=[1,2]}")
        self.assertEqual(problems, [])
        self.assertEqual((settings.materials["grains.friction"], settings.name, settings.recording.plate_start, settings.recording.box),
                         (0.2, "ab c", 3.0, Box(1, 2)))

    def test_problems_name_the_option(self):
        for word in ("x", "=3", ".a=3", "a.=3", "a..b=3", "a" * 1001 + "=3"):
            self.assertEqual(first_problem(TEXT, word), "--set: must be KEY=VALUE such as box.size=[0.165,0.166], got "
                             + (f'"{word}"' if len(word) < 80 else f'"{word[:80]}.."'))
        for words, message in ((["grains.friction=-1"], "grains.friction must be a number between 0 and 10, got -1"),
                               (["grains=3", "grains.friction=1"], "grains must be a table, got a value before"),
                               (["foo.bar={a=3}"], f"foo {NO_KEY}"),
                               (["box={size=[1]}"], "box.size must be the inner width and depth of the box, two numbers [m], such as "
                                "[0.165, 0.166]"),
                               (["plate.start=1", "programme=[{position=0.1}, {forc=\udcff}]"],
                                "programme must be a list of 1 to 100 stages ([[programme]])"),
                               (["plate.start=1", "programme=[{position=0.1}, {stage='\udcff'}]"],
                                'programme.2.stage must be one of move, hold, cycle, repeat, got "?"')):
            self.assertEqual(first_problem(TEXT, *words), f"--set: {message}")


class Writing(unittest.TestCase):
    def test_settings_are_read_back(self):
        text = TEXT + STAGES + '[[programme]]\nstage = "repeat"\nstages = 2\ntimes = 2\n'
        for written in (text, text + '[container]\nshape = "periodic"', TEXT + "[plate]\nstart = 0.01\nspeed = 1e-7\npause = 1\nhold = 2",
                        'container = {shape = "cylinder", radius = 0.033333333333333333}\nplate.start = 0.1'):
            settings, problems = parsed(written)
            self.assertEqual(problems, [])
            self.assertEqual(stated(parsed(settings_text(settings))[0]), stated(settings))

    def test_numbers_are_exact(self):
        settings, _ = parsed(TEXT, "plate.start=0.1")
        settings = replace(settings, materials={"grains.youngs_modulus": 1e5 / 3, "walls.friction": 0.1 + 0.2})
        self.assertEqual(settings_text(settings), """name = 'two grains'

[box]
size = [ 0.040000000000000001, 0.029999999999999999 ]

[grains]
youngs_modulus = 33333.333333333336

[measurement]
diameter_error = 0.0
force_error = 0.0
force_threshold = 0.0050000000000000001
position_error = 0.0001

[plate]
start = 0.10000000000000001

[uncertainty.grains]
youngs_modulus = 500.0

[uncertainty.walls]
youngs_modulus = 1000000.0

[walls]
friction = 0.30000000000000004
""")

    def test_names_are_read_back(self):
        for name, text in (("", "''"), ('a "b" \\ µ\t', "'a \"b\" \\ µ\t'"), ("a'b\\\"", '"a\'b\\\\\\""'), ("a\nb", '"a\\nb"'),
                           ("\x1b\x7f\x85\u2028", '"\\u001B\\u007F\\u0085\\u2028"'), ("\udcff", '"\\u00FF"')):
            settings = replace(parsed(TEXT, "plate.start=1")[0], name=name)
            written = settings_text(settings)
            self.assertEqual(written.split("\n")[0], f"name = {text}")
            self.assertEqual(parsed(written)[0].name, name.replace("\udcff", "ÿ"))


class Lines(unittest.TestCase):
    def test_every_value_has_the_line_where_it_begins(self):
        text = '''a = 1 # [x]
"b.c" . 'd' = """
]=[ " \\""""
[e.f]  # first
g = [1,
  {h = 2, i.j = 3}, [
  1979-05-27 07:32:00]]
[e]
k = ["""a""b"""", {k = 1}, """a"""""]
l = \'\'\'
'a''\'\'\'
[[m.n]]
[[m.n]]
o = {}
[m.n.p]
q = 1e-3
'''
        expected = {("a",): 1, ("b.c",): 2, ("b.c", "d"): 2, ("e",): 8, ("e", "f"): 4, ("e", "f", "g"): 5, ("e", "f", "g", 0): 5,
                    ("e", "f", "g", 1): 6, ("e", "f", "g", 1, "h"): 6, ("e", "f", "g", 1, "i"): 6, ("e", "f", "g", 1, "i", "j"): 6,
                    ("e", "f", "g", 2): 6, ("e", "f", "g", 2, 0): 7, ("e", "k"): 9, ("e", "k", 0): 9,
                    ("e", "k", 1): 9, ("e", "k", 1, "k"): 9, ("e", "k", 2): 9, ("e", "l"): 10, ("m",): 12, ("m", "n"): 12,
                    ("m", "n", 0): 12, ("m", "n", 1): 13, ("m", "n", 1, "o"): 14, ("m", "n", 1, "p"): 15, ("m", "n", 1, "p", "q"): 16}
        self.assertEqual(toml_lines.parse(text).lines, expected)


if __name__ == "__main__":
    unittest.main()
