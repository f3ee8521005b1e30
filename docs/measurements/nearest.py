"""Which model is nearest to each measurement of docs/measurements.md: its models swapped one kind at a time by `gudgeon compare`.

    python3 docs/measurements/nearest.py [--binary PATH] [--out DIR] [SET...]

prints a table for each set of data (all without SET) and the commands that gave it. A comparison whose folder is complete is not repeated. Needs Python 3.9 or newer and,
without `--binary`, cargo. All of it takes about an hour on one core.
"""

import argparse
import json
import math
import pathlib
import shlex
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def summits(model, roughness, slope, more=""):
    return f'{{ model = "{model}", roughness = "{roughness}", composite_modulus = "115 GPa", eta_beta_sigma = 0.05, sigma_over_beta = {slope}{more} }}'


def contacts(roughness, slope):
    """Contact models that the data of the case are enough for: the same roughness, summits and coefficient of friction."""
    hard = ', hardness = "2 GPa"'
    threshold = f'{{ model = "roughness_threshold", roughness = "{roughness}", friction_coefficient = 0.1 }}'
    rough = [summits(m, roughness, slope) for m in ("greenwood_tripp", "greenwood_williamson", "load_sharing")]
    return [*rough, summits("kogut_etsion", roughness, slope, hard), threshold]


FILMS = ["closed_form_face", *(f'{{ model = "closed_form_face", cavitation = "{c}" }}' for c in ("swift_stieber", "half_sommerfeld")), "gridded_face"]
GAS = ["narrow_channel", "orifice_network", "gap_orifice", "labyrinth", "namazian_heywood"]
FLANKS = ["wetted_strip", "squeeze_film", "dry"]
MOTIONS = ["newton_groove", "seated", "three_seat"]
OIL = ["off", "liner_film"]
FLOODED = ["models.oil_transport.model=off"]


class Compare:
    """Comparisons of points, each in a folder of its own."""

    def __init__(self, binary, out):
        self.command = [binary] if binary else ["cargo", "run", "--release", "--quiet", "--"]
        self.out = pathlib.Path(out)

    def run(self, name, points, swap, values, sets):
        """Results of every value at every point: `{value: [results or None]}`."""
        folder = self.out / name / swap.replace(".", "-")
        args = ["compare", *points, *(w for s in sets for w in ("--set", s)), "--swap", f"{swap}={','.join(values)}"]
        if not (folder / "comparison.json").exists():
            subprocess.run([*self.command, *args, "--out", str(folder), "-q"], cwd=ROOT, capture_output=True)
        found = json.loads((folder / "comparison.json").read_text())
        table = {v: [None] * len(points) for v in values}
        for number, variant in enumerate(found["variants"]):
            run = variant["run"]
            periodic = run and not any(n["level"] == "failure" for n in run["notes"])
            results = {k: r["value"] for k, r in run["results"].items()} if periodic else None
            table[values[number % len(values)]][variant["case"]] = results
        shown = points if len(points) < 4 else [points[0], f"... ({len(points)} points)"]
        print("    gudgeon", " ".join(a if a.startswith("...") else shlex.quote(a) for a in ["compare", *shown, *args[1 + len(points):]]))
        return table


def short(value):
    """The name of a model, with what sets it apart."""
    if "{" not in value:
        return f"`{value}`"
    words = value.strip("{ }").split(", ")
    name = words[0].split('"')[1]
    cavitation = [w.split('"')[1] for w in words if w.startswith("cavitation")]
    return f"`{name}`, `{cavitation[0]}`" if cavitation else f"`{name}`"


def changed(case, *changes):
    """The case with changes; a comma within a value is protected by braces or brackets."""
    return ",".join([f"cases/{case}.toml", *changes])


class Set:
    """One set of data: points, the kinds that are swapped, and what is told of each."""

    def __init__(self, points, kinds, head, tell):
        self.points, self.kinds, self.head, self.tell = points, kinds, head, tell

    def table(self, name, compare):
        rows = []
        for swap, (values, sets) in self.kinds.items():
            for value, results in compare.run(name, self.points, swap, values, sets).items():
                rows.append([f"`{swap}`", short(value), *self.tell(results)])
        print()
        print("| swapped | model | " + " | ".join(self.head) + " |")
        print("|---" * (2 + len(self.head)) + "|")
        for row in rows:
            print("| " + " | ".join(row) + " |")
        print()


def percent(x):
    return "-" if math.isnan(x) else f"{100 * x:+.0f} %"


def held(right):
    """How many of some signs are right; `None` where a run is missing."""
    known = [r for r in right if r is not None]
    return f"{sum(known)} of {len(known)}" if known else "-"


def over_measured(result, measured):
    """Ratios to measured values, their mean and their rms distance from 1."""

    def tell(results):
        ratios = [r[result] / m if r else None for r, m in zip(results, measured)]
        known = [x for x in ratios if x is not None]
        cells = [" / ".join("-" if x is None else f"{x:.2f}" for x in ratios)]
        if not known:
            return [*cells, "-", "-"]
        rms = math.sqrt(sum((x - 1) ** 2 for x in known) / len(known))
        return [*cells, f"{sum(known) / len(known):.2f}", percent(rms).lstrip("+")]

    return tell


def motored():
    torque = {1000: 2.1, 2000: 3.2, 3000: 2.9, 4000: 2.3, 5000: 2.4, 5600: 3.7}
    measured = [t * n * math.pi / 30 / 4 for n, t in torque.items()]
    kinds = {"contact": (contacts("0.3 um", "1e-3"), []), "hydrodynamics": (FILMS, FLOODED), "ring_motion": (MOTIONS, []), "flank": (FLANKS, []), "gas_flow": (GAS, []), "oil_transport": (OIL, [])}
    points = [changed("motored-rings-1600", f"engine.speed={n} rpm") for n in torque]
    return Set(points, kinds, ["power over measured, 1000 / 2000 / 3000 / 4000 / 5000 / 5600 rpm", "mean", "rms distance from 1"], over_measured("friction_power", measured))


def engines():
    points = [changed("turbo-diesel-140"), changed("alcohol-2000-5600")]
    kinds = {"gas_flow": (GAS, []), "ring_motion": (MOTIONS, []), "flank": (FLANKS, []), "contact": (contacts("0.3 um", "1e-3"), []), "hydrodynamics": (FILMS, FLOODED)}
    return Set(points, kinds, ["blow-by over measured, diesel / alcohol engine", "mean", "rms distance from 1"], over_measured("blow_by", [87.2, 20.0]))


def ring_on_liner():
    oils, speeds, forces = (14.7, 24.1, 39.6, 65.1, 107.1), (135, 267, 402), (84, 174, 342)
    grid = [(o, n, f) for o in oils for n in speeds for f in forces]
    points = [changed("ring-on-liner", f"models.oil.viscosity={o} mPa s", f"engine.speed={n} rpm", f"rings.0.tangential_force={f} N") for o, n, f in grid]

    def tell(results):
        if any(r is None for r in results):
            return [f"{sum(r is None for r in results)} of 45 not run", "", "", "", ""]
        film = dict(zip(grid, (r["ring1.h_max"] for r in results)))
        # Friction power over load (2 pi times the tangential force) and mean speed (twice the stroke of 100 mm a revolution).
        friction = {p: r["friction_power"] / (2 * math.pi * p[2] * 0.2 * p[1] / 60) for p, r in zip(grid, results)}
        load = sum(friction[o, n, b] > friction[o, n, a] for o in oils for n in speeds for a, b in zip(forces, forces[1:]))
        speed = sum(friction[o, b, f] < friction[o, a, f] for o in oils for f in forces for a, b in zip(speeds, speeds[1:]))
        films, coefficients = film.values(), friction.values()
        return [
            str(load),
            str(speed),
            f"{sum(0.5 <= h <= 4 for h in films)}, {min(films):.2f} to {max(films):.2f} um",
            f"{max(films) / min(films):.1f}",
            f"{sum(0.02 <= c <= 0.1 for c in coefficients)}, {min(coefficients):.3f} to {max(coefficients):.3f}",
        ]

    kinds = {"contact": ([*contacts("0.8 um", "1e-2"), "off"], []), "hydrodynamics": (FILMS, [])}
    return Set(points, kinds, ["signs over load, of 30", "signs over speed, of 30", "films in range, of 45", "their span (measured: 8)", "coefficients in range, of 45"], tell)


def trends():
    case = "turbo-diesel-120"
    warm = [(120, 50), (140, 70), (160, 90), (180, 110), (200, 130)]
    speeds = (1000, 1400, 2000, 2600, 3200)
    thin = (1.7, 5.1, 17)
    points = [changed(case, f"models.film_temperature.tdc={a} degC", f"models.film_temperature.bdc={b} degC") for a, b in warm]
    points += [changed(case, f"engine.speed={n} rpm") for n in speeds]
    points += [changed(case, f'models.oil={{ model = "constant", viscosity = "{v} mPa s" }}') for v in thin]

    def tell(results):
        f = [r["fmep"] if r else math.nan for r in results]
        temperature, speed, oil = f[:5], f[5:10], f[10:]
        falls = held([None if math.isnan(a + b) else b < a for a, b in zip(temperature, temperature[1:])])
        powers = [math.log(b / a) / math.log(n / m) for a, b, m, n in zip(speed, speed[1:], speeds, speeds[1:])]
        right = held([None if math.isnan(p) else 0 < p < 1 for p in powers])
        least = held([None if math.isnan(a + oil[1]) else a > oil[1] for a in (oil[0], oil[2])])
        told = ["-" if math.isnan(p) else f"{p:.2f}" for p in powers], ["-" if math.isnan(x) else f"{x:.3f}" for x in oil]
        return [falls, f"{right} ({' / '.join(told[0])})", f"{least} ({' / '.join(told[1])})"]

    kinds = {"contact": (contacts("0.3 um", "1e-3"), []), "hydrodynamics": (FILMS, FLOODED), "ring_motion": (MOTIONS[:2], []), "flank": (FLANKS, []), "gas_flow": (GAS, []), "oil_transport": (OIL, [])}
    head = ["falls with the oil temperature", "rises less than the speed (powers)", "least between 1.7 and 17 mPa s (at 1.7 / 5.1 / 17, bar)"]
    return Set(points, kinds, head, tell)


def low_friction():
    points = [changed("turbo-diesel-140", *c) for c in ([], ["rings.2.tangential_force=36 N"], ["rings.0.face.offset=-0.6 mm"], ["rings.2.tangential_force=36 N", "rings.0.face.offset=-0.6 mm"])]

    def tell(results):
        f = [r["fmep"] if r else math.nan for r in results]
        gas = [r["blow_by"] if r else math.nan for r in results]
        share = [results[0][f"ring{i}.fmep"] / f[0] if results[0] else math.nan for i in (1, 2, 3)]
        return [f"{percent(f[1] / f[0] - 1)}, {percent(f[2] / f[0] - 1)}, {percent(f[3] / f[0] - 1)}", percent(gas[3] / gas[0] - 1), " / ".join("-" if math.isnan(x) else f"{x:.2f}" for x in share)]

    kinds = {"contact": (contacts("0.3 um", "1e-3"), []), "hydrodynamics": (FILMS, FLOODED), "ring_motion": (MOTIONS, []), "flank": (FLANKS, []), "gas_flow": (GAS, []), "oil_transport": (OIL, [])}
    return Set(points, kinds, ["fmep: less tension, skewed barrel, both (measured: -30 to -40 %)", "blow-by, both", "shares of the rings"], tell)


def narrow_pack():
    def pack(height, clearance, tension, rail, spring):
        rings = [w for i in (0, 1) for w in (f"rings.{i}.height={height} mm", f"rings.{i}.groove.height={height + clearance[i]:.3f} mm", f"rings.{i}.tangential_force={tension[i]} N")]
        face = 'rings.2.face={ shape = "parabola", drop = "25 um" }'
        return [*rings, "rings.2.design=three_piece", face, f"rings.2.height={rail} mm", f"rings.2.groove.height={rail + 0.035:.3f} mm", f"rings.2.tangential_force={spring} N"]

    usual, narrow = pack(1.2, (0.045, 0.04), (11.2, 8.2), 0.5, 40), pack(1.0, (0.045, 0.04), (9.33, 6.83), 0.4, 24)
    loads = [(1200, 0.4, 0.3125), (2000, 0.4, 0.3125), (2000, 0.6, 0.625), (3000, 0.6, 0.625), (4000, 0.95, 1.25)]
    points = []
    for n, p, heat in loads:
        at = [f"engine.speed={n} rpm", f"models.cylinder_pressure.intake_pressure={p} bar", "models.cylinder_pressure.exhaust_pressure=1.05 bar", f"models.cylinder_pressure.heat={heat} kJ"]
        points += [changed("alcohol-2000-5600", *rings, *at) for rings in (usual, narrow)]

    def tell(results):
        f = [r["fmep"] if r else math.nan for r in results]
        less = [b / a - 1 for a, b in zip(f[::2], f[1::2])]
        known = [x for x in less if not math.isnan(x)]
        mean = percent(sum(known) / len(known)) if known else "-"
        return [" / ".join(percent(x) for x in less), mean]

    kinds = {"contact": (contacts("0.3 um", "1e-3"), []), "hydrodynamics": (FILMS, FLOODED), "ring_motion": (MOTIONS, []), "flank": (FLANKS, []), "gas_flow": (GAS, [])}
    return Set(points, kinds, ["fmep, narrow over usual, five points", "mean (measured: -28 %)"], tell)


def films():
    points = [changed("turbo-diesel-120", "models.oil_transport.model=liner_film"), changed("turbo-diesel-120", *FLOODED)]

    def tell(results):
        cells = []
        for r in results:
            names = ("ring1.h_min", "ring1.h_mean", "ring2.h_mean", "ring1.h_mid", "ring1.h_max")
            cells.append(" / ".join(f"{r[n]:.2f}" for n in names) if r else "-")
        return cells

    kinds = {"contact": (contacts("0.3 um", "1e-3"), []), "hydrodynamics": (FILMS, []), "ring_motion": (MOTIONS[:2], []), "flank": (FLANKS, []), "gas_flow": (GAS, [])}
    head = ["starved: ring 1 least / mean, ring 2 mean, ring 1 mid-stroke / thickest, um", "flooded: the same"]
    return Set(points, kinds, head, tell)


SETS = {"motored": motored, "engines": engines, "ring-on-liner": ring_on_liner, "trends": trends, "low-friction": low_friction, "narrow-pack": narrow_pack, "films": films}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sets", nargs="*", metavar="SET", help=", ".join(SETS))
    parser.add_argument("--binary", help="a gudgeon program that is built already")
    parser.add_argument("--out", default=str(ROOT / "out/nearest"))
    args = parser.parse_args()
    compare = Compare(args.binary and str(pathlib.Path(args.binary).resolve()), args.out)
    for name in args.sets or SETS:
        print(f"## {name}\n")
        SETS[name]().table(name, compare)


if __name__ == "__main__":
    main()
