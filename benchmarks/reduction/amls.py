"""Automated multi-level substructuring in numpy: how much work and how much error?

A prototype to decide by, not part of the program. Nested dissection by METIS (METIS_NodeNDP), each
substructure eliminated from its ancestors by dense blocks, all its fixed-interface modes below a
cut-off kept, and a dense reduced pencil (diag(lambda), M) at the end. Dense kernels are those of
numpy's BLAS, so that the times are those of the arithmetic.
Source: Bennighof and Lehoucq, SIAM J. Sci. Comput. 25 (2004) 2084.
"""
import ctypes
import time

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as sla


def dissect(pattern, depth):
    """Substructures as arrays of rows, in postorder, with the index of each parent (-1: root)."""
    metis = ctypes.CDLL("libmetis.so.5")
    n = pattern.shape[0]
    graph = pattern.tocsr(copy=True)
    graph.setdiag(0)
    graph.eliminate_zeros()
    c = lambda a: a.ctypes.data_as(ctypes.POINTER(ctypes.c_int32))
    xadj, adjncy = graph.indptr.astype(np.int32), graph.indices.astype(np.int32)
    perm, iperm = np.zeros(n, np.int32), np.zeros(n, np.int32)
    parts = 2**depth
    sizes = np.zeros(2 * parts - 1 + 2, np.int32)
    status = metis.METIS_NodeNDP(ctypes.c_int32(n), c(xadj), c(adjncy), None, ctypes.c_int32(parts),
                                 None, c(perm), c(iperm), c(sizes))
    if status != 1:
        raise SystemExit(f"METIS_NodeNDP: {status}")
    # Sizes: the leaves, then the separators level by level from below, the root last. The new order
    # is that of the tree: left, right, separator.
    levels, first, width = [], 0, parts
    while width >= 1:
        levels.append(sizes[first:first + width])
        first, width = first + width, width // 2
    blocks, parent, used = [], [], 0

    def visit(level, i):
        nonlocal used
        below = [visit(level - 1, 2 * i + k) for k in (0, 1)] if level > 0 else []
        blocks.append(perm[used:used + levels[level][i]])
        used += levels[level][i]
        parent.append(-1)
        for child in below:
            parent[child] = len(blocks) - 1
        return len(blocks) - 1

    visit(len(levels) - 1, 0)
    return blocks, np.array(parent)


class Amls:
    """M x = mu K x of the reduced pencil, mu = 1 / lambda."""

    def __init__(self, K, M, block_size, depth, lambda_cut):
        self.times = {}
        start = time.process_time()
        nodes = self.nodes_of(K, block_size)
        blocks, parent = dissect(nodes, depth)
        self.blocks = [self.rows_of(block, block_size, K.shape[0]) for block in blocks]
        self.parent = parent
        self.times["dissection"] = time.process_time() - start
        self.lambda_cut = lambda_cut
        self.lambdas, self.entries = [], []
        self.n_reduced = 0
        self.flops = 0.0
        start = time.process_time()
        self.local_s = 0.0
        self.eliminate(K.tocsr(), M.tocsr())
        self.times["local eigenproblems"] = self.local_s
        self.times["elimination and projection"] = time.process_time() - start - self.local_s

    @staticmethod
    def nodes_of(K, b):
        coo = K.tocoo()
        n = -(-K.shape[0] // b)
        return sp.coo_matrix((np.ones(coo.nnz, np.int8), (coo.row // b, coo.col // b)), (n, n)).tocsr()

    @staticmethod
    def rows_of(block, b, n):
        rows = (np.asarray(block)[:, None] * b + np.arange(b)).ravel()
        return rows[rows < n]

    def eliminate(self, K, M):
        n = K.shape[0]
        owner, place = np.empty(n, int), np.empty(n, int)
        for i, rows in enumerate(self.blocks):
            owner[rows], place[rows] = i, np.arange(len(rows))
        children = [[] for _ in self.blocks]
        for i, p in enumerate(self.parent):
            if p >= 0:
                children[p].append(i)
        done = {}
        for i, rows in enumerate(self.blocks):
            done[i] = self.eliminate_one(i, rows, K, M, owner, [done.pop(c) for c in children[i]])

    def eliminate_one(self, i, rows, K, M, owner, children):
        """Fronts as in a multifrontal factorisation; S: rows of the modes below, by columns of the
        boundary."""
        near = np.unique(K[rows].indices)
        boundary = near[owner[near] > i]
        for child in children:
            boundary = np.union1d(boundary, child["boundary"][owner[child["boundary"]] > i])
        front = np.concatenate([rows, boundary]).astype(int)
        at = {row: k for k, row in enumerate(front)}
        n_i = len(rows)
        K_f, M_f = np.zeros((len(front),) * 2), np.zeros((len(front),) * 2)
        K_f[:n_i], M_f[:n_i] = K[rows][:, front].toarray(), M[rows][:, front].toarray()
        K_f[n_i:, :n_i], M_f[n_i:, :n_i] = K_f[:n_i, n_i:].T, M_f[:n_i, n_i:].T
        below, S = [], []
        for child in children:
            columns = [at[row] for row in child["boundary"]]
            K_f[np.ix_(columns, columns)] += child["K"]
            M_f[np.ix_(columns, columns)] += child["M"]
            wide = np.zeros((len(child["modes"]), len(front)))
            wide[:, columns] = child["S"]
            below.append(child["modes"])
            S.append(wide)
        below = np.concatenate(below) if below else np.zeros(0, int)
        S = np.vstack(S) if S else np.zeros((0, len(front)))
        if n_i == 0:
            return {"boundary": boundary, "K": K_f, "M": M_f, "S": S, "modes": below}
        K_ii, M_ii = K_f[:n_i, :n_i], M_f[:n_i, :n_i]
        L = la.cho_factor(K_ii, lower=True)
        Psi = -la.cho_solve(L, K_f[:n_i, n_i:])
        M_iA = M_f[:n_i, n_i:] + M_ii @ Psi
        K_AA = K_f[n_i:, n_i:] + K_f[n_i:, :n_i] @ Psi
        M_AA = M_f[n_i:, n_i:] + Psi.T @ M_iA + M_f[n_i:, :n_i] @ Psi
        start = time.process_time()
        half = la.solve_triangular(L[0], M_ii, lower=True)
        A = la.solve_triangular(L[0], half.T, lower=True)
        mu, Y = la.eigh(0.5 * (A + A.T), subset_by_value=(1 / self.lambda_cut, np.inf), driver="evr")
        Phi = la.solve_triangular(L[0], Y, lower=True, trans="T") / np.sqrt(mu)
        self.local_s += time.process_time() - start
        own = self.n_reduced + np.arange(len(mu))
        self.n_reduced += len(mu)
        self.lambdas.append(1 / mu)
        if len(below) and len(own):
            self.entries.append((below, own, S[:, :n_i] @ Phi))
        S_own = Phi.T @ M_iA
        S_A = S[:, n_i:] + S[:, :n_i] @ Psi
        return {"boundary": boundary, "K": K_AA, "M": M_AA, "S": np.vstack([S_A, S_own]),
                "modes": np.concatenate([below, own])}

    def solve(self, n_modes):
        """The lowest lambda of the reduced pencil, by Lanczos on D^-1/2 M D^-1/2."""
        start = time.process_time()
        lam = np.concatenate(self.lambdas)
        n = self.n_reduced
        A = np.eye(n)
        for rows, columns, block in self.entries:
            A[np.ix_(rows, columns)] = block
            A[np.ix_(columns, rows)] = block.T
        A /= np.sqrt(np.outer(lam, lam))
        if n_modes > n // 4:
            mu = la.eigh(A, eigvals_only=False, subset_by_index=(n - n_modes, n - 1), driver="evr")[0]
        else:
            mu = sla.eigsh(A, k=n_modes, which="LA", ncv=min(n, 2 * n_modes + 50), tol=1e-8)[0]
        self.times["reduced eigenproblem"] = time.process_time() - start
        return 1 / np.sort(mu)[::-1]
