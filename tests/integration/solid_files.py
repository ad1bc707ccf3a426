"""One curved block of solids, held at one face, as a file of Gmsh and of every other format, element type by element type.

Usage: from solid_files import Block
"""

import itertools
import math
from dataclasses import dataclass

N = (3, 2, 2)  # elements along the three axes of the grid
STEEL = {"young": 210e3, "poisson": 0.3, "density": 7.85e-9}  # MPa, t/mm^3

# The edges of each shape by its corners, in the order of the manuals of the programs.
BOTTOM_TOP_UPRIGHT = {
    "tet": ["01", "12", "20", "03", "13", "23"],
    "wedge": ["01", "12", "20", "34", "45", "53", "03", "14", "25"],
    "hex": ["01", "12", "23", "30", "45", "56", "67", "74", "04", "15", "26", "37"],
}
NASTRAN = {
    "tet": ["01", "12", "20", "03", "13", "23"],
    "wedge": ["01", "12", "20", "03", "14", "25", "34", "45", "53"],
    "hex": ["01", "12", "23", "30", "04", "15", "26", "37", "45", "56", "67", "74"],
}
GMSH = {
    "tet": ["01", "12", "02", "03", "23", "13"],
    "wedge": ["01", "02", "03", "12", "14", "25", "34", "35", "45"],
    "hex": ["01", "03", "04", "12", "15", "23", "26", "37", "45", "47", "56", "67"],
}
# Universal files go around: corners and edges in one list.
UNIVERSAL = {
    "tet": ["0", "01", "1", "12", "2", "20", "03", "13", "23", "3"],
    "wedge": ["0", "01", "1", "12", "2", "20", "03", "14", "25", "3", "34", "4", "45", "5", "53"],
    "hex": ["0", "01", "1", "12", "2", "23", "3", "30", "04", "15", "26", "37",
            "4", "45", "5", "56", "6", "67", "7", "74"],
}  # fmt: skip
# The corners of the faces S1, S2, ... of Abaqus.
ABAQUS_FACES = {
    "tet": ["012", "031", "132", "230"],
    "wedge": ["012", "354", "0341", "1452", "2530"],
    "hex": ["0123", "4765", "0451", "1562", "2673", "3740"],
}
# Corners of the pieces of a cell of the grid, whose corners are numbered as those of a hexahedron.
PIECES = {
    "hex": [(0, 1, 2, 3, 4, 5, 6, 7)],
    "wedge": [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)],
    "tet": [(0, 1, 2, 6), (0, 5, 1, 6), (0, 4, 5, 6), (0, 7, 4, 6), (0, 3, 7, 6), (0, 2, 3, 6)],
}
CELL = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]


def position(i, j, k):
    """mm, of a place in the grid of half the step: a twisted sector of a ring. Few digits, which fit into eight columns."""
    phi = 0.04 * k - 0.9 * i / (2 * N[0])
    r = 30 + 20 * (j / (2 * N[1])) ** 1.2 + 0.3 * k
    z = 12 * k / (2 * N[2]) + 1.1 * math.sin(2 * phi)
    return round(r * math.cos(phi), 4), round(r * math.sin(phi), 4), round(z, 4)


@dataclass
class Block:
    """Elements of one shape ("tet", "wedge" or "hex") and order."""

    shape: str
    order: int
    straight: bool = False  # nodes in the middle of edges stand halfway between the corners

    def __post_init__(self):
        self.elements = []  # by their corners, as places in the grid
        for origin in itertools.product(*(range(0, 2 * n, 2) for n in N)):
            cell = [tuple(a + b for a, b in zip(origin, corner)) for corner in CELL]
            self.elements += [[cell[c] for c in piece] for piece in PIECES[self.shape]]
        places = {place for element in self.elements for place in element}
        if self.order == 2:
            places |= {self.middle(element, edge) for element in self.elements for edge in BOTTOM_TOP_UPRIGHT[self.shape]}
        self.number = {place: k for k, place in enumerate(sorted(places), 1)}

    @staticmethod
    def middle(element, edge):
        a, b = (element[int(c)] for c in edge)
        return tuple((x + y) // 2 for x, y in zip(a, b))

    def nodes(self):
        """(number, x, y, z)."""
        return [(number, *self.position(place)) for place, number in self.number.items()]

    def position(self, place):
        """Odd numbers in a place are halfway between corners."""
        if not self.straight or all(i % 2 == 0 for i in place):
            return position(*place)
        ends = [position(*(i + step * (i % 2) for i in place)) for step in (-1, 1)]  # all diagonals ascend
        return tuple((a + b) / 2 for a, b in zip(*ends))

    def node(self, element, part):
        """Of a corner "0" or an edge "01"."""
        return self.number[element[int(part)] if len(part) == 1 else self.middle(element, part)]

    def listed(self, order):
        """The nodes of each element: corners, then the edges of a table, or in an order of both."""
        corners = [str(c) for c in range(len(self.elements[0]))]
        table = order[self.shape]
        if any(len(part) == 1 for part in table):
            parts = table if self.order == 2 else corners
        else:
            parts = corners + (table if self.order == 2 else [])
        return [[self.node(element, part) for part in parts] for element in self.elements]

    def held(self):
        """The nodes of the face i = 0."""
        return [number for (i, _, _), number in self.number.items() if i == 0]

    def faces(self, axis, value):
        """(element, number of the face, corners of the face) where a place in the grid has a value."""
        return [(e, f, face) for e, element in enumerate(self.elements) for f, face in enumerate(ABAQUS_FACES[self.shape])
                if all(element[int(c)][axis] == value for c in face)]  # fmt: skip

    def root(self):
        return self.faces(0, 0)

    def top(self):
        return self.faces(2, 2 * N[2])


def gmsh_file(block):
    kind = {("tet", 1): 4, ("tet", 2): 11, ("hex", 1): 5, ("hex", 2): 17, ("wedge", 1): 6, ("wedge", 2): 18}
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '2 3 "root"', '2 2 "top"', '3 1 "body"',
             "$EndPhysicalNames", "$Nodes", str(len(block.number))]  # fmt: skip
    lines += [f"{n} {x} {y} {z}" for n, x, y, z in block.nodes()]
    elements = [f"{kind[block.shape, block.order]} 2 1 1 {' '.join(map(str, nodes))}" for nodes in block.listed(GMSH)]
    for group, faces in ((2, block.top()), (3, block.root())):
        for e, _, face in faces:
            element = block.elements[e]
            nodes = [block.node(element, c) for c in face]
            if block.order == 2:
                nodes += [block.node(element, a + b) for a, b in zip(face, face[1:] + face[0])]
            surface = {3: 2, 4: 3, 6: 9, 8: 16}[len(nodes)]
            elements.append(f"{surface} 2 {group} {group} {' '.join(map(str, nodes))}")
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    return "\n".join([*lines, *(f"{k} {line}" for k, line in enumerate(elements, 1)), "$EndElements", ""])


def abaqus_file(block, kind):
    """For CalculiX too."""
    lines = ["*Heading", "a block", "*Node, nset=All"] + [f"{n}, {x}, {y}, {z}" for n, x, y, z in block.nodes()]
    lines.append(f"*Element, type={kind}, elset=Body")
    for e, nodes in enumerate(block.listed(BOTTOM_TOP_UPRIGHT), 1):
        words = [str(n) for n in (e, *nodes)]
        rows = [words[at : at + 11] for at in range(0, len(words), 11)]
        lines += [", ".join(row) + ("," if k + 1 < len(rows) else "") for k, row in enumerate(rows)]
    lines += ["*Nset, nset=Root"] + [f"{n}," for n in block.held()]
    lines += ["*Surface, name=Top, type=element"] + [f"{e + 1}, S{f + 1}" for e, f, _ in block.top()]
    lines += ["*Material, name=Steel", "*Elastic", f"{STEEL['young']}, {STEEL['poisson']}", "*Density",
              f"{STEEL['density']},", "*Solid Section, elset=Body, material=Steel", "*Boundary", "Root, 1, 3", ""]  # fmt: skip
    return "\n".join(lines)


def card(name, fields, width):
    """In free (0), small (8) or large fields (16)."""
    if width == 0:
        rows = [fields[at : at + 8] for at in range(0, len(fields), 8)]
        return "\n".join(",".join([name if k == 0 else "", *(str(f) for f in row)]) for k, row in enumerate(rows))
    if width == 8:
        rows = [fields[at : at + 8] for at in range(0, len(fields), 8)]
        return "\n".join(f"{name if k == 0 else '':8}" + "".join(f"{f!s:8}" for f in row) for k, row in enumerate(rows))
    rows = [fields[at : at + 4] for at in range(0, len(fields), 4)]
    return "\n".join(f"{name + '*' if k == 0 else '*':8}" + "".join(f"{f!s:16}" for f in row) for k, row in enumerate(rows))


def nastran_file(block, width):
    kind = {"tet": "CTETRA", "wedge": "CPENTA", "hex": "CHEXA"}[block.shape]
    lines = ["SOL 103", "CEND", "BEGIN BULK"] + [card("GRID", (n, "", x, y, z), width) for n, x, y, z in block.nodes()]
    lines += [card(kind, (e, 7, *nodes), width) for e, nodes in enumerate(block.listed(NASTRAN), 1)]
    lines += ["PSOLID,7,1", "MAT1,1,2.1+5,,.3,7.85-9", card("SPC1", (1, 123, *block.held()), width), "ENDDATA", ""]
    return "\n".join(lines)


def tens(numbers):
    rows = [numbers[at : at + 8] for at in range(0, len(numbers), 8)]
    return ["".join(f"{n:10}" for n in row) for row in rows]


def universal_file(block):
    lines = ["    -1", "  2411"]
    for n, x, y, z in block.nodes():
        lines += [f"{n:10}         1         1        11", f"  {x:.16E}  {y:.16E}  {z:.16E}".replace("E", "D")]
    descriptor = {("tet", 1): 111, ("tet", 2): 118, ("hex", 1): 115, ("hex", 2): 116, ("wedge", 1): 112, ("wedge", 2): 113}
    lines += ["    -1", "    -1", "  2412"]
    listed = block.listed(UNIVERSAL)
    for e, nodes in enumerate(listed, 1):
        lines += tens([e, descriptor[block.shape, block.order], 1, 1, 7, len(nodes)]) + tens(nodes)
    lines += ["    -1", "    -1", "  2467"]
    for k, (group, kind, labels) in enumerate((("body", 8, range(1, len(listed) + 1)), ("root", 7, block.held())), 1):
        lines += tens([k, 0, 0, 0, 0, 0, 0, len(labels)]) + [group]
        lines += tens([value for label in labels for value in (kind, label, 0, 0)])
    return "\n".join([*lines, "    -1", ""])


def med_file(block, path):
    """The corners of a MED file go round the other way."""
    import h5py
    import numpy as np

    turned = {"tet": [0, 2, 1, 3], "wedge": [0, 2, 1, 3, 5, 4], "hex": [0, 3, 2, 1, 4, 7, 6, 5]}[block.shape]
    others = Block(block.shape, block.order)
    others.elements = [[element[c] for c in turned] for element in block.elements]
    name = {("tet", 1): "TE4", ("tet", 2): "T10", ("hex", 1): "HE8", ("hex", 2): "H20", ("wedge", 1): "PE6", ("wedge", 2): "P15"}
    held = set(block.held())
    with h5py.File(path, "w") as file:
        file.create_group("INFOS_GENERALES").attrs.update({"MAJ": 4, "MIN": 1, "REL": 0})
        mesh = file.create_group("ENS_MAA/Mesh_1")
        mesh.attrs.update({"DIM": 3, "ESP": 3, "REP": 0, "TYP": 0})
        step = mesh.create_group("-0000000000000000001-0000000000000000001")
        step.create_dataset("NOE/COO", data=np.array([x for _, *x in block.nodes()]).flatten(order="F"))
        step.create_dataset("NOE/FAM", data=np.array([2 * (n in held) for n, *_ in block.nodes()], dtype=np.int32))
        of_type = step.create_group(f"MAI/{name[block.shape, block.order]}")
        nodes = np.array(others.listed(BOTTOM_TOP_UPRIGHT), dtype=np.int32)
        of_type.create_dataset("NOD", data=nodes.flatten(order="F"))
        of_type.create_dataset("FAM", data=np.full(len(nodes), -1, dtype=np.int32))
        file.create_group("FAS/Mesh_1/FAMILLE_ZERO").attrs["NUM"] = 0
        for place, number, group in (("ELEME", -1, "body"), ("NOEUD", 2, "root")):
            family = file.create_group(f"FAS/Mesh_1/{place}/FAM_{number}_{group}")
            family.attrs["NUM"] = number
            text = np.frombuffer(group.encode().ljust(80, b"\0"), dtype=np.int8)
            family.create_dataset("GRO/NOM", shape=(1,), dtype=np.dtype((np.int8, (80,))))[0] = text


# How a hexahedron of Ansys stands for the other shapes: corners that are one, and edges between them.
COLLAPSED = {
    "hex": "01234567",
    "wedge": "01223455",
    "tet": "01223333",
}


def ansys_file(block):
    """SOLID185 and 186, of which wedges and tetrahedra are collapsed forms; SOLID187 for tetrahedra of order 2."""
    kind = 185 if block.order == 1 else 186
    lines = ["/PREP7", f"ET,1,{kind}", "NBLOCK,6,SOLID,  999,  999", "(3i9,6e21.13e3)"]
    lines += [f"{n:9}{0:9}{0:9}" + "".join(f"{c:21.13E}" for c in x) for n, *x in block.nodes()]
    lines += ["N,UNBL,LOC,       -1,", "EBLOCK,19,SOLID,  999,  999", "(19i9)"]
    corners = [int(c) for c in COLLAPSED[block.shape]]
    for e, element in enumerate(block.elements, 1):
        nodes = [block.node(element, str(c)) for c in corners]
        if block.order == 2:
            for a, b in BOTTOM_TOP_UPRIGHT["hex"]:
                one, other = corners[int(a)], corners[int(b)]
                nodes.append(block.node(element, str(one) if one == other else f"{one}{other}"))
        words = [1, 1, 1, 1, 0, 0, 0, 0, len(nodes), 0, e, *nodes]
        lines += ["".join(f"{w:9}" for w in words[:19]), "".join(f"{w:9}" for w in words[19:])][: 1 + (len(words) > 19)]
    held = block.held()
    lines += ["       -1", f"CMBLOCK,ROOT,NODE,{len(held):8}", "(8i10)", *tens(held)]
    lines += [f"MP,EX,1,{STEEL['young']},", f"MP,PRXY,1,{STEEL['poisson']},", f"MP,DENS,1,{STEEL['density']},"]
    lines += [f"D,{n:9},{c},  0.00000000    ,  0.00000000" for n in held for c in ("UX", "UY", "UZ")]
    return "\n".join([*lines, "FINISH", ""])
