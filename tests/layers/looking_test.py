"""A path that cannot be looked at is an error that names it; an experiment is published whole or not at all.

looking_test.py MCDEM LAYER    (LAYER: the library of failing_files.cpp)
"""
import shutil
import sys

from storage_test import RUN, expect, mcdem, run_tests, whole_run

REASONS = {"EIO": "Input/output error", "ESTALE": "Stale file handle", "EACCES": "Permission denied"}
# Of a message that takes an error for an answer.
MISTAKEN = ("no such", "nothing there", "not there", "holds no", "must hold", "is not an experiment", "remove it", "mcdem: :")
FROM_RUN = ["experiment", "from-run", "out", "--replica", "mc_dem", "--out", "lab"]


def importing(place):
    """Words that import a table."""
    (place / "plate.txt").write_text("z_m force_N\n" + "".join(f"{0.06 - k / 1000} {k}\n" for k in range(9)))
    return ["experiment", "import", "plate.txt", "--set", "box.size=[0.05,0.05]", "--out", "imp"]


def operations(place, words, kinds, code=0):
    """The kind and path of each operation of these kinds."""
    log = place.parent / "log"
    log.unlink(missing_ok=True)
    expect(mcdem(place, *words, fault_log=log, fault_kinds=kinds), code)
    return [line.split(" ", 2)[1:] for line in log.read_text().splitlines()]


def check_looks(place, words, outputs=(), step=1):
    """Every failing look (with `step` 2 every second one) ends the command with the reason, or changes nothing of what it prints."""
    plain = mcdem(place, *words)
    for output in outputs:
        shutil.rmtree(place / output)
    looks = operations(place, words, "stat")
    assert looks, words
    for number, (_, path) in list(enumerate(looks, 1))[::step]:
        fault, reason = list(REASONS.items())[number % len(REASONS)]
        for output in outputs:
            shutil.rmtree(place / output, ignore_errors=True)
        done = mcdem(place, *words, fault=fault, fault_at=number, fault_kinds="stat")
        told, seen = done.stderr + done.stdout, (words, path, fault, done)
        if done.returncode != 0 or reason in told:
            assert done.returncode in (0, 1) and reason in told, seen
            # Each process counts its own looks, so a command that starts Python may have failed at another path.
            assert path.rsplit("/", 1)[1] in told or "import" in words or "export" in words, seen
            assert not any(mistaken in done.stderr for mistaken in MISTAKEN), seen
        else:
            assert done.stdout == plain.stdout, seen


def results_are_looked_for(place):
    whole_run(place)
    for words in (["table", "out"], [*RUN, "--resume"]):
        check_looks(place, words)


def scenes_and_packings_are_looked_for(place):
    whole_run(place)
    (place / "grains.csv").write_text("x_m,y_m,z_m,diameter_m\n0.02,0.02,0.01,0.01\n0.03,0.03,0.01,0.01\n")
    (place / "file.toml").write_text((place / "tiny.toml").read_text().replace(
        "count = 12\npacking_fraction = 0.5", 'file = "grains.csv"'))
    check_looks(place, ["validate", "file.toml"])


def experiments_are_looked_for(place):
    whole_run(place)
    expect(mcdem(place, *FROM_RUN), 0)
    check_looks(place, ["experiment", "check", "lab"])


def outputs_are_looked_for(place):
    whole_run(place)
    check_looks(place, [*FROM_RUN[:-1], "new"], ["new"])
    check_looks(place, ["report", "out", "--out", "page.html"], step=2)
    check_looks(place, ["export", "out", "--xyz", "--out", "xyz"], ["xyz"], step=2)


def tables_are_looked_for_by_python(place):
    check_looks(place, importing(place), ["imp"], step=2)


def names_in(folder):
    return {path.name for path in folder.iterdir()} if folder.exists() else set()


def without_temporaries(names):
    return {name for name in names if not name.endswith(".tmp")}


def check_publishing(place, words, fault, out, whole, before=()):
    """Each failing step leaves nothing or a whole experiment, and the same command again works. `before`: files in `out` that are
    not of mcdem. tests/experiment/publish_test.py has the steps themselves."""
    def prepare():
        for folder in (place / out, *place.glob("*.tmp")):
            shutil.rmtree(folder, ignore_errors=True)
        for name in before:
            (place / out).mkdir(exist_ok=True)
            (place / out / name).write_text("kept\n")

    kinds = "rename,fsync,create,unlink"
    prepare()
    steps = operations(place, words, kinds)
    assert len(steps) > 4 and names_in(place / out) == whole | set(before), (steps, names_in(place / out))
    for number, step in enumerate(steps, 1):
        prepare()
        done = mcdem(place, *words, fault=fault, fault_at=number, fault_kinds=kinds)
        left = without_temporaries(names_in(place / out)) - set(before)
        seen = (words, step, fault, done.returncode, done.stderr, left)
        assert left in ([whole] if done.returncode == 0 else [set(), whole] if fault == "KILL" else [set()]), seen
        assert done.returncode in (0, -9) or "Input/output error" in done.stderr, seen
        if left != whole:
            expect(mcdem(place, *words), 0)
            assert names_in(place / out) == whole | set(before) and not list(place.glob("*.tmp")), seen
        assert all((place / out / name).read_text() == "kept\n" for name in before), seen
        expect(mcdem(place, "experiment", "check", out), 0)


def an_experiment_of_a_run_is_published_at_once(place):
    whole_run(place)
    check_publishing(place, FROM_RUN, "KILL", "lab", {"contacts.csv", "grains.csv", "plate.csv", "experiment.toml", "SHA256SUMS"})


def an_import_is_published_at_once(place):
    check_publishing(place, importing(place), "EIO", "imp", {"plate.csv", "experiment.toml", "mapping.toml"}, ["notes.txt"])


if __name__ == "__main__":
    sys.exit(run_tests({name: test for name, test in globals().items()
                        if name not in ("check_looks", "check_publishing", "importing", "operations")}))
