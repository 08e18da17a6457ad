"""Code that makes diagnoses cannot read sealed data: it does not import the reader, directly or indirectly. blindness_test.py"""
import ast
import pathlib
import tempfile
import unittest

import mcdem

PACKAGES = pathlib.Path(mcdem.__file__).parents[1]
SEALED = {"mcdem.challenge.truth", "mcdem.challenge.case", "mcdem.challenge.plan", "mcdem.challenge.make", "mcdem.challenge.score"}
DIAGNOSING = ("mcdem.challenge.run", "mcdem.diagnosis.diagnose", "mcdem.commands.challenge_run")


def file_of(module, packages):
    """The source of a module or package; None for others."""
    place = packages.joinpath(*module.split("."))
    return next((file for file in (place / "__init__.py", place.with_suffix(".py")) if file.exists()), None)


def imported_by(module, packages):
    """Names that may be modules: in all import statements of the source, also those within functions."""
    file = file_of(module, packages)
    package = module.split(".") if file.name == "__init__.py" else module.split(".")[:-1]
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[:len(package) - node.level + 1] if node.level else []
            source = ".".join([*above, *filter(None, [node.module])])
            yield source
            yield from (f"{source}.{alias.name}" for alias in node.names)


def reached_from(roots, packages=PACKAGES):
    """All modules of the package that these import, directly or indirectly, with the packages that they are in."""
    seen, left = set(), list(roots)
    while left:
        module = left.pop()
        if module and module not in seen and file_of(module, packages):
            seen.add(module)
            left += [module.rpartition(".")[0], *imported_by(module, packages)]
    return seen


def words_of(module):
    """The code without comments and documentation."""
    tree = ast.parse(file_of(module, PACKAGES).read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and ast.get_docstring(node):
            node.body = node.body[1:] or [ast.Pass()]
    return ast.unparse(tree)


class Blindness(unittest.TestCase):
    def test_diagnosing_code_does_not_import_the_truth(self):
        reached = reached_from(DIAGNOSING)
        self.assertIn("mcdem.diagnosis.proposals", reached, "the search itself must search")
        self.assertEqual(reached & SEALED, set())
        for module in SEALED:
            self.assertIsNotNone(file_of(module, PACKAGES), module)

    def test_scoring_code_imports_the_truth(self):
        for module in ("mcdem.commands.challenge_score", "mcdem.commands.challenge_make"):
            self.assertIn("mcdem.challenge.truth", reached_from([module]))

    def test_every_way_of_importing_is_found(self):
        for statement in ("import mcdem.challenge.truth", "from mcdem.challenge import truth", "from .truth import open_truth",
                          "from . import truth as t", "def f():\n    from ..challenge.truth import open_truth", "from ..other import x"):
            with self.subTest(statement), tempfile.TemporaryDirectory() as folder:
                package = pathlib.Path(folder, "mcdem")
                (package / "challenge").mkdir(parents=True)
                for name, text in (("__init__", ""), ("challenge/__init__", ""), ("challenge/truth", ""), ("challenge/run", statement),
                                   ("other", "import mcdem.challenge.truth")):
                    package.joinpath(name + ".py").write_text(text)
                self.assertIn("mcdem.challenge.truth", reached_from(["mcdem.challenge.run"], pathlib.Path(folder)))

    def test_running_code_does_not_mention_the_truth(self):
        for module in (*DIAGNOSING, "mcdem.challenge.files", "mcdem.challenge.results"):
            self.assertNotIn("truth", words_of(module), module)

    def test_running_code_imports_no_module_by_a_computed_name(self):
        """Except commands/command_line.py, which imports the module of the command, and mcdem/__init__.py, which imports a listed one."""
        dynamic = {module for module in reached_from(DIAGNOSING) if any(word in words_of(module) for word in
                                                                        ("import_module", "__import__", "runpy", "exec(", "eval("))}
        self.assertLessEqual(dynamic, {"mcdem", "mcdem.commands.command_line", "mcdem.program"})


if __name__ == "__main__":
    unittest.main()
