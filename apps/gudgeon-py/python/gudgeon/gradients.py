"""Derivatives of results by inputs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import pandas

__all__ = ["Gradients"]


class Gradients(Mapping[str, np.ndarray]):
    """Derivatives of the results of a case: a mapping from the names of results to arrays, a number for each input.

    Each is in the unit of the result over the SI unit of the input (``units_by`` says it), and not a number (NaN) where the result has a corner there, jumps or counts.

    >>> import gudgeon
    >>> g = gudgeon.example("pin-85-alcohol").gradients(["pin.outer", "pin.inner"], ["pin_mass"])
    >>> g.inputs, g.units["pin_mass"], g["pin_mass"].round(-1)
    ({'pin.outer': 'm', 'pin.inner': 'm'}, 'g', array([ 16680., -10640.]))
    >>> g.units_by["pin_mass"]["pin.outer"]
    'g/m'
    """

    def __init__(self, told: dict[str, Any]) -> None:
        self.method: str = told["method"]
        """How they were found."""
        self.inputs: dict[str, str] = {i["path"]: i["unit"] for i in told["inputs"]}
        """Paths of the inputs with their SI units."""
        self.at: dict[str, float] = {i["path"]: i["value"] for i in told["inputs"]}
        """Values of the inputs."""
        self.units: dict[str, str] = {name: g["value"]["unit"] for name, g in told["results"].items()}
        """Units of the results."""
        self.units_by: dict[str, dict[str, str]] = {name: dict(zip(self.inputs, g["by_unit"])) for name, g in told["results"].items()}
        """Units of the derivatives, by result and path."""
        self.notes: list[dict[str, Any]] = told.get("notes", [])
        """What a person who relies on the derivatives must know."""
        self._by = {name: np.array([np.nan if d is None else d for d in g["by"]]) for name, g in told["results"].items()}

    def __getitem__(self, name: str) -> np.ndarray:
        return self._by[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._by)

    def __len__(self) -> int:
        return len(self._by)

    def __repr__(self) -> str:
        return f"<derivatives of {len(self)} results by {', '.join(self.inputs)}>"

    def to_dataframe(self) -> pandas.DataFrame:
        """The derivatives as a pandas DataFrame: a row a result, a column an input; their units are ``attrs["units"]``, by result and path."""
        import pandas as pd

        frame = pd.DataFrame.from_dict(self._by, orient="index", columns=list(self.inputs))
        frame.attrs["units"] = self.units_by
        return frame
