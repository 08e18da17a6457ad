"""Benchmark results as Markdown."""
PAPER_STROKE_GRAINS = 514


def million(value):
    return f"{value / 1e6:.3g}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def case_of(name):
    """mc_dem/saturated/float/grains:514/replicas:64/real_time"""
    model, friction, precision, grains, replicas = name.split("/")[:5]
    return {"model": model, "friction": friction, "precision": precision,
            "grains": int(grains.split(":")[1]), "replicas": int(replicas.split(":")[1])}


def steps_by_case(output):
    """The benchmarks of one run of step_bench, by (model, friction, precision, grains, replicas)."""
    return {tuple(case_of(b["name"]).values()): b for b in output["benchmarks"]} if output else {}


def count(number):
    return f"{number:,}"


def conditions(machine):
    lines = [f"- device: {machine['device']}", f"- host: {machine['processor']}, {machine['cores']} cores",
             f"- commit: {machine['commit']}", f"- measured {machine['date']}, load average of the machine before "
             f"{machine['load_before']:.2f}; meanwhile other programs kept {machine['other_programs']:.2f} cores busy"]
    if machine["other_programs"] > 0.05 * machine["cores"]:
        lines.append("- **measured under load**: read every figure as a lower bound and every ratio as rough")
    return "\n".join(lines) + "\n"


def step_rows(results):
    every, one = steps_by_case(results["steps"]), steps_by_case(results.get("steps_one_core"))
    head = ["contact model", "friction", "precision", "packing", "Z", "million grain-steps/s"]
    head += ["on one core"] if one else []
    rows = []
    for key, bench in every.items():
        model, friction, precision, grains, replicas = key
        packing = f"{count(grains)} grains" if replicas == 1 else f"{replicas} x {count(grains)} grains"
        row = [model, friction, precision, packing, f"{bench['contacts_per_grain']:.2f}",
               million(bench["grain_steps_per_s"])]
        if one:
            row.append(million(one[key]["grain_steps_per_s"]) if key in one else "")
        rows.append(row)
    return table(head, rows)


def growth(results):
    singles = {key[3]: b for key, b in steps_by_case(results["steps"]).items()
               if key[:3] == ("mc_dem", "saturated", "float") and key[4] == 1}
    rows = [[count(grains), f"{1e3 / singles[grains]['steps_per_s']:.3g}",
             f"{1e9 / singles[grains]['grain_steps_per_s']:.0f}",
             f"{singles[grains]['device_bytes_per_grain']:.0f}"] for grains in sorted(singles)]
    return table(["grains", "time of a step [ms]", "time of a grain-step [ns]", "device memory [bytes/grain]"], rows)


def limits(output):
    """The best of all repetitions, because limits of the machine are wanted."""
    def best(counter):
        return max(b[counter] for b in output["benchmarks"] if b["run_type"] == "iteration" and counter in b)
    return {"bytes_per_s": best("bytes_per_s"), "flops_per_s": best("flops_per_s"), "launch_s": 1 / best("launches_per_s")}


def limits_table(results):
    columns = [limits(results[key]) for key in ("limits", "limits_one_core") if results.get(key)]
    rows = [["memory bandwidth (triad) [GB/s]"] + [f"{c['bytes_per_s'] / 1e9:.1f}" for c in columns],
            ["multiply-add, float [GFLOP/s]"] + [f"{c['flops_per_s'] / 1e9:.1f}" for c in columns],
            ["a launch in a queue of launches [us]"] + [f"{c['launch_s'] * 1e6:.2f}" for c in columns]]
    return table(["limit", "whole device", "one core"][: len(columns) + 1], rows)


def roofline(results, grains=50_000):
    limit = limits(results["limits"])
    rows = []
    for (model, friction, precision, size, replicas), b in steps_by_case(results["steps"]).items():
        if size != grains or replicas != 1 or precision != "float":
            continue
        by_memory = limit["bytes_per_s"] / b["counted_bytes"]
        by_arithmetic = limit["flops_per_s"] / b["counted_flops"]
        roof = min(by_memory, by_arithmetic)
        rows.append([model, friction, f"{b['counted_bytes']:.0f}", f"{b['counted_flops']:.0f}", million(by_memory),
                     million(by_arithmetic), million(b["grain_steps_per_s"]), f"{100 * b['grain_steps_per_s'] / roof:.0f} %"])
    return table(["contact model", "friction", "bytes", "flops", "roof by memory", "roof by arithmetic", "measured",
                  "of the lower roof"], rows)


def waiting(results):
    cold, warm = results["compile"]
    rows = [[f"kernels ready, {precision}, nothing cached", f"{cold[precision]:.2f}"] for precision in cold]
    rows += [[f"kernels ready, {precision}, cached", f"{warm[precision]:.2f}"] for precision in warm]
    rows += [[f"{s['what']}, {PAPER_STROKE_GRAINS} grains ({s['packing']} packing), top force {s['top_force']:.2f} N",
              f"{s['seconds']:.2f}"] for s in results.get("stroke", [])]
    return table(["from the program's start", "seconds"], rows)


def ours_for_peer(results, grains, one_core):
    steps = results.get("steps_one_core") if one_core else results["steps"]
    found = steps_by_case(steps or results["steps"])
    wanted = [("mc_dem", "mindlin"), ("mc_dem", "saturated"), ("independent", "mindlin")]
    return [found.get((*pair, "float", grains, 1), {}).get("grain_steps_per_s") for pair in wanted]


def peers_table(results, grains=50_000):
    """One process of the peer compared with one core of mcdem, all cores with all cores."""
    head = ["code", "contacts", "processes", "Z", "million grain-steps/s", "mcdem mc_dem, mindlin, over it",
            "mc_dem, saturated", "independent, mindlin"]
    rows = []
    for peer in results["peers"]:
        row = [peer["code"], peer["contacts"], str(peer["processes"])]
        rate = peer.get("grain_steps_per_s")
        if rate is None:
            rows.append(row + ["", peer["note"], "", "", ""])
            continue
        ours = ours_for_peer(results, grains, peer["processes"] == 1)
        rows.append(row + [f"{peer['contacts_per_grain']:.2f}", million(rate)] +
                    [f"{own / rate:.3g}" if own else "" for own in ours])
    return table(head, rows)


def markdown(results):
    parts = [conditions(results["machine"]), "### Grain-steps a second\n", step_rows(results),
             "### Growth (mc_dem, saturated, float)\n", growth(results), "### The machine's limits\n", limits_table(results),
             "### Roofline at 50,000 grains (million grain-steps/s)\n", roofline(results),
             "### What a user waits for\n", waiting(results)]
    if results.get("peers"):
        parts += ["### Other codes, same packing, same session\n", peers_table(results)]
    return "\n".join(parts)
