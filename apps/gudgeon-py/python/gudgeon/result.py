"""What a run produced."""

from __future__ import annotations

import html
from collections.abc import Iterator, Mapping
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _native
from .table import Table

if TYPE_CHECKING:
    import pandas

__all__ = ["Note", "Result"]


class Note(dict[str, Any]):
    """Something that a person who relies on a result must know: ``topic``, ``level`` (``info``, ``caution``, ``exceeded``: a limit of the case is not kept, ``failure``), ``text``, ``amounts``."""

    def __str__(self) -> str:
        return str(self["text"])


class Result(Mapping[str, float]):
    """What a run produced: a mapping from the names of its results to numbers, in the units of :attr:`units`.

    >>> import gudgeon
    >>> r = gudgeon.example("pin-85-alcohol").run()
    >>> print(f"{r['pin_mass']:.1f} {r.units['pin_mass']}: {r.what['pin_mass']}")
    108.0 g: mass of the pin

    Results can be pickled, and are equal when everything but the wall times is.

    >>> import pickle
    >>> pickle.loads(pickle.dumps(r)) == r
    True
    """

    def __init__(self, native: _native.Outcome) -> None:
        self._native = native
        told = native.results()
        self._values = {name: value for name, value, _, _ in told}
        self.units: dict[str, str] = {name: unit for name, _, unit, _ in told}
        """Units by name."""
        self.what: dict[str, str] = {name: what for name, _, _, what in told}
        """What each result is, by name."""

    def __getitem__(self, name: str) -> float:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __eq__(self, other: object) -> bool:
        return self._native.equals(other._native) if isinstance(other, Result) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (self._native.state(),))

    @cached_property
    def about(self) -> dict[str, Any]:
        """Everything besides results, series and tables: case, models, what was skipped, balance sheet, events, figures, wall times."""
        return self._native.about()

    @property
    def provenance(self) -> dict[str, Any]:
        """What the run was made of: text of the case, changes, files, resolved values, and their hashes."""
        return self.about["provenance"]

    @property
    def notes(self) -> list[Note]:
        """What a person who relies on the results must know."""
        return [Note(n) for n in self.about["notes"]]

    @property
    def counters(self) -> dict[str, int]:
        """Work of the solver: steps, right-hand sides, film evaluations."""
        return self.about["counters"]

    @property
    def uncertainty(self) -> dict[str, float]:
        """Numerical uncertainty of each result, in its unit, of a run with ``verify=True``; empty otherwise."""
        return (self.about["verification"] or {"uncertainty": {}})["uncertainty"]

    @property
    def ok(self) -> bool:
        """Whether the results are what was asked for: no note is a failure (a cycle that is not periodic, for example)."""
        return all(n["level"] != "failure" for n in self.notes)

    @cached_property
    def series(self) -> Table:
        """Curves over the cycle, or over what the scene runs along."""
        return self._table("series")

    @cached_property
    def tables(self) -> dict[str, Table]:
        """Further tables by name: ``sweep``, natural frequencies, …"""
        return {name: self._table(name) for name in self._native.tables()[1:]}

    def _table(self, name: str) -> Table:
        return Table(self._native.columns(name), lambda k: self._native.column(name, k))

    def to_dataframe(self) -> pandas.DataFrame:
        """The results as a pandas DataFrame: a row each, with ``value``, ``unit`` and ``what``."""
        import pandas as pd

        index = pd.Index(list(self._values), name="result")
        columns = {"value": list(self._values.values()), "unit": list(self.units.values()), "what": list(self.what.values())}
        return pd.DataFrame(columns, index=index)

    def plot(self, name: str | None = None, *, ax: Any = None, backend: str = "matplotlib") -> Any:
        """Draws a figure: one of :attr:`figures`, by matplotlib (what it answers are its axes) or by ``backend="plotly"``.

        Without a name, the first one.
        """
        from . import figures

        return figures.plot(self, name, ax=ax, backend=backend)

    def plot_campbell(self, *, ax: Any = None, backend: str = "matplotlib") -> Any:
        """Draws the Campbell diagram of a shaft line: natural frequencies over the speed, orders as rays, critical speeds where they meet."""
        return self.plot("campbell", ax=ax, backend=backend)

    @property
    def figures(self) -> list[str]:
        """Names of the figures that :meth:`plot` draws."""
        from . import figures

        return list(figures.of(self))

    def write(self, folder: str | PathLike[str]) -> Path:
        """Writes ``report.html``, ``summary.json`` and ``series.csv`` into a folder, as ``gudgeon run --out`` does; answers the path of the report."""
        return Path(self._native.write(Path(folder)))

    def summary(self) -> str:
        """The text of ``summary.json``: :func:`gudgeon.load` reads it as the case that was run."""
        return self._native.summary()

    def __repr__(self) -> str:
        return f"<Result of {self.about['case']}: {len(self)} results, {len(self.series) - 1} curves>"

    def _repr_html_(self) -> str:
        def row(name: str) -> str:
            cells = (f"{self[name]:.4g}", html.escape(self.units[name]), html.escape(self.what[name]))
            number, unit, what = cells
            return f"<tr><th style='text-align:left'><code>{html.escape(name)}</code></th><td style='text-align:right'>{number}</td><td style='text-align:left'>{unit}</td><td style='text-align:left'>{what}</td></tr>"

        told = "".join(f"<li>{html.escape(str(n))}</li>" for n in self.notes if n["level"] != "info")
        head = html.escape(self.about["title"] or self.about["case"])
        return f"<b>{head}</b><table>{''.join(map(row, self))}</table>" + (f"<ul>{told}</ul>" if told else "")


def _restored(state: bytes) -> Result:
    return Result(_native.Outcome.restored(state))
