"""Steps and cycles of a ring pack over speed, stiffness of the contact, mass and number of rings: the tables of docs/bench.md.

    python3 docs/bench/steps.py [--binary PATH] [--integrator NAME] [--tolerance T] [--oil off|liner_film]

runs the diesel of the README at six speeds, three moduli of contact and three masses of the rings, and packs of three to ten rings made of its second one, and prints
Markdown. Cycles and steps are those of the whole pack, times also those of the cycles in halves that lead there. Needs Python 3.9 or newer and, without `--binary`, cargo.
"""

import argparse
import json
import pathlib
import re
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
CASE = ROOT / "cases/turbo-diesel-120.toml"
SPEEDS = (1000, 2000, 3000, 4000, 5000, 6000)
FACTORS = (1 / 3, 1, 3)
# Modulus [GPa] and masses [g] of the case.
MODULUS, MASSES = 115.0, (43.0, 37.0, 44.0)


def run(command, case, changes):
    """Counters of a run, and whether a note calls it a failure; nothing if it stopped."""
    with tempfile.TemporaryDirectory() as out:
        sets = [word for change in changes for word in ("--set", change)]
        done = subprocess.run([*command, "run", str(case), "--threads", "1", "--out", out, *sets], cwd=ROOT, capture_output=True, text=True)
        if done.returncode not in (0, 1):
            print(done.stderr)
        path = pathlib.Path(out) / "summary.json"
        if not path.exists():
            return None
        summary = json.loads(path.read_text())
        counters = summary["solver"]["counters"]
        counters["failed"] = any(n["level"] == "failure" for n in summary["notes"])
        # Results say nothing of time, which differs from run to run; the terminal does.
        counters["seconds"] = float(re.search(r"implicit: .*, ([0-9.e-]+) s", done.stdout)[1])
        return counters


def attempts(counters):
    """Steps a cycle, rejected ones included."""
    return (counters["steps"] + counters["rejected"]) / counters["cycles"]


def operating_points(command, common):
    """Attempts a cycle, and cycles, over speed (rows) and modulus times mass (columns)."""
    pairs = [(e, m) for e in FACTORS for m in FACTORS]
    print("| rpm | " + " | ".join(f"E x{e:.2g}, m x{m:.2g}" for e, m in pairs) + " |")
    print("|---:|" + "---:|" * len(pairs))
    seen, cycles = [], []
    for speed in SPEEDS:
        cells = []
        for e, m in pairs:
            masses = [f"rings.{i}.mass={mass * m:.4f} g" for i, mass in enumerate(MASSES)]
            changes = [*common, f"engine.speed={speed} rpm", f"models.contact.composite_modulus={MODULUS * e:.4f} GPa", *masses]
            counters = run(command, CASE, changes)
            if counters is None:
                cells.append("fails")
                continue
            seen.append(attempts(counters))
            cycles.append(counters["cycles"])
            cells.append(f"{seen[-1]:.0f} ({cycles[-1]}{'*' if counters['failed'] else ''})")
        print(f"| {speed} | " + " | ".join(cells) + " |", flush=True)
    middle = statistics.median(seen)
    print(f"\nSteps a cycle: median {middle:.0f}, largest {max(seen):.0f}, {max(seen) / middle:.2f} times the median. "
          f"Cycles: median {statistics.median(cycles):.0f}, most {max(cycles)}.\n")


def pack_of(rings):
    """The case with `rings` rings: the second one and the land below it repeated."""
    # The liner goes on below the last height that the case gives.
    text = CASE.read_text().replace('position = "-130 mm"', 'position = "-230 mm"')
    lands = text.split("[[piston.lands]]")
    head, body = lands[0], lands[1:]
    last, after = body[-1].split("\n\n", 1)
    tail = after.split("[[rings]]")
    parts = [head + "[[piston.lands]]" + body[0]]
    parts += ["[[piston.lands]]" + body[1]] * (rings - 2) + ["[[piston.lands]]" + last + "\n\n" + tail[0]]
    return "".join(parts) + "[[rings]]" + tail[1] + ("[[rings]]" + tail[2]) * (rings - 2) + "[[rings]]" + tail[3]


def numbers_of_rings(command, common):
    """Cost a ring."""
    print("| rings | steps a cycle | cycles | right-hand sides a cycle | ms a cycle and ring | us a step and ring |\n|---:|---:|---:|---:|---:|---:|")
    for rings in (3, 4, 6, 8, 10):
        with tempfile.TemporaryDirectory() as folder:
            case = pathlib.Path(folder) / "rings.toml"
            case.write_text(pack_of(rings))
            counters = run(command, case, common)
        if counters is None:
            print(f"| {rings} | fails |")
            continue
        per = counters["seconds"] / counters["cycles"] / rings
        print(f"| {rings} | {attempts(counters):.0f} | {counters['cycles']} | {counters['rhs'] / counters['cycles']:.0f} | {1e3 * per:.2f} "
              f"| {1e6 * per / attempts(counters):.1f} |", flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--binary")
    parser.add_argument("--integrator", default="rodas3")
    parser.add_argument("--tolerance", default="3e-3")
    parser.add_argument("--oil", default="off", choices=("off", "liner_film"))
    given = parser.parse_args()
    command = [given.binary] if given.binary else ["cargo", "run", "--release", "--quiet", "--"]
    common = [f"models.oil_transport.model={given.oil}", f"solver.integrator={given.integrator}",
              f"solver.tolerance={given.tolerance}", f"solver.periodicity={given.tolerance}"]
    operating_points(command, common)
    numbers_of_rings(command, common)


if __name__ == "__main__":
    main()
