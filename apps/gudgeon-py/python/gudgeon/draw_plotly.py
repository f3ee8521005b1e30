"""Figures by plotly, which answer to the pointer."""

from __future__ import annotations

import plotly.graph_objects as go
from plotly.colors import qualitative

from .figures import Bars, Curves, Drawing, Figure, Map

__all__ = ["draw"]


def draw(figure: Figure) -> go.Figure:
    """The figure as one of plotly's."""
    if isinstance(figure, Curves):
        made = _curves(figure)
    elif isinstance(figure, Map):
        made = _map(figure)
    elif isinstance(figure, Bars):
        made = _bars(figure)
    else:
        made = _drawing(figure)
    return made.update_layout(title=figure.title, template="simple_white", margin={"t": 50, "b": 50})


def _curves(f: Curves) -> go.Figure:
    made = go.Figure()
    for c in f.curves:
        color = "gray" if c.color is None else qualitative.D3[c.color % len(qualitative.D3)]
        mode = "+".join(["lines"] * c.line + ["markers"] * c.points)
        made.add_scatter(x=c.x, y=c.y, name=c.label, mode=mode, line={"color": color, "dash": "dash" if c.dash else "solid"})
    made.update_xaxes(title=f.x, type="log" if f.log_x else "linear")
    made.update_yaxes(title=f.y, type="log" if f.log_y else "linear")
    return made.update_layout(hovermode="x unified")


def _map(f: Map) -> go.Figure:
    made = go.Figure(go.Heatmap(x=f.at_x, y=f.at_y, z=f.values, colorscale="Viridis", zsmooth="best", colorbar={"title": f.value}))
    return made.update_xaxes(title=f.x).update_yaxes(title=f.y)


def _bars(f: Bars) -> go.Figure:
    labels = [label for label, _, _ in f.bars]
    made = go.Figure(go.Bar(x=[value for _, value, _ in f.bars], y=labels, orientation="h", name=f.title, showlegend=False))
    marks = [(label, limit) for label, _, limit in f.bars if limit is not None]
    if marks:
        made.add_scatter(x=[m for _, m in marks], y=[label for label, _ in marks], mode="markers", name="limit", marker={"symbol": "line-ns-open", "size": 18, "color": "black"})
    return made.update_xaxes(title=f.unit).update_yaxes(autorange="reversed")


def _drawing(f: Drawing) -> go.Figure:
    made = go.Figure()
    for shape in f.shapes:
        ((kind, s),) = shape.items()
        line = {"color": {"accent": "crimson", "second": "royalblue"}.get(s.get("style", ""), "black"), "width": 1}
        if kind == "path":
            points = s["points"] + (s["points"][:1] if s["closed"] else [])
            fill = "toself" if s["closed"] and s["style"] in ("metal", "cut", "oil") else None
            made.add_scatter(x=[p[0] for p in points], y=[p[1] for p in points], mode="lines", line=line, fill=fill, fillcolor="lightgray", hoverinfo="skip")
        elif kind == "circle":
            (x, y), r = s["centre"], s["radius"]
            made.add_shape(type="circle", x0=x - r, x1=x + r, y0=y - r, y1=y + r, line=line)
        elif kind == "text":
            made.add_annotation(x=s["at"][0], y=s["at"][1], text=s["text"], showarrow=False, xanchor={"start": "left", "middle": "center", "end": "right"}[s["anchor"]])
        else:
            (x0, y0), (x1, y1) = s["from"], s["to"]
            made.add_annotation(x=(x0 + x1) / 2, y=(y0 + y1) / 2, text=s["text"], showarrow=False)
    made.update_yaxes(scaleanchor="x", visible=False).update_xaxes(visible=False)
    return made.update_layout(showlegend=False)
