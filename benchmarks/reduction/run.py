"""Runs chladni on the benchmark disc, and writes what was found; shared by the scripts of this folder."""
import importlib
import json
import os
import pathlib
import platform
import resource
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
CHLADNI = ROOT / "build/release/bin/chladni"
ENVIRONMENT = dict(
    os.environ,
    OMP_NUM_THREADS="1",
    OPENBLAS_NUM_THREADS="1",
    OMPI_ALLOW_RUN_AS_ROOT="1",
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
    OMPI_MCA_btl_vader_single_copy_mechanism="none",
    OMPI_MCA_mpi_yield_when_idle="1",
)


def scene(folder, size, order=3, modes=100):
    """Writes the scene into the folder and returns its path."""
    text = (HERE / "disc.toml").read_text()
    for word, value in [("ELEMENT_ORDER", order), ("ELEMENT_SIZE", size), ("MODES", modes)]:
        text = text.replace(word, str(value))
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "disc.toml"
    path.write_text(text)
    return path


def reduce(folder, path, ranks=1, options=(), cache=None, variables=None):
    """One reduction, with the mesh that `cache` keeps and the environment variables of all ranks if given; returns the summary that
    the program writes, and its -log_view events."""
    set_by = ["env", *(f"{name}={value}" for name, value in (variables or {}).items())]
    launcher = [*(["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []), *set_by]
    command = [*launcher, str(CHLADNI), "reduce", str(path), "--output", str(folder),
               "--json", str(folder / "summary.json"), *(["--mesh-cache", str(cache)] if cache else []), "--", "-log_view", *options]
    done = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)}\n{done.stderr}")
    events = {}
    for line in done.stdout.splitlines():
        if line.startswith("CMS"):
            name, count, _, seconds, *_ = line.split()
            events[name] = {"count": int(count), "wall_s": float(seconds)}
    summary = json.loads((folder / "summary.json").read_text())
    return {**summary, "events": events, "printed": done.stdout}


def timed(command, folder, most_s=None):
    """Runs a command that must succeed: {wall_s, cpu_s, peak_MiB} of the whole process as the kernel counts them; one that
    takes `most_s` of CPU time is ended, and has `stopped` then."""
    limit = most_s and (lambda: resource.setrlimit(resource.RLIMIT_CPU, (most_s, most_s)))
    with tempfile.TemporaryFile("w+") as printed:
        start = time.perf_counter()
        with subprocess.Popen(list(map(str, command)), cwd=folder, env=ENVIRONMENT, stdout=printed,
                              stderr=subprocess.STDOUT, preexec_fn=limit) as process:  # fmt: skip
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        wall = time.perf_counter() - start
        printed.seek(0)
        text = printed.read()
    cpu_s = usage.ru_utime + usage.ru_stime
    stopped = process.returncode < 0 and most_s is not None and cpu_s > 0.95 * most_s  # the kernel counts by ticks
    if process.returncode != 0 and not stopped:
        raise SystemExit(f"{' '.join(map(str, command))}\n{text[-2000:]}")
    return {"wall_s": wall, "cpu_s": cpu_s, "peak_MiB": usage.ru_maxrss / 1024, "printed": text, **({"stopped": True} if stopped else {})}


def exact_frequencies(theory, count, **more):
    """The lowest of the clamped disc, in Hz: of the "annulus", bending of the Reissner-Mindlin plate and motion in its
    plane, or of the elastic "solid" (benchmarks/elements/exact_annulus.py and exact_solid.py); `more` goes to these."""
    sys.path.insert(0, str(ROOT / "benchmarks/elements"))
    return importlib.import_module(f"exact_{theory}").all_frequencies(0.02, count, **more)


def errors_of(f_Hz, exact):
    """Relative errors of frequencies by their place in the order: {median, largest}."""
    error = sorted(abs(a / b - 1) for a, b in zip(f_Hz, exact))
    return {"median": float(error[len(error) // 2]), "largest": float(error[-1])}


def summary(program, command, scene_file, folder):
    """That of a run that must succeed."""
    file = folder / f"{program.name}_{command}.json"
    words = [str(word) for word in (program, command, scene_file, "--output", folder, "--json", file)]
    done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{program.name} {command}: {done.stderr}")
    return json.loads(file.read_text())


def publish(output, name, result, text):
    """Writes OUTPUT/NAME.json and .md."""
    output.mkdir(parents=True, exist_ok=True)
    (output / f"{name}.json").write_text(json.dumps(result, indent=1))
    (output / f"{name}.md").write_text(text)


def machine():
    """What the figures were measured on."""
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="ascii")
                  if line.startswith("model name")), platform.machine())
    commit = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--short", "HEAD"],
                            capture_output=True, text=True, check=False).stdout.strip()
    return {"processor": model, "cores": os.cpu_count(), "commit": commit}
