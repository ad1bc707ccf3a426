"""A reduced system that goes to Nastran's files and back is the same, whoever wrote them and in whatever unit.

Usage: superelements.py PROGRAM_DIR
"""

import struct
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
from running import changed, run, start, summary, told

SCENE = """name = "pad"

[mesh]
generator = "pad"
inner_radius = 0.1
outer_radius = 0.15
angle_deg = 40.0
element_size = 0.02
element_order = 2

[material.steel]
young = 210e9
poisson = 0.3
density = 7850.0

[[section]]
group = "pad"
type = "shell"
material = "steel"
thickness = 0.006

[[coupling]]
name = "pin"
group = "first_edge"
type = "rigid"

[interface]
nodes = ["last_edge", "pin"]

[reduce]
method = "craig-bampton"
modes = 5

[body]
fixed = ["pin"]
keep = { modes = 10 }
"""


def read(file):
    with h5py.File(file) as f:
        system = {name: f[f"matrices/{name}"][...] for name in ("stiffness", "mass")}
        system["node"], system["component"] = f["masters/node"][...], f["masters/component"][...]
        system["number"], system["x"] = f["attachment/node_numbers"][...], f["attachment/node_positions"][...]
        system["omega"] = f["fixed_interface_frequencies"][...]
        sets = {name: f[f"attachment/sets/{name}"][...] for name in f["attachment/sets"]}
        system["sets"] = {name: sorted(system["number"][nodes]) for name, nodes in sets.items()}
        return system


def by_grid(system):
    """Rows by grid and component, then the modes; the matrices so, and the labels."""
    n_m = len(system["node"])
    labels = sorted((system["number"][system["node"][i]], system["component"][i], i) for i in range(n_m))
    order = [i for _, _, i in labels] + list(range(n_m, len(system["stiffness"])))
    return [(g, c) for g, c, _ in labels], system["stiffness"][np.ix_(order, order)], system["mass"][np.ix_(order, order)]


def apart(A, B):
    """Relative to the roots of the diagonals."""
    scale = np.sqrt(np.abs(np.outer(B.diagonal(), B.diagonal())))
    return np.max(np.abs(A - B) / scale)


def same(name, found, expected, most):
    labels, K, M = by_grid(expected)
    labels_found, K_found, M_found = by_grid(found)
    if labels != labels_found:
        yield f"{name}: other rows, {labels_found[:5]}"
        return
    signs = np.ones(len(K))
    for i in range(len(labels), len(K)):  # modes are known but for their signs
        signs[i] = 1.0 if M_found[: len(labels), i] @ M[: len(labels), i] > 0.0 else -1.0
    K_found, M_found = K_found * np.outer(signs, signs), M_found * np.outer(signs, signs)
    worst = max(apart(K_found, K), apart(M_found, M), np.max(np.abs(found["omega"] / expected["omega"] - 1.0)))
    print(f"{name}: {worst:.1e}")
    if worst > most:
        yield f"{name}: matrices differ by {worst:.1e}, more than {most}"


def body_frequencies(programs, scene, folder):
    return np.array(summary(programs / "chladni", "body", scene, "--output", folder)["frequencies_Hz"])


def in_millimetres(system):
    """K, M in N/mm and t, with amplitudes of modes in units of mm t^(1/2)."""
    labels, K, M = by_grid(system)
    scale = np.array([1e-3 if c < 3 else 1.0 for _, c in labels] + [np.sqrt(1e-3)] * (len(K) - len(labels)))
    return labels, 1e3 * K * np.outer(scale, scale), 1e3 * M * np.outer(scale, scale)


def grids(system, factor):
    lines = [f"GRID,{n},," + ",".join(f"{factor * c:.10f}" for c in x) for n, x in zip(system["number"], system["x"])]
    return "\n".join(lines) + "\n"


def dmig_by_hand(system):
    """Upper triangles in large fields, as a square matrix of both triangles for M; modes as QSET."""
    labels, K, M = in_millimetres(system)
    first = int(max(system["number"])) + 1
    ids = [(n, c + 1) for n, c in labels] + [(first + i, 0) for i in range(len(K) - len(labels))]
    text = "BEGIN SUPER = 7\n" + grids(system, 1000.0) + f"SPOINT,{first},THRU,{ids[-1][0]}\nQSET1,0,{first},THRU,{ids[-1][0]}\n"
    for name, A, form in (("KAAX", K, 6), ("MAAX", M, 1)):
        text += f"DMIG,{name},0,{form},2,0,,,{len(K)}\n"
        for j, (g, c) in enumerate(ids):
            text += f"DMIG*   {name:16}{g:16}{c:16}\n"
            for i in range(len(ids)) if form == 1 else range(j + 1):
                text += f"*       {ids[i][0]:16}{ids[i][1]:16}{A[i, j]:16.9E}\n".replace("E-", "D-").replace("E+", "D+")
    return text + "ENDDATA\n"


def with_mixed_modes(A, n_masters):
    """Other coordinates for the same modes, which are neither orthogonal nor of unit mass."""
    T = np.eye(len(A))
    n = len(A) - n_masters
    T[n_masters:, n_masters:] = 2.0 * np.eye(n) + np.tril(np.ones((n, n)), -1) / 4.0
    return T.T @ A @ T


LAYOUTS = ("binary", "binary_big_endian", "binary_sparse", "binary_sparse_big_endian", "binary_bigmat", "text_sparse", "text_bigmat")


def op4_bytes(matrices, layout):
    """KAA, MAA as other programs write them: each column one string of values, or two that follow what tells their rows."""
    order, is_big = ">" if "big_endian" in layout else "<", "bigmat" in layout

    def record(*parts):
        body = b"".join(parts)
        return struct.pack(order + "i", len(body)) + body + struct.pack(order + "i", len(body))

    data = b""
    for name, A in matrices:
        n = len(A)
        half = n // 2  # two strings, none of which is empty
        strings = [(row, length) for row, length in ((0, half), (half, n - half)) if length > 0]
        words = sum(2 * length + (2 if is_big else 1) for _, length in strings)
        heads = [(2 * length + 1, row + 1) if is_big else (row + 1 + 65536 * (2 * length + 1),) for row, length in strings]
        if "binary" in layout:
            data += record(struct.pack(order + "4i", n, -n if is_big else n, 6, 2), f"{name:8}".encode())
            for j in range(n):
                if layout.startswith(("binary_sparse", "binary_bigmat")):
                    parts = [struct.pack(f"{order}{len(head)}i{length}d", *head, *A[row : row + length, j])
                             for head, (row, length) in zip(heads, strings)]  # fmt: skip
                    data += record(struct.pack(order + "3i", j + 1, 0, words), *parts)
                else:
                    data += record(struct.pack(order + "3i", j + 1, 1, 2 * n), struct.pack(f"{order}{n}d", *A[:, j]))
            data += record(struct.pack(order + "3i", n + 1, 1, 2), struct.pack(order + "d", 2.0**0.5))
            continue
        text = f"{n:8}{-n if is_big else n:8}{6:8}{2:8}{name:8}1P,3E23.16\n"
        for j in range(n):
            text += f"{j + 1:8}{0:8}{words:8}\n"
            for head, (row, length) in zip(heads, strings):
                text += "".join(f"{word:8}" for word in head) + "\n"
                values = [f"{v:23.16E}" for v in A[row : row + length, j]]
                text += "".join("".join(values[k : k + 3]) + "\n" for k in range(0, length, 3))
        data += (text + f"{n + 1:8}{1:8}{1:8}\n{2.0**0.5:23.16E}\n").encode()
    return data


def round_trip(programs, folder, expected):
    frequencies = body_frequencies(programs, folder / "pad.toml", folder)
    for kind, extension, most in (("nastran-dmig", ".dmig", 1e-9), ("nastran-op4", ".op4", 1e-14)):
        back = folder / kind
        back.mkdir()
        run(programs / "chladni", "export", folder / "pad.reduced.h5", "--format", kind, "--output", folder / f"pad{extension}")
        run(programs / "chladni", "import", folder / f"pad{extension}", "--length-unit", "m", "--output", back / "pad.toml")
        found = read(back / "pad.reduced.h5")
        yield from same(kind, found, expected, most)
        for name, nodes in expected["sets"].items():
            if found["sets"].get(name) != nodes:
                yield f"{kind}: the set {name} is {found['sets'].get(name)} instead of {nodes}"
        scene = back / "pad.toml"
        scene.write_text(changed(scene.read_text(), ("fixed = []", 'fixed = ["pin"]\nkeep = { modes = 10 }')))
        again = body_frequencies(programs, scene, back)
        if len(again) != len(frequencies) or np.max(np.abs(again / frequencies - 1.0)) > 1e-8:
            yield f"{kind}: body of {again} Hz instead of {frequencies}"
        run(programs / "chladni", "check", back / "pad.body.h5")


def others_writers(programs, folder, expected):
    (folder / "hand.pch").write_text(dmig_by_hand(expected))
    out = folder / "hand"
    out.mkdir()
    said = run(programs / "chladni", "import", folder / "hand.pch", "--length-unit", "mm", "--output", out / "hand.toml")
    yield from same("DMIG in mm", read(out / "hand.reduced.h5"), expected, 1e-9)
    if "the mass is 0.2" not in said:
        yield f"the mass is not told: {said}"
    labels, K, M = in_millimetres(expected)
    first = int(max(expected["number"])) + 1
    n_modes = len(K) - len(labels)
    pairs = "".join(f"ASET,{n},{c + 1}\n" for n, c in labels)
    modal = f"QSET1,0,{first},THRU,{first + n_modes - 1}\nSPOINT,{first},THRU,{first + n_modes - 1}\n"
    K, M = (with_mixed_modes(A, len(labels)) for A in (K, M))
    for layout in LAYOUTS:
        (folder / f"{layout}.op4").write_bytes(op4_bytes((("KAA", K), ("MAA", M), ("PA", np.zeros((1, 1)))), layout))
        (folder / f"{layout}.pch").write_text(grids(expected, 1000.0) + pairs + modal)
        run(programs / "chladni", "import", folder / f"{layout}.op4", "--length-unit", "mm", "--output", out / f"{layout}.toml")
        yield from same(f"OP4, {layout}", read(out / f"{layout}.reduced.h5"), expected, 1e-9)


def bad_superelements(programs, folder, expected):
    good = dmig_by_hand(expected)
    lines = good.splitlines()

    def expect(name, text, *words, file="bad.pch", op4=None):
        (folder / "bad.pch").write_text(text)
        if op4 is not None:
            (folder / "bad.op4").write_bytes(op4)
        done = start(programs / "chladni", "import", folder / file, "--length-unit", "mm", "--output", folder / "none.toml")
        said = done.stderr
        if done.returncode != 1 or said.count("\n") != 1 or any(word not in said for word in words):
            yield f"{name}: exit code {done.returncode}, said {said!r} instead of {words}"
        if (folder / "none.toml").exists() or (folder / "bad.reduced.h5").exists():
            yield f"{name}: something was written"

    grid = int(expected["number"][expected["node"][0]])
    yield from expect("no mass", good.replace("MAAX", "XAAX"), "has no mass", "MAAX")
    yield from expect("two of a kind", good.replace("ENDDATA", f"DMIG,KGG,0,6,2,0,,,{len(lines)}"), "KAAX and KGG")
    yield from expect("no GRID", "\n".join(line for line in lines if not line.startswith(f"GRID,{grid},")), f"no GRID {grid}")
    yield from expect("complex", good.replace("DMIG,KAAX,0,6,2", "DMIG,KAAX,0,6,4"), "DMIG KAAX", "complex")
    own = next(line for line in lines if line.startswith(f"GRID,{grid},"))
    yield from expect("axes of its own", good.replace(own, f"CORD2R,3,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n{own},3"), f"GRID {grid}", "CD")
    turned = good.splitlines()
    second = next(i for i, line in enumerate(turned) if line.startswith("DMIG*   MAAX")) + 2  # row of the first column
    turned[second] = turned[second][:40] + f"{1e3:16.9E}"
    yield from expect("unsymmetric", "\n".join(turned), "DMIG MAAX", "other side of the diagonal")
    labels, K, M = in_millimetres(expected)
    op4 = op4_bytes((("KAA", K), ("MAA", M)), "text_sparse")
    pch = grids(expected, 1000.0) + "".join(f"ASET,{n},{c + 1}\n" for n, c in labels)
    K_m, M_m = K[: len(labels), : len(labels)], M[: len(labels), : len(labels)]  # without modes
    row = f"grid {labels[3][0]}, component {labels[3][1] + 1}"
    for name, change, words in (("skew", lambda A: np.add(A, A[3, 3] * (np.indices(A.shape) == [[[3]], [[2]]]).all(0)), (row, "other side")),
                                ("penalty", lambda A: np.where((np.indices(A.shape) == 3).all(0), 1e36, A), (row, "1e+36", "supports")),
                                ("soft", lambda A: np.where((np.indices(A.shape) == 3).all(0), 0.2 * A, A), ("grid", "negative energy")),
                                ("negative", lambda A: np.where((np.indices(A.shape) == 3).all(0), -A, A), (row, "negative"))):  # fmt: skip
        for which, pair in (("KAA", (change(K_m), M_m)), ("MAA", (K_m, change(M_m)))):
            bad = op4_bytes((("KAA", pair[0]), ("MAA", pair[1])), "binary_sparse")
            yield from expect(f"{name} {which}", pch, "bad.op4" if name != "soft" else which, which, *words, file="bad.op4", op4=bad)
    wide = struct.pack("<i", 48) + struct.pack("<4q", 3, 3, 6, 2) + b"KAA".ljust(16) + struct.pack("<i", 48)
    yield from expect("64 bits", pch, "bad.op4", "64 bits", file="bad.op4", op4=wide)
    yield from expect("other rows", grids(expected, 1000.0) + "ASET,1,1\n", "KAA is", "1 components", file="bad.op4", op4=op4)
    yield from expect("cut off", good, "bad.op4", "ends within a matrix", file="bad.op4", op4=op4[: op4.rindex(b"\n", 0, len(op4) // 3) + 1])
    (folder / "alone.op4").write_bytes(op4)
    done = start(programs / "chladni", "import", folder / "alone.op4", "--length-unit", "mm", "--output", folder / "none.toml")
    if done.returncode != 1 or "no .pch beside it" not in done.stderr:
        yield f"an .op4 alone: {done.stderr}"
    done = start(programs / "chladni", "modes", folder / "nastran-dmig" / "pad.toml", "--output", folder / "none")
    if done.returncode != 1 or "mesh" not in done.stderr or "chladni body" not in done.stderr:
        yield f"a scene without a mesh: {done.stderr}"


def main():
    programs = Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "pad.toml").write_text(SCENE)
        run(programs / "chladni", "reduce", folder / "pad.toml", "--output", folder)
        expected = read(folder / "pad.reduced.h5")
        problems = [
            *round_trip(programs, folder, expected),
            *others_writers(programs, folder, expected),
            *bad_superelements(programs, folder, expected),
        ]
    return told(problems)


if __name__ == "__main__":
    sys.exit(main())
