"""Figures by matplotlib."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon

from .figures import Bars, Curves, Drawing, Figure, Map

__all__ = ["draw"]

_FACES = {"metal": "0.8", "cut": "0.6", "hollow": "white", "oil": "#e8c36a"}
_LINES: dict[str, dict[str, Any]] = {
    "outline": {"color": "0.1", "lw": 1.4},
    "thin": {"color": "0.5", "lw": 0.7},
    "dashed": {"color": "0.5", "lw": 0.7, "ls": "--"},
    "axis": {"color": "0.5", "lw": 0.7, "ls": "-."},
    "accent": {"color": "C3", "lw": 1.8},
    "second": {"color": "C0", "lw": 1.8},
}
_ANCHORS = {"start": "left", "middle": "center", "end": "right"}


def draw(figure: Figure, ax: Axes | None) -> Axes:
    """Draws into the axes, or into new ones."""
    if ax is None:
        height = max(3.0, 1.0 + 0.22 * len(figure.bars)) if isinstance(figure, Bars) else 4.0
        _, ax = plt.subplots(figsize=(7, height), layout="constrained")
    if isinstance(figure, Curves):
        _curves(figure, ax)
    elif isinstance(figure, Map):
        _map(figure, ax)
    elif isinstance(figure, Bars):
        _bars(figure, ax)
    else:
        _drawing(figure, ax)
    ax.set_title(figure.title, loc="left")
    return ax


def _curves(f: Curves, ax: Axes) -> None:
    for c in f.curves:
        color = f"C{c.color % 10}" if c.color is not None else "0.5" if c.at_end else "0.1"
        style = ("--" if c.dash else "-") if c.line else "none"
        label = f"_{c.label}" if c.at_end else c.label
        ax.plot(c.x, c.y, color=color, ls=style, lw=0.8 if c.at_end else 1.5, marker="o" if c.points else None, ms=3 if c.line else 5, label=label)
        drawn = np.flatnonzero(np.isfinite(c.y))
        if c.at_end and drawn.size:
            ax.annotate(c.label, (c.x[drawn[-1]], c.y[drawn[-1]]), xytext=(3, 0), textcoords="offset points", va="center", fontsize="small", color="0.4")
    ax.set_xlabel(f.x)
    ax.set_ylabel(f.y)
    if f.log_x:
        ax.set_xscale("log")
    if f.log_y:
        ax.set_yscale("log")
    ax.grid(alpha=0.3)
    ax.margins(x=0)
    if len(f.curves) > 1:
        ax.legend(fontsize="small", loc="center left", bbox_to_anchor=(1.04, 0.5), frameon=False)


def _map(f: Map, ax: Axes) -> None:
    mesh = ax.pcolormesh(f.at_x, f.at_y, f.values, shading="gouraud" if min(f.values.shape) > 1 else "nearest", cmap="viridis")
    ax.figure.colorbar(mesh, ax=ax, label=f.value)
    ax.set_xlabel(f.x)
    ax.set_ylabel(f.y)


def _bars(f: Bars, ax: Axes) -> None:
    at = np.arange(len(f.bars))
    values = [value for _, value, _ in f.bars]
    over = [limit is not None and value > limit for _, value, limit in f.bars]
    ax.barh(at, values, color=["C3" if o else "C0" for o in over])
    for k, (_, _, limit) in enumerate(f.bars):
        if limit is not None:
            ax.plot([limit, limit], [k - 0.45, k + 0.45], color="0.1", lw=2)
    ax.set_yticks(at, [label for label, _, _ in f.bars])
    ax.invert_yaxis()
    ax.set_xlabel(f.unit)
    ax.grid(axis="x", alpha=0.3)


def _drawing(f: Drawing, ax: Axes) -> None:
    for shape in f.shapes:
        ((kind, s),) = shape.items()
        style = s.get("style", "thin")
        if kind == "text":
            ax.text(s["at"][0], s["at"][1], s["text"], ha=_ANCHORS[s["anchor"]], fontsize="small")
        elif kind == "dimension":
            _dimension(s, ax)
        elif kind == "circle":
            ax.add_patch(Circle(s["centre"], s["radius"], **_look(style, closed=True)))
        elif s["closed"]:
            ax.add_patch(Polygon(s["points"], **_look(style, closed=True)))
        else:
            ax.plot(*np.transpose(s["points"]), **_LINES.get(style, _LINES["thin"]))
    ax.set_aspect("equal")
    ax.autoscale_view()
    ax.axis("off")


def _look(style: str, *, closed: bool) -> dict[str, Any]:
    if style in _FACES:
        return {"facecolor": _FACES[style], "edgecolor": "0.1", "lw": 1.0}
    line = _LINES[style]
    return {"fill": False, "edgecolor": line["color"], "lw": line["lw"], "ls": line.get("ls", "-")}


def _dimension(s: dict[str, Any], ax: Axes) -> None:
    a, b = np.array(s["from"]), np.array(s["to"])
    along = (b - a) / (np.linalg.norm(b - a) or 1.0)
    off = s["offset"] * np.array([-along[1], along[0]])
    ax.update_datalim([a + off, b + off])
    ax.annotate("", a + off, b + off, arrowprops={"arrowstyle": "<->", "lw": 0.7, "color": "0.4"})
    x, y = (a + b) / 2 + off
    ax.text(x, y, s["text"], ha="center", va="bottom", fontsize="small")
