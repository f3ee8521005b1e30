"""Models written in Python: a function becomes a table in the case.

The table is part of the case, so a case with such a model is text like any other: it pickles, it runs on other machines, and ``summary.json`` repeats it
without Python. Rows are added until the curve that Gudgeon puts through them is within ``tolerance`` of the function.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from . import _native

__all__ = ["tabulated_cylinder_pressure", "tabulated_drive", "tabulated_oil"]

_MOST = 5000
"""Most rows of a table: a function that needs more has a jump, or noise."""

_FIRST = 16
"""Intervals to begin with."""

_NARROW = 1e-7
"""Narrowest interval, as a part of the range: what a smooth function does not need."""

Curve = Callable[[float], float]


def _value(f: Curve, x: float, positive: bool) -> float:
    y = float(f(x))
    if not math.isfinite(y) or (positive and y <= 0.0):
        raise ValueError(f"the function answers {y} at {x}; {'a positive' if positive else 'a finite'} number is wanted")
    return y


def _rows(f: Curve, ends: tuple[float, float], tolerance: float, period: float | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Rows such that the monotone cubic through them is within ``tolerance`` of ``f`` at the quarters of every interval."""
    known: dict[float, float] = {}

    def at(points: np.ndarray) -> np.ndarray:
        for x in points.tolist():
            if x not in known:
                known[x] = f(x)
        return np.array([known[x] for x in points.tolist()])

    x = np.linspace(*ends, _FIRST + 1)
    while True:
        left, width = x[:-1], np.diff(x)
        between = left + np.outer([0.25, 0.5, 0.75], width)
        rows = x[:-1] if period else x
        told = _native.interpolated(rows.tolist(), at(rows).tolist(), period, between.ravel().tolist())
        error = np.abs(np.frombuffer(told).reshape(between.shape) - at(between.ravel()).reshape(between.shape)).max(axis=0)
        coarse = error > tolerance
        if not coarse.any():
            return rows, at(rows)
        x = np.sort(np.concatenate([x, between[1][coarse]]))
        if len(x) > _MOST or width[coarse].min() < _NARROW * (ends[1] - ends[0]):
            worst = left[error.argmax()]
            raise ValueError(f"no table follows the function within the tolerance; it is worst from {worst:.6g} on: a jump, or noise?")


def tabulated_oil(viscosity: Curve, T: tuple[float, float] = (273.15, 473.15), *, tolerance: float = 1e-5) -> dict[str, Any]:
    """An ``oil`` whose dynamic viscosity [Pa s] is a function of the temperature [K], tabulated from ``T[0]`` to ``T[1]``.

    ``tolerance`` is the relative deviation of the table from the function. Beyond its ends ``ln mu`` goes on straight over ``1/T``.

    >>> import gudgeon, math
    >>> oil = gudgeon.tabulated_oil(lambda T: 1.5e-4 * math.exp(720 / (T - 202)), T=(300, 480))
    >>> case = gudgeon.example("turbo-diesel-120").with_model("models.oil", oil)
    >>> case.resolved["models"]["oil"]["model"]
    'table'
    """
    # Gudgeon interpolates the logarithm over 1/T, where oils are nearly straight; errors of a logarithm are relative.
    x, y = _rows(lambda x: math.log(_value(viscosity, 1.0 / x, True)), (1.0 / T[1], 1.0 / T[0]), tolerance)
    return {"model": "table", "temperature": (1.0 / x[::-1]).tolist(), "viscosity": np.exp(y[::-1]).tolist()}


def tabulated_cylinder_pressure(pressure: Curve, *, cycle: float = 720.0, tolerance: float = 1e-5) -> dict[str, Any]:
    """A ``cylinder_pressure`` that is a function of the crank angle [deg], in Pa: 0 is the gas-exchange dead centre, 360 the firing one.

    ``cycle`` is 720 for four strokes, 360 for two; ``tolerance`` the deviation of the table from the function by the highest pressure.
    """
    scale = max(_value(pressure, t, True) for t in np.linspace(0.0, cycle, 721))
    x, y = _rows(lambda t: _value(pressure, t, True), (0.0, cycle), tolerance * scale, cycle)
    return {"model": "table", "theta_deg": x.tolist(), "pressure": y.tolist(), "cycle": (cycle, "deg"), "smoothing": "off"}


def tabulated_drive(torque: Curve, rpm: tuple[float, float], *, tolerance: float = 1e-5) -> dict[str, Any]:
    """A ``drive`` of a shaft line whose torque [N m] is a function of the speed [rpm], tabulated from ``rpm[0]`` to ``rpm[1]``.

    ``tolerance`` is the deviation of the table from the function by the highest torque. Beyond its ends the torque goes on straight.
    """
    scale = max(abs(_value(torque, n, False)) for n in np.linspace(*rpm, 201)) or 1.0
    x, y = _rows(lambda n: _value(torque, n, False), rpm, tolerance * scale)
    return {"model": "table", "speed_rpm": x.tolist(), "torque": y.tolist()}
