"""A plate of quadrilaterals and triangles, clamped at its edge x = 0, as a file of Gmsh and as scenes on any file with the
groups "plate" and "root"."""

from running import summary

N_X, N_Y, STEP, THICKNESS = 6, 4, 50, 5  # mm
STEEL = "[material.steel]\nyoung = 2.1e11\npoisson = 0.3\ndensity = 7850.0\n"


def number(i, j):
    """Of the node in a grid of half the step."""
    return 1 + i + j * (2 * N_X + 1)


def grid(order):
    """Nodes in use as (number, x, y), and elements of 4 or 8 nodes, with two triangles for each of the last column."""
    quads, triangles = [], []
    for j in range(0, 2 * N_Y, 2):
        for i in range(0, 2 * N_X, 2):
            at = [number(i + a, j + b) for a, b in ((0, 0), (2, 0), (2, 2), (0, 2))]
            sides = [number(i + a, j + b) for a, b in ((1, 0), (2, 1), (1, 2), (0, 1))]
            if i < 2 * N_X - 2:
                quads.append(at + (sides if order == 2 else []))
                continue
            middle = number(i + 1, j + 1)
            triangles.append([at[0], at[1], at[2]] + ([sides[0], sides[1], middle] if order == 2 else []))
            triangles.append([at[0], at[2], at[3]] + ([middle, sides[2], sides[3]] if order == 2 else []))
    used = {node for element in quads + triangles for node in element}
    nodes = [(number(i, j), i * STEP / 2, j * STEP / 2) for j in range(2 * N_Y + 1) for i in range(2 * N_X + 1)]
    return [node for node in nodes if node[0] in used], quads, triangles


def gmsh_file(order):
    nodes, quads, triangles = grid(order)
    kinds = ((2, triangles), (3, quads)) if order == 1 else ((9, triangles), (16, quads))
    elements = [(kind, nodes_of) for kind, all_of in kinds for nodes_of in all_of]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '1 2 "root"', '2 1 "plate"',
             "$EndPhysicalNames", "$Nodes", str(len(nodes))]  # fmt: skip
    lines += [f"{n} {x} {y} 0" for n, x, y in nodes]
    edge = [(number(0, j), number(0, j + 2), number(0, j + 1)) for j in range(0, 2 * N_Y, 2)]
    lines += ["$EndNodes", "$Elements", str(len(elements) + len(edge))]
    for k, (a, b, middle) in enumerate(edge, 1):
        lines.append(f"{k} {1 if order == 1 else 8} 2 2 1 {a} {b}" + (f" {middle}" if order == 2 else ""))
    lines += [f"{k} {kind} 2 1 2 {' '.join(map(str, of))}" for k, (kind, of) in enumerate(elements, 100)]
    return "\n".join([*lines, "$EndElements", ""])


def scene(file, group, root):
    return (f'name = "by_hand"\n[mesh]\nfile = "{file}"\nlength_unit = "mm"\n{STEEL}'
            f'[[section]]\ngroup = "{group}"\ntype = "shell"\nmaterial = "steel"\nthickness = {THICKNESS * 1e-3}\n'
            f'[[support]]\ngroup = "{root}"\ntype = "clamped"\n[modes]\ncount = 10\n')  # fmt: skip


def frequencies(chladni, path):
    return summary(chladni, "modes", path, "--output", path.with_suffix(""))["frequencies_Hz"]
