"""What a reduction cannot be faster than on one core, phase by phase, from its sizes and rates measured in the same run.

A bound counts what the method has to do at least: operations at the rate of dgemm, passes over what stands in memory at
the rate of reading it, files at that of writing them. n are the slaves, m the masters, k the fixed-interface modes, p the
pairs with an estimate, l the entries of the factor, V the vectors of block Lanczos, which come b = 8 at a time. Those of a
flat disc are of bending or of motion in the plane: half as long, of half of the factor and of M, and orthogonal to those
of their part alone.
"""
import os
import pathlib
import subprocess
import time

import run

BLOCK = 8
PARTS = 2
RATES = """
import numpy as np, time
a = np.random.rand(2000, 2000)
b = np.zeros(40_000_000)
b.fill(1.0)
def fresh():
    np.empty(40_000_000).fill(2.0)
def best(work):
    times = []
    for _ in range(5):
        start = time.perf_counter(); work(); times.append(time.perf_counter() - start)
    return min(times)
print(2e-9 * 2000**3 / best(lambda: a @ a), 8e-9 * b.size / best(lambda: b @ b), 8e-9 * b.size / best(lambda: b.fill(2.0)),
      8e-9 * b.size / best(fresh))
"""
# phase: how it is bounded, or why it is not
MEANING = {
    "mesh": "none: Gmsh, no known least work",
    "assembly": "K and M written once to memory never touched, 8 bytes an entry; operations of the elements are not counted",
    "partition": "K and M read and their blocks written once, 8 bytes an entry; the order of elimination, searched here too, "
                 "has no bound",
    "factorization": "operations of the factor",
    "fixed-interface modes": "for each block two passes over its part of the factor, one over that of M_ss and its own columns "
                             "read and written by both; n V^2 / 2 operations, or reading all earlier vectors of the part twice "
                             "for each block, to make them orthogonal once",
    "constraint modes": "l m operations of the backward solution; forward, columns with few entries need less",
    "projection": "n m^2 / 4 operations of Psi^T M Psi, half of it known by symmetry, and n m k / 2 of Phi^T M Psi",
    "error estimates": "n (m + k) p / 2 operations of the shapes, 2 l p of the solutions",
    "residuals": "K, M and half of Phi, which is zero in the other, read once",
    "condition": "two passes over the factor; how many solutions the estimate takes is not counted",
    "pictures": "none: a choice of rows, no known least work",
    "write": "bytes of the file",
}


def rates(folder):
    """GFLOP/s of dgemm, GB/s of reading memory, of writing some that has been touched and some that has not, and of
    writing a file, of one core, in a process that has one thread and the kernels that the program takes."""
    environment = dict(run.ENVIRONMENT)
    environment.setdefault("OPENBLAS_CORETYPE", "SkylakeX" if "avx512f" in open(
        "/proc/cpuinfo", encoding="ascii").read() else "Haswell")
    out = subprocess.run(["/usr/bin/python3", "-c", RATES], env=environment, capture_output=True, text=True, check=True).stdout
    names = ("dgemm_GFLOP_per_s", "memory_GB_per_s", "memory_write_GB_per_s", "memory_fresh_GB_per_s")
    return {**dict(zip(names, map(float, out.split()))), "file_GB_per_s": file_rate(folder)}


def file_rate(folder, size=2**27):
    """GB/s of writing a file, best of three; it need not have reached the disk."""
    block, best = bytes(2**20), float("inf")
    for _ in range(3):
        path = pathlib.Path(folder) / "rate"
        start = time.perf_counter()
        with open(path, "wb", buffering=0) as file:
            for _ in range(size // len(block)):
                file.write(block)
        best = min(best, time.perf_counter() - start)
        os.remove(path)
    return 1e-9 * size / best


def phases(entry, rate):
    """Least seconds of each phase of MEANING that has a bound."""
    s = entry["sizes"]
    n, m, k, p = s["slaves"], s["masters"], s["modes"], s["pairs"]
    l, entries = entry["factor_entries"], s["K_entries"] + s["M_entries"]
    operations = lambda count: 1e-9 * count / rate["dgemm_GFLOP_per_s"]
    reading = lambda count: 8e-9 * count / rate["memory_GB_per_s"]
    writing = lambda count: 8e-9 * count / rate["memory_write_GB_per_s"]
    blocks, length = lanczos(entry)[0], n / PARTS
    return {"assembly": 8e-9 * entries / rate["memory_fresh_GB_per_s"], "partition": reading(entries) + writing(entries),
            "factorization": operations(entry["factor_operations"]),
            "fixed-interface modes": blocks * (reading((2 * l + s["M_entries"]) / PARTS + 2 * length * BLOCK) +
                                               writing(2 * length * BLOCK)) + orthogonal(entry, rate),
            "constraint modes": operations(2 * l * m / PARTS),
            "projection": operations((n * m**2 + 2 * n * m * k) / PARTS**2),
            "error estimates": operations(2 * n * (m + k) * p / PARTS**2 + 4 * l * p / PARTS),
            "residuals": reading(entries + n * k / PARTS),
            "condition": reading(2 * l), "write": 1e-9 * s["file_bytes"] / rate["file_GB_per_s"]}


def lanczos(entry):
    """Blocks and vectors of the eigen-solve: each block is made orthogonal once."""
    blocks = entry["events"]["CMSOrthogonal"]["count"]
    return blocks, BLOCK * blocks


def orthogonal(entry, rate):
    """Least seconds to make the vectors of the parts orthogonal: where each part has as many of them."""
    products = entry["sizes"]["slaves"] * (lanczos(entry)[1] / PARTS)**2
    return max(2e-9 * products / rate["dgemm_GFLOP_per_s"], 8e-9 * products / BLOCK / rate["memory_GB_per_s"])


def events(entry, rate):
    """Least seconds of what -log_view tells apart below the phases."""
    n, (blocks, vectors) = entry["sizes"]["slaves"], lanczos(entry)
    one_solve = 16e-9 * entry["factor_entries"] / PARTS / rate["memory_GB_per_s"]
    length = n / PARTS
    return {"CMSFactor": 1e-9 * entry["factor_operations"] / rate["dgemm_GFLOP_per_s"],
            "CMSSolve": one_solve * entry["events"]["CMSSolve"]["count"],
            "CMSSpMM": 8e-9 * (entry["sizes"]["M_entries"] / PARTS * entry["events"]["CMSSpMM"]["count"] + length * vectors) /
                       rate["memory_GB_per_s"] + 8e-9 * length * vectors / rate["memory_write_GB_per_s"],
            "CMSOrthogonal": orthogonal(entry, rate)}


EVENTS = {"CMSFactor": "operations of the factor, dgemm", "CMSSolve": "two passes over a part of the factor for each block, reading memory",
          "CMSSpMM": "one pass over a part of M for each product with M or K, the vectors of the eigen-solve read and written once",
          "CMSOrthogonal": "every vector against all earlier ones of its part once: dgemm, or reading them twice for each block"}


def memory_MiB(entry):
    """What has to stand in memory at once: K and M with 12 bytes an entry, the factor, and the vectors of Lanczos, or Psi
    and Phi where they are not zero."""
    s = entry["sizes"]
    columns = max(lanczos(entry)[1], s["masters"] + s["modes"]) / PARTS
    return (12 * (s["K_entries"] + s["M_entries"]) + 8 * entry["factor_entries"] + 8 * s["slaves"] * columns) / 2**20
