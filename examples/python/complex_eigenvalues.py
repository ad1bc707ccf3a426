"""Which modes of a brake are unstable whose friction is in its matrices? Complex eigenvalues of files of matrices.

Usage: [mpirun -n 2] complex_eigenvalues.py --mass M.mtx --damping D.mtx --stiffness K.mtx --up-to-Hz 8000 [--output lambda.csv]

A file is of Matrix Market, or has lines `row column value`, or lines `node, DOF, node, DOF, value` of Abaqus (*MATRIX OUTPUT).
"""

import argparse
import sys
from pathlib import Path

import numpy as np
import scipy.sparse
from petsc4py import PETSc

import chladni

DOFS = 64  # more than a node has, whose temperatures and amplitudes Abaqus numbers up to 30


def read_matrices(files) -> list:
    """Matrices of one system, as of scipy: coordinate files of Matrix Market, lines `row column value`, or lines
    `node, DOF, node, DOF, value` of Abaqus, whose rows are those of the first file in ascending order. Lines of one
    triangle alone are of a symmetric matrix.

    Raises:
        chladni.Error: with file and line
    """
    labels, found, n = None, [], 0
    for file in files:
        entries, is_symmetric, n_rows = entries_of(Path(file))
        if entries.shape[1] == 5:
            rows, columns = (DOFS * entries[:, k].astype(np.int64) + entries[:, k + 1].astype(np.int64) for k in (0, 2))
            labels = np.unique(np.concatenate([rows, columns])) if labels is None else labels
            unknown = np.setdiff1d(np.concatenate([rows, columns]), labels)
            if len(unknown):
                raise chladni.Error(f"{file}: node {unknown[0] // DOFS}, DOF {unknown[0] % DOFS} is not in {files[0]}")
            rows, columns, n_rows = np.searchsorted(labels, rows), np.searchsorted(labels, columns), len(labels)
        else:
            rows, columns = entries[:, 0].astype(np.int64) - 1, entries[:, 1].astype(np.int64) - 1
        n = max(n, n_rows, int(max(rows.max(initial=-1), columns.max(initial=-1))) + 1)
        is_symmetric = is_symmetric if is_symmetric is not None else bool((rows <= columns).all() or (rows >= columns).all())
        code = np.sort(rows * n + columns)
        if np.any(code[1:] == code[:-1]):
            twice = int(code[1:][code[1:] == code[:-1]][0])
            raise chladni.Error(f"{file}: row {twice // n + 1}, column {twice % n + 1} is there twice")
        found.append((rows, columns, entries[:, -1], is_symmetric))
    matrices = []
    for rows, columns, values, is_symmetric in found:
        A = scipy.sparse.coo_matrix((values, (rows, columns)), shape=(n, n)).tocsr()
        matrices.append(A + scipy.sparse.triu(A.T, 1) + scipy.sparse.tril(A.T, -1) if is_symmetric else A)
    return matrices


def entries_of(file):
    """The numbers of each line, whether the file says that they are of a symmetric matrix, and its number of rows, or 0."""
    try:
        lines = file.read_text().splitlines()
    except (OSError, UnicodeDecodeError) as reason:
        raise chladni.Error(f"{file}: cannot be read: {getattr(reason, 'strerror', None) or 'it is no text'}") from None
    is_symmetric, n, size_line = None, 0, None
    head = lines[0].lower().split() if lines else []
    if head[:1] == ["%%matrixmarket"]:
        if head[1:4] != ["matrix", "coordinate", "real"] or head[4:] not in (["general"], ["symmetric"]):
            raise chladni.Error(f"{file}, line 1: give a real coordinate matrix, general or symmetric")
        is_symmetric = head[4] == "symmetric"
        size_line = next((i for i, line in enumerate(lines) if line.strip() and not line.startswith("%")), None)
    kept = [(i, line.replace(",", " ").lower().replace("d", "e").split()) for i, line in enumerate(lines)
            if line.strip() and line.lstrip()[0] not in "%*#" and i != size_line]  # fmt: skip
    width = 3 if size_line is not None or not kept else len(kept[0][1])
    if (not kept and size_line is None) or width not in (3, 5):
        raise chladni.Error(f"{file}: has no lines `row column value` or `node, DOF, node, DOF, value`")
    table = np.empty((len(kept), width))
    for at, (i, fields) in enumerate(kept):
        try:
            if len(fields) != width:  # a row of numpy takes one number for all
                raise ValueError
            table[at] = fields
            if any(value != int(value) or value < 1 for value in table[at, :-1]) or (width == 5 and table[at, 1:4:2].max() >= DOFS):
                raise ValueError
        except (ValueError, OverflowError):
            raise chladni.Error(f"{file}, line {i + 1}: '{lines[i].strip()[:60]}' is not {width - 1} numbers from 1 and a value") from None
    if size_line is not None:
        sizes = lines[size_line].split()
        if len(sizes) != 3 or sizes[0] != sizes[1] or sizes[2] != str(len(kept)):
            raise chladni.Error(f"{file}, line {size_line + 1}: says '{lines[size_line].strip()[:40]}', and {len(kept)} entries follow; the matrix must be square and complete")
        n = int(sizes[0])
        if table[:, :2].max(initial=0) > n:
            raise chladni.Error(f"{file}: row or column {int(table[:, :2].max())} of a matrix of {n} rows")
    return table, is_symmetric, n


def main(arguments=None) -> int:
    parser = argparse.ArgumentParser(description="Complex eigenvalues of M x'' + D x' + K x = 0.")
    parser.add_argument("--mass", required=True, help="symmetric matrix")
    parser.add_argument("--damping", help="any matrix of velocities: damping, gyroscopic terms, friction")
    parser.add_argument("--stiffness", required=True, help="any matrix, with friction in it")
    parser.add_argument("--up-to-Hz", type=float, required=True)
    parser.add_argument("--tolerance", type=float, default=1e-8, help="of errors relative to |lambda|")
    parser.add_argument("--output", type=Path, help="table of all eigenvalues, .csv")
    given = parser.parse_args(arguments)
    is_first = PETSc.COMM_WORLD.getRank() == 0
    try:
        matrices = read_matrices([file for file in (given.stiffness, given.mass, given.damping) if file])
        K, M, D = (None if A is None else on_all_ranks(A) for A in (*matrices, None)[:3])
        found = chladni.complex_eigenvalues(M, D, K, up_to_Hz=given.up_to_Hz, tolerance=given.tolerance)
        rows = ["frequency_Hz,growth_1_per_s,error_1_per_s"]
        rows += [f"{v.imag / (2 * np.pi):.9g},{v.real:.9g},{e:.2g}" for v, e in zip(found.values, found.errors)]
        if is_first and given.output:
            given.output.write_text("\n".join(rows) + "\n")
    except (chladni.Error, OSError) as error:
        if is_first:
            print(error, file=sys.stderr)
        return 1
    if is_first:
        print(f"{len(found.values)} eigenvalues up to {given.up_to_Hz:g} Hz, {len(found.unstable)} of them unstable:")
        print("\n".join(f"{v.imag / (2 * np.pi):12.3f} Hz  {v.real:12.4g} 1/s" for v in found.unstable))
    return 0


def on_all_ranks(A):
    rows = PETSc.Mat().createAIJ(A.shape, nnz=1, comm=PETSc.COMM_WORLD)
    first, last = rows.getOwnershipRange()
    own = A[first:last]
    rows.setPreallocationCSR((own.indptr.astype(PETSc.IntType), own.indices.astype(PETSc.IntType), own.data.astype(float)))
    rows.assemble()
    return rows


if __name__ == "__main__":
    sys.exit(main())
