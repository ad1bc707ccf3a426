#!/usr/bin/python3
"""Runs the benchmarks one after the other and writes what they found.

usage: bench.py [--quick] [--only NAME ...] OUTPUT

OUTPUT/results.json holds everything: machine, versions, and of each benchmark its commit, date and seconds, its
JSON and its text. OUTPUT/results.md is made of it alone, and the table of results in README.md. With --quick small
sizes are run, into a folder of their own, to see that everything works; the figures that documents show come from full
runs. With --only the others stay as they were, with the commit and date that they had, results.md says that it is
mixed, and README.md is left alone.
"""
import argparse
import json
import os
import pathlib
import platform
import subprocess
import sys
import tempfile
import time

import claims

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
BUILD = ROOT / "build/release"
PYTHON = "/usr/bin/python3"  # the one with Debian's h5py and matplotlib
ENVIRONMENT = dict(
    os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1",
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_btl_vader_single_copy_mechanism="none",
    OMPI_MCA_mpi_yield_when_idle="1", PYTHONDONTWRITEBYTECODE="1")


def program(name):
    """The path of a benchmark program in the build."""
    found = sorted(p for p in BUILD.rglob(name) if p.is_file() and os.access(p, os.X_OK))
    if not found:
        raise SystemExit(f"bench.py: {name} is not built; run ./dev build and the target benchmarks")
    return str(found[0])


def call(command, output=None):
    """Runs a command and appends what it prints to `output`."""
    done = subprocess.run([str(word) for word in command], env=ENVIRONMENT, capture_output=True,
                          text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    if output is not None:
        with open(output, "a", encoding="utf-8") as file:
            file.write(done.stdout)


def elements(out, quick):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        call([program("element_convergence"), *(["--smallest"] if quick else [])], folder / "runs.jsonl")
        # About 300,000 DOFs; of a tenth of it when quick.
        for order, size in ((2, 0.0083 if quick else 0.0026), (3, 0.0125 if quick else 0.0041)):
            for ranks in (1, 2):
                call(["mpirun", "--oversubscribe", "-n", ranks, program("element_assembly_speed"), order,
                      size], folder / "assembly.jsonl")
        call([PYTHON, HERE / "elements/report.py", HERE / "elements/exact_annulus.json",
              folder / "runs.jsonl", folder / "assembly.jsonl", out])


def squeal(out, quick):
    with tempfile.TemporaryDirectory() as name:
        result = pathlib.Path(name) / "squeal_benchmarks.json"
        call([program("squeal_work_precision"), *(["--smallest"] if quick else []), result])
        modes = pathlib.Path(name) / "modes.json"
        call([PYTHON, HERE / "squeal/modes.py", *(["--quick"] if quick else []), modes])
        call([PYTHON, HERE / "squeal/report.py", result, modes, out])


def sound(out, quick):
    with tempfile.TemporaryDirectory() as name:
        result = pathlib.Path(name) / "sound_benchmarks.json"
        call([program("sound_convergence"), *(["--smallest"] if quick else []), result])
        call([PYTHON, HERE / "sound/report.py", result, out])


def script(path, quick_words=("--quick",), full_words=()):
    """A benchmark that is one script: SCRIPT OUTPUT [WORDS]."""
    return lambda out, quick: call([PYTHON, HERE / path, out, *(quick_words if quick else full_words)])


# name, title, how it is run, and the stem of the .json and .md that it writes
BENCHMARKS = [
    ("elements", "Elements", elements, "elements"),
    ("scale", "Reduction over size and ranks", script("reduction/scale.py"), "reduction_scale"),
    ("ranks", "Reduction on many ranks", script("reduction/ranks.py"), "reduction_ranks"),
    ("accuracy", "Accuracy of the reduction",
     script("reduction/accuracy.py", ("--size", "0.03", "--ring", "12", "--modes", "20", "50")),
     "reduction_accuracy"),
    ("methods", "Craig-Bampton, Rubin and MacNeal", script("reduction/methods.py"), "reduction_methods"),
    ("rings", "Harmonics of a ring as masters",
     script("reduction/ring_harmonics.py", ("--size", "0.03", "--harmonics", "4", "--larger")), "ring_harmonics"),
    ("sectors", "One sector of a disc",
     script("reduction/sectors.py", ("--counts", "12", "--across", "8", "--large", "6", "8", "--modes", "10")), "sector_benchmarks"),
    ("peers", "Reduction beside other programs",
     script("reduction/peers.py", ("--modes", "20", "--size", "0.02")), "reduction_peers"),
    ("calculix", "Modes beside CalculiX",
     script("reduction/calculix.py", ("--modes", "20", "--around", "60", "--across", "12")),
     "reduction_calculix"),
    ("many-modes", "Many modes",
     script("reduction/many_modes.py", ("--size", "0.02", "--modes", "60", "--cut", "5"),
            ("--modes", "100", "500", "--cut", "5")), "reduction_many_modes"),
    ("body", "Bodies", script("body/run.py"), "body_benchmarks"),
    ("squeal", "Squeal", squeal, "squeal_benchmarks"),
    ("response-modes", "Response modes", script("squeal/response_modes.py"), "response_modes"),
    ("sound", "Sound", sound, "sound_benchmarks"),
    ("source", "The figures of the source", script("source/gallery.py"), "gallery"),
    ("end-to-end", "End to end", script("end_to_end/frontier.py"), "end_to_end"),
]


def versions():
    """Of the Debian packages that the figures depend on."""
    names = ["g++", "libpetsc-real-dev", "libslepc-real-dev", "libmumps-dev", "libmetis-dev",
             "libopenblas-dev", "libgmsh-dev", "libhdf5-dev", "libeigen3-dev", "openmpi-bin", "calculix-ccx",
             "libsundials-dev", "python3-numpy", "python3-scipy"]
    done = subprocess.run(["dpkg-query", "-W", "-f", "${Package} ${Version}\n", *names],
                          capture_output=True, text=True, check=False)
    return dict(line.split() for line in done.stdout.splitlines())


def setting(path):
    """What the kernel has been told, of a list in brackets the choice; empty where it has no such file."""
    try:
        text = pathlib.Path(path).read_text(encoding="ascii").strip()
    except OSError:
        return ""
    return text[text.index("[") + 1:text.index("]")] if "[" in text else text


def machine():
    with open("/proc/cpuinfo", encoding="ascii") as file:
        model = next((line.split(":")[1].strip() for line in file if line.startswith("model name")),
                     platform.machine())
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    return {"processor": model, "cores": os.cpu_count(), "memory_GiB": round(memory, 1),
            "system": platform.platform(),
            "huge_pages": setting("/sys/kernel/mm/transparent_hugepage/enabled"),
            "page_reporting_order": setting("/sys/module/page_reporting/parameters/page_reporting_order")}


def commit():
    """Of the sources; what this program writes, docs/ and README.md, changes while it runs."""
    git = lambda *words: subprocess.run(["git", "-C", str(ROOT), *words], capture_output=True, text=True,
                                        check=False).stdout.strip()
    changed = " with changes" if git("status", "--porcelain", "--untracked-files=no", "--", ".",
                                        ":!docs", ":!README.md") else ""
    return git("rev-parse", "--short", "HEAD") + changed


def run_one(name, title, work, stem, out, quick):
    print(f"== {title}", flush=True)
    stamp = {"title": title, "commit": commit(), "date": time.strftime("%Y-%m-%d")}
    start, load = time.time(), os.getloadavg()[0]
    written = [out / f"{stem}.md", out / f"{stem}.json"]
    before = {path: path.stat().st_mtime_ns for path in written if path.exists()}
    try:
        work(out, quick)
        for path in written:  # a result of another run is none of this one
            if not path.exists() or path.stat().st_mtime_ns == before.get(path):
                raise RuntimeError(f"{path} was not written")
    except RuntimeError as error:
        print(f"bench.py: {name}: {error}", file=sys.stderr)
        return {**stamp, "failed": str(error)}
    found = {**stamp, "seconds": round(time.time() - start, 1), "load_before": load}
    found["text"] = (out / f"{stem}.md").read_text(encoding="utf-8")
    found["results"] = json.loads((out / f"{stem}.json").read_text(encoding="utf-8"))
    return found


def lowered(text):
    """The text of one benchmark as a section: its headings one level down."""
    return "\n".join("#" + line if line.startswith("#") else line for line in text.splitlines())


def stamps(benchmarks, key):
    """The different commits or dates of the benchmarks, in the order in which they come."""
    return list(dict.fromkeys(found.get(key, "not recorded") for found in benchmarks.values()))


def common(benchmarks, key):
    """What the header says of them."""
    different = stamps(benchmarks, key)
    return different[0] if len(different) == 1 else "mixed, as the sections say: " + ", ".join(different)


def footer(found, benchmarks):
    """What follows a section; commit and date too where they are not those of all."""
    own = [f"{key} {found.get(key, 'not recorded')}" for key in ("commit", "date") if len(stamps(benchmarks, key)) > 1]
    ran = [f"{found['seconds']:.0f} s", f"load of the machine before: {found['load_before']:.1f}"] if "seconds" in found else []
    return f"*{'; '.join(ran + own)}*" if ran + own else ""


def markdown(results):
    """results.md, of results.json alone."""
    about, packages, benchmarks = results["machine"], results["versions"], results["benchmarks"]
    lines = ["# Results", "",
             f"Written by `./dev bench{' quick' if results['quick'] else ''}` from `results.json`; no number "
             "here was typed. Times compare within one section only.", "",
             "| | |", "|---|---|",
             f"| commit | {common(benchmarks, 'commit')} |", f"| date | {common(benchmarks, 'date')} |",
             f"| processor | {about['processor']}, {about['cores']} cores, {about['memory_GiB']} GiB |",
             f"| system | {about['system']} |",
             f"| memory | transparent huge pages: {about['huge_pages'] or 'none'}; page_reporting_order "
             f"{about['page_reporting_order'] or 'none'} (above 10: a virtual machine keeps the pages it frees) |",
             f"| packages | {', '.join(f'{k} {v}' for k, v in packages.items())} |", "",
             "## In short", "", "The same table stands in README.md" +
             (" as of the last run of all." if len(stamps(benchmarks, "commit")) > 1 else "."), "", *claims.table(benchmarks), ""]
    for found in benchmarks.values():
        if "failed" in found:
            lines += [f"## {found['title']}", "", "Failed:", "", "```", found["failed"], "```", ""]
        else:
            lines += [lowered(found["text"]), ""]
        lines += [footer(found, benchmarks), ""]
    return "\n".join(lines)


def earlier(out):
    """The benchmarks of OUTPUT/results.json, each with its commit and date (before it had them: those of the file)."""
    file = out / "results.json"
    if not file.exists():
        return {}
    results = json.loads(file.read_text(encoding="utf-8"))
    whole = {key: results[key] for key in ("commit", "date") if key in results}
    return {name: {**whole, **found} for name, found in results["benchmarks"].items()}


def write(out, results):
    (out / "results.json").write_text(json.dumps(results, indent=1), encoding="utf-8")
    (out / "results.md").write_text(markdown(results), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", nargs="+", choices=[b[0] for b in BENCHMARKS], metavar="NAME")
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    out = arguments.output
    (out / "figures").mkdir(parents=True, exist_ok=True)
    results = {"quick": arguments.quick, "machine": machine(), "versions": versions(),
               "benchmarks": earlier(out) if arguments.only else {}}
    for name, title, work, stem in BENCHMARKS:
        if not arguments.only or name in arguments.only:
            results["benchmarks"][name] = run_one(name, title, work, stem, out, arguments.quick)
            write(out, results)
    if not arguments.quick and not arguments.only:
        claims.put_into(ROOT / "README.md", results["benchmarks"])
    return 1 if any("failed" in found for found in results["benchmarks"].values()) else 0


if __name__ == "__main__":
    sys.exit(main())
