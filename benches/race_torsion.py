"""openTorsion and ROSS beside Gudgeon in one run: an engine of nine inertias, its eigenvalues and its forced vibration at 401 speeds and 24 orders.

How to run (in a directory outside the source tree):

    python3 -m venv venv
    venv/bin/pip install numpy scipy opentorsion ross-rotordynamics "plotly<6"
    venv/bin/python <source tree>/benches/race_torsion.py

Needs cargo. Options: `--rounds N` (default 3), `--binary PATH` (a `torsion` bench that is built already; otherwise `cargo bench --no-run` builds
one).

Rules
- One problem: the inertias, stiffnesses and dampings of `benches/torsion.rs`, the same torques and speeds.
- openTorsion's matrices and excitations are built outside its timing. Of its sweep only the calls of `ss_response` are timed, one per order with all
  speeds; Gudgeon's timing holds everything but the line itself. Python's own overhead is part of what a user of openTorsion waits for.
- ROSS knows rotors that bend, stretch and turn: six freedoms a node, 54 in all. Its shafts here have the same stiffness in torsion and next to no mass, so
  that its torsional frequencies are those of the engine. Its matrices are built outside the timing, and SciPy's symmetric solver finds their eigenvalues:
  its own `run_modal` forms a state space of twice the size and sorts modes of all kinds, which would say little of torsion.
- The error of each is against exact solutions with 25 digits (mpmath), as largest relative deviation of the elastic frequencies, and of the angle of
  order 3 and the shaft torque of order 6 at 2100 rpm.
- A round runs each once (medians of many calls); the table holds medians over the rounds.
"""

import statistics
import sys
import time

import racing

import numpy as np
import scipy.linalg as la

try:
    import opentorsion as ot
except ImportError:
    ot = None

J = [0.120, 0.030, 0.055, 0.055, 0.055, 0.055, 0.055, 0.055, 1.60]
K = [0.08e6, 0.90e6, 1.35e6, 1.35e6, 1.35e6, 1.35e6, 1.35e6, 1.80e6]
C = [25, 2, 2, 2, 2, 2, 2, 2]
C_ABS = [0, 0, 1.5, 1.5, 1.5, 1.5, 1.5, 1.5, 0]
FIRING = [0.0, 480.0, 240.0, 600.0, 120.0, 360.0]
OMEGA = [691.6327859407956, 1440.440080366365, 3440.1628614475494, 5307.914956291062, 6799.924756648763, 8031.322137571369, 9043.232890181248,
         9691.269760304264]
ORDER_3, ORDER_6 = 6.27602491443047e-3, 837.52852016825


def median(rounds, times, f):
    seconds = []
    for _ in range(rounds):
        begin = time.perf_counter()
        for _ in range(times):
            f()
        seconds.append((time.perf_counter() - begin) / times)
    return statistics.median(seconds)


def torque(order, amplitude, speeds):
    u = np.zeros((9, len(speeds)), dtype=complex)
    for throw, firing in enumerate(FIRING):
        u[2 + throw, :] = amplitude * np.exp(-1j * order * np.radians(firing))
    return u


def with_opentorsion():
    shafts = [ot.Shaft(i, i + 1, None, None, k=k, c=c) for i, (k, c) in enumerate(zip(K, C))]
    disks = [ot.Disk(i, j, c=c) for i, (j, c) in enumerate(zip(J, C_ABS))]
    engine = ot.Assembly(shafts, disk_elements=disks)
    out = {}
    out["eigenvalues"] = median(5, 300, engine.undamped_modal_analysis)
    found = np.sort(np.sqrt(np.abs(engine.undamped_modal_analysis()[0])))[1:]
    out["eigenvalue_error"] = float(np.max(np.abs(found / OMEGA - 1)))
    out["damped"] = median(5, 300, engine.modal_analysis)
    speeds = (800 + 8 * np.arange(401)) * np.pi / 30
    orders = 0.5 * np.arange(1, 25)
    inputs = [(torque(o, 160.0 if o == 3 else 55.0, speeds), o * speeds) for o in orders]
    out["sweep"] = median(3, 1, lambda: [engine.ss_response(u, w) for u, w in inputs])
    at = np.array([2100 * np.pi / 30])
    q3, _ = engine.ss_response(torque(3, 160.0, at), 3 * at)
    q6, _ = engine.ss_response(torque(6, 55.0, at), 6 * at)
    shaft = abs((K[7] + 1j * 6 * at[0] * C[7]) * (q6[7, 0] - q6[8, 0]))
    out["sweep_error"] = float(max(abs(abs(q3[0, 0]) / ORDER_3 - 1), abs(shaft / ORDER_6 - 1)))
    return out


def ross_matrices():
    """Stiffness and mass of the engine as ROSS has them; none where it is missing or does not start."""
    try:
        import ross
    except Exception:  # A wrong version of plotly ends its import with one of several errors.
        return None
    light = ross.Material(name="light", rho=1e-6, G_s=8e10, E=2e11)
    diameter = lambda k: (32 * k * 0.1 / (np.pi * light.G_s)) ** 0.25
    shafts = [ross.ShaftElement(L=0.1, idl=0.0, odl=diameter(k), material=light, n=i) for i, k in enumerate(K)]
    disks = [ross.DiskElement(n=i, m=10.0, Id=0.5 * j, Ip=j) for i, j in enumerate(J)]
    bearings = [ross.BearingElement(n=n, kxx=1e8, kyy=1e8, kzz=1e8, cxx=0, cyy=0) for n in (0, 8)]
    rotor = ross.Rotor(shafts, disks, bearings)
    return rotor.K(0), rotor.M(0)


def with_ross(matrices):
    frequencies = lambda: np.sqrt(np.abs(la.eigh(*matrices, eigvals_only=True)))
    found = frequencies()
    error = max(float(np.abs(found / w - 1).min()) for w in OMEGA)
    return {"eigenvalues": median(5, 30, frequencies), "error": error}


NAME = "Torsion of an engine of nine inertias"


def prepare(binary):
    return {"binary": binary or racing.build("torsion"), "ross": ross_matrices(), "rounds": []}


def play(state):
    own = racing.answer(state["binary"], "--json")
    of_ot = with_opentorsion() if ot is not None else None
    of_ross = with_ross(state["ross"]) if state["ross"] is not None else None
    state["rounds"].append((own, of_ot, of_ross))


def report(state):
    rounds = state["rounds"]
    of = lambda f: statistics.median(f(*r) for r in rounds)
    (first, of_ot, of_ross), rows = rounds[0], []

    def row(what, code, seconds, error, own):
        rows.append((f"{what}: {code}", error, racing.figure(1e6 * of(seconds)), racing.figure(of(lambda *r: seconds(*r) / own(*r)))))

    eigen = lambda o, t, r: o["eigenvalues"]["seconds"]
    damped = lambda o, t, r: o["damped"]["seconds"] + o["eigenvalues_and_shapes"]["seconds"]
    sweep = lambda o, t, r: o["sweep"]["seconds"]
    closed = lambda o, t, r: o["closed_form"]["seconds"]
    row("eigenvalues", "Gudgeon", eigen, f"{first['eigenvalues']['error']:.1e}", eigen)
    if of_ot:
        row("eigenvalues", "openTorsion", lambda o, t, r: t["eigenvalues"], f"{of_ot['eigenvalue_error']:.1e}", eigen)
    if of_ross:
        row("eigenvalues", "matrices of ROSS", lambda o, t, r: r["eigenvalues"], f"{of_ross['error']:.1e}", eigen)
    row("damped eigenvalues", "Gudgeon", damped, "", damped)
    if of_ot:
        row("damped eigenvalues", "openTorsion", lambda o, t, r: t["damped"], "", damped)
    row("401 speeds, 24 orders", "Gudgeon", sweep, f"{first['sweep']['error']:.1e}", sweep)
    if of_ot:
        row("401 speeds, 24 orders", "openTorsion", lambda o, t, r: t["sweep"], f"{of_ot['sweep_error']:.1e}", sweep)
    row("free vibration of a compressor, 0.1 s", "closed form", closed, "rounding", closed)
    for k, kutta in enumerate(first["runge_kutta"]):
        row("free vibration", f"Runge-Kutta, step {kutta['step']:g} s", lambda o, t, r, k=k: o["runge_kutta"][k]["seconds"],
            f"{kutta['error']:.1e} rad/s", closed)
    missing = [name for name, there in (("opentorsion", ot), ("ross-rotordynamics", state["ross"])) if there is None]
    notes = "".join(f"; {name} did not start" for name in missing)
    table = racing.table(("code", "error", "us", "times Gudgeon's"), rows)
    return "; ".join(racing.versions("numpy", "scipy", "opentorsion", "ross-rotordynamics", "plotly")) + notes + "\n\n" + table


if __name__ == "__main__":
    racing.alone(sys.modules["__main__"], 3)
