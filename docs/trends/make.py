"""Tables of docs/trends.md: what inputs do to blow-by, friction and oil of the diesel of the README.

    python3 docs/trends/make.py [--binary PATH] [--out DIR]

runs the case 280 times (ten minutes on one core; runs whose folder is complete are not repeated) and prints what it finds as Markdown. `*` marks a run that is not
periodic, `fails` one that failed. Needs Python 3.9 or newer and, without `--binary`, cargo.
"""

import argparse
import csv
import json
import math
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
CASE = ROOT / "cases/turbo-diesel-120.toml"
FLOODED = "models.oil_transport.model=off"
FACES = {"here": [], "flooded": [FLOODED]}
GAS = ("narrow_channel", "namazian_heywood", "labyrinth", "gap_orifice", "orifice_network")
# Results, their digits and what they are called.
BLOW_BY, FMEP = ("blow_by", 1, "blow-by, l/min"), ("fmep", 3, "fmep, bar")
OIL_UP, LAND = ("oil_up", 2, "oil upwards, g/h"), ("land2.p_max", 1, "pressure of land 2, bar")


class Run:
    """What a run left; nothing if it failed."""

    def __init__(self, folder):
        self.folder = folder
        self.summary = json.loads((folder / "summary.json").read_text()) if (folder / "summary.json").exists() else None
        self.mark = "*" if self.summary and any(n["level"] == "failure" for n in self.summary["notes"]) else ""

    def value(self, name):
        """A result; flooded faces have no oil upwards."""
        return self.summary["results"].get(name, {"value": math.nan})["value"] if self.summary else math.nan

    def text(self, name, digits, _=""):
        return f"{self.value(name):.{digits}f}{self.mark}".replace("nan", "-") if self.summary else "fails"

    def steps(self):
        counters = self.summary["solver"]["counters"]
        return f"{counters['steps'] / counters['cycles'] / 10:.0f}0"

    def at(self, name, degrees):
        """A column of the series at a crank angle."""
        with open(self.folder / "series.csv", newline="") as file:
            head, *rows = csv.reader(file)
        column = [h.split("[")[0] for h in head].index(name)
        return float(min(rows, key=lambda row: abs(float(row[0]) - degrees))[column])


class Runs:
    """Runs of the case, each in a folder that its changes name."""

    def __init__(self, binary, out):
        self.command = [binary] if binary else ["cargo", "run", "--release", "--quiet", "--"]
        self.out = pathlib.Path(out)

    def get(self, *changes):
        folder = self.out / (re.sub(r"[^A-Za-z0-9_.]+", "-", " ".join(changes)).strip("-") or "as-it-ships")
        if not (folder / "summary.json").exists():
            args = [word for c in changes for word in ("--set", c)]
            subprocess.run([*self.command, "run", str(CASE), *args, "--out", str(folder), "-q"], cwd=ROOT, capture_output=True)
        return Run(folder)

    def over(self, changes, values, *results):
        """Results over values; a value is the changes that set it."""
        found = [self.get(*changes, *value) for value in values]
        return "; ".join(" / ".join(r.text(*result) for r in found) for result in results)


def oil(viscosity):
    return [f'models.oil={{model="constant",viscosity="{viscosity} mPa s"}}']


def gas(model):
    return [f"models.gas_flow.model={model}"]


def fill(part):
    return [f"rings.{i}.groove.oil_fill={part}" for i in range(3)]


def to(path, unit):
    return lambda value: [f"{path}={value} {unit}"]


# Input, unit, values, what sets one; results, with which faces.
OILS, FILLS = (1.5, 5, 15, 50), (0, 0.1, 0.3, 0.6, 1)
INPUTS = [
    ("viscosity of all oil", "mPa s", (0.5, 1, 1.5, 2, 5, 15, 50), oil, [FMEP], FACES),
    ("liner temperature at top dead centre", "degC", (120, 150, 180, 210), to("models.film_temperature.tdc", "degC"), [FMEP], FACES),
    ("tension of the oil ring", "N", (30, 60, 90), to("rings.2.tangential_force", "N"), [FMEP, OIL_UP], FACES),
    ("cold gap of the top ring", "mm", (0.35, 0.45, 0.55, 0.65), to("rings.0.cold_gap", "mm"), [BLOW_BY], FACES),
    ("cold gap of the second ring", "mm", (0.55, 0.70, 0.85, 1.00), to("rings.1.cold_gap", "mm"), [LAND, BLOW_BY, OIL_UP], FACES),
    ("burn pressure", "bar", (80, 194), to("models.cylinder_pressure.burn_pressure", "bar"), [FMEP], FACES),
    ("speed", "rpm", (1000, 1400, 2000, 2600, 3000), to("engine.speed", "rpm"), [FMEP, BLOW_BY], FACES),
    ("supply of oil to the liner", "um", (1, 3, 10, 20, 50), to("models.oil_transport.supply", "um"), [OIL_UP, FMEP], ["here"]),
]
RAILS = ["rings.2.design=three_piece", "rings.2.height=0.6 mm", "rings.2.width=3.0 mm"]
GROOVES = {
    "vented": [],
    "12 holes of 3 mm": ['rings.2.groove.drain={holes=12,diameter="3 mm"}'],
    "4 holes of 1 mm": ['rings.2.groove.drain={holes=4,diameter="1 mm"}'],
    "closed": ["rings.2.groove.vented=false"],
    "three-piece": [*RAILS, 'rings.2.expander={mass="14 g",height="2.75 mm",ear_angle="15 deg"}'],
    "three-piece, ears of 30 deg": [*RAILS, 'rings.2.expander={mass="14 g",height="2.75 mm",ear_angle="30 deg"}'],
}
STILL, DRY = "models.ring_motion.film_force=false", "models.flank.model=dry"
LEFT_OUT = {"nothing": [], "rings that move (`seated`)": ["models.ring_motion.model=seated"], "`film_force`": [STILL], "`film_force`, oil on the flanks": [STILL, DRY]}


def table(head, rows):
    print("\n".join("| " + " | ".join(row) + " |" for row in (head, ["---"] * len(head), *rows)) + "\n")


def inputs(runs):
    swept = [(f"viscosity of all oil, `{g}`", "mPa s", OILS, oil, [BLOW_BY], FACES, gas(g)) for g in GAS]
    swept += [(f"oil on the flanks, `{g}`", "", FILLS, fill, [BLOW_BY], FACES, gas(g)) for g in GAS]
    rows = []
    for what, unit, values, how, results, faces, *changes in swept + INPUTS:
        cells = [runs.over([*FACES[f], *sum(changes, [])], map(how, values), *results) if f in faces else "" for f in FACES]
        rows.append([what, f"{' / '.join(map(str, values))} {unit}", "; ".join(r[2] for r in results), *cells])
    table(["input", "values", "result", *FACES], rows)
    for name, faces in FACES.items():
        f = [runs.get(*faces, *oil(v)).value("fmep") for v in OILS[1:]]
        print(f"powers of fmep over viscosity, {name}: {math.log(f[1] / f[0], 3):.2f} from 5 to 15, {math.log(f[2] / f[1], 50 / 15):.2f} from 15 to 50 mPa s\n")


def flanks(runs):
    rows = [[f"`{g}`", *(runs.over([*f, *gas(g), "models.flank.model=squeeze_film"], map(oil, OILS), BLOW_BY) for f in FACES.values())] for g in GAS]
    table(["blow-by with `squeeze_film` over 1.5 / 5 / 15 / 50 mPa s", *FACES], rows)
    rows = [[f"`{g}`", *(runs.over([*gas(g), *c], map(oil, OILS), ("blow_by", 2)) for c in LEFT_OUT.values())] for g in GAS]
    table(["blow-by here over 1.5 / 5 / 15 / 50 mPa s, left out:", *LEFT_OUT], rows)
    for g in ("labyrinth", "namazian_heywood"):
        found = [runs.get(*gas(g), *oil(v)) for v in OILS]
        back = [1e6 * (r.at("ring1.cumulative_mass", 490) - r.at("ring1.cumulative_mass", 494)) for r in found]
        told = zip([r.at("land2.p", 504) / 1e5 for r in found], back, [r.value("ring1.lift_angle") for r in found])
        print(f"`{g}`: " + " / ".join(f"{p:.2f} bar in land 2 at 504 deg, {m:.2f} mg back past ring 1 from 490 to 494 deg, it leaves at {a:.2f} deg" for p, m, a in told) + "\n")


def friction(runs):
    for changes in ([], ["engine.speed=1000 rpm"], ["engine.speed=2600 rpm"], ["rings.2.tangential_force=90 N"], [FLOODED]):
        run = runs.get(*changes)
        print(f"friction of rings 1 / 2 / 3, {' '.join(changes) or 'here'}: {' / '.join(run.text(f'ring{i}.friction_power', 0) for i in (1, 2, 3))} W\n")


def oil_ring(runs):
    rows = []
    for name, changes in GROOVES.items():
        run = runs.get(FLOODED, *changes)
        columns = [run.text(*r) for r in (("land3.p_max", 2), ("ring3.lifted_share", 2), ("ring3.seat_changes", 0), FMEP)]
        rows.append([name, run.text(*BLOW_BY), runs.over([FLOODED, *changes], map(oil, OILS), BLOW_BY), *columns, run.steps()])
    table(["groove of ring 3", "blow-by, l/min", "over 1.5 / 5 / 15 / 50 mPa s", "land 3, bar", "off", "arrivals", "fmep, bar", "steps a cycle"], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--binary", help="a gudgeon program that is built already")
    parser.add_argument("--out", default=str(ROOT / "out/trends"), help="folder of the runs")
    args = parser.parse_args()
    runs = Runs(args.binary and str(pathlib.Path(args.binary).resolve()), args.out)
    for part in (inputs, flanks, friction, oil_ring):
        part(runs)


if __name__ == "__main__":
    main()
