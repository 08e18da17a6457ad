"""Layers: which headers each layer of host/ may include. Limits for the length of files and functions.

floors_test.py SOURCE_FOLDER; lists violations, exit code 1 if there are any.
"""
import pathlib
import re
import sys

# Layer -> the layers whose headers it may include, in addition to its own.
FLOORS = {
    "core": [],
    "elasticity": ["core"],
    "cl": ["core"],
    "scene": ["core"],
    "sim": ["scene", "elasticity", "cl", "core"],
    "io": ["scene", "core"],
    "ensemble": ["sim", "io", "scene", "cl", "core"],
    "cli": ["ensemble", "sim", "io", "scene", "cl", "core"],
    "python": ["ensemble", "sim", "io", "scene", "cl", "core"],
}
# Room of the Python package -> the rooms that it may import. All may import the modules that are in no room.
ROOMS = {
    "results": [],
    "importing": [],
    "experiment": ["results"],
    "observe": ["experiment", "results"],
    "exporting": ["results"],
    "diagnosis": ["observe", "experiment", "results"],
    "calibration": ["diagnosis", "observe", "experiment", "results"],
    "convergence": ["diagnosis", "observe", "experiment", "results"],
    "report": ["convergence", "calibration", "diagnosis", "observe", "experiment", "results"],
    "figures": ["report"],
    "challenge": ["report", "diagnosis", "observe", "experiment", "results"],
    "commands": ["challenge", "figures", "report", "convergence", "diagnosis", "calibration", "observe", "exporting", "experiment",
                 "importing", "results"],
}
LONGEST_FILE = 400
LONGEST_FUNCTION = 70
MAX_ARGUMENTS = {"kernel": 16, "device function": 8}
SOURCES = {".cpp", ".h", ".cl", ".py"}


def sources(root, folders=("host", "kernels", "tests", "bench")):
    for folder in folders:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in SOURCES and file.is_file():
                yield file


def floor_of(include):
    """The layer of an included file; kernels/ is a layer of its own, libraries are none."""
    first = include.split("/")[0]
    return first if first in FLOORS or first == "kernels" else None


def wrong_includes(root):
    for floor, below in FLOORS.items():
        allowed = {floor, *below, *(["kernels"] if floor == "sim" else [])}
        for file in sorted((root / "host" / floor).rglob("*.*")):
            if file.suffix not in SOURCES:
                continue
            for number, line in enumerate(file.read_text().splitlines(), 1):
                include = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
                if include and floor_of(include[1]) not in allowed | {None}:
                    yield (f"{file.relative_to(root)}:{number}: {floor} must not include {include[1]}; "
                           f"it may use {', '.join(sorted(allowed - {floor})) or 'nothing'}")


def imported_rooms(text):
    """Line and name of what each line imports from beside its room: `from ..NAME`, `from .. import NAME`."""
    for number, line in enumerate(text.splitlines(), 1):
        if found := re.match(r"\s*from \.\.(?:(\w+)| import (\w+))", line):
            yield number, found[1] or found[2]


def wrong_imports(root):
    package = root / "host/python/mcdem"
    for room, below in ROOMS.items():
        for file in sorted((package / room).glob("*.py")):
            for number, name in imported_rooms(file.read_text()):
                if (package / name).is_dir() and name not in below:
                    yield (f"{file.relative_to(root)}:{number}: {room} must not import {name}; it may use {', '.join(below) or 'no room'}")


def types_twice(root):
    """Two types with one name in one namespace violate the one-definition rule; each layer has one namespace."""
    for floor in FLOORS:
        seen = {}
        for file in sorted((root / "host" / floor).rglob("*.h")):
            for name in re.findall(r"^(?:struct|class|enum class) (\w+)[^;{]*\{", file.read_text(), re.MULTILINE):
                if name in seen and seen[name] != file:
                    yield f"{file.relative_to(root)}: {name} is also in {seen[name].relative_to(root)}"
                seen[name] = file


def defined_names(text):
    """Types, functions and constants of a namespace: what is defined at the beginning of a line."""
    for line in text.splitlines():
        found = re.match(r"(?:struct|class|enum class) (\w+)|using (\w+) =", line) or re.match(
            r"(?!TEST|INSTANTIATE|namespace|using|template|return|#)\w[\w:<>,&*\[\] ]*?[ &*>](\w+)(?:\(|\{|\[| =|;)", line)
        if found:
            yield next(filter(None, found.groups()))


def hidden_types(text):
    """Types and constants that are defined in unnamed namespaces."""
    for block in re.findall(r"^namespace \{$(.*?)^\}  // namespace$", text, re.MULTILINE | re.DOTALL):
        for line in block.splitlines():
            found = re.match(r"(?:struct|class|enum class) (\w+)[^;]*$|const(?:expr)? [^(]*?[ &*>](\w+)(?:\[\w*\])* ?[={]", line)
            if found:
                yield found[1] or found[2]


def test_names_twice(root):
    """Tests of a floor are compiled together: files must have no names in common in one namespace, not even of overloads."""
    for floor in sorted(FLOORS):
        seen = {}
        for file in sorted((root / "tests" / floor).glob("*.*")):
            text = file.read_text() if file.suffix in (".cpp", ".h") else ""
            for name in {f"{space}::{name}" for space in re.findall(r"^namespace ([\w:]+) {", text, re.M) for name in defined_names(text)}:
                if name in seen and seen[name].stem != file.stem:
                    yield f"{file.relative_to(root)}: {name} is also in {seen[name].relative_to(root)}"
                seen[name] = file


def hidden_types_twice(root):
    """Sources of a floor are compiled together: one name in two unnamed namespaces is an error unless it is a function's."""
    for floor in FLOORS:
        seen = {}
        for file in sorted((root / "host" / floor).rglob("*.cpp")):
            for name in sorted(set(hidden_types(file.read_text()))):
                if name in seen:
                    yield f"{file.relative_to(root)}: {name} is also in {seen[name].relative_to(root)}"
                seen[name] = file


def has_functions(kernel_file):
    return re.search(r"^\s*(INLINE|kernel|WORK_GROUP)\b", kernel_file.read_text(), re.MULTILINE)


def untested_kernels(root):
    """Functions of kernels/NAME are tested in tests/kernels/NAME_test.cpp; structs and constants in shared_structs_test.cpp."""
    names = {file.stem for file in (root / "kernels").glob("*.*") if file.suffix in (".h", ".cl") and has_functions(file)}
    tests = {file.name.removesuffix("_test.cpp") for file in (root / "tests" / "kernels").glob("*_test.cpp")}
    for name in sorted(names - tests):
        yield f"kernels/{name}: has functions, but there is no tests/kernels/{name}_test.cpp"
    for name in sorted(tests - names - {"shared_structs"}):
        yield f"tests/kernels/{name}_test.cpp: is named after no file of kernels/ with functions"


def strange_folders(root):
    for folder in sorted((root / "host").iterdir()):
        if folder.is_dir() and folder.name not in FLOORS:
            yield f"host/{folder.name}: is no floor; name it in tests/floors_test.py"
    for folder in sorted((root / "host/python/mcdem").iterdir()):
        if folder.is_dir() and folder.name not in {*ROOMS, "__pycache__"}:
            yield f"host/python/mcdem/{folder.name}: is no room; name it in tests/floors_test.py"


def long_files(root):
    for file in sources(root):
        lines = len(file.read_text().splitlines())
        if lines > LONGEST_FILE:
            yield f"{file.relative_to(root)}: has {lines} lines, at most {LONGEST_FILE}"


def functions(text):
    """First line and length of each block that follows a parameter list, found by the indentation of its brace."""
    lines = text.splitlines()
    for first, line in enumerate(lines):
        if not re.search(r"\)[\w\s:<>,&*()-]*\{$", line) or re.match(r"\s*(if|for|while|switch|namespace|})\b", line):
            continue
        start = first
        while start > 0 and (lines[start].lstrip().startswith(":") or lines[start - 1].endswith((",", "("))):
            start -= 1  # a signature of several lines
        closing = re.match(r"\s*", lines[start])[0] + "}"
        for last in range(first + 1, len(lines)):
            if lines[last].startswith(closing):
                yield start + 1, last - start + 1
                break


def long_functions(root):
    for file in sources(root):
        if file.suffix == ".py":
            continue
        for line, length in functions(file.read_text()):
            if length > LONGEST_FUNCTION:
                yield f"{file.relative_to(root)}:{line}: function of {length} lines, at most {LONGEST_FUNCTION}"


# These take any error for "not there": core/look.h and mcdem/look.py distinguish the two.
LOOKS = {"host": r"(?:fs|filesystem)::(?:exists|is_\w+|status|symlink_status|file_size|(?:recursive_)?directory_iterator)\(|ifstream",
         "python": r"os\.path\.(?:l?exists|is\w+)\(|\.(?:exists|is_file|is_dir|is_symlink)\(\)"}
OWN_LOOKS = {"host/core/look.cpp", "host/core/atomic_file.cpp", "host/cl/kernel_cache.cpp"}  # the last two tidy up


def careless_looks(root):
    for file in sorted((root / "host").rglob("*.*")):
        name = str(file.relative_to(root))
        if file.suffix not in SOURCES or name in OWN_LOOKS:
            continue
        for number, line in enumerate(file.read_text().splitlines(), 1):
            if re.search(LOOKS["python" if file.suffix == ".py" else "host"], line):
                yield f"{name}:{number}: must look at paths by core/look.h or mcdem/look.py, got {line.strip()}"


def argument_counts(text):
    """Kind, name and number of arguments of each kernel and device function."""
    for kind, name, arguments in re.findall(r"^(kernel|INLINE)\b[\w\s*]*?\b(\w+)\(([^)]*)\) \{", text, re.M):
        yield "kernel" if kind == "kernel" else "device function", name, len(arguments.split(","))


def many_arguments(root):
    for file in sorted((root / "kernels").glob("*.*")):
        for kind, name, count in argument_counts(file.read_text()):
            if count > MAX_ARGUMENTS[kind]:
                yield f"{file.relative_to(root)}: {kind} {name} has {count} arguments, at most {MAX_ARGUMENTS[kind]}"


def self_test():
    """Checks that the checker finds violations."""
    body = "void f(int a) {\n" + "    g();\n" * 80 + "}\nvoid g() {\n}\n"
    assert list(functions(body)) == [(1, 82), (83, 2)], list(functions(body))
    constructor = "    A(int a,\n      int b)\n        : a_(a) {\n        f();\n    }\n"
    assert list(functions(constructor)) == [(1, 5)], list(functions(constructor))
    assert list(defined_names("struct A {\n    int b;\nstd::vector<int> f(int a,\nconst int c = 3;\nTEST(A, b) {\n")) == ["A", "f", "c"]
    assert list(argument_counts("kernel void f(int a,\n  global real* b) {\nINLINE lanes3 g(int a) {\n")) == [
        ("kernel", "f", 2), ("device function", "g", 1)]
    text = "namespace a {\nstruct Open {\n};\nnamespace {\n\nstruct Hidden : Open {\n};\nconstexpr double size = 3;\nvoid f(int a) {\n}\n}  // namespace\n}\n"
    assert list(hidden_types(text)) == ["Hidden", "size"], list(hidden_types(text))
    assert list(imported_rooms("from ..a.b import c\n  from .. import d\nfrom .e import f\n")) == [(1, "a"), (2, "d")]
    assert floor_of("sim/engine.h") == "sim" and floor_of("vector") is None


def main():
    self_test()
    root = pathlib.Path(sys.argv[1])
    rules = (strange_folders, wrong_includes, wrong_imports, types_twice, test_names_twice, hidden_types_twice, untested_kernels, long_files,
             long_functions, many_arguments, careless_looks)
    problems = [problem for rule in rules for problem in rule(root)]
    print("\n".join(problems) or f"{sum(1 for _ in sources(root))} files in order")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
