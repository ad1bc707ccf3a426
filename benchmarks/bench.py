#!/usr/bin/python3
"""Runs the benchmarks one after the other and writes what they found.

usage: bench.py [--quick] [--only NAME ...] [--pages | --check] OUTPUT

Each benchmark writes its page and its JSON into OUTPUT. OUTPUT/results.json has the machine, the versions, and of each
benchmark commit, date, seconds and the digest of its JSON. OUTPUT/README.md is an index that is made of these files alone:
for each page a link and a few lines. Each page names its run below its heading. With --quick small sizes are run, into a folder of their own, to see that everything
works; the figures that documents show come from full runs. With --only the others stay as they were. With --pages nothing
is run: all that is written besides the pages is made of the files that are there; with --check it must be what these files give. The three lines of
the README.md of the project and what other pages of docs/ quote are written when OUTPUT is docs/results.
"""
import argparse
import hashlib
import json
import os
import pathlib
import platform
import re
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
    ("methods", "Craig-Bampton and Rubin", script("reduction/methods.py"), "reduction_methods"),
    ("rings", "Harmonics of a ring as masters",
     script("reduction/ring_harmonics.py", ("--size", "0.03", "--harmonics", "4", "--larger")), "ring_harmonics"),
    ("sectors", "One sector of a disc",
     script("reduction/sectors.py", ("--counts", "12", "--across", "8", "--large", "6", "8", "--modes", "10")), "sector_benchmarks"),
    ("peers", "Reduction beside other programs",
     script("reduction/peers.py", ("--modes", "20", "--size", "0.02")), "reduction_peers"),
    ("calculix", "Modes beside CalculiX",
     script("reduction/calculix.py", ("--modes", "20", "--around", "60", "--across", "12")),
     "reduction_calculix"),
    ("solids", "Modes of solids beside CalculiX and scipy", script("reduction/solids.py"), "reduction_solids"),
    ("many-modes", "Many modes",
     script("reduction/many_modes.py", ("--size", "0.02", "--modes", "60", "--cut", "5"),
            ("--modes", "100", "500", "--cut", "5")), "reduction_many_modes"),
    ("body", "Bodies", script("body/run.py"), "body_benchmarks"),
    ("squeal", "Squeal", squeal, "squeal_benchmarks"),
    ("solid-disc", "One disc as a shell and as a solid", script("squeal/solid_disc.py"), "solid_disc"),
    ("condensed", "Small bodies for one brake", script("squeal/condensed_bodies.py"), "condensed_bodies"),
    ("told-errors", "Printed errors of growth rates and critical speeds", script("squeal/told_errors.py"), "told_errors"),
    ("friction-matrices", "Unstable eigenvalues of matrices with friction", script("squeal/friction_matrices.py"), "friction_matrices"),
    ("response-modes", "Response modes", script("squeal/response_modes.py"), "response_modes"),
    ("sound", "Sound", sound, "sound_benchmarks"),
    ("source", "The figures of the source", script("source/gallery.py"), "gallery"),
    ("end-to-end", "End to end", script("end_to_end/frontier.py"), "end_to_end"),
    ("scenes", "One accuracy for every scene", script("end_to_end/accuracy.py"), "accuracy"),
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
    """Of the sources; what this program writes, docs/results/ and README.md, changes while it runs."""
    git = lambda *words: subprocess.run(["git", "-C", str(ROOT), *words], capture_output=True, text=True,
                                        check=False).stdout.strip()
    changed = " with changes" if git("status", "--porcelain", "--untracked-files=no", "--", ".",
                                        ":!docs/results", ":!README.md") else ""
    return git("rev-parse", "--short", "HEAD") + changed


def run_one(name, title, work, stem, out, quick):
    print(f"== {title}", flush=True)
    stamp = {"title": title, "commit": commit(), "date": time.strftime("%Y-%m-%d"), "machine": named(machine())}
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
    return {**stamp, "seconds": round(time.time() - start, 1), "load_before": load, "digest": digest(written[1])}


def digest(path):
    """Of a file of results, so that a stamp is known to be that of the file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


def named(machine):
    """A machine in a few words, however a file of results describes it; nothing where it does not."""
    if isinstance(machine, str):
        return machine
    return f"{machine['processor']}, {machine['cores']} cores" if isinstance(machine, dict) and "processor" in machine else ""


def stamp_of(name, path, recorded):
    """Commit, date, machine, seconds and load of the results in a file; of those that were not written here what the file says."""
    found = json.loads(path.read_text(encoding="utf-8"))
    machine = found.get("machine", {}) if isinstance(found, dict) else {}
    own = {"machine": named(machine), "commit": machine.get("commit") if isinstance(machine, dict) else None}
    stamp = recorded.get(name, {})
    return {**own, **{key: value for key, value in stamp.items() if value}} if stamp.get("digest") == digest(path) else own


RUN = re.compile(r"\A(# [^\n]*\n\n)(?:\*Run: [^\n]*\*\n\n)?")


def with_run(page, stamp):
    """The text of a page with the line below its heading that says where its numbers come from."""
    if "in_commit" in stamp:
        of = f"commit not recorded, numbers stored by {stamp['in_commit']}"
    else:
        of = f"commit {stamp['commit']}" if stamp.get("commit") else "commit not recorded"
    line = f"*Run: {of}{', ' + stamp['date'] if 'date' in stamp else ''}; machine: {stamp.get('machine') or 'not recorded'}.*"
    return RUN.sub(lambda head: f"{head[1]}{line}\n\n", page.read_text(encoding="utf-8"))


def pages(out, recorded):
    """Each page of results beside a file of numbers, with its run."""
    names = {stem: name for name, _, _, stem in BENCHMARKS}
    both = [path for path in sorted(out.glob("*.json")) if path.with_suffix(".md").exists()]
    return [(path.with_suffix(".md"), with_run(path.with_suffix(".md"), stamp_of(names.get(path.stem, path.stem), path, recorded))) for path in both]


def section(name, title, stem, out, recorded):
    """A benchmark in the index: its link, and its facts."""
    if "failed" in recorded.get(name, {}):
        return [f"## {title}", "", "Failed:", "", "```", recorded[name]["failed"], "```", ""]
    page, path = out / f"{stem}.md", out / f"{stem}.json"
    if not (page.exists() and path.exists()):
        return []
    said = claims.facts(name, json.loads(path.read_text(encoding="utf-8")))
    return [f"## [{heading(page)}]({stem}.md)", "", *([*(f"- {fact}" for fact in said), ""] if said else [])]


def heading(page):
    return page.read_text(encoding="utf-8").split("\n", 1)[0].lstrip("# ")


def runs(out, recorded):
    """When each benchmark ran."""
    lines = ["| page | commit | machine | date | s | load before |", "|---|---|---|---|---|---|"]
    for name, title, _, stem in BENCHMARKS:
        if (out / f"{stem}.json").exists():
            stamp = stamp_of(name, out / f"{stem}.json", recorded)
            seconds, load = (f"{stamp[key]:{form}}" if key in stamp else "" for key, form in (("seconds", ".0f"), ("load_before", ".1f")))
            lines.append(f"| [{title}]({stem}.md) | {stamp.get('commit') or ''} | {stamp.get('machine', '')} | {stamp.get('date', '')} | {seconds} | {load} |")
    return lines


def others(out):
    """Pages in the folder that other programs write."""
    own = {"README", *(stem for _, _, _, stem in BENCHMARKS)}
    return [f"- [{heading(page)}]({page.name})" for page in sorted(out.glob("*.md")) if page.stem not in own]


def index(out, results):
    """README.md of the folder."""
    about, packages, recorded = results["machine"], results["versions"], results["benchmarks"]
    lines = ["# Results", "",
             f"An index of all benchmarks, written by `./dev bench{' quick' if results['quick'] else ''}` from the JSON files beside it; no "
             "number here was typed. Times compare within one page only.", ""]
    for name, title, _, stem in BENCHMARKS:
        lines += section(name, title, stem, out, recorded)
    if others(out):
        lines += ["## Other pages that programs write", "", *others(out), ""]
    return "\n".join([
        *lines, "## Runs", "", "A cell is empty where nothing was recorded, as when a benchmark was run by itself.", "", *runs(out, recorded), "",
        "| machine and software of the last run | |", "|---|---|",
        f"| processor | {about['processor']}, {about['cores']} cores, {about['memory_GiB']} GiB |",
        f"| system | {about['system']} |", f"| transparent huge pages | {about['huge_pages'] or 'none'} |",
        f"| page_reporting_order (above 10: a virtual machine keeps the pages it frees) | {about['page_reporting_order'] or 'none'} |",
        *(f"| {package} | {version} |" for package, version in packages.items()), ""])


def earlier(out):
    """OUTPUT/results.json, if there is one."""
    file = out / "results.json"
    return json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}


def write(out, results):
    (out / "results.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    for page, text in [*pages(out, results["benchmarks"]), (out / "README.md", index(out, results))]:
        page.write_text(text, encoding="utf-8")


def quoting(out):
    """README.md with its three lines of the results in a folder, and every other page of docs/ that quotes them."""
    found = {name: claims.read(out, stem) for name, _, _, stem in BENCHMARKS if name in ("scale", "peers", "squeal")}
    texts = {path: path.read_text(encoding="utf-8") for path in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))] if out not in path.parents}
    texts[ROOT / "README.md"] = claims.put_into(texts[ROOT / "README.md"], found)
    return [(path, claims.quote(text, out)) for path, text in texts.items()]


def check(out):
    """Whether the pages that are made of the results are theirs."""
    results = earlier(out)
    made = [*pages(out, results["benchmarks"]), (out / "README.md", index(out, results)), *quoting(out)]
    old = [path for path, text in made if path.read_text(encoding="utf-8") != text]
    print("\n".join(f"FAILED: {path} is out of date: ./dev bench pages" for path in old) or f"{len(made)} pages are those of the results")
    return 1 if old else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", nargs="+", choices=[b[0] for b in BENCHMARKS], metavar="NAME")
    parser.add_argument("--pages", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("output", type=pathlib.Path)
    arguments = parser.parse_args()
    out = arguments.output.resolve()
    if arguments.check:
        return check(out)
    (out / "figures").mkdir(parents=True, exist_ok=True)
    before = earlier(out)
    if arguments.pages:
        results = before
        write(out, results)
    else:
        results = {"quick": arguments.quick, "machine": machine(), "versions": versions(),
                   "benchmarks": before.get("benchmarks", {}) if arguments.only else {}}
        for name, title, work, stem in BENCHMARKS:
            if not arguments.only or name in arguments.only:
                results["benchmarks"][name] = run_one(name, title, work, stem, out, arguments.quick)
                write(out, results)
    if out == ROOT / "docs/results":
        for path, text in quoting(out):
            path.write_text(text, encoding="utf-8")
    return 1 if any("failed" in found for found in results["benchmarks"].values()) else 0


if __name__ == "__main__":
    sys.exit(main())
