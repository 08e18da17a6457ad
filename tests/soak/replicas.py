"""10,000 short replicas in one process: memory does not grow after the first two thousand.

replicas.py [REPLICAS]; PYTHONPATH must contain the module.
"""
import os
import pathlib
import shutil
import sys
import tempfile

import mcdem

AT_ONCE = 100
WARM_UP = 20          # runs until the caches of the kernels' compiler and the allocator are filled
MOST_GROWTH = 2**20   # [bytes] from the first to the last third of 8,000 replicas: 200 per replica, less than the row of one scan

SCENE = mcdem.Scene(
    name="soak",
    box={"size_x": 0.06, "size_y": 0.06},
    packing={"count": 20, "packing_fraction": 0.4},
    plate={"start": 0.08, "end": 0.078},
    protocol={"scans_per_stroke": 2, "rate_tolerance": 0, "relax_time": 0.01},
    batch={"replicas": AT_ONCE},
)


def resident():
    """[bytes]"""
    pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def main():
    replicas = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    runs = max(3 * WARM_UP, replicas // AT_ONCE)
    held = []
    with tempfile.TemporaryDirectory(prefix="mcdem-soak-") as name:
        folder = pathlib.Path(name) / "run"
        for k in range(runs):
            run = mcdem.run(SCENE, str(folder))
            assert len(run) == AT_ONCE and all(len(recording.scans) == 4 for recording in run)
            del run
            shutil.rmtree(folder)
            held.append(resident())
            if (k + 1) % 10 == 0:
                print(f"{(k + 1) * AT_ONCE} replicas: {held[-1] / 2**20:.1f} MiB", flush=True)
    third = (runs - WARM_UP) // 3
    early = max(held[WARM_UP:WARM_UP + third])
    late = max(held[-third:])
    growth = late - early
    print(f"{runs * AT_ONCE} replicas: {early / 2**20:.1f} MiB, then {late / 2**20:.1f} MiB, {growth / 2**10:+.0f} KiB")
    if growth > MOST_GROWTH:
        sys.exit(f"memory grows by more than {MOST_GROWTH / 2**10:.0f} KiB")


if __name__ == "__main__":
    main()
