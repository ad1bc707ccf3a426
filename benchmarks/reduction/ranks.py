#!/usr/bin/python3
"""What a reduction would gain from more ranks than this machine has cores: counted work, and a model of a cluster.

usage: ranks.py [--quick] [--machine FILE] OUTPUT      (--quick: the small disc on up to four ranks)

All ranks share the cores of this machine, so their seconds mean little; what they have to do is counted: the operations and the
entries of the factor on the fullest rank, the messages and bytes that PETSc's log sees, the memory of a rank. A model turns
the counts and the times of one rank into a time on as many cores, with the numbers of FILE (machine.json). Writes
OUTPUT/reduction_ranks.json and .md.
"""
import argparse
import json
import math
import pathlib
import re
import tempfile

import run

HERE = pathlib.Path(__file__).resolve().parent
SIZES = {"73k": 0.009, "300k": 0.0041}
RANKS = {"73k": (1, 2, 4, 8, 16, 32, 64), "300k": (1, 2, 4, 8, 16, 32)}
SERIAL_PHASES = ("mesh", "pictures", "write")
SERIAL_EVENTS = ("CMSAnalysis",)


def logged(printed):
    """Messages, bytes of them and reductions of the rank that has most, from -log_view."""
    value = lambda name: float((re.search(rf"^{name}:?\s+([\d.e+-]+)", printed, re.M) or [0, 0])[1])
    messages = value("MPI Msg Count") or value("MPI Messages")
    length = value(r"MPI Msg Len \(bytes\)") or value("MPI Message Lengths")
    return {"messages": messages, "bytes": length, "reductions": value("MPI Reductions")}


def measure(folder, name, ranks):
    path = run.scene(folder / f"{name}-{ranks}", SIZES[name])
    cache = folder / "meshes"
    if ranks == 1:  # kept for all numbers of ranks, as one would on a cluster
        run.timed([run.CHLADNI, "mesh", path, "--output", folder / name, "--mesh-cache", cache], folder)
    summary = run.reduce(folder / f"{name}-{ranks}", path, ranks, cache=cache)
    counted = {f"{what}{of}": summary[f"factor_{what}{of}"] for what in ("entries", "operations") for of in ("", "_of_rank")}
    return {"disc": name, "ranks": ranks, "dofs": summary["n_dofs"], **counted,
            "wall_s": summary["wall_s"], "cpu_s": summary["cpu_s"], "peak_MiB": summary["peak_MiB"], "frequencies_Hz": summary["frequencies_Hz"],
            "phases_s": summary["phases"], "events_s": {key: value["wall_s"] for key, value in summary["events"].items()},
            **logged(summary["printed"])}


def parts_of(one):
    """Seconds of one rank by what they shrink with on many."""
    events = one["events_s"]
    serial = sum(one["phases_s"].get(p, 0.0) for p in SERIAL_PHASES) + sum(events.get(e, 0.0) for e in SERIAL_EVENTS)
    parts = {"serial": serial, "ordering": events["CMSOrdering"], "factor": events["CMSFactor"], "solutions": events["CMSSolve"]}
    return {**parts, "rows": one["wall_s"] - sum(parts.values())}


def ordering_share(blocks, ranks):
    """The longest way of a dissection that ranks make together over that of one rank: a separator costs as much as the graph is
    large, and is sought by one rank while the others wait; whole subgraphs of ranks are dissected at the same time."""
    least = 200.0  # vertices, from which on METIS dissects no further
    levels, shared = math.log2(blocks / least), math.log2(ranks)
    return (sum(0.5**i for i in range(math.ceil(shared))) + (levels - shared) / ranks) / levels


def predicted(entry, one, machine):
    """Seconds on as many cores, by parts."""
    parts, ranks = parts_of(one), entry["ranks"]
    waits = entry["messages"] + 2.0 * entry["reductions"] * max(ranks - 1, 0).bit_length()
    network = 1e-6 * machine["latency_us"] * waits + 1e-9 * entry["bytes"] / machine["bandwidth_GB_per_s"] if ranks > 1 else 0.0
    cores = machine["cores_of_full_memory_bandwidth"]
    crowded = max(1.0, min(ranks, machine["cores_per_node"]) / cores) if ranks > 1 else 1.0
    return {"serial": parts["serial"], "ordering": parts["ordering"] * ordering_share(entry["dofs"] / 6, ranks),
            "factor": parts["factor"] * entry["operations_share"], "solutions": parts["solutions"] * entry["entries_share"] * crowded,
            "rows": parts["rows"] / ranks, "network": network}


def judged(runs, machine):
    one = {r["disc"]: r for r in runs if r["ranks"] == 1}
    for r in runs:  # an order that ranks make together fills a little more
        for what in ("entries", "operations"):
            r[f"{what}_share"] = r[f"{what}_of_rank"] / one[r["disc"]][what]
    largest_change = lambda r: max(abs(a / b - 1.0) for a, b in zip(r["frequencies_Hz"], one[r["disc"]]["frequencies_Hz"]))
    entries = []
    for r in runs:
        parts = predicted(r, one[r["disc"]], machine)
        whole = sum(parts.values())
        speedup = one[r["disc"]]["wall_s"] / whole
        losses = sorted(((parts[k] - parts_of(one[r["disc"]]).get(k, 0.0) / r["ranks"], k) for k in parts), reverse=True)
        entries.append({**r, "predicted_s": parts, "predicted_wall_s": whole, "speedup": speedup, "efficiency": speedup / r["ranks"],
                        "losses_s": {k: v for v, k in losses}, "change_of_frequencies": largest_change(r)})
    return entries


def table(entries, machine, here):
    lines = ["# Reduction on many ranks, by counts", "",
             "366 masters and 100 fixed-interface modes. All ranks shared the cores of one machine, where they only counted: operations and "
             "entries of the factor on the fullest rank against those of one rank alone, messages, bytes and reductions of PETSc's log, memory. Written by "
             "`benchmarks/reduction/ranks.py`.", "",
             f"{here['processor']}, {here['cores']} cores, commit {here['commit']}. Predicted seconds are those of one rank here, shared out as "
             f"counted, on a machine with {machine['cores_per_node']} cores a node, of which {machine['cores_of_full_memory_bandwidth']} together "
             f"take all its memory bandwidth, {machine['latency_us']} us for a message and {machine['bandwidth_GB_per_s']} GB/s "
             "(`benchmarks/reduction/machine.json`): solutions slow down by the shared bandwidth, rows are shared out evenly, "
             "reading the mesh, which was kept before (`--mesh-cache`), analysis, pictures and files stay on one rank, "
             "ranks order together, each separator by one of them, "
             "a reduction takes two messages for each doubling of the ranks. "
             "Waiting for the slowest rank beyond these counts is left out.", "",
             "| disc | ranks | factor: whole over the fullest rank, entries | operations | messages | MB | reductions | peak MiB of a rank | "
             "predicted, s | speed-up | efficiency | largest losses, s | change of the frequencies |", "|---" * 13 + "|"]
    for e in entries:
        losses = ", ".join(f"{k} {v:.2f}" for k, v in list(e["losses_s"].items())[:3]) if e["ranks"] > 1 else "-"
        lines.append(f"| {e['disc']} | {e['ranks']} | {1 / e['entries_share']:.1f} | {1 / e['operations_share']:.1f} | {e['messages']:.0f} | "
                     f"{e['bytes'] / 1e6:.1f} | {e['reductions']:.0f} | {e['peak_MiB']:.0f} | {e['predicted_wall_s']:.2f} | {e['speedup']:.1f} | "
                     f"{100 * e['efficiency']:.0f} % | {losses} | {e['change_of_frequencies']:.0e} |")
    two = [e for e in entries if e["ranks"] == 2]
    lines += ["", "The model beside this machine, where two ranks have a core each:", "", "| disc | predicted, s | measured, s |", "|---|---|---|"]
    lines += [f"| {e['disc']} | {e['predicted_wall_s']:.2f} | {e['wall_s']:.2f} |" for e in two]
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
    result = {"machine": machine, "here": run.machine(), "runs": [{k: v for k, v in e.items() if k != "frequencies_Hz"} for e in entries]}
    (arguments.output / "reduction_ranks.json").write_text(json.dumps(result, indent=1))
    text = table(entries, machine, result["here"])
    (arguments.output / "reduction_ranks.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
