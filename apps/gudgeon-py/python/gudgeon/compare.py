"""One case with every combination of some models or settings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product

from .case import Case, Progress
from .models import models
from .rows import Rows
from .values import Value

__all__ = ["compare"]


def compare(case: Case, swaps: Mapping[str, Sequence[Value]], *, threads: int = 0, progress: Progress | None = None) -> Rows:
    """Runs a case with every combination of ``swaps``, the last one fastest: a row each.

    A swap is a path with its values; the name of a kind stands for the name of its model, ``gas_flow`` for ``models.gas_flow.model``. A combination that the case forbids is
    a row with the code ``refused`` and the reason.

    >>> import gudgeon
    >>> pin = gudgeon.example("pin-85-alcohol")
    >>> rows = gudgeon.compare(pin, {"pin_strength": ["thin_ring", "shear_beam"]})
    >>> rows["pin_strength"].tolist(), rows["deflection"].round(4).tolist()
    (['thin_ring', 'shear_beam'], [0.0338, 0.0796])
    """
    kinds = models()
    paths = [f"models.{name}.model" if name in kinds else name for name in swaps]
    points = [dict(zip(paths, values)) for values in product(*swaps.values())]
    return case.run_many(points, threads=threads, progress=progress).renamed(dict(zip(paths, swaps)))
