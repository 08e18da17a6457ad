"""Builds and runs the benchmark programs, and reads their output."""
import json
import os
import pathlib
import resource
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAMS = ["step_bench", "machine_bench", "compile_bench", "export_packing"]


class Failed(Exception):
    """A program failed; the message is for the user."""


def add_build_arguments(parser):
    parser.add_argument("--build", type=lambda text: pathlib.Path(text).resolve(), default=ROOT / "build_bench", help="build folder")
    parser.add_argument("--no-build", action="store_true", help="the build folder is up to date")


def build(folder):
    """Configures and builds in `folder`; `mcdem` too if it is a target."""
    configure = ["cmake", "-S", ROOT, "-B", folder, "-DMCDEM_BENCH=ON", "-DMCDEM_TESTS=OFF", "-DCMAKE_BUILD_TYPE=Release"]
    subprocess.run(configure, check=True, stdout=subprocess.DEVNULL)
    targets = PROGRAMS + (["mcdem"] if (ROOT / "host/main.cpp").exists() else [])
    subprocess.run(["cmake", "--build", folder, "--parallel", "--target", *targets], check=True)


def environment(one_core=False, **more):
    """`one_core`: limits PoCL's CPU device to one core."""
    variables = dict(os.environ, OMP_NUM_THREADS="1", **more)
    if one_core:
        variables["POCL_MAX_PTHREAD_COUNT"] = "1"
    return variables


def run_benchmark(folder, program, only="", min_time=1.0, env=None, repetitions=1):
    """Output of a Google Benchmark program as {"context": .., "benchmarks": [..]}; raises Failed if a check failed."""
    command = [folder / "bench" / program, "--benchmark_format=json", f"--benchmark_min_time={min_time}",
               f"--benchmark_repetitions={repetitions}"]
    if only:
        command.append(f"--benchmark_filter={only}")
    done = subprocess.run(command, env=env or environment(), capture_output=True, text=True)
    if done.returncode != 0:
        raise Failed(f"{program} ended with {done.returncode}: {done.stderr.strip()[-2000:]}")
    output = json.loads(done.stdout)
    errors = [f"{b['name']}: {b['error_message']}" for b in output["benchmarks"] if b.get("error_occurred")]
    if errors:
        raise Failed(f"{program}: not timed, since the check before failed:\n" + "\n".join(errors))
    return output


def commit():
    command = ["git", "-C", ROOT, "describe", "--always", "--dirty=, changed since", "--exclude=*"]
    done = subprocess.run(command, capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def processor():
    for line in open("/proc/cpuinfo"):
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown processor"


class OtherPrograms:
    """Mean number of cores used by other programs than our own children, from here on (Linux)."""

    def __init__(self):
        self.busy, self.total, self.own = self.clock()

    @staticmethod
    def clock():
        """Seconds of all cores: busy, total; and those of our children."""
        fields = [float(f) / os.sysconf("SC_CLK_TCK") for f in open("/proc/stat").readline().split()[1:9]]
        idle = fields[3] + fields[4]
        children = resource.getrusage(resource.RUSAGE_CHILDREN)
        return sum(fields) - idle, sum(fields), children.ru_utime + children.ru_stime

    def cores(self):
        busy, total, own = self.clock()
        share = (busy - self.busy - (own - self.own)) / max(total - self.total, 1e-9)
        return max(0.0, share * (os.cpu_count() or 1))


def cold_and_warm_compile(folder):
    """Seconds from the start to the first steps, with an empty and with a full kernel cache, by precision."""
    with tempfile.TemporaryDirectory() as cache:
        env = environment(POCL_CACHE_DIR=cache, CUDA_CACHE_PATH=cache)
        runs = [run_benchmark(folder, "compile_bench", env=env) for _ in range(2)]
    return [{b["name"].split("/")[0]: b["real_time"] / 1e3 for b in run["benchmarks"]} for run in runs]
