"""Gudgeon: the open simulator of the power cylinder, from Python.

>>> import gudgeon
>>> case = gudgeon.example("turbo-diesel-120")
>>> r = case.set({"engine.speed": (2000, "rpm")}).run()
>>> print(f"{r['blow_by']:.0f} {r.units['blow_by']}")
66 l/min
"""

from ._native import __version__
from .case import Case, Explanation, example, load, loads
from .compare import Comparison, Shares, compare
from .errors import CaseError, Mistake, RunError
from .function import Function
from .gradients import Gradients
from .models import describe, models, scenes
from .result import Note, Result
from .rows import Failure, Rows
from .study import Study
from .table import Table
from .tabulated import tabulated_cylinder_pressure, tabulated_drive, tabulated_oil

__all__ = [
    "Case",
    "CaseError",
    "Comparison",
    "Explanation",
    "Failure",
    "Function",
    "Gradients",
    "Mistake",
    "Note",
    "Result",
    "Rows",
    "RunError",
    "Shares",
    "Study",
    "Table",
    "__version__",
    "compare",
    "describe",
    "example",
    "load",
    "loads",
    "models",
    "scenes",
    "tabulated_cylinder_pressure",
    "tabulated_drive",
    "tabulated_oil",
]
