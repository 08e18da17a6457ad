"""Tables and provenance on a page compared with files, digests and the output of `mcdem table` and `mcdem compare`."""
import hashlib
import re
import subprocess

from report import page_truth as truth

ORIGIN = "Provenance"


def found(parts, tag, section, heading):
    """The content under these headings, which must occur once."""
    here = [part["content"] for part in parts if (part["tag"], part["section"], part["heading"]) == (tag, section, heading)]
    assert len(here) == 1, (tag, section, heading, len(here))
    return here[0]


def cells_of(line):
    return [re.sub(r"\\(.)", r"\1", cell.strip()) for cell in re.split(r"(?<!\\)\|", line.strip())[1:-1]]


def printed_tables(program, folder, *words):
    """Tables printed by a command as rows of cells, without the rules below the headings."""
    text = subprocess.run([program, *words, "--markdown"], cwd=folder, check=True, capture_output=True, text=True,
                          timeout=100).stdout
    tables = [[]]
    for line in text.splitlines():
        if line.startswith("|"):
            tables[-1].append(cells_of(line))
        elif tables[-1]:
            tables.append([])
    return [[table[0], *table[2:]] for table in tables if table]


def check_table(parts, section, heading, expected):
    shown = found(parts, "table", section, heading)
    assert shown == expected, (heading, shown, expected)


def check_metrics(parts, program, folder):
    models, scaling = printed_tables(program, folder, "table", "run")
    assert len(models) == 3 and len(scaling) == 5, "two settings, each with two phases"
    check_table(parts, "Metrics", "Top force", models)
    check_table(parts, "Metrics", "Scaling law", scaling)


def check_comparison(parts, program, folder, experiments, label):
    against = [word for experiment in experiments for word in ("--against", experiment)]
    table, = printed_tables(program, folder, "compare", "run", *against)
    assert len(table) == 4, table
    check_table(parts, "Metrics", "Against " + label, table)


def sha256(file):
    return hashlib.sha256(file.read_bytes()).hexdigest()


def seeds_of(run):
    return list(dict.fromkeys(truth.parameters(run, replica)["packing.seed"]
                              for replica in range(run["parameters"].attrs["replicas"])))


def check_run_origin(parts, run, folder):
    """Checks all statements about the run: versions, device, seeds and digests."""
    stated = {key: truth.text(value) for key, value in run["parameters"].attrs.items()}
    expected = {"results": "run", "program": stated["program"], "device": stated["device"],
                "precision": stated["precision"], "replicas": stated["replicas"],
                "packing seeds": ", ".join(seeds_of(run)), "SHA-256 of the scene": sha256(folder / "scene.toml"),
                "SHA-256 of run.h5": sha256(folder / "run/run.h5")}
    assert stated["program"] == truth.text(run["h5md/creator"].attrs["version"])
    shown = dict(found(parts, "dl", ORIGIN, stated["name"]))
    assert shown == expected, (shown, expected)
    scene = found(parts, "pre", ORIGIN, stated["name"])
    assert scene.strip() == (folder / "scene.toml").read_text().strip(), scene
