"""Rows of many runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import RunError

if TYPE_CHECKING:
    import pandas

__all__ = ["Failure", "Rows"]


@dataclass(frozen=True)
class Failure:
    """Why a point has no result, or a result that is not what was asked for."""

    row: int
    """Number of the point, from 0."""
    code: str
    """``refused`` (the input cannot be read), ``impossible`` (there is no such machine), ``model``, ``integration``, ``not_a_number``, ``scene``, ``stopped``; or the topic of a note, when there are results and they are marked."""
    message: str
    """What is wrong, in one line."""
    path: str
    """Path of the input that is wrong; empty where none is to blame."""

    def error(self) -> RunError:
        """The same as an exception."""
        return RunError(f"point {self.row}: {self.message}", self.code, self.path)


class Rows(Mapping[str, np.ndarray]):
    """Inputs and results of many runs, a row each in the order of their points: a mapping from names to columns.

    A point that failed is a row like any other, whose results are not numbers (NaN); ``code`` and ``message`` say why.

    >>> import gudgeon
    >>> case = gudgeon.example("pin-85-alcohol")
    >>> rows = case.run_many([{"pin.inner": (d, "mm")} for d in (12, 13, 25)])
    >>> rows["pin_mass"].round(1), rows.failures[0].code
    (array([127.2, 117.7,   nan]), 'impossible')
    """

    def __init__(self, inputs: Mapping[str, Any], told: list[tuple[str, str, str, bytearray]], failures: list[tuple[int, str, str, str]], index: Any = None) -> None:
        count = len(next(iter(inputs.values()), ()))
        self.inputs = list(inputs)
        """Names of the columns that hold inputs."""
        self.results = [name for name, _, _, _ in told]
        """Names of the columns that hold results."""
        self.units: dict[str, str] = {name: unit for name, unit, _, _ in told}
        """Units of the results, by name."""
        self.what: dict[str, str] = {name: what for name, _, what, _ in told}
        """What each result is, by name."""
        self.failures = [Failure(*f) for f in failures]
        """Points without a result, and points whose results are marked."""
        self._index = index
        self._columns: dict[str, np.ndarray] = {name: _column(values) for name, values in inputs.items()}
        self._columns |= {name: np.frombuffer(values, dtype=np.float64) for name, _, _, values in told}
        for word in ("code", "message"):
            column = np.full(count, "", dtype=object)
            for f in self.failures:
                column[f.row] = getattr(f, word)
            self._columns[word] = column

    @property
    def ok(self) -> np.ndarray:
        """Which rows hold results that are what was asked for."""
        return self["code"] == ""

    def __getitem__(self, name: str) -> np.ndarray:
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        return f"<{len(self['code'])} runs, {len(self.results)} results, {len(self.failures)} failures>"

    def to_dataframe(self) -> pandas.DataFrame:
        """Inputs, results, ``code`` and ``message`` as a pandas DataFrame, with the units in ``attrs["units"]``."""
        import pandas as pd

        frame = pd.DataFrame(self._columns, index=self._index)
        frame.attrs["units"] = dict(self.units)
        return frame

    def _repr_html_(self) -> str:
        return self.to_dataframe().to_html(max_rows=20, max_cols=12)


def _column(values: list[Any]) -> np.ndarray:
    """Numbers as numbers (of quantities in one unit the numbers), everything else as it was given."""
    units = {v[1] for v in values if isinstance(v, tuple) and len(v) == 2}
    plain = [v[0] if isinstance(v, tuple) and len(v) == 2 else v for v in values]
    if len(units) <= 1 and all(isinstance(v, (int, float, np.number)) and not isinstance(v, bool) for v in plain):
        return np.asarray(plain)
    column = np.empty(len(values), dtype=object)
    column[:] = values
    return column
