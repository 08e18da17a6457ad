"""Compares the types in __init__.pyi with the module, name by name and argument by argument, and checks them by mypy,
on their own and with the examples of the README.

stub_test.py SOURCE; exit code 77: no errors, but mypy is not installed
"""
import ast
import inspect
import pathlib
import re
import subprocess
import sys
import tempfile

import mcdem
import readme_examples

# Types for annotations only; they do not exist at run time.
def is_annotation_only(node):
    return any(isinstance(base, ast.Name) and base.id == "TypedDict" for base in node.bases)


def arguments(function):
    """Argument names of a stub's function, `*` before keyword-only ones."""
    listed = [one.arg for one in function.args.args if one.arg != "self"]
    keywords = [one.arg for one in function.args.kwonlyargs]
    return listed + (["*"] + keywords if keywords else [])


def documented_arguments(function):
    """The same for the module; the signature of a compiled function is the first line of its documentation."""
    if inspect.isfunction(function):
        parameters = inspect.signature(function).parameters.values()
        keywords = [one.name for one in parameters if one.kind == one.KEYWORD_ONLY]
        return [one.name for one in parameters if one.kind != one.KEYWORD_ONLY] + (["*"] + keywords if keywords else [])
    inside = re.search(r"\((.*)\) ->", function.__doc__.splitlines()[0])[1]
    names = re.findall(r"(?:^|, )(\*|\w+)(?=:|,|$| =)", re.sub(r"\[[^\[\]]*\]|\([^()]*\)|'[^']*'", "", inside))
    return [name for name in names if name != "self"]


def public(names):
    return {name for name in names if not name.startswith("_") or name in ("__len__", "__getitem__", "__iter__")}


def check_class(node, problems):
    methods = {one.name: one for one in node.body if isinstance(one, ast.FunctionDef)}
    runtime = getattr(mcdem, node.name)
    stated, there = public(methods), public(vars(runtime))
    if stated != there:
        problems.append(f"{node.name}: the stub has {sorted(stated - there)} too many, lacks {sorted(there - stated)}")
    for name in stated & there:
        decorators = {one.id for one in methods[name].decorator_list if isinstance(one, ast.Name)}
        is_property = isinstance(vars(runtime)[name], property)
        if is_property != ("property" in decorators):
            problems.append(f"{node.name}.{name}: property in one of stub and module only")
        elif not is_property and "overload" not in decorators and not name.startswith("__"):
            compare(f"{node.name}.{name}", methods[name], getattr(runtime, name), problems)


def compare(name, stub, function, problems):
    if arguments(stub) != documented_arguments(function):
        problems.append(f"{name}: the stub says {arguments(stub)}, the module {documented_arguments(function)}")


def check_stub(text):
    problems, names = [], {"__version__"}
    for node in ast.parse(text).body:
        if isinstance(node, ast.ClassDef) and not is_annotation_only(node):
            names.add(node.name)
            check_class(node, problems)
        elif isinstance(node, ast.FunctionDef):
            names.add(node.name)
            compare(node.name, node, getattr(mcdem, node.name), problems)
    if names != set(mcdem.__all__):
        problems.append(f"names: the stub has {sorted(names)}, the module {sorted(mcdem.__all__)}")
    return problems


def check_docstrings():
    return [f"{name}: has no documentation" for name in mcdem.__all__
            if name != "__version__" and not getattr(mcdem, name).__doc__]


def has_mypy():
    return subprocess.run(["/usr/bin/python3", "-c", "import mypy"], capture_output=True).returncode == 0


def check_with_mypy(source):
    with tempfile.TemporaryDirectory(prefix="mcdem-mypy-") as folder:
        script = pathlib.Path(folder) / "examples.py"
        script.write_text("\n".join(readme_examples.examples(source)))
        done = subprocess.run(["/usr/bin/python3", "-m", "mypy", "--strict", "--ignore-missing-imports", "--follow-imports=silent",
                               "--cache-dir", folder, script, "mcdem/__init__.pyi"], text=True, capture_output=True, cwd=source / "host/python",
                              env={"MYPYPATH": str(source / "host/python"), "PATH": "/usr/bin:/bin"})
    return [] if done.returncode == 0 else [done.stdout + done.stderr]


def main():
    source = pathlib.Path(sys.argv[1])
    text = (source / "host/python/mcdem/__init__.pyi").read_text()
    assert check_stub(text.replace("resume:", "again:").replace("def top_force", "def force")), "finds nothing"
    with_mypy = has_mypy()
    problems = check_stub(text) + check_docstrings() + (check_with_mypy(source) if with_mypy else [])
    print("\n".join(problems))
    if problems or with_mypy:
        return 1 if problems else 0
    print("skipped: types were not checked: mypy is not installed")
    return 77


if __name__ == "__main__":
    sys.exit(main())
