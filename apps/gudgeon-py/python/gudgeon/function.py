"""A case as a function of numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Union

import numpy as np

if TYPE_CHECKING:
    from .case import Case

__all__ = ["Function"]


class Function:
    """A case as a function of numbers: what SALib, Optuna, pymoo, SciPy and others call. :meth:`gudgeon.Case.function` makes one.

    ``f(x)`` takes one point, as many numbers as there are inputs, or a row a point, and answers accordingly:

    ================  ========================  ====================
    x                 outputs a list of m       outputs one name
    ================  ========================  ====================
    shape ``(d,)``    shape ``(m,)``            a number
    shape ``(n, d)``  shape ``(n, m)``          shape ``(n,)``
    ================  ========================  ====================

    Rows are run on all cores. It can be pickled, and so be sent to other processes.
    """

    def __init__(
        self,
        case: Case,
        inputs: Mapping[str, str] | Sequence[str],
        outputs: str | Sequence[str],
        failed: str | float | Mapping[str, float] = "nan",
        threads: int = 0,
    ) -> None:
        self.case = case
        self.inputs: dict[str, str] = dict(inputs) if isinstance(inputs, Mapping) else dict.fromkeys(inputs, "")
        """Paths with the units of their numbers; empty for SI."""
        self.outputs = [outputs] if isinstance(outputs, str) else list(outputs)
        """Names of the results."""
        self.failed = failed
        self.threads = threads
        self._single = isinstance(outputs, str)
        if isinstance(failed, str) and failed not in ("nan", "raise"):
            raise ValueError(f"failed is 'nan', 'raise', a number or a number for each output, not {failed!r}")
        known = case.result_names
        for name in self.outputs:
            if known is not None and name not in known:
                raise KeyError(f"a run of {case.name} tells no result {name!r}; it tells {', '.join(known)}")

    def __call__(self, x: Union[np.ndarray, Sequence[float], Sequence[Sequence[float]]]) -> Union[np.ndarray, float]:
        points = np.asarray(x, dtype=np.float64)
        width = len(self.inputs)
        if points.ndim not in (1, 2) or points.shape[-1] != width:
            raise ValueError(f"x has the shape {points.shape}; {width} inputs are wanted: ({width},) or (n, {width})")
        y = self._rows(np.atleast_2d(points))
        if self._single:
            y = y[:, 0]
        if points.ndim == 2:
            return y
        return float(y[0]) if self._single else y[0]

    def _rows(self, points: np.ndarray) -> np.ndarray:
        units = self.inputs.items()
        rows = self.case.run_many(
            [{path: (v, unit) if unit else v for (path, unit), v in zip(units, p.tolist())} for p in points], threads=self.threads
        )
        if rows.failures and self.failed == "raise":
            raise rows.failures[0].error()
        count = len(points)
        y = np.column_stack([rows[name] if name in rows.results else np.full(count, np.nan) for name in self.outputs])
        # Results that a run marks as failed are no results here.
        y[~rows.ok] = np.nan
        if not isinstance(self.failed, str):
            for k, name in enumerate(self.outputs):
                penalty = self.failed[name] if isinstance(self.failed, Mapping) else self.failed
                y[np.isnan(y[:, k]), k] = penalty
        return y

    def __repr__(self) -> str:
        return f"<{', '.join(self.outputs)} of {self.case.name} over {', '.join(self.inputs)}>"
