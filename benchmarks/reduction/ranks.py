#!/usr/bin/python3
"""What a reduction would gain from more ranks than this machine has cores: work counted rank by rank, and a model of a cluster.

usage: ranks.py [--quick] [--machine FILE] OUTPUT      (--quick: the small disc on up to four ranks)

All ranks share the cores of this machine, so their seconds mean little. What each of them does by itself is counted instead: the CPU
time between its calls of MPI, phase by phase, and the bytes and messages of these calls, by the library work_outside_mpi. The phases
follow one another on the rank that has most to do, with the numbers of FILE (machine.json) for the network. Writes
OUTPUT/reduction_ranks.json and .md.
"""
import argparse
import json
import math
import pathlib
import tempfile

import run

HERE = pathlib.Path(__file__).resolve().parent
COUNTER = run.ROOT / "build/release/benchmarks/reduction/libwork_outside_mpi.so"
SIZES = {"73k": 0.009, "300k": 0.0041, "500k": 0.0031, "1M": 0.00225}
RANKS = {"73k": (1, 2, 4, 8, 16, 32, 64), "300k": (1, 2, 4, 8, 16, 32, 64), "500k": (1, 64), "1M": (1, 2, 16, 32)}
CARRIED_ON_TO = 4e6  # DOFs
BOUND_BY_MEMORY = "CMSSolve"  # the event whose speed is that of memory


def measure(folder, name, ranks):
    path = run.scene(folder / f"{name}-{ranks}", SIZES[name])
    cache = folder / "meshes"
    if ranks == 1:  # kept for all numbers of ranks, as one would on a cluster
        run.timed([run.CHLADNI, "mesh", path, "--output", folder / name, "--mesh-cache", cache], folder)
    counted = folder / f"{name}-{ranks}" / "work.json"
    summary = run.reduce(folder / f"{name}-{ranks}", path, ranks, cache=cache,
                         variables={"LD_PRELOAD": COUNTER, "WORK_OUTSIDE_MPI": counted})
    return {"disc": name, "ranks": ranks, "dofs": summary["n_dofs"], "wall_s": summary["wall_s"], "peak_MiB": summary["peak_MiB"],
            "frequencies_Hz": summary["frequencies_Hz"],
            **{key: summary[f"factor_{key}"] for key in ("entries", "operations", "entries_of_rank", "operations_of_rank")},
            "work": [json.loads(counted.with_suffix(f".json.{rank}").read_text()) for rank in range(ranks)]}


def crowding(ranks, machine):
    """How much slower memory is where all cores of a node that have a rank ask for it."""
    return max(1.0, min(ranks, machine["cores_per_node"]) / machine["cores_of_full_memory_bandwidth"])


def phases_of(run_, machine):
    """Seconds of each phase, on the rank that has most to do in it."""
    slower = crowding(run_["ranks"], machine) - 1.0
    phases = {}
    for rank in run_["work"]:
        own = {}
        for key, counted in rank.items():
            phase, _, event = key.partition("/")
            own[phase] = own.get(phase, 0.0) + counted["work_s"] * (1.0 + (slower if event == BOUND_BY_MEMORY else 0.0)) \
                + 1e-6 * machine["latency_us"] * counted["messages"] + 1e-9 * counted["bytes"] / machine["bandwidth_GB_per_s"]
        for phase, seconds in own.items():
            phases[phase] = max(phases.get(phase, 0.0), seconds)
    return phases


def most_of(run_, what):
    return max(sum(counted[what] for counted in rank.values()) for rank in run_["work"])


def losses_of(run_, one):
    """Seconds of each event of a phase beyond its share of one rank's, the largest first: work alone."""
    keys = {key for rank in run_["work"] for key in rank}
    most = {key: max(rank.get(key, {"work_s": 0.0})["work_s"] for rank in run_["work"]) for key in keys}
    alone = {key: one["work"][0].get(key, {"work_s": 0.0})["work_s"] for key in keys}
    return dict(sorted(((key, most[key] - alone[key] / run_["ranks"]) for key in keys), key=lambda item: -item[1]))


def judged(runs, machine):
    one = {r["disc"]: r for r in runs if r["ranks"] == 1}
    entries = []
    for r in runs:
        alone = one[r["disc"]]
        phases, before = phases_of(r, machine), phases_of(alone, machine)
        speedup = sum(before.values()) / sum(phases.values())
        change = max(abs(a / b - 1.0) for a, b in zip(r["frequencies_Hz"], alone["frequencies_Hz"]))
        entries.append({**{k: v for k, v in r.items() if k not in ("work", "frequencies_Hz")}, "phases_s": phases,
                        "predicted_s": sum(phases.values()), "speedup": speedup, "efficiency": speedup / r["ranks"],
                        "entries_share": r["entries_of_rank"] / alone["entries"],
                        "operations_share": r["operations_of_rank"] / alone["operations"],
                        "messages": most_of(r, "messages"), "bytes": most_of(r, "bytes"),
                        "mean_work_s": sum(c["work_s"] for rank in r["work"] for c in rank.values()) / r["ranks"],
                        "losses_s": losses_of(r, alone), "change_of_frequencies": change})
    return entries


def grown(points, dofs):
    """Seconds at a larger size, of a power law through (DOFs, seconds) of some discs by least squares, from the largest of them on."""
    x, y = [math.log(size) for size, _ in points], [math.log(seconds) for _, seconds in points]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    rate = sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)
    size, seconds = max(points)
    return seconds * (dofs / size) ** max(0.0, rate)


def carried_on(entries, dofs):
    """Efficiencies at a larger size, {ranks: (efficiency, discs)}: the time on one rank, and what more ranks take beyond their share of it,
    each grow over the discs by a power of their own."""
    alone = {e["disc"]: e for e in entries if e["ranks"] == 1}
    further = {}
    for ranks in sorted({e["ranks"] for e in entries} - {1}):
        known = [e for e in entries if e["ranks"] == ranks]
        losses = [(e["dofs"], e["predicted_s"] - alone[e["disc"]]["predicted_s"] / ranks) for e in known]
        if len(losses) < 2 or min(seconds for _, seconds in losses) <= 0.0:
            continue
        one = grown([(e["dofs"], e["predicted_s"]) for e in alone.values()], dofs)
        further[ranks] = (one / (one + ranks * grown(losses, dofs)), [e["disc"] for e in known])
    return further


def table(entries, machine, here):
    lines = ["# Reduction on many ranks, by counts", "",
             "366 masters and 100 fixed-interface modes. All ranks shared the cores of one machine; what each does by itself was counted: CPU "
             "time between its calls of MPI, by phases, and messages and bytes of these calls. Written by "
             "`benchmarks/reduction/ranks.py`.", "",
             f"{here['processor']}, {here['cores']} cores, commit {here['commit']}. The predicted time is, phase after phase, that of the rank "
             f"with most to do, on a machine with {machine['cores_per_node']} cores a node, of which "
             f"{machine['cores_of_full_memory_bandwidth']} together take all its memory bandwidth, {machine['latency_us']} us for a message and "
             f"{machine['bandwidth_GB_per_s']} GB/s (`benchmarks/reduction/machine.json`). Solutions slow down by the shared bandwidth; a "
             "collective call waits for one message per doubling of the ranks, a sum of all ranks for two, an exchange for one to each rank that gets "
             "something; bytes are those that a rank sends or receives, whichever is more. The mesh was kept before "
             "(`--mesh-cache`). Waiting within a phase and the start of the program are left out. The work of ranks that share a "
             "core is counted too high, because the others empty its caches.", "",
             "| disc | ranks | factor: whole over the fullest rank, entries | operations | messages | MB | peak MiB of a rank | "
             "mean work, s | predicted, s | speed-up | efficiency | largest losses, s of one rank | change of the frequencies |", "|---" * 13 + "|"]
    for e in entries:
        losses = ", ".join(f"{k} {v:.2f}" for k, v in list(e["losses_s"].items())[:3]) if e["ranks"] > 1 else "-"
        lines.append(f"| {e['disc']} | {e['ranks']} | {1 / e['entries_share']:.1f} | {1 / e['operations_share']:.1f} | {e['messages']:.0f} | "
                     f"{e['bytes'] / 1e6:.0f} | {e['peak_MiB']:.0f} | {e['mean_work_s']:.2f} | {e['predicted_s']:.2f} | {e['speedup']:.1f} | "
                     f"{100 * e['efficiency']:.0f} % | {losses} | {e['change_of_frequencies']:.0e} |")
    further = carried_on(entries, CARRIED_ON_TO)
    if further:
        lines += ["", f"Extrapolated to {CARRIED_ON_TO / 1e6:.0f} million DOFs. The time on one rank, and the time that more ranks take beyond their share of "
                  "it, are extrapolated by the power of the DOFs with which they grow over the discs:", "", "| ranks | discs | efficiency |",
                  "|---|---|---|"]
        lines += [f"| {ranks} | {', '.join(discs)} | {100 * share:.0f} % |" for ranks, (share, discs) in further.items()]
    two = [e for e in entries if e["ranks"] == 2]
    lines += ["", "The model compared with this machine, on which two ranks have a core each:", "", "| disc | predicted, s | measured, s |", "|---|---|---|"]
    lines += [f"| {e['disc']} | {e['predicted_s']:.2f} | {e['wall_s']:.2f} |" for e in two]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--machine", type=pathlib.Path, default=HERE / "machine.json")
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    machine = json.loads(arguments.machine.read_text())
    wanted = {"73k": (1, 2, 4)} if arguments.quick else RANKS
    with tempfile.TemporaryDirectory() as folder:
        runs = [measure(pathlib.Path(folder), name, ranks) for name, counts in wanted.items() for ranks in counts]
    entries = judged(runs, machine)
    arguments.output.mkdir(parents=True, exist_ok=True)
    result = {"machine": machine, "here": run.machine(), "carried_on": {str(n): share for n, (share, _) in carried_on(entries, CARRIED_ON_TO).items()},
              "runs": entries}
    (arguments.output / "reduction_ranks.json").write_text(json.dumps(result, indent=1))
    text = table(entries, machine, result["here"])
    (arguments.output / "reduction_ranks.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
