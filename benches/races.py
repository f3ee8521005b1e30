"""All races in one run: what other programs take for the same problems, with the error beside the time. Writes `docs/races.md`.

    python3 -m venv venv
    venv/bin/pip install numpy scipy numba scikit-sundae nlopt opentorsion ross-rotordynamics "plotly<6"
    venv/bin/python <source tree>/benches/races.py [--rounds N] [--out PATH] [--only gas,film,pin,torsion]

Needs cargo. Rounds of all races take turns, and within a round all contenders, so that each sees the same load of the machine. A package that is not installed
is told to be missing. What each race compares stands at the head of its file.
"""

import argparse
import pathlib

import racing

import race
import race_film
import race_pin
import race_torsion

RACES = {"gas": race, "film": race_film, "pin": race_pin, "torsion": race_torsion}
HEAD = """# Races

Other programs on the same problems, in one run on one machine, error beside time. Written by `benches/races.py`; what is compared, and what is
not, stands at the head of `benches/race.py`, `race_film.py`, `race_pin.py` and `race_torsion.py`. Times are those of one core of a machine that other
programs share, and within a race all contenders took turns: on the gas network the least of all rounds, else medians. Only ratios mean something.
"""


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--rounds", type=int, default=5)
    options.add_argument("--out", type=pathlib.Path, default=racing.ROOT / "docs" / "races.md")
    options.add_argument("--only", default=",".join(RACES))
    options = options.parse_args()
    chosen = [RACES[name] for name in options.only.split(",")]
    states = [(one, one.prepare(None)) for one in chosen]
    for _ in range(options.rounds):
        for one, state in states:
            one.play(state)
    parts = [HEAD, f"{options.rounds} rounds; " + "; ".join(racing.system())]
    parts += [f"## {one.NAME}\n\n{one.report(state)}" for one, state in states]
    options.out.write_text("\n\n".join(part.strip() for part in parts) + "\n")
    print(f"written to {options.out}")


if __name__ == "__main__":
    main()
