"""openTorsion (from PyPI) beside Gudgeon in one run: an engine of nine inertias, its eigenvalues and its forced vibration at 401 speeds and 24 orders.

How to run (in a directory outside the source tree):

    python3 -m venv venv
    venv/bin/pip install numpy scipy opentorsion
    venv/bin/python <source tree>/benches/race_torsion.py

Needs cargo. Options: `--rounds N` (default 3), `--binary PATH` (a `torsion` bench that is built already; otherwise `cargo bench --no-run` builds
one).

Rules
- One problem: the inertias, stiffnesses and dampings of `benches/torsion.rs`, the same torques and speeds.
- openTorsion's matrices and excitations are built outside its timing. Of its sweep only the calls of `ss_response` are timed, one per order with all
  speeds; Gudgeon's timing holds everything but the line itself. Python's own overhead is part of what a user of openTorsion waits for.
- The error of each is against exact solutions with 25 digits (mpmath), as largest relative deviation of the elastic frequencies, and of the angle of
  order 3 and the shaft torque of order 6 at 2100 rpm.
- A round runs each once (medians of many calls); the table holds medians over the rounds.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import time

import numpy as np
import opentorsion as ot

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


def theirs():
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


def build():
    command = ["cargo", "bench", "-p", "gudgeon-benches", "--bench", "torsion", "--no-run", "--message-format=json"]
    root = pathlib.Path(__file__).resolve().parent.parent
    text = subprocess.run(command, cwd=root, check=True, capture_output=True, text=True).stdout
    found = [json.loads(line) for line in text.splitlines() if line.startswith("{")]
    return [m["executable"] for m in found if m.get("executable") and m["target"]["name"] == "torsion"][-1]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--binary")
    args = parser.parse_args()
    binary = args.binary or build()
    pairs = []
    for _ in range(args.rounds):
        ours = json.loads(subprocess.run([binary, "--json"], check=True, capture_output=True, text=True).stdout)
        pairs.append((ours, theirs()))
    of = lambda f: statistics.median(f(o, t) for o, t in pairs)
    print(f"{'':>34} {'Gudgeon':>12} {'openTorsion':>12} {'times':>7}   errors")
    rows = [
        ("eigenvalues", lambda o: o["eigenvalues"]["seconds"], "eigenvalues", "error", "eigenvalue_error"),
        ("damped eigenvalues", lambda o: o["damped"]["seconds"] + o["eigenvalues_and_shapes"]["seconds"], "damped", None, None),
        ("401 speeds x 24 orders", lambda o: o["sweep"]["seconds"], "sweep", "error", "sweep_error"),
    ]
    for name, ours, key, _, error in rows:
        a, b = of(lambda o, t: ours(o)), of(lambda o, t: t[key])
        ratio = of(lambda o, t: t[key] / ours(o))
        group = {"eigenvalues": "eigenvalues", "sweep": "sweep"}.get(key)
        errors = f"{pairs[0][0][group]['error']:.1e} and {pairs[0][1][error]:.1e}" if error else ""
        print(f"{name:>34} {1e6 * a:>9.2f} us {1e6 * b:>9.1f} us {ratio:>7.0f}   {errors}")
    print("\nFree vibration of the compressor to 0.1 s: closed form, and the published Runge-Kutta scheme in the same program")
    closed = of(lambda o, t: o["closed_form"]["seconds"])
    print(f"{'closed form':>34} {1e6 * closed:>9.1f} us   no error but rounding")
    for k, row in enumerate(pairs[0][0]["runge_kutta"]):
        seconds = of(lambda o, t: o["runge_kutta"][k]["seconds"])
        print(f"{'Runge-Kutta, step %g s' % row['step']:>34} {1e6 * seconds:>9.1f} us   error {row['error']:.1e} rad/s, {seconds / closed:.0f} times the closed form")


if __name__ == "__main__":
    main()
