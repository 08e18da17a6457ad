"""The paper's experiment with 514 grains and gamma = 1.125: time from the program's start to the written result."""
import csv
import statistics
import subprocess
import tempfile
import time

from programs import ROOT, Failed, environment

# One compression and release: at constant speed, and as slow as the scene's rate_tolerance requires.
SCENES = {"one cycle, plate at 0.1 m/s": "continuous_stroke.toml", "one cycle, rate_tolerance 0.01": "compression.toml"}
LEAST_TOP_FORCE = 5.0  # [N] at full stroke; MC-DEM reaches well above 10


def run_once(folder, scene, packing, out):
    command = [folder / "mcdem", "run", ROOT / "scenes" / scene, "--no-figures", "--out", out]
    command += ["--set", "contact.model=mc_dem", "--set", "contact.gamma=1.125"]
    if packing:
        command += ["--set", f"packing.file={packing}"]
    begin = time.perf_counter()
    done = subprocess.run(command, env=environment(), capture_output=True, text=True)
    seconds = time.perf_counter() - begin
    if done.returncode != 0:
        raise Failed(f"{scene} ended with {done.returncode}: {done.stderr.strip()[-2000:]}")
    return seconds


def top_force(out):
    with open(f"{out}/plate.csv", newline="") as file:
        return max(float(row["top_force_N"]) for row in csv.DictReader(file))


def measure(folder, packing=None, repetitions=3):
    """[{what, seconds, top_force, packing}]; the median of `repetitions` runs after one that fills the kernel cache."""
    results = []
    for what, scene in SCENES.items():
        times = []
        for _ in range(repetitions + 1):
            with tempfile.TemporaryDirectory() as out:
                times.append(run_once(folder, scene, packing, f"{out}/run"))
                force = top_force(f"{out}/run")
        if not force > LEAST_TOP_FORCE:
            raise Failed(f"{scene}: the top force must pass {LEAST_TOP_FORCE} N, got {force}")
        results.append({"what": what, "seconds": statistics.median(times[1:]), "top_force": force,
                        "packing": "given" if packing else "generated"})
    return results
