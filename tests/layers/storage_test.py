"""Damaged files are distinguished from temporary system errors; checksums show changed bytes.

storage_test.py MCDEM LAYER    (LAYER: the library of failing_files.cpp)
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

try:
    import h5py
except ImportError:
    print("skipped: h5py is not there (Debian package python3-h5py)")
    sys.exit(77)

MCDEM, LAYER = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
TIME_LIMIT = 600  # seconds per command, which may include compiling the kernels on a busy machine
SCENE = """name = "tiny"
[box]
size_x = 0.05
size_y = 0.05
[packing]
count = 12
packing_fraction = 0.5
[plate]
start = 0.06
end = 0.05
speed = 0.2
[protocol]
scans_per_stroke = 2
scan_at_start = true
relax_time = 0.05
settle_time = 0.03
[batch.vary]
"contact.model" = ["independent", "mc_dem"]
"""
RUN = ["run", "tiny.toml", "--out", "out", "--no-figures"]
IN_PARTS = RUN + ["--part-replicas", "1"]


def mcdem(place, *words, **layer):
    """Runs the command in the folder; `layer` sets MCDEM_TEST_.. variables of the layer."""
    environment = dict(os.environ)
    if layer:
        environment.update({f"MCDEM_TEST_{name.upper()}": str(value) for name, value in layer.items()},
                           LD_PRELOAD=str(LAYER), MCDEM_TEST_FILES=str(place))
    return subprocess.run([MCDEM, *words], cwd=place, env=environment, capture_output=True, text=True,
                          timeout=TIME_LIMIT)


def expect(done, code, part="", stream="stderr"):
    text = getattr(done, stream)
    assert done.returncode == code and part in text, (done.returncode, done.stdout, done.stderr, part)


def whole_run(place):
    expect(mcdem(place, *RUN), 0)
    return (place / "out/run.h5").read_bytes()


def stopped_before_merge(place):
    """All parts exist, and they are not merged."""
    for part in "1/2", "2/2":
        expect(mcdem(place, *RUN, "--part-replicas", "1", "--part", part), 0)
    parts = sorted((place / "out/parts").glob("*.h5"))
    assert len(parts) == 2
    return parts


def a_temporary_read_error_at_the_merge_deletes_no_part(place):
    stopped_before_merge(place)
    for fault in ["ESTALE", "EMFILE", "EACCES", "EIO"]:
        for kind in ["open", "read"]:
            if (fault, kind) in (("EMFILE", "read"), ("EACCES", "read")):
                continue
            identities = [part.stat().st_ino for part in (place / "out/parts").glob("*.h5")]
            done = mcdem(place, *IN_PARTS, fault=fault, fault_at=1, fault_kinds=kind, fault_name="parts/00000.h5")
            expect(done, 1, "parts/00000.h5")
            assert "damaged" not in done.stderr and "computed again" not in done.stderr, done.stderr
            assert identities == [part.stat().st_ino for part in (place / "out/parts").glob("*.h5")]
    expect(mcdem(place, *IN_PARTS), 0)


def a_temporary_read_error_is_not_reported_as_damage(place):
    whole_run(place)
    for fault in ["ESTALE", "EMFILE", "EACCES"]:
        done = mcdem(place, "table", "out", fault=fault, fault_at=1, fault_kinds="open", fault_name="run.h5")
        expect(done, 1, "run.h5: cannot be opened: ")
        assert "damaged" not in done.stderr, done.stderr
    # While the file is opened and later; once, and as of a disk that also refuses to close it, from then on.
    for read in (3, 15):
        for stays in ({}, {"fault_stays": 1}):
            done = mcdem(place, "table", "out", fault="EIO", fault_at=read, fault_kinds="read,close", fault_name="run.h5", **stays)
            expect(done, 1, "Input/output error")
            assert "damaged" not in done.stderr, done.stderr


def a_refused_read_is_not_a_missing_object(place):
    whole_run(place)
    log = place.parent / "log"
    words = ["experiment", "from-run", "out", "--replica", "mc_dem", "--out", "lab"]
    expect(mcdem(place, *words, fault_log=log, fault_kinds="read", fault_name="run.h5"), 0)
    reads = len(log.read_text().splitlines())
    assert reads > 20, reads
    for read in range(1, reads + 1, 3):  # scripts/faults lets each fail
        shutil.rmtree(place / "lab", ignore_errors=True)
        done = mcdem(place, *words, fault="EIO", fault_at=read, fault_kinds="read", fault_name="run.h5")
        expect(done, 1, "Input/output error")
        assert "damaged" not in done.stderr, (read, done.stderr)


def a_refused_read_of_a_checkpoint_is_an_error(place):
    often = ["--set", "output.checkpoint_minutes=1e-6"]
    mcdem(place, *RUN, *often, fault="KILL", fault_at=3, fault_kinds="create", fault_name="segment")
    shutil.copytree(place / "out", place / "begun")
    log = place.parent / "log"
    words = [*RUN, *often, "--resume"]
    expect(mcdem(place, *words, fault_log=log, fault_kinds="read", fault_name="checkpoint.h5"), 0)
    reads = len(log.read_text().splitlines())
    assert reads > 20, reads
    for read in range(1, reads + 1, 3):  # scripts/faults lets each fail
        shutil.rmtree(place / "out")
        shutil.copytree(place / "begun", place / "out")
        done = mcdem(place, *words, fault="EIO", fault_at=read, fault_kinds="read", fault_name="checkpoint.h5")
        expect(done, 1, "Input/output error")


def a_restored_manifest_costs_no_part(place):
    result = whole_run(place)
    shutil.rmtree(place / "out")
    stopped_before_merge(place)
    manifest = place / "out/parts/manifest.json"
    text = manifest.read_text()
    manifest.write_text(text[:40])
    expect(mcdem(place, *IN_PARTS), 2, "manifest.json: is damaged: restore it from a copy")
    manifest.write_text(text)
    expect(mcdem(place, *IN_PARTS, fault_log=place.parent / "log"), 0)
    assert (place / "out/run.h5").read_bytes() == result
    assert ".work-" not in (place.parent / "log").read_text()  # folder in which parts are computed


def a_manifest_is_on_the_disk_before_it_has_its_name(place):
    log = place.parent / "log"
    expect(mcdem(place, *IN_PARTS, fault_log=log, fault_name="manifest.json"), 0)
    kinds = [line.split()[1] for line in log.read_text().splitlines()]
    assert kinds.index("fsync") < kinds.index("link"), kinds
    log.unlink()
    expect(mcdem(place, "run", "tiny.toml", "--out", "again", "--no-figures", "--part-replicas", "2", fault_log=log), 0)
    lines = [line.split(" ", 2)[1:] for line in log.read_text().splitlines()]
    linked = next(n for n, (kind, path) in enumerate(lines) if kind == "link" and path.endswith("manifest.json"))
    assert ["fsync", str(place / "again/parts")] in lines[linked:linked + 5], lines[linked:linked + 5]


def parts_of_no_replicas_are_refused(place):
    stopped_before_merge(place)
    manifest = place / "out/parts/manifest.json"
    manifest.write_text(re.sub(r'("replicas of a part": )"\d+"', r'\1"0"', manifest.read_text()))
    expect(mcdem(place, *IN_PARTS), 2, "must be a number of replicas above 0")


def parts_with_other_replicas_are_computed_again(place):
    result = whole_run(place)
    shutil.rmtree(place / "out")
    parts = stopped_before_merge(place)
    shutil.copy(parts[0], parts[1])
    done = mcdem(place, *IN_PARTS)
    expect(done, 0, "part 00001 is computed again")
    assert (place / "out/run.h5").read_bytes() == result


def pipes_are_refused_at_once(place):
    os.mkfifo(place / "pipe.toml")
    expect(mcdem(place, "run", "pipe.toml", "--out", "new"), 2, "pipe.toml")
    (place / "challenge").mkdir()
    os.mkfifo(place / "challenge/challenge.json")
    expect(mcdem(place, "challenge", "run", "challenge", "--scene", "tiny.toml", "--out", "answers", "--library", "l.json"), 2,
           "challenge.json: is a pipe or device")


def errors_of_the_system_are_reported_with_the_path(place):
    os.symlink("loop", place / "loop")
    done = mcdem(place, *RUN[:3], "loop", "--no-figures")
    expect(done, 1, "mcdem: loop")
    assert "filesystem error" not in done.stderr and "Too many levels of symbolic links" in done.stderr, done.stderr


def kernels_are_compiled_in_an_empty_environment(place):
    result = whole_run(place)
    shutil.rmtree(place / "out")
    done = subprocess.run([MCDEM, *RUN], cwd=place, env={"POCL_CACHE_DIR": str(place / "cache")}, capture_output=True,
                          text=True, timeout=TIME_LIMIT)
    expect(done, 0)
    assert (place / "out/run.h5").read_bytes() == result


def changed_bytes_are_found_in_every_table(place):
    """Every table has HDF5's checksum, by which readers find a changed byte (tests/results/read_run_test.py)."""
    whole_run(place)
    with h5py.File(place / "out/run.h5") as run:
        tables = []
        run.visititems(lambda name, table: tables.append(table.name) if isinstance(table, h5py.Dataset) and table.size else None)
        assert len(tables) > 10 and all(run[name].fletcher32 for name in tables), tables
        chunks = {name: run[name].id.get_chunk_info(0) for name in tables}
    whole = (place / "out/run.h5").read_bytes()
    for name, words in {"/observables/replica_00000": ["table", "out"], "/contacts/replica_00000/contact": ["figures", "out", "--out", "f"],
                        "/particles/replica_00000/position/value": ["export", "out", "--vtk", "--out", "vtk"]}.items():
        content = bytearray(whole)
        content[chunks[name].byte_offset + chunks[name].size - 5] ^= 16
        (place / "out/run.h5").write_bytes(content)
        done = mcdem(place, *words)
        expect(done, 2, f"run.h5: {name}: ")
        assert "the file is damaged" in done.stderr, done.stderr


def an_experiment_carries_sums(place):
    whole_run(place)
    for packed in [[], ["--gzip"]]:
        words = ["experiment", "from-run", "out", "--replica", "mc_dem", "--out", "lab", *packed]
        expect(mcdem(place, *words), 0)
        check = ["sha256sum", "--check", "--strict", "--quiet", "SHA256SUMS"]
        subprocess.run(check, cwd=place / "lab", check=True)
        listed = {line.split("  ")[1] for line in (place / "lab/SHA256SUMS").read_text().splitlines()}
        assert listed == {file.name for file in (place / "lab").iterdir()} - {"SHA256SUMS"}, listed
        table = next((place / "lab").glob("plate.csv*"))
        table.write_bytes(table.read_bytes()[:-2])
        expect(mcdem(place, *words), 2, "holds another experiment or run")
        assert subprocess.run(check, cwd=place / "lab", capture_output=True).returncode == 1
        shutil.rmtree(place / "lab")


def run_tests(known):
    """Runs the functions with the argument `place` of a module, in a folder each."""
    tests = [test for name, test in known.items()
             if callable(test) and getattr(test, "__code__", None) and test.__code__.co_varnames[:1] == ("place",)
             and test not in (mcdem, whole_run, stopped_before_merge)]
    wanted = sys.argv[3] if len(sys.argv) > 3 else ""
    failed = 0
    for test in tests:
        if wanted not in test.__name__:
            continue
        with tempfile.TemporaryDirectory(prefix="mcdem-storage-") as name:
            place = pathlib.Path(name) / "place"
            place.mkdir()
            (place / "tiny.toml").write_text(SCENE)
            try:
                test(place)
                print("passed:", test.__name__.replace("_", " "), flush=True)
            except (AssertionError, subprocess.SubprocessError, OSError, KeyError) as error:
                failed += 1
                print("FAILED:", test.__name__.replace("_", " "), error, flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(run_tests(globals()))
