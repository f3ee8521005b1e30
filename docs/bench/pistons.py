"""Pistons that differ at random and the way to their periodic motion: the table of docs/bench.md.

    python3 docs/bench/pistons.py [--binary PATH] [--pistons N] [CASE...]

varies speed, viscosity and clearance of each case from half to twice, lengths, masses and inertia by a quarter and the offset of the centre of gravity from a twentieth to twice, the same
way every time, and prints how many motions are not periodic, and the cycles of the searches, as Markdown. Needs Python 3.11 or newer and, without `--binary`, cargo.
"""

import argparse
import concurrent.futures
import functools
import json
import os
import pathlib
import random
import subprocess
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
WIDE = ("engine.speed", "models.oil.viscosity", "skirt.clearance")
NARROW = ("piston.mass", "piston.pin_mass", "piston.inertia", "skirt.length")
OFFSET = "piston.gravity_offset"


def value(case, path):
    """Number and unit at a path of a case."""
    for key in path.split("."):
        case = case[key]
    number, unit = case.split(" ", 1)
    return float(number), unit


def pistons(case, count):
    """Changes that make a piston, one after the other."""
    draw = random.Random(7).uniform
    for _ in range(count):
        factors = {path: 2 ** draw(-1, 1) for path in WIDE}
        factors |= {path: 1.25 ** draw(-1, 1) for path in NARROW}
        factors[OFFSET] = draw(0.05, 2)
        values = {path: value(case, path) for path in factors}
        yield [f"{path}={values[path][0] * factor:.6g} {values[path][1]}" for path, factor in factors.items()]


def run(command, case, changes):
    """Whether the motion is periodic, and the cycles of the search."""
    with tempfile.TemporaryDirectory() as out:
        sets = [word for change in changes for word in ("--set", change)]
        subprocess.run([*command, "run", str(case), "--quiet", "--threads", "1", "--out", out, *sets], cwd=ROOT, capture_output=True)
        summary = json.loads((pathlib.Path(out) / "summary.json").read_text())
    periodic = all(note["topic"] != "not_periodic" or note["level"] != "failure" for note in summary["notes"])
    return periodic, summary["solver"]["counters"]["cycles"]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--binary")
    parser.add_argument("--pistons", type=int, default=400)
    parser.add_argument("cases", nargs="*", metavar="CASE", default=["zhu-motored-1000", "ea111-1400"])
    given = parser.parse_args()
    command = [given.binary] if given.binary else ["cargo", "run", "--release", "--quiet", "--"]
    print("| case | pistons | not periodic | cycles: half, nine in ten, all |\n|---|---:|---:|---:|")
    for name in given.cases:
        path = ROOT / f"cases/{name}.toml"
        case = tomllib.loads(path.read_text())
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            runs = list(pool.map(functools.partial(run, command, path), pistons(case, given.pistons)))
        cycles = sorted(cycles for _, cycles in runs)
        lost = sum(not periodic for periodic, _ in runs)
        print(f"| `{name}` | {len(runs)} | {lost} | {cycles[len(cycles) // 2]}, {cycles[len(cycles) * 9 // 10]}, {sum(cycles)} |")


if __name__ == "__main__":
    main()
