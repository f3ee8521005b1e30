"""What the races share: the program of a bench, rounds, tables.

A race is a module with `NAME`, `prepare(binary)`, which gives a state and lists contenders that are missing, `play(state)`, which runs one round of
all contenders, and `report(state)`, which gives the text of its tables. `races.py` runs them all.
"""

import argparse
import importlib.metadata
import json
import os
import pathlib
import platform
import subprocess

os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
ROOT = pathlib.Path(__file__).resolve().parent.parent


def built(name, *command):
    """The program `name` that a cargo command builds."""
    text = subprocess.run(["cargo", *command, "--message-format=json"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
    for line in text.splitlines():
        message = json.loads(line)
        if message.get("executable") and message.get("target", {}).get("name") == name:
            return message["executable"]
    raise RuntimeError(f"cargo built no `{name}`")


def build(bench):
    """The program of a bench."""
    return built(bench, "bench", "-q", "-p", "gudgeon-benches", "--bench", bench, "--no-run")


def build_apart(folder, name):
    """A program that is no part of the workspace, from a folder beside this file; none where its packages cannot be had."""
    try:
        return built(name, "build", "-q", "--release", "--manifest-path", f"benches/{folder}/Cargo.toml")
    except subprocess.CalledProcessError:
        return None


def answer(*command):
    """What a program prints as JSON."""
    return json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True).stdout)


def versions(*packages):
    """Names and versions of packages; one that is not installed is told to be missing."""
    found = []
    for name in packages:
        try:
            found.append(f"{name} {importlib.metadata.version(name)}")
        except importlib.metadata.PackageNotFoundError:
            found.append(f"{name} missing")
    return found


def system():
    rust = subprocess.run(["rustc", "--version"], stdout=subprocess.PIPE, text=True).stdout.strip()
    return [f"Python {platform.python_version()}", rust]


def table(head, rows):
    """A table: names in the first column, numbers in the others."""
    lines = ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 1)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines)


def figure(value, digits=3):
    """A number with so many digits, without an exponent where it is short."""
    return "–" if value is None else f"{value:.{digits}g}" if 1e-3 <= abs(value) < 10**digits or value == 0 else f"{value:.0f}" if abs(value) >= 1 else f"{value:.1e}"


def alone(race, rounds):
    """The command line of one race."""
    options = argparse.ArgumentParser(description=race.__doc__.splitlines()[0])
    options.add_argument("--rounds", type=int, default=rounds)
    options.add_argument("--binary", help="the bench, built already")
    options = options.parse_args()
    state = race.prepare(options.binary)
    for _ in range(options.rounds):
        race.play(state)
    print("; ".join(system()))
    print(race.report(state))
