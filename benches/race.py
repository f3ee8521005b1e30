"""The five-volume gas network of `benches/gas_network.rs` with other people's integrators, in one run with Gudgeon's.

How to run (in a directory outside the source tree):

    python3 -m venv venv
    venv/bin/pip install numpy scipy numba scikit-sundae
    venv/bin/python <source tree>/benches/race.py

Needs cargo, which also builds diffsol where it can be had. A code whose package is missing is told to be. Options: `--rounds N` (default 5),
`--binary PATH` (a `gas_network` bench that is built already; otherwise `cargo bench --no-run` builds one).

Rules
- One problem: the same nine links, volumes, temperatures, pressure pulse, start state and cycle, from the periodic start state. The
  flow law is evaluated by the same polynomial of degree 9 in Chebyshev nodes. The right-hand side is compiled by numba with
  `error_model="numpy"`; Gudgeon's is its library's `Network`, errors checked.
- One accuracy measure: the relative error of the blow-by after the cycle against a value on which three codes at relative tolerances of 1e-11 and
  1e-12 agree within 1e-10.
- Errors scatter: from one tolerance to the next, a tenth of a decade away, the error changes by factors of three, so the fastest run of few with an
  error below a limit is a lucky one. Every code therefore runs at 101 tolerances from 1e-1 to 1e-11 (codes of SciPy that are written in Python at every
  fifth), and the time for an error is that of a straight line through the logarithms of time and error of all runs whose error is within a factor of 16
  of it. Tolerances go that far because an error wanted needs runs on both sides of it: at 1e-9 the multistep codes still miss by more than 1e-8, but for single runs
  whose error happens to change its sign. `safe` is stricter: the shortest time from which on no tolerance nearby (three on either side) leaves a larger error.
- The same tolerances: relative `rtol`, absolute `rtol` times the start mass for the volumes. All have the blow-by within the error control, as a
  quadrature or a sixth state with an absolute tolerance of `rtol` times 1e-6 kg; Gudgeon's Radau5 alone has it outside. Gudgeon also integrates the
  outflow of the chamber, to check its mass balance. Every code chooses its first step; no code is told of the largest step.
- Jacobians: Gudgeon has the partial derivatives of its network, codes marked `J` the same, compiled too; the others difference.
- `compiled` codes call the compiled functions without Python in between: CVODE through its C interface, diffsol from Rust (`benches/diffsol`, a package of its
  own, because it brings sixty others) with Gudgeon's own rates and partial derivatives; its right-hand sides are counted as iterations. The others call back
  into Python for every evaluation, which is most of their time: they show what the package costs as it is usually used, not
  what the method costs.
- Timing: setup of a solver counts where its interface offers no reset (all others than Gudgeon set up anew for every cycle; for CVODE through C the
  memory is made once and reinitialised). One round runs every code at every tolerance, so that all see the same load of the machine; a compiled code's
  figure of a round is the median of 15 cycles, Gudgeon's in a process of its own, the others' is one cycle. What counts is the least figure of all rounds: other
  programs on the machine only add to it.
- Compilation and the first call of each function are outside the timing.
"""

import ctypes
import glob
import math
import os
import statistics
import sys
import time

import racing

import numpy as np

try:
    import numba
    from numba import carray, cfunc, types

    def compiled(f):
        return numba.njit(error_model="numpy")(f)
except ImportError:
    numba = None

    def compiled(f):
        return f


try:
    import scipy
    from scipy.integrate import solve_ivp
except ImportError:
    scipy = None

try:
    import sksundae
except ImportError:
    sksundae = None

BLOW_BY = 6.2493570768654555e-6
WANTED = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8]
TOLERANCES = [10.0 ** (-1 - 0.1 * k) for k in range(101)]
# Runs within this distance of an error, in powers of ten, say what it costs.
NEAR = 1.2
N = 5
CH, CC = 5, 6
FROM = np.array([CH, CH, 0, 1, 1, 2, 3, 3, 4])
TO = np.array([0, 1, 1, 2, 3, 3, 4, CC, CC])
AREA = np.array([3e-7, 1.2e-7, 1.5e-7, 3e-7, 1.6e-7, 1e-7, 4e-7, 1e-6, 2e-6])
VOLUME = np.array([1.2e-7, 6e-7, 1e-7, 5e-7, 2e-7])
START = np.array(
    [100018.5728228574880631641, 100049.1854464881180319935, 100046.3416580167831853032,
     100008.2727634799521183595, 100001.4000864467234350741]
)  # fmt: skip
RT = 287.0 * 450.0
GAMMA = 1.33
EPS = 1e-3
OMEGA = 18000.0  # deg/s: 3000 rpm
CYCLE = 720.0 / OMEGA
TO_P = RT / VOLUME
INV_SQRT_RT = 1.0 / math.sqrt(RT)
U_CRIT = 1.0 - (2.0 / (GAMMA + 1.0)) ** (GAMMA / (GAMMA - 1.0))


def _polynomial():
    """psi(u)/sqrt(u) interpolated in the ten Chebyshev nodes of 0 to U_CRIT; powers of 2 u/U_CRIT - 1."""
    nodes = np.cos(np.pi * (np.arange(10) + 0.5) / 10)
    u = 0.5 * U_CRIT * (nodes + 1.0)
    k = (GAMMA - 1.0) / GAMMA
    ln_r = np.log1p(-u)
    psi = np.sqrt(2.0 / k * np.exp(2.0 / GAMMA * ln_r) * -np.expm1(k * ln_r))
    chebyshev = np.polynomial.chebyshev.chebfit(nodes, psi / np.sqrt(u), 9)
    return np.polynomial.chebyshev.cheb2poly(chebyshev)


C = tuple(float(c) for c in _polynomial())
C0, C1, C2, C3, C4, C5, C6, C7, C8, C9 = C


@compiled
def chamber(t):
    deg = t * OMEGA
    a, b = (deg - 360.0) / 55.0, (deg - 370.0) / 18.0
    return 1e5 * (1.0 + 11.0 * math.exp(-a * a)) + 68e5 * math.exp(-0.5 * b * b)


@compiled
def poly(x):
    x2 = x * x
    x4 = x2 * x2
    lo = (C0 + C1 * x) + (C2 + C3 * x) * x2
    mid = (C4 + C5 * x) + (C6 + C7 * x) * x2
    return lo + mid * x4 + (C8 + C9 * x) * (x4 * x4)


@compiled
def poly_slope(x):
    s = 9.0 * C9
    for c in ((8.0 * C8), (7.0 * C7), (6.0 * C6), (5.0 * C5), (4.0 * C4), (3.0 * C3), (2.0 * C2), C1):
        s = s * x + c
    return s


@compiled
def nozzle(p, dp):
    """p psi sqrt(u/(u + eps)) for the upstream pressure p and the difference dp > 0."""
    u, laminar = dp / p, dp / (dp + EPS * p)
    uc = min(u, U_CRIT)
    return p * math.sqrt(uc * laminar) * poly(2.0 / U_CRIT * uc - 1.0)


@compiled
def nozzle_slope(p, dp):
    """Its derivatives with respect to the upstream and the downstream pressure."""
    u = dp / p
    uc = min(u, U_CRIT)
    x = 2.0 / U_CRIT * uc - 1.0
    laminar = u / (u + EPS)
    root = math.sqrt(uc * laminar)
    q = poly(x)
    # d ln(root)/du: half of the logarithmic slopes of uc and of the laminar factor.
    slope = root * q * 0.5 * EPS / (u * (u + EPS))
    if u < U_CRIT:
        slope += root * (0.5 * q / uc + poly_slope(x) * 2.0 / U_CRIT)
    # du/dp_up = (1 - u)/p, du/dp_down = -1/p.
    return root * q + (1.0 - u) * slope, -slope


@compiled
def rates(t, y, f):
    p = (y[0] * TO_P[0], y[1] * TO_P[1], y[2] * TO_P[2], y[3] * TO_P[3], y[4] * TO_P[4], chamber(t), 1e5)
    for i in range(6):
        f[i] = 0.0
    for k in range(9):
        a, b = FROM[k], TO[k]
        dp = p[a] - p[b]
        flow = 0.0
        if dp > 0.0:
            flow = AREA[k] * INV_SQRT_RT * nozzle(p[a], dp)
        elif dp < 0.0:
            flow = -AREA[k] * INV_SQRT_RT * nozzle(p[b], -dp)
        if a < 5:
            f[a] -= flow
        if b < 5:
            f[b] += flow
        elif b == 6:
            f[5] += flow


@compiled
def jacobian(t, y, jac):
    p = (y[0] * TO_P[0], y[1] * TO_P[1], y[2] * TO_P[2], y[3] * TO_P[3], y[4] * TO_P[4], chamber(t), 1e5)
    for i in range(6):
        for j in range(6):
            jac[i, j] = 0.0
    for k in range(9):
        a, b = FROM[k], TO[k]
        dp = p[a] - p[b]
        # Slope of the laminar branch where the pressures are equal.
        by_a = math.sqrt(1.0 / EPS) * poly(-1.0)
        by_b = -by_a
        if dp > 0.0:
            by_a, by_b = nozzle_slope(p[a], dp)
        elif dp < 0.0:
            up, down = nozzle_slope(p[b], -dp)
            by_a, by_b = -down, -up
        scale = AREA[k] * INV_SQRT_RT
        into = b if b < 5 else 5
        if a < 5:
            s = scale * by_a * TO_P[a]
            jac[a, a] -= s
            jac[into, a] += s
        if b < 5:
            s = scale * by_b * TO_P[b]
            jac[into, b] += s
            if a < 5:
                jac[a, b] -= s


Y0 = np.append(START / TO_P, 0.0)


def absolute(rtol):
    return rtol * np.append(Y0[:N], 1e-6)


# The codes: each gives a function of the tolerance that makes a function of nothing, which runs one cycle and returns
# (blow-by, steps, evaluations of the right-hand side).


def through_scipy(method, exact):
    def make(rtol):
        calls = [0]

        def fun(t, y):
            calls[0] += 1
            f = np.empty(6)
            rates(t, y, f)
            return f

        def jac(t, y):
            j = np.empty((6, 6))
            jacobian(t, y, j)
            return j

        more = {"jac": jac} if exact else {}

        def once():
            calls[0] = 0
            s = solve_ivp(fun, (0.0, CYCLE), Y0, method=method, rtol=rtol, atol=absolute(rtol), **more)
            if not s.success:
                raise RuntimeError(s.message)
            return s.y[5, -1], len(s.t) - 1, calls[0]

        return once

    return make


def through_sksundae(rtol):
    calls = [0]

    def fun(t, y, f):
        calls[0] += 1
        rates(t, y, f)

    def jac(t, y, f, j):
        jacobian(t, y, j)

    span = np.array([0.0, CYCLE])

    def once():
        calls[0] = 0
        solver = sksundae.cvode.CVODE(
            fun, rtol=rtol, atol=absolute(rtol), jacfn=jac, linsolver="dense", max_num_steps=100000
        )
        s = solver.solve(span, Y0)
        if not s.success:
            raise RuntimeError(s.message)
        return s.y[-1, 5], len(s.t) - 1, calls[0]

    return once


def through_c():
    """CVODE with its dense solver through the C interface, from the libraries in the scikit-sundae wheel."""
    folder = os.path.join(os.path.dirname(os.path.dirname(sksundae.__file__)), "scikit_sundae.libs")
    lib = {}
    for name in ("core", "nvecserial", "sunmatrixdense", "sunlinsoldense", "cvode"):
        found = glob.glob(os.path.join(folder, f"libsundials_{name}-*"))
        if not found:
            raise OSError(f"the wheel holds no libsundials_{name}")
        lib[name] = ctypes.CDLL(found[0], ctypes.RTLD_GLOBAL)
    ptr, real, integer, long = ctypes.c_void_p, ctypes.c_double, ctypes.c_int, ctypes.c_long

    def declare(library, name, result, *args):
        f = getattr(lib[library], name)
        f.restype, f.argtypes = result, list(args)
        return f

    new_context = declare("core", "SUNContext_Create", integer, integer, ptr)
    # Sizes are 32 or 64 bits wide depending on the build; small positive numbers pass in registers either way.
    new_vector = declare("nvecserial", "N_VNew_Serial", ptr, ctypes.c_int64, ptr)
    vector_data = declare("nvecserial", "N_VGetArrayPointer_Serial", ctypes.POINTER(real), ptr)
    new_matrix = declare("sunmatrixdense", "SUNDenseMatrix", ptr, ctypes.c_int64, ctypes.c_int64, ptr)
    matrix_data = declare("sunmatrixdense", "SUNDenseMatrix_Data", ctypes.POINTER(real), ptr)
    new_solver = declare("sunlinsoldense", "SUNLinSol_Dense", ptr, ptr, ptr, ptr)
    create = declare("cvode", "CVodeCreate", ptr, integer, ptr)
    init = declare("cvode", "CVodeInit", integer, ptr, ptr, real, ptr)
    reinit = declare("cvode", "CVodeReInit", integer, ptr, real, ptr)
    tolerances = declare("cvode", "CVodeSVtolerances", integer, ptr, real, ptr)
    set_solver = declare("cvode", "CVodeSetLinearSolver", integer, ptr, ptr, ptr)
    set_jacobian = declare("cvode", "CVodeSetJacFn", integer, ptr, ptr)
    set_max_steps = declare("cvode", "CVodeSetMaxNumSteps", integer, ptr, long)
    set_stop = declare("cvode", "CVodeSetStopTime", integer, ptr, real)
    advance = declare("cvode", "CVode", integer, ptr, real, ptr, ptr, integer)
    get_steps = declare("cvode", "CVodeGetNumSteps", integer, ptr, ptr)
    get_rhs = declare("cvode", "CVodeGetNumRhsEvals", integer, ptr, ptr)
    get_differences = declare("cvode", "CVodeGetNumLinRhsEvals", integer, ptr, ptr)

    @cfunc(types.int32(types.double, types.voidptr, types.voidptr, types.voidptr), error_model="numpy")
    def rhs(t, y, f, _user):
        rates(t, carray(vector_data(y), 6), carray(vector_data(f), 6))
        return 0

    @cfunc(types.int32(types.double, *[types.voidptr] * 7), error_model="numpy")
    def jac(t, y, _f, j, _user, _a, _b, _c):
        # Stored by columns.
        jacobian(t, carray(vector_data(y), 6), carray(matrix_data(j), (6, 6)).T)
        return 0

    def good(flag):
        if flag < 0:
            raise RuntimeError(f"CVODE answers {flag}")

    context = ptr()
    good(new_context(0, ctypes.byref(context)))

    def array(vector):
        return np.ctypeslib.as_array(vector_data(vector), (6,))

    def make(rtol, exact):
        y, weights = new_vector(6, context), new_vector(6, context)
        state = array(y)
        state[:] = Y0
        array(weights)[:] = absolute(rtol)
        memory = create(2, context)  # 2: BDF
        good(init(memory, ctypes.cast(rhs.address, ptr), 0.0, y))
        good(tolerances(memory, rtol, weights))
        matrix = new_matrix(6, 6, context)
        good(set_solver(memory, new_solver(y, matrix, context), matrix))
        if exact:
            good(set_jacobian(memory, ctypes.cast(jac.address, ptr)))
        good(set_max_steps(memory, 100_000))
        reached, count = real(), long()

        def number(get):
            good(get(memory, ctypes.byref(count)))
            return count.value

        def once():
            state[:] = Y0
            good(reinit(memory, 0.0, y))
            good(set_stop(memory, CYCLE))
            good(advance(memory, CYCLE, y, ctypes.byref(reached), 1))  # 1: to the given time
            return state[5], number(get_steps), number(get_rhs) + number(get_differences)

        return once

    return make


def codes():
    """Name, cycles timed per round, every how manieth tolerance, maker."""
    if sksundae is not None and numba is not None:
        try:
            make = through_c()
            yield "CVODE J, compiled", 15, 1, lambda rtol: make(rtol, True)
            yield "CVODE, compiled", 15, 1, lambda rtol: make(rtol, False)
        except OSError as e:
            print(f"CVODE through C is skipped: {e}")
    if sksundae is not None:
        yield "scikit-sundae CVODE J", 1, 1, through_sksundae
    if scipy is not None:
        # The two written in Python take a fraction of a second each.
        for method, every in (("LSODA", 1), ("BDF", 5), ("Radau", 5)):
            yield f"SciPy {method}", 1, every, through_scipy(method, False)
            yield f"SciPy {method} J", 1, every, through_scipy(method, True)


def check_jacobian():
    """The exact Jacobian against central differences, at a state between choked and free flow."""
    y = np.append(np.array([30e5, 12e5, 9e5, 1.5e5, 1.03e5]) / TO_P, 0.0)
    exact, up, down = np.empty((6, 6)), np.empty(6), np.empty(6)
    jacobian(0.0205, y, exact)
    for j in range(N):
        d = np.zeros(6)
        d[j] = 1e-5 * y[j]
        rates(0.0205, y + d, up)
        rates(0.0205, y - d, down)
        # Differences of relative step 1e-5 are right to about 1e-8 of the largest entry of the column.
        if np.abs((up - down) / (2 * d[j]) - exact[:, j]).max() > 1e-6 * np.abs(exact[:, j]).max():
            raise AssertionError(f"the exact Jacobian is wrong in column {j}")


def at_error(rows, wanted):
    """Time of the line through the runs near an error; none where there are too few on one side."""
    x = np.array([math.log10(max(error, 1e-16) / wanted) for error, _ in rows])
    y = np.array([math.log(us) for _, us in rows])
    near = np.abs(x) <= NEAR
    if near.sum() < 4 or not (x[near].min() < 0 < x[near].max()):
        return None
    return math.exp(np.polyfit(x[near], y[near], 1)[1])


def safely(rows, wanted):
    """Shortest time of a tolerance around which none leaves a larger error."""
    safe = [us for i, (_, us) in enumerate(rows) if max(e for e, _ in rows[max(0, i - 3) : i + 4]) <= wanted]
    return min(safe, default=None)


NAME = "Gas network of five volumes over a cycle"


def prepare(binary):
    check_jacobian()
    runners, result = [], {}
    for name, repeat, every, make in codes():
        for rtol in TOLERANCES[::every]:
            once = make(rtol)
            try:
                result[name, rtol] = once()
                runners.append((name, repeat, rtol, once))
            except RuntimeError as e:
                print(f"{name} at {rtol:.0e}: {e}")
    programs = [binary or racing.build("gas_network"), racing.build_apart("diffsol", "race-diffsol")]
    return {"programs": programs, "runners": runners, "result": result, "us": {}}


def play(state):
    def keep(key, us):
        state["us"][key] = min(us, state["us"].get(key, math.inf))

    for row in (row for program in filter(None, state["programs"]) for row in racing.answer(program, "--json")):
        state["result"][row["code"], row["rtol"]] = row["blow_by"], row["steps"], row["rhs"]
        keep((row["code"], row["rtol"]), row["microseconds"])
    for name, repeat, rtol, once in state["runners"]:
        times = []
        for _ in range(repeat):
            begin = time.perf_counter()
            once()
            times.append((time.perf_counter() - begin) * 1e6)
        keep((name, rtol), statistics.median(times))


def report(state):
    runs = {}
    for (name, rtol), us in state["us"].items():
        runs.setdefault(name, []).append((abs(state["result"][name, rtol][0] / BLOW_BY - 1.0), us))
    line = {name: [at_error(rows, e) for e in WANTED] for name, rows in runs.items()}
    safe = {name: [safely(rows, e) for e in WANTED] for name, rows in runs.items() if len(rows) == len(TOLERANCES)}

    def lead(best):
        """How many times as long the better CVODE takes as the best of Gudgeon."""
        def least(own, k):
            found = [v[k] for n, v in best.items() if n.startswith("Gudgeon" if own else "CVODE") and v[k]]
            return min(found, default=None)

        pairs = [(least(True, k), least(False, k)) for k in range(len(WANTED))]
        return [f"{b / a:.2f}" if a and b else "–" for a, b in pairs]

    head = ["us for an error of the blow-by of"] + [f"{e:.0e}" for e in WANTED]
    show = lambda best: [[name] + [racing.figure(v) for v in row] for name, row in best.items()]
    lead_row = lambda best: [["better compiled CVODE over the best of Gudgeon"] + lead(best)] if sksundae else []
    some = [(n, r) for n in runs for r in (1e-3, 1e-5, 1e-7) if (n, r) in state["us"]]
    counts = [[f"{n}, {r:.0e}", *state["result"][n, r][1:], f"{abs(state['result'][n, r][0] / BLOW_BY - 1):.1e}",
               f"{state['us'][n, r]:.0f}"] for n, r in some]  # fmt: skip
    used = racing.versions("numpy", "scipy", "numba", "scikit-sundae")
    used.append("diffsol 0.18.0" if state["programs"][1] else "diffsol missing")
    used += [f"SUNDIALS {sksundae.SUNDIALS_VERSION}"] if sksundae else []
    return "\n\n".join([
        "; ".join(used),
        racing.table(head, show(line) + lead_row(line)),
        "The same, safe from a larger error at tolerances nearby:",
        racing.table(head, show(safe) + lead_row(safe)),
        "Single runs:",
        racing.table(["code and tolerance", "steps", "right-hand sides", "error", "us"], counts),
    ])  # fmt: skip


if __name__ == "__main__":
    racing.alone(sys.modules["__main__"], 5)
