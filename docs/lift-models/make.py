"""Tables and figures of docs/lift-models.md: the diesel of the README with three models of the motion of its rings.

    python3 docs/lift-models/make.py [--binary PATH] [--out DIR]

runs the case 87 times (ten minutes on one core; runs whose folder is complete are not repeated), prints the tables, and writes the figures beside this file.
Needs Python 3.9 or newer and, without `--binary`, cargo.
"""

import argparse
import csv
import json
import pathlib
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
CASE = ROOT / "cases/turbo-diesel-120.toml"
MODELS = ("newton_groove", "seated", "three_seat")
OIL = {"flooded": "off", "starved": "liner_film"}
COLOURS = {"newton_groove": "#1b6ca8", "seated": "#7a7a7a", "three_seat": "#c2410c"}
SPEEDS = (1000, 1400, 1800, 2000, 2200, 2600, 3000)
BURN = (40, 80, 120, 160, 194)


class Runs:
    """Runs of the case, each in a folder of its own."""

    def __init__(self, binary, out):
        self.command = [binary] if binary else ["cargo", "run", "--release", "--quiet", "--"]
        self.out = pathlib.Path(out)

    def get(self, name, motion, oil, *changes):
        """Results and notes of a run; `None` for the results of one that was not periodic is told by the mark."""
        folder = self.out / name
        if not (folder / "summary.json").exists():
            sets = [f"models.ring_motion.model={motion}", f"models.oil_transport.model={OIL[oil]}", *changes]
            args = [word for s in sets for word in ("--set", s)]
            subprocess.run([*self.command, "run", str(CASE), *args, "--out", str(folder), "-q"], cwd=ROOT, capture_output=True)
        return Run(folder)


class Run:
    """What a run left."""

    def __init__(self, folder):
        self.summary = json.loads((folder / "summary.json").read_text())
        self.folder = folder
        # Runs that did not become periodic are marked.
        self.mark = "*" if any(n["level"] == "failure" for n in self.summary["notes"]) else ""

    def value(self, name):
        return self.summary["results"][name]["value"]

    def series(self):
        with open(self.folder / "series.csv", newline="") as file:
            rows = list(csv.reader(file))
        columns = list(zip(*[[float(x) for x in row] for row in rows[1:]]))
        return {name.split("[")[0]: column for name, column in zip(rows[0], columns)}


def text(run, name, digits):
    return f"{run.value(name):.{digits}f}{run.mark}"


def states(run, ring):
    """Gas past a ring [mg/cycle], upwards and downwards together, while it is on its lower flank, off both, and on its upper flank."""
    s = run.series()
    mass, at = s[f"ring{ring}.cumulative_mass"], s[f"ring{ring}.position"]
    parts = [0.0, 0.0, 0.0]
    for k in range(1, len(mass)):
        middle = 0.5 * (at[k] + at[k - 1])
        parts[0 if middle < 0.05 else 2 if middle > 0.95 else 1] += 1e6 * (mass[k] - mass[k - 1])
    return parts


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|---" * len(head) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def as_it_stands(runs):
    rows = []
    for oil in OIL:
        for motion in MODELS:
            r = runs.get(f"{oil}-{motion}", motion, oil)
            lifted = " / ".join(f"{r.value(f'ring{i}.lifted_share'):.2f}" for i in (1, 2, 3))
            changes = " / ".join(f"{r.value(f'ring{i}.seat_changes'):.0f}" for i in (1, 2, 3))
            past = " / ".join(f"{m:.1f}" for m in states(r, 2))
            rows.append([oil, f"`{motion}`", text(r, "blow_by", 1), text(r, "fmep", 3), text(r, "land2.p_max", 1), text(r, "land3.p_max", 1), lifted, changes, past])
    table(["faces", "model", "blow-by, l/min", "fmep, bar", "land 2, bar", "land 3, bar", "off the lower flank", "arrivals", "gas past ring 2, mg"], rows)


def over(runs, path, values, unit, label):
    rows = []
    for oil in OIL:
        for motion in MODELS:
            found = [runs.get(f"{label}-{v}-{oil}-{motion}", motion, oil, f"{path}={v} {unit}") for v in values]
            rows.append([oil, f"`{motion}`", *(f"{text(r, 'blow_by', 1)}, {text(r, 'fmep', 3)}, {r.value('ring2.lifted_share'):.2f}" for r in found)])
    table(["faces", "model", *(f"{v} {unit}" for v in values)], rows)


STEPS = [
    ("`newton_groove`", "newton_groove", []),
    ("nothing on the flanks resists", "newton_groove", ["models.flank.model=dry", "models.flank.gas_viscosity=0"]),
    ("the same, lands at 12 bar at the start", "newton_groove", ["models.flank.model=dry", "models.flank.gas_viscosity=0", 'solver.starts=["12 bar"]']),
    ("`three_seat`", "three_seat", []),
    ("never half-way (`band = 0`)", "three_seat", ["models.ring_motion.band=0"]),
    ("decided every 0.1 deg", "three_seat", ["models.ring_motion.interval=0.1 deg"]),
    ("both", "three_seat", ["models.ring_motion.band=0", "models.ring_motion.interval=0.1 deg"]),
    ("dry flanks", "three_seat", ["models.flank.model=dry"]),
    ("`seated`", "seated", []),
]


def steps(runs):
    rows = []
    for k, (what, motion, changes) in enumerate(STEPS):
        r = runs.get(f"step-{k}", motion, "flooded", *changes)
        lifted = " / ".join(f"{r.value(f'ring{i}.lifted_share'):.2f}" for i in (1, 2, 3))
        rows.append([what, text(r, "blow_by", 1), text(r, "fmep", 3), text(r, "land2.p_max", 1), lifted])
    table(["flooded", "blow-by, l/min", "fmep, bar", "land 2, bar", "off the lower flank"], rows)


class Panel:
    """One diagram of a figure."""

    def __init__(self, x, y, width, height, xs, ys, title):
        self.x, self.y, self.width, self.height, self.xs, self.ys = x, y, width, height, xs, ys
        self.parts = [
            f'<rect x="{x}" y="{y}" width="{width}" height="{height}" fill="none" stroke="black"/>',
            f'<text x="{x}" y="{y - 8}" font-weight="bold">{title}</text>',
        ]
        for v in xs[2]:
            self.parts.append(f'<text x="{self.at_x(v):.1f}" y="{y + height + 15}" text-anchor="middle">{v:g}</text>')
        for v in ys[2]:
            self.parts.append(f'<line x1="{x}" x2="{x + width}" y1="{self.at_y(v):.1f}" y2="{self.at_y(v):.1f}" stroke="#dddddd"/>')
            self.parts.append(f'<text x="{x - 5}" y="{self.at_y(v) + 4:.1f}" text-anchor="end">{v:g}</text>')

    def at_x(self, v):
        return self.x + self.width * (v - self.xs[0]) / (self.xs[1] - self.xs[0])

    def at_y(self, v):
        return self.y + self.height * (1 - (v - self.ys[0]) / (self.ys[1] - self.ys[0]))

    def line(self, xs, ys, colour, dash="", dots=False):
        points = [(self.at_x(a), self.at_y(b)) for a, b in zip(xs, ys) if self.xs[0] <= a <= self.xs[1]]
        path = " ".join(f"{a:.1f},{b:.1f}" for a, b in points)
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.4" stroke-dasharray="{dash}"/>')
        if dots:
            self.parts += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="2.6" fill="{colour}"/>' for a, b in points]


def figure(path, width, height, panels, legend):
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">', '<rect width="100%" height="100%" fill="white"/>']
    for p in panels:
        parts += p.parts
    for k, (name, colour, dash) in enumerate(legend):
        x = 60 + 150 * k
        parts.append(f'<line x1="{x}" x2="{x + 24}" y1="{height - 12}" y2="{height - 12}" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash}"/>')
        parts.append(f'<text x="{x + 30}" y="{height - 8}">{name}</text>')
    path.write_text("\n".join([*parts, "</svg>"]) + "\n")


def draw_cycle(runs):
    angles = (0, 720, range(0, 721, 90))
    panels = [
        Panel(60, 30, 660, 130, angles, (0, 12, (0, 3, 6, 9, 12)), "Pressure of land 2 [bar]"),
        Panel(60, 200, 660, 130, angles, (0, 5, range(6)), "Pressure of land 3 [bar]"),
        Panel(60, 370, 660, 90, angles, (0, 1, (0, 0.5, 1)), "Ring 2 in its groove: 0 on the lower flank, 1 on the upper one"),
        Panel(60, 500, 660, 90, angles, (0, 1, (0, 0.5, 1)), "Ring 3 in its groove"),
        Panel(60, 630, 660, 130, angles, (0, 18, (0, 6, 12, 18)), "Gas past ring 2 since 0 deg [mg]; crank angle [deg]"),
    ]
    for motion in MODELS:
        s = runs.get(f"flooded-{motion}", motion, "flooded").series()
        x, colour = s["theta"], COLOURS[motion]
        panels[0].line(x, [p / 1e5 for p in s["land2.p"]], colour)
        panels[1].line(x, [p / 1e5 for p in s["land3.p"]], colour)
        panels[2].line(x, s["ring2.position"], colour)
        panels[3].line(x, s["ring3.position"], colour)
        panels[4].line(x, [1e6 * m for m in s["ring2.cumulative_mass"]], colour)
    figure(HERE / "cycle.svg", 760, 810, panels, [(m, COLOURS[m], "") for m in MODELS])


def draw_speeds(runs):
    axis = (900, 3100, (1000, 1500, 2000, 2500, 3000))
    panels = [
        Panel(60, 30, 290, 230, axis, (20, 120, range(20, 121, 20)), "Blow-by [l/min] over speed [rpm]"),
        Panel(430, 30, 290, 230, axis, (0.1, 0.3, (0.1, 0.15, 0.2, 0.25, 0.3)), "Friction mean effective pressure [bar]"),
    ]
    for oil, dash in (("flooded", ""), ("starved", "4 3")):
        for motion in MODELS:
            found = [runs.get(f"speed-{v}-{oil}-{motion}", motion, oil, f"engine.speed={v} rpm") for v in SPEEDS]
            for panel, name in zip(panels, ("blow_by", "fmep")):
                panel.line(SPEEDS, [r.value(name) for r in found], COLOURS[motion], dash, dots=not dash)
    figure(HERE / "speed.svg", 760, 310, panels, [*((m, COLOURS[m], "") for m in MODELS), ("starved: dashed", "black", "4 3")])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--binary", help="a gudgeon program that is built already")
    parser.add_argument("--out", default=str(ROOT / "out/lift-models"))
    args = parser.parse_args()
    runs = Runs(args.binary and str(pathlib.Path(args.binary).resolve()), args.out)
    as_it_stands(runs)
    steps(runs)
    over(runs, "engine.speed", SPEEDS, "rpm", "speed")
    over(runs, "models.cylinder_pressure.burn_pressure", BURN, "bar", "burn")
    draw_cycle(runs)
    draw_speeds(runs)


if __name__ == "__main__":
    main()
