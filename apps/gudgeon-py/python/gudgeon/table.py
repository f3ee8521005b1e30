"""Columns of numbers with their units."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import pandas
    import xarray

__all__ = ["Table"]


class Table(Mapping[str, np.ndarray]):
    """Columns over a common axis: a mapping from names to arrays, the axis first.

    Numbers are handed over when a column is asked for, once, and stand in memory that the array owns.

    >>> import gudgeon
    >>> series = gudgeon.example("slider-straight").run().tables["sweep"]
    >>> series.axis, series.units[series.axis]
    ('h_in', 'um')
    """

    def __init__(self, columns: list[tuple[str, str]], numbers: Callable[[int], bytearray]) -> None:
        self.units: dict[str, str] = dict(columns)
        """Units by name; ``1`` or empty for a ratio."""
        self._names = {name: k for k, (name, _) in enumerate(columns)}
        self._numbers = numbers
        self._kept: dict[str, np.ndarray] = {}

    @property
    def axis(self) -> str:
        """Name of the column that the rows are at: ``theta`` [deg] over a cycle."""
        return next(iter(self._names))

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._kept:
            self._kept[name] = np.frombuffer(self._numbers(self._names[name]), dtype=np.float64)
        return self._kept[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<{len(self) - 1} columns over {self.axis}, {len(self[self.axis])} rows>"

    def to_dataframe(self) -> pandas.DataFrame:
        """The table as a pandas DataFrame, with the axis as its index and the units in ``attrs["units"]``."""
        import pandas as pd

        frame = pd.DataFrame({name: self[name] for name in self if name != self.axis}, index=pd.Index(self[self.axis], name=self.axis))
        frame.attrs["units"] = dict(self.units)
        return frame

    def to_xarray(self) -> xarray.Dataset:
        """The table as an xarray Dataset over its axis, each variable with its unit in ``attrs``."""
        import xarray as xr

        def variable(name: str) -> tuple[str, np.ndarray, dict[str, Any]]:
            return (self.axis, self[name], {"units": self.units[name]})

        return xr.Dataset({name: variable(name) for name in self if name != self.axis}, coords={self.axis: variable(self.axis)})
