"""Figures of results: what they show. How they are drawn stands in ``draw_matplotlib`` and ``draw_plotly``."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _native
from .table import Table

if TYPE_CHECKING:
    from .result import Result

__all__ = ["Bars", "Curve", "Curves", "Drawing", "Map", "campbell", "of", "plot"]


@dataclass
class Curve:
    """One curve of a figure."""

    label: str
    x: np.ndarray
    y: np.ndarray
    dash: bool = False
    color: int | None = None
    """Number of its colour; none for that of the text."""
    points: bool = False
    line: bool = True
    at_end: bool = False
    """Whether its label stands at its end, and not in the legend."""


@dataclass
class Curves:
    """Curves over one axis."""

    title: str
    hint: str
    x: str
    y: str
    curves: list[Curve]
    log_x: bool = False
    log_y: bool = False


@dataclass
class Map:
    """Colours over a grid."""

    title: str
    hint: str
    x: str
    y: str
    value: str
    at_x: np.ndarray
    at_y: np.ndarray
    values: np.ndarray


@dataclass
class Bars:
    """Labelled bars, each with the mark that it should not pass."""

    title: str
    hint: str
    unit: str
    bars: list[tuple[str, float, float | None]]


@dataclass
class Drawing:
    """Something drawn to scale."""

    title: str
    hint: str
    shapes: list[dict[str, Any]] = field(default_factory=list)


Figure = Curves | Map | Bars | Drawing

# The unit that a person plots a quantity in, for values up to a limit: limit, factor, label.
_SHOWN: dict[str, list[tuple[float, float, str]]] = {
    "Pa": [(np.inf, 1e-5, "bar")],
    "m": [(2e-3, 1e6, "µm"), (2, 1e3, "mm"), (np.inf, 1, "m")],
    "m/s": [(2e-3, 1e6, "µm/s"), (0.5, 1e3, "mm/s"), (np.inf, 1, "m/s")],
    "kg/s": [(1e-6, 1e9, "µg/s"), (2e-3, 1e6, "mg/s"), (2, 1e3, "g/s"), (np.inf, 1, "kg/s")],
    "kg": [(1e-7, 1e9, "µg"), (1e-4, 1e6, "mg"), (1, 1e3, "g"), (np.inf, 1, "kg")],
    "N": [(5e4, 1, "N"), (np.inf, 1e-3, "kN")],
    "N/m": [(5e4, 1, "N/m"), (np.inf, 1e-3, "kN/m")],
    "W": [(5e3, 1, "W"), (np.inf, 1e-3, "kW")],
    "N m": [(5e3, 1, "N·m"), (np.inf, 1e-3, "kN·m")],
    "Pa s": [(2, 1e3, "mPa·s"), (np.inf, 1, "Pa·s")],
    "rad": [(0.1, 1e3, "mrad"), (np.inf, 1, "rad")],
    "deg": [(np.inf, 1, "°")],
    "1": [(np.inf, 1, "")],
    "-": [(np.inf, 1, "")],
}


def _shown(unit: str, *arrays: np.ndarray) -> tuple[float, str]:
    """Factor and label of the unit that values are shown in."""
    largest = max((float(np.nanmax(np.abs(a))) for a in arrays if a.size and not np.isnan(a).all()), default=0.0)
    return next((factor, label) for limit, factor, label in _SHOWN.get(unit, [(np.inf, 1, unit)]) if largest < limit or limit == np.inf)


def _named(name: str, unit: str) -> str:
    return f"{name.replace('_', ' ')} [{unit}]" if unit else name.replace("_", " ")


def _curves(table: Table, title: str, hint: str, x: str, lines: Sequence[tuple[str, str, bool, int | None]], **more: Any) -> Curves:
    """Columns of a table as curves: label, column, dashed, number of the colour."""
    fx, ux = _shown(table.units[x], table[x])
    fy, uy = _shown(table.units[lines[0][1]], *(table[c] for _, c, _, _ in lines))
    drawn = [Curve(label, table[x] * fx, table[c] * fy, dash, color, points=len(table[x]) <= 40) for label, c, dash, color in lines]
    return Curves(title, hint, _named("crank angle" if x == "theta" else x, ux), uy, drawn, **more)


def _carried(result: Result, figure: dict[str, Any]) -> Figure | None:
    """A figure that the result carries; none where its table or columns are missing, and of numbers in rows, which are no picture."""
    kind, said = next(iter(figure["kind"].items()))
    title: str = figure["title"][:1].upper() + figure["title"][1:]
    hint: str = figure["hint"]
    if kind == "bars":
        return Bars(title, hint, said["unit"], [(b["label"], b["value"], b["limit"]) for b in said["bars"]])
    if kind == "table":
        return None
    if kind == "drawing":
        # Of a moving drawing, the picture in the middle.
        frames = said["frames"]
        moving: dict[str, Any] = frames[len(frames) // 2] if frames else {"label": "", "shapes": []}
        return Drawing(title, ", ".join(filter(None, [hint, moving["label"]])), said["fixed"] + moving["shapes"])
    table = result.series if figure["table"] == "series" else result.tables.get(figure["table"])
    if table is None:
        return None
    if kind in ("map", "waterfall"):
        # Of a waterfall the first of its spectra, over its first abscissa, as colours.
        x, y, v = (said["x"], said["y"], said["value"]) if kind == "map" else (said["x"][0], said["y"], said["spectra"][0][1])
        shown = {name: _shown(table.units[name], table[name]) for name in (x, y, v)}
        rows = int(np.flatnonzero(np.diff(table[y]))[0]) + 1 if np.diff(table[y]).any() else len(table[y])
        grid = {name: (table[name] * shown[name][0])[: len(table[name]) // rows * rows].reshape(-1, rows) for name in (x, y, v)}
        return Map(title, hint, _named(x, shown[x][1]), _named(y, shown[y][1]), shown[v][1], grid[x][0], grid[y][:, 0], grid[v])
    lines = [(label, column, i > 7, i) for i, (label, column) in enumerate(said["lines"]) if column in table]
    if said["x"] not in table or not lines:
        return None
    made = _curves(table, title, hint, said["x"], lines, log_x=said["log_x"], log_y=said["log_y"])
    # Points of single instants, each curve over an abscissa of its own.
    for curve, x in zip(made.curves, said.get("own_x", [])):
        curve.x = table[x]
    if said.get("scatter"):
        made.curves = [Curve(c.label, c.x[c.x > 0], c.y[c.x > 0], color=c.color, points=True, line=False) for c in made.curves]
    return made


_OVER_CYCLE: list[dict[str, Any]] = json.loads(_native.over_cycle())
"""Columns over the cycle that form a figure: the same list that the page of a run is drawn from."""


def _over_cycle(table: Table, group: dict[str, Any], only: int | None = None) -> Curves | None:
    lines: list[tuple[str, str, bool, int | None]] = []
    for pattern, label, color, *dash in group["columns"]:
        matcher = re.compile(re.escape(pattern).replace(r"\#", rf"({only or r'[0-9]+'})"))
        for name in table:
            found = matcher.fullmatch(name)
            if found:
                number = int(found[1]) if found.groups() else 0
                # A negative colour counts from the number: what is below a ring has its colour.
                own = None if color == "text" else color if color >= 0 else number + color
                lines.append((label.replace("#", str(number)), name, bool(dash), own))
    # The space above ring 1 is the cylinder.
    if any(c == "cylinder.p" for _, c, _, _ in lines):
        lines = [line for line in lines if line[1] != "land1.p"]
    if not lines or group.get("unless_zero") and not any(table[c].any() for _, c, _, _ in lines):
        return None
    return _curves(table, group["title"].replace("#", str(only)), group["hint"], table.axis, lines, log_y=group.get("log", False))


def campbell(result: Result) -> Curves | None:
    """Natural frequencies over the speed, orders of the speed as rays, critical speeds where they meet; none without a shaft line."""
    table, critical = result.tables.get("interference"), result.tables.get("critical_speeds")
    if table is None:
        return None
    speed = table[table.axis]
    modes = [c for c in table if c.startswith("mode")]
    orders = [c for c in table if c.startswith("order")]
    # Modes that an order can reach, and one above.
    reach = max((table[o].max() for o in orders), default=np.inf)
    drawn = modes[: max(1, sum(table[m].max() <= reach for m in modes) + 1)]
    top = 1.1 * max(table[m].max() for m in drawn)
    curves = [Curve(m.replace("mode", "mode "), speed, table[m], False, k) for k, m in enumerate(drawn)]
    rays = [np.where(table[o] <= top, table[o], np.nan) for o in orders]
    curves += [Curve(o.removeprefix("order"), speed, ray, dash=True, at_end=True) for o, ray in zip(orders, rays)]
    if critical is not None and len(critical[critical.axis]):
        at = {name.split(".")[-1]: name for name in critical}
        f = critical[at["frequency"]] if "frequency" in at else np.interp(critical[at["speed"]], speed, table[drawn[0]])
        curves.append(Curve("critical speeds", critical[at["speed"]], f, color=3, points=True, line=False))
    return Curves("Campbell diagram", "natural frequencies, orders of the speed as dashed rays with their numbers, critical speeds where they meet", _named("speed", table.units[table.axis]), "Hz", curves)


def _slug(title: str) -> str:
    return re.sub(r"[^a-z0-9]+", "_", title.lower()).strip("_")


def of(result: Result) -> dict[str, Figure]:
    """The figures of a result by name."""
    made: dict[str, Figure] = {}
    for figure in result.about["figures"]:
        drawn = _carried(result, figure)
        if drawn is not None:
            made.setdefault(_slug(figure["title"]), drawn)
    diagram = campbell(result)
    if diagram is not None:
        made.pop(_slug(diagram.title), None)
        made = {"campbell": diagram, **made}
    if result.series.axis == "theta":
        rings = sorted({int(m[1]) for c in result.series if (m := re.match(r"ring(\d+)\.", c))})
        for group in _OVER_CYCLE:
            # A figure for every ring, or one of all.
            for k in rings if "#" in group["name"] else [None]:
                drawn = _over_cycle(result.series, group, k)
                if drawn is not None:
                    made[group["name"].replace("#", str(k))] = drawn
    return made


def plot(result: Result, name: str | None, *, ax: Any, backend: str) -> Any:
    """Draws the figure of that name."""
    known = of(result)
    if not known:
        raise KeyError("this result has nothing to draw")
    chosen = next(iter(known)) if name is None else name
    if chosen not in known:
        raise KeyError(f"no figure is called {name!r}; there are {', '.join(known)}")
    return draw(known[chosen], ax=ax, backend=backend)


def draw(figure: Figure, *, ax: Any, backend: str) -> Any:
    """Draws a figure by one of the two libraries."""
    if backend == "matplotlib":
        from . import draw_matplotlib

        return draw_matplotlib.draw(figure, ax)
    if backend == "plotly":
        from . import draw_plotly

        return draw_plotly.draw(figure)
    raise ValueError(f"backend is 'matplotlib' or 'plotly', not {backend!r}")
