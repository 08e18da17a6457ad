#!/usr/bin/env python3
"""Compiles the kernels for GPUs of two vendors, without a GPU, and compares their resources with tests/gpu/budget.csv.

registers_test.py SOURCES [--write]; skipped (77) without Clang and libclc. AMD's registers are counted by Clang,
NVIDIA's by ptxas if it is found (PATH, PTXAS, or PyPI's nvidia-cuda-nvcc). --write updates the budget.
"""
import csv
import glob
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ITEMS = 256  # work-group size: host/cl/program.h
KERNELS = ("advance", "measure")
GRANULE = 8  # registers are allocated per work-item in multiples of this
COLUMNS = ("target", "kernel", "precision", "slots", "registers", "local_bytes", "barriers")
CLC = "/usr/lib/clc"


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(77)


def find_clang():
    """Clang and libclc of the same version, because older versions cannot read newer bitcode."""
    for folder in sorted(glob.glob("/usr/lib/llvm-*"), key=lambda path: -int(path.rsplit("-", 1)[1])):
        version = folder.rsplit("-", 1)[1]
        owned = subprocess.run(["dpkg-query", "-W", "-f", "${Status}", f"libclc-{version}"], capture_output=True, text=True)
        if os.access(f"{folder}/bin/clang", os.X_OK) and "install ok" in owned.stdout:
            return f"{folder}/bin/clang"
    return None


def find_ptxas():
    pattern = "lib/python3*/site-packages/nvidia/*/bin/ptxas"
    found = [os.environ.get("PTXAS"), shutil.which("ptxas"), "/usr/local/cuda/bin/ptxas",
             *glob.glob(f"{sys.prefix}/{pattern}"), *glob.glob(str(pathlib.Path.home() / ".local" / pattern))]
    return next((path for path in found if path and os.access(path, os.X_OK)), None)


def compile_kernels(clang, sources, target, library, options, out):
    subprocess.run([clang, "-target", target, *options, "-x", "cl", "-cl-std=CL1.2", "-Xclang", "-finclude-default-header", "-w", "-O3",
                    "-DLANES=1", "-DLIST_ITEMS=64", "-I", f"{sources}/kernels", "-Xclang", "-mlink-builtin-bitcode",
                    "-Xclang", f"{CLC}/{library}", "-S", "-o", out, f"{sources}/kernels/mcdem.cl"], check=True)
    return pathlib.Path(out).read_text()


def of_kernels(text, begin, barrier):
    """Number of barriers of each kernel in assembler code; `begin` matches a kernel's first line."""
    parts = re.split(begin, text, flags=re.M)
    return {name: len(re.findall(barrier, body)) for name, body in zip(parts[1::2], parts[2::2])}


def count_amd(clang, sources, defines, folder):
    text = compile_kernels(clang, sources, "amdgcn--amdhsa", "amdgcn--amdhsa.bc", ["-mcpu=gfx90a", "-nogpulib", *defines],
                           f"{folder}/amd.s")
    barriers = of_kernels(text, r"^([a-z_]+):.*@\1$", r"\bs_barrier\b")
    for entry in text[text.index("amdhsa.kernels:"):].split("  - .agpr_count")[1:]:
        number = {name: int(value) for name, value in re.findall(r"\.(\w+): +(\d+)$", entry, flags=re.M)}
        name = re.search(r"\.name: +(\w+)", entry)[1]
        yield name, number["vgpr_count"], number["vgpr_spill_count"], number["group_segment_fixed_size"], barriers[name]


def count_nvidia(clang, ptxas, sources, defines, folder):
    text = compile_kernels(clang, sources, "nvptx64-nvidia-nvcl", "nvptx64--nvidiacl.bc", ["-march=sm_80", *defines],
                           f"{folder}/nvidia.s")
    barriers = of_kernels(text, r"^\.entry (\w+)\(", r"\bbar\.sync\b|\bbarrier\.sync\b")
    if not ptxas:
        return
    done = subprocess.run([ptxas, "-v", "-arch=sm_90", f"{folder}/nvidia.s", "-o", f"{folder}/nvidia.cubin"], check=True,
                          capture_output=True, text=True)
    for entry in done.stderr.split("Compiling entry function '")[1:]:
        local = re.search(r"(\d+) bytes smem", entry)
        yield (entry[:entry.index("'")], int(re.search(r"Used (\d+) registers", entry)[1]),
               int(re.search(r"(\d+) bytes spill stores", entry)[1]), int(local[1]) if local else 0, barriers[entry[:entry.index("'")]])


def count(sources):
    clang, ptxas = find_clang(), find_ptxas()
    if not clang:
        skip("Clang and libclc of one version are not installed (Debian: clang-15 libclc-15)")
    if not ptxas:
        print("registers of NVIDIA are not counted: ptxas is not installed (PyPI: nvidia-cuda-nvcc)")
    with tempfile.TemporaryDirectory() as folder:
        for precision in ("float", "double"):
            for slots in (16, 32, 48, 64):
                defines = [f"-DMCDEM_DOUBLE={int(precision == 'double')}", f"-DSLOTS={slots}", f"-DBLOCK={ITEMS // slots}"]
                for target, rows in (("gfx90a", count_amd(clang, sources, defines, folder)),
                                     ("sm_90", count_nvidia(clang, ptxas, sources, defines, folder))):
                    for kernel, registers, spilled, local, barriers in rows:
                        if spilled:
                            sys.exit(f"{kernel} spills registers on {target} with {slots} slots in {precision}: {spilled}")
                        if kernel in KERNELS:
                            yield (target, kernel, precision, slots, -(-registers // GRANULE) * GRANULE, local, barriers)


def main():
    sources = sys.argv[1]
    file = pathlib.Path(sources) / "tests/gpu/budget.csv"
    counted = sorted(count(sources))
    if "--write" in sys.argv:
        file.write_text("\n".join([",".join(COLUMNS), *(",".join(map(str, row)) for row in counted)]) + "\n")
        return
    budget = {tuple(row[:4]): list(map(int, row[4:])) for row in list(csv.reader(file.read_text().splitlines()))[1:]}
    failed = []
    for row in counted:
        allowed = budget[tuple(map(str, row[:4]))]
        over = [f"{name} {there} > {limit}" for name, there, limit in zip(COLUMNS[4:], row[4:], allowed) if there > limit]
        if over:
            failed.append(f"{row[0]} {row[1]} {row[2]} {row[3]} slots: {', '.join(over)}")
    if failed:
        sys.exit("over the budget (tests/gpu/budget.csv; --write takes over what was counted):\n" + "\n".join(failed))
    print(f"{len(counted)} kernels within their budget")


if __name__ == "__main__":
    main()
