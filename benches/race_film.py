"""The textured slider of `benches/film_2d.rs` by SciPy's sparse direct solver, in one run with Gudgeon's multigrid.

How to run (in a directory outside the source tree):

    python3 -m venv venv
    venv/bin/pip install numpy scipy
    venv/bin/python <source tree>/benches/race_film.py

Needs cargo. Options: `--rounds N` (default 3), `--binary PATH` (a `film_2d` bench that is built already; otherwise
`cargo bench --no-run` builds one).

Rules
- One problem: the slider of Woloszynski et al. 2015 with K x K square dimples, 30 K + 2 nodes a side, the same control volumes.
- The same Newton: `min` sets every node full or cavitated by the signs of pressure and void, as Gudgeon does; `FBNS` is the
  published method with the function of Fischer and Burmeister. Both stop at an imbalance of 1e-9 of the largest flow, as Gudgeon.
- One measure: load and highest pressure against values on which two other programs agree.
- SciPy's code assembles whole arrays and calls SuperLU with two column orderings, COLAMD (the default) and minimum degree on A' + A. Assembly
  of A and B is outside its timing; for Gudgeon it is inside. A direct solution of each step leaves no error of its own, so its last digits are better.
- A round runs every code once, Gudgeon's figure of a round is the median of seven searches in a process of its own. The table holds
  medians over the rounds.
"""

import statistics
import sys
import time

import racing

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

REFERENCE = {1: (409.70979254654713, 482112.287892393), 2: (381.6177220018324, 537438.9038046171),
             8: (352.305446513026, 492443.5055594756), 10: (351.325960714651, 469600.0601681846)}
LENGTH, SPEED, VISCOSITY, P_CAV, P_EDGE, UNIT = 80e-3, 5.0, 3e-2, 30e3, 100e3, 1e6


def film(k):
    place = np.arange(30 * k) % 30 + 1
    out, base = (place <= 4) | (place >= 27), (place >= 6) & (place <= 25)
    h = np.full((30 * k, 30 * k), 21e-6)
    h[out[:, None] | out[None, :]] = 15e-6
    h[base[:, None] & base[None, :]] = 27e-6
    return np.pad(h, 1, constant_values=15e-6)


def assemble(h):
    """Balance A p + B void + c = 0 of the inner nodes; x is the first index."""
    n = h.shape[0]
    step = LENGTH / (n - 1)
    cond = h**3 / (12 * VISCOSITY)
    gx, gy = 0.5 * (cond[1:] + cond[:-1]), 0.5 * (cond[:, 1:] + cond[:, :-1])
    q = 0.5 * SPEED * h[:-1] * step
    node = np.arange(n * n).reshape(n, n)
    rows, cols, vals = [], [], []
    for a, b, g in ((node[:-1], node[1:], gx), (node[:, :-1], node[:, 1:], gy)):
        for i, j, v in ((a, a, g), (a, b, -g), (b, b, g), (b, a, -g)):
            rows.append(i.ravel()), cols.append(j.ravel()), vals.append(v.ravel())
    size = (n * n, n * n)
    A = sp.csr_matrix((np.concatenate(vals), (np.concatenate(rows), np.concatenate(cols))), shape=size)
    a, b = node[:-1].ravel(), node[1:].ravel()
    B = sp.csr_matrix((np.concatenate([-q.ravel(), q.ravel()]), (np.concatenate([a, b]), np.concatenate([a, a]))), shape=size)
    c = np.zeros(n * n)
    np.add.at(c, a, q.ravel())
    np.add.at(c, b, -q.ravel())
    inner = node[1:-1, 1:-1].ravel()
    p = np.full(n * n, P_EDGE - P_CAV)
    p[inner] = 0.0
    c = (c + A @ p)[inner]
    return A[inner][:, inner].tocsc() * UNIT, B[inner][:, inner].tocsc(), c, q.max(), inner, p, step


def newton(A, B, c, largest, kind, ordering, most=60):
    """Pressure in units of UNIT and void, from nothing."""
    p, r = np.zeros(c.size), np.zeros(c.size)
    for iteration in range(most):
        if kind == "min":
            full = p >= r
            p, r = np.where(full, p, 0.0), np.where(full, 0.0, r)
            f = np.minimum(p, r)
            fp, fr = np.where(full, 0.0, 1.0), np.where(full, 1.0, 0.0)
        else:
            s = np.hypot(p, r)
            f = p + r - s
            safe = np.where(s > 0, s, 1.0)
            corner = 1 - np.sqrt(0.5)
            fp, fr = np.where(s > 0, 1 - p / safe, corner), np.where(s > 0, 1 - r / safe, corner)
            full = fr > fp
        balance = A @ p + B @ r + c
        if iteration and np.abs(balance).max() <= 1e-9 * largest and np.abs(f).max() <= 1e-9:
            return p, r, iteration
        # Of each node the variable with the smaller derivative of f stays; the other one follows from f.
        one, two = np.where(full, fr, 1.0), np.where(full, 1.0, fp)
        to_p, to_r = np.where(full, 1.0, -fr / two), np.where(full, -fp / one, 1.0)
        at_p, at_r = np.where(full, 0.0, -f / two), np.where(full, -f / one, 0.0)
        M = A @ sp.diags(to_p) + B @ sp.diags(to_r)
        z = sla.splu(M.tocsc(), permc_spec=ordering).solve(-balance - A @ at_p - B @ at_r)
        p, r = p + to_p * z + at_p, r + to_r * z + at_r
        if kind == "FBNS":
            p, r = np.maximum(p, 0.0), np.clip(r, 0.0, 1.0)
    return p, r, most


def scipy_row(k, kind, ordering):
    A, B, c, largest, inner, p, step = assemble(film(k))
    begin = time.perf_counter()
    x, r, iterations = newton(A, B, c, largest, kind, ordering)
    took = (time.perf_counter() - begin) * 1e3
    p[inner] = np.maximum(x, 0.0) * UNIT
    load = ((p + P_CAV - P_EDGE) * step**2).sum() + P_EDGE * LENGTH**2
    return dict(iterations=iterations, milliseconds=took, load_error=load / REFERENCE[k][0] - 1,
                peak_error=(p.max() + P_CAV) / REFERENCE[k][1] - 1)


NAME = "Cavitating film of a textured slider"
OWN = "Gudgeon, multigrid"


def prepare(binary):
    return {"binary": binary or racing.build("film_2d"), "rows": {}}


def play(state):
    rows = state["rows"]
    for r in racing.answer(state["binary"], "--json"):
        rows.setdefault((r["k"], OWN), []).append(r)
    for k in REFERENCE:
        for kind in ("min", "FBNS"):
            for ordering in ("COLAMD", "MMD_AT_PLUS_A"):
                rows.setdefault((k, f"SuperLU, {kind}, {ordering}"), []).append(scipy_row(k, kind, ordering))


def report(state):
    rows = state["rows"]
    middle = lambda runs: statistics.median(r["milliseconds"] for r in runs)
    out = []
    for (k, code), runs in sorted((key, runs) for key, runs in rows.items() if key[0] in REFERENCE):
        r, ms = runs[0], middle(runs)
        out.append((f"{30 * k + 2} nodes a side, {code}", r["iterations"], f"{abs(r['load_error']):.1e}",
                    f"{abs(r['peak_error']):.1e}", f"{ms:.1f}", f"{ms / middle(rows[k, OWN]):.1f}"))
    head = ("code", "Newton steps", "error of the load", "of the peak", "ms", "times Gudgeon's")
    return "; ".join(racing.versions("numpy", "scipy")) + "\n\n" + racing.table(head, out)


if __name__ == "__main__":
    racing.alone(sys.modules["__main__"], 3)
