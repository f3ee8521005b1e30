#!/usr/bin/env python3
"""Gudgeon's pin optimiser against SciPy and NLopt on the same random engines.

    python benches/race_pin.py [--rounds 5] [--binary PATH]

Needs Python with numpy and scipy, takes nlopt where it is installed, and builds the bench `pin` with Cargo unless `--binary` names it. The table is
printed.

What is compared, and what is not:

- The problem: length and both diameters of the lightest pin, less the flats relieved on the piston, under eight limits, for random engines of 60 to 200 mm
  bore (the program hands out their numbers). Every code starts cold: Gudgeon from its own start, the others from the same feasible-looking start (mid
  diameter, the length that the boss pressure asks for, half the diameter as bore).
- SLSQP of SciPy and of NLopt, and MMA of NLopt, get functions and exact gradients in double precision, on the logarithms of the utilisations as Gudgeon
  does, with variables over the bore. Their functions are Python: SciPy's and NLopt's time is mostly theirs, so the count of evaluations stands beside it.
- Errors are relative to Gudgeon's optimum, which its own conditions prove to rounding; a code that fails or ends above it by more than 1e-6 counts as
  missed.
- A round solves all engines with every code once; times are medians over rounds. All run on one core.
"""

import math
import statistics
import sys
import time

import racing

import numpy as np
from scipy.optimize import minimize

try:
    import nlopt
except ImportError:
    nlopt = None

STEEL, ALLOY = 7850.0, 2690.0


class Problem:
    def __init__(self, e):
        self.e = e
        self.count = 0
        d = e["bore"]
        self.lower = np.array([1.001 * e["gap"], 0.2 * d, 0.0]) / d
        self.upper = np.array([0.999 * d, e["outer"], 0.999 * e["outer"]]) / d
        force = e["gas"] + e["inertia"]
        outer = 0.5 * (0.2 * d + e["outer"])
        length = min(e["gap"] + force / (e["limits"][0] * outer), 0.99 * d)
        self.start = np.array([length, outer, 0.5 * outer]) / d

    def mass(self, x):
        """Pin less relief over density times bore cubed, and its gradient."""
        self.count += 1
        d = self.e["bore"]
        l, o, i = x
        # The flats: two circular segments of a circle of diameter one.
        root = math.sqrt(max(1.0 - l * l, 1e-300))
        k = self.e["relief"] / d * ALLOY / STEEL
        m = math.pi / 4 * (o * o - i * i) * l - k * (0.5 * math.acos(l) - 0.5 * l * root)
        return m, np.array([math.pi / 4 * (o * o - i * i) + k * root, math.pi / 2 * o * l, -math.pi / 2 * i * l])

    def limits(self, x):
        """Logarithms of the utilisations and their gradients."""
        e = self.e
        d = e["bore"]
        l, o, i = np.maximum(x * d, [e["gap"] * (1 + 1e-9), 1e-4, 0.0])
        i = min(i, 0.9999 * o)
        f, gas, gap, rod, mod = e["gas"] + e["inertia"], e["gas"], e["gap"], e["rod"], e["modulus"]
        a = 0.5 * (l + gap)
        j4 = o**4 - i**4
        jo, ji = 4 * o**3 / j4, -4 * i**3 / j4
        r = i / o
        q = lambda v: np.array(v, float)
        boss = math.log(f / (o * (l - gap))), q([-1 / (l - gap), -1 / o, 0])
        s = 3 * (2 / (1 - r * r))  # d ln c/d rho
        oval = math.log(gas * ((1 + r) / (1 - r)) ** 3 / (8 * mod * l)), q([-1 / l, -s * r / o, s / o])
        w = a - rod / 2
        bend = math.log(a * a * w * f / (48 * mod * math.pi / 64 * j4)), q([1 / a + 0.5 / w, -jo, -ji])
        rodp = math.log(f / (o * rod)), q([0, -1 / o, 0])
        sb = (a / 4 - rod / 8) * f * o / (2 * math.pi / 64 * j4)
        dsb = sb * q([0.125 / (a / 4 - rod / 8), 1 / o - jo, -ji])
        so = 0.75 * f * (o + i) / (l * (o - i) ** 2)
        dso = so * q([-1 / l, 1 / (o + i) - 2 / (o - i), 1 / (o + i) + 2 / (o - i)])
        dr = (1 + 2 * r) / (1 + r + r * r) + 4 * r**3 / (1 - r**4)
        tau = math.log(0.85 * f * (1 + r + r * r) / (o * o * (1 - r**4))), q([0, -2 / o - dr * r / o, dr / o])
        sr = math.hypot(sb, so)
        rows = [boss, oval, bend, rodp, (math.log(sb), dsb / sb), (math.log(so), dso / so), tau,
                (math.log(sr), (sb * dsb + so * dso) / sr**2)]
        return np.array([v for v, _ in rows]) - np.log(e["limits"]), np.array([g for _, g in rows]) * d

    def unit(self):
        return STEEL * self.e["bore"] ** 3


def scipy_slsqp(p):
    cons = {"type": "ineq", "fun": lambda x: -p.limits(x)[0], "jac": lambda x: -p.limits(x)[1]}
    r = minimize(lambda x: p.mass(x), p.start, jac=True, method="SLSQP", bounds=list(zip(p.lower, p.upper)),
                 constraints=[cons], options={"ftol": 1e-15, "maxiter": 200})
    return r.x


def with_nlopt(algorithm):
    def solve(p):
        o = nlopt.opt(algorithm, 3)
        o.set_lower_bounds(p.lower)
        o.set_upper_bounds(p.upper)

        def f(x, g):
            m, d = p.mass(x)
            if g.size:
                g[:] = d
            return m

        def c(out, x, g):
            v, d = p.limits(x)
            out[:] = v
            if g.size:
                g[:] = d

        o.set_min_objective(f)
        o.add_inequality_mconstraint(c, np.full(8, 1e-12))
        o.set_xtol_rel(1e-12)
        o.set_maxeval(2000)
        try:
            return o.optimize(p.start)
        except (RuntimeError, nlopt.RoundoffLimited, ValueError):
            return np.full(3, np.nan)

    return solve


CODES = {"SciPy SLSQP": scipy_slsqp}
if nlopt is not None:
    CODES |= {"NLopt SLSQP": with_nlopt(nlopt.LD_SLSQP), "NLopt MMA": with_nlopt(nlopt.LD_MMA)}
NAME = "The lightest pin"
ENGINES = 200


def prepare(binary):
    return {"binary": binary or racing.build("pin"), "times": {"Gudgeon": []}, "errors": {}, "counts": {}}


def solved(e, solve):
    """Time, evaluations and error of one code on one engine."""
    p = Problem(e)
    # The functions of both programs agree: else the race means nothing.
    here = p.mass(np.array(e["size"]) / e["bore"])[0] * p.unit()
    assert abs(here - e["mass"]) < 1e-12 * (abs(e["mass"]) + p.unit() * 1e-3), (here, e["mass"])
    assert p.limits(np.array(e["size"]) / e["bore"])[0].max() < 1e-11
    p.count = 0
    begin = time.perf_counter()
    x = solve(p)
    spent = time.perf_counter() - begin
    count = p.count
    # A point that breaks a limit is no pin: its excess counts as error too.
    over = max(0.0, float(np.max(p.limits(x)[0]))) if np.all(np.isfinite(x)) else math.inf
    m = p.mass(x)[0] * p.unit() if math.isfinite(over) else math.inf
    pin = STEEL * math.pi / 4 * (e["size"][1] ** 2 - e["size"][2] ** 2) * e["size"][0]
    return spent, count, max((m - e["mass"]) / pin, over)


def play(state):
    own = racing.answer(state["binary"], "--json", str(ENGINES))
    state["times"]["Gudgeon"].append(own["seconds"])
    engines = [e for e in own["engines"] if e["size"]]
    for code, solve in CODES.items():
        runs = [solved(e, solve) for e in engines]
        state["times"].setdefault(code, []).append(statistics.mean(r[0] for r in runs))
        state["counts"][code], state["errors"][code] = [r[1] for r in runs], [r[2] for r in runs]


def report(state):
    own = statistics.median(state["times"]["Gudgeon"])
    rows = [("Gudgeon", "", "proved", 0, f"{1e6 * own:.1f}", 1)]
    for code in CODES:
        t, e = statistics.median(state["times"][code]), state["errors"][code]
        rows.append((code, f"{statistics.mean(state['counts'][code]):.0f}", f"{statistics.median(map(abs, e)):.1e}",
                     sum(v > 1e-6 for v in e), f"{1e6 * t:.0f}", f"{t / own:.0f}"))
    head = ("code", "evaluations", "median error", f"missed of {ENGINES}", "us each", "times Gudgeon's")
    return "; ".join(racing.versions("numpy", "scipy", "nlopt")) + "\n\n" + racing.table(head, rows)


if __name__ == "__main__":
    racing.alone(sys.modules["__main__"], 5)
