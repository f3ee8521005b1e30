"""Errors and cost of an integrator over forty ring packs that differ at random: the spread of docs/bench.md.

    python3 docs/bench/spread.py [--binary PATH] [--integrator NAME] [--packs N] [--oil] TOLERANCE...

varies speed, end gaps, stiffness of the contact and masses of the diesel of the README with flooded faces, or with oil on the liner, the same way every time, and prints for each
tolerance the median error, that of nine packs in ten, and the largest one against the Rosenbrock method of order 5 at 1e-5, as Markdown. Needs Python 3.9 or newer and, without
`--binary`, cargo.
"""

import argparse
import json
import pathlib
import random
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
CASE = ROOT / "cases/turbo-diesel-120.toml"
RESULTS = ("blow_by", "friction_power", "land2.p_max")
REFERENCE = ("solver.integrator=rodas5p", "solver.tolerance=1e-5", "solver.periodicity=1e-5")


def packs(count, oil):
    """Changes that make a pack, one after the other, with oil on the liner or without."""
    draw = random.Random(7).uniform
    for _ in range(count):
        yield [
            *([] if oil else ["models.oil_transport.model=off"]),
            f"engine.speed={draw(700, 2400):.1f} rpm",
            f"rings.0.cold_gap={draw(0.35, 0.8):.4f} mm",
            f"rings.1.cold_gap={draw(0.4, 0.9):.4f} mm",
            f"models.contact.composite_modulus={115 * draw(0.5, 2):.3f} GPa",
            f"rings.1.mass={37 * draw(0.5, 1.5):.3f} g",
            f"rings.0.mass={43 * draw(0.5, 1.5):.3f} g",
        ]


def run(command, changes):
    """Results, counters and the time of the search and its record [s]."""
    with tempfile.TemporaryDirectory() as out:
        sets = [word for change in changes for word in ("--set", change)]
        subprocess.run([*command, "run", str(CASE), "--threads", "1", "--out", out, *sets], cwd=ROOT, capture_output=True, check=True)
        summary = json.loads((pathlib.Path(out) / "summary.json").read_text())
        seconds = json.loads((pathlib.Path(out) / "timing.json").read_text())["seconds"]["solve"]
    return [summary["results"][name]["value"] for name in RESULTS], summary["solver"]["counters"], seconds


def spread(errors):
    """Median, that of nine in ten, largest."""
    errors = sorted(errors)
    return f"{statistics.median(errors):.1e}, {errors[int(0.9 * len(errors))]:.1e}, {errors[-1]:.1e}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--binary")
    parser.add_argument("--integrator", default="waveform")
    parser.add_argument("--packs", type=int, default=40)
    parser.add_argument("--oil", action="store_true")
    parser.add_argument("tolerances", nargs="+", metavar="TOLERANCE")
    given = parser.parse_args()
    command = [given.binary] if given.binary else ["cargo", "run", "--release", "--quiet", "--"]
    exact = [run(command, [*pack, *REFERENCE])[0] for pack in packs(given.packs, given.oil)]
    print("| tolerance | blow-by | friction | land 2 | cycles | steps a cycle | ms a run |\n|---:|---:|---:|---:|---:|---:|---:|")
    for tolerance in given.tolerances:
        own = [f"solver.integrator={given.integrator}", f"solver.tolerance={tolerance}", f"solver.periodicity={min(float(tolerance), 1e-3):g}"]
        runs = [run(command, [*pack, *own]) for pack in packs(given.packs, given.oil)]
        errors = [[abs(a / b - 1) for (a, b) in zip(results, there)] for (results, _, _), there in zip(runs, exact)]
        cycles = sum(counters["cycles"] for _, counters, _ in runs)
        steps = sum(counters["steps"] + counters["rejected"] for _, counters, _ in runs)
        parts = " | ".join(spread(each) for each in zip(*errors))
        time = 1e3 * sum(seconds for _, _, seconds in runs)
        print(f"| {tolerance} | {parts} | {cycles / given.packs:.1f} | {steps / cycles:.0f} | {time / given.packs:.1f} |", flush=True)


if __name__ == "__main__":
    main()
