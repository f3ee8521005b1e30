"""Cases with every combination of some models or settings, and which of these choices matter."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING, Any

from . import _native
from .case import Case, Progress
from .rows import Rows
from .values import Value, toml

if TYPE_CHECKING:
    import pandas

__all__ = ["Comparison", "Shares", "compare"]


class Shares(Mapping[str, dict[str, float]]):
    """Which part of the variance of each result each choice explains: a mapping from results to ``{term: share}``.

    A term is a choice, ``gas_flow``, or an interaction, ``gas_flow × ring_motion``; ``case`` in it tells cases apart. The shares of a result make 1; one that too many
    failed combinations leave open is not a number (NaN). ``docs/guide/src/studies.md`` says what they mean.
    """

    def __init__(self, told: dict[str, Any]) -> None:
        rows: list[dict[str, Any]] = told["rows"]
        self.terms: list[str] = told["effects"]
        """Choices, then interactions."""
        self.spread: dict[str, float] = {r["result"]: r["spread"] for r in rows}
        """Standard deviation of each result over the combinations of a case: an angle's in degrees, any other in per cent of the mean magnitude."""
        self.headlines: list[str] = [r["result"] for r in rows if r["headline"] and r.get("same_as") is None]
        """Results to look at first, without those that are another one times a constant."""
        self.left_out: dict[str, list[str]] = {r["result"]: r["left_out"] for r in rows if r.get("left_out")}
        """Values that the shares of a result are without, ``gas_flow=prescribed``, because not all combinations with them have the result."""
        self.within_numerics: dict[str, list[str]] = {
            r["result"]: [term for term, s in zip(self.terms, r["shares"]) if s and s["within_numerics"]] for r in rows
        }
        """Terms that the numerical uncertainties of a result can make."""
        self.findings: list[str] = told["findings"]
        """What follows, a sentence each."""
        self._of = {r["result"]: {term: s["share"] if s else float("nan") for term, s in zip(self.terms, r["shares"])} for r in rows}

    def __getitem__(self, result: str) -> dict[str, float]:
        return self._of[result]

    def __iter__(self) -> Iterator[str]:
        return iter(self._of)

    def __len__(self) -> int:
        return len(self._of)

    def __repr__(self) -> str:
        return f"<shares of {', '.join(self.terms)} in {len(self)} results>"

    def to_dataframe(self) -> pandas.DataFrame:
        """The shares as a pandas DataFrame: a row a result, a column a term."""
        import pandas as pd

        return pd.DataFrame.from_dict(self._of, orient="index", columns=self.terms)


class Comparison(Rows):
    """The runs of a comparison, a row each, and the shares of its choices."""

    shares: Shares | None
    """Over all cases together; none where there is only one choice to make."""
    by_case: dict[str, Shares]
    """Over each case alone; empty where there is only one swap."""


def compare(
    cases: Case | Sequence[Case],
    swaps: Mapping[str, Sequence[Value]],
    *,
    verify: bool = False,
    results: Sequence[str] = (),
    threads: int = 0,
    progress: Progress | None = None,
) -> Comparison:
    """Runs a case, or several, with every combination of ``swaps``, the last one fastest: a row each, and which of the choices matter.

    A swap is a path with its values; the name of a kind stands for the name of its model, ``gas_flow`` for ``models.gas_flow.model``, and a value may be a table with a model's
    settings. Several cases are one more choice, ``case``; those of one file are told apart by what :meth:`Case.set` changed. A combination that cannot be is left out: its row
    has the code ``impossible`` and the reason, and no results.

    ``verify`` finds the numerical uncertainty of every result, which tells small shares from numerics; ``results`` are those to look at first.

    Raises :class:`gudgeon.CaseError` when no combination is possible, and :class:`gudgeon.RunError` when ``progress`` ends it.

    >>> import gudgeon
    >>> pin = gudgeon.example("pin-85-alcohol")
    >>> told = gudgeon.compare(pin, {"pin_strength": ["thin_ring", "shear_beam"], "pin.modulus": [(200, "GPa"), (210, "GPa")]})
    >>> told["pin_strength"].tolist(), told["deflection"].round(4).tolist()
    (['thin_ring', 'thin_ring', 'shear_beam', 'shear_beam'], [0.0348, 0.0331, 0.0819, 0.078])
    >>> {term: round(share, 3) for term, share in told.shares["deflection"].items()}
    {'pin_strength': 0.996, 'pin.modulus': 0.004, 'pin_strength × pin.modulus': 0.001}
    """
    if not swaps:
        raise ValueError("a comparison needs a path with values: {\"gas_flow\": [\"orifice_network\", \"narrow_channel\"]}")
    of = [cases] if isinstance(cases, Case) else list(cases)
    written = [(path, [_written(v) for v in values]) for path, values in swaps.items()]
    told, names, tables = _native.compare([c._native for c in of], written, verify, list(results), threads, progress)
    points = list(product(names, *swaps.values()))
    inputs = dict(zip(["case", *swaps], zip(*points)))
    if len(of) == 1:
        del inputs["case"]
    rows = Comparison(inputs, told.columns(), told.failures())
    shares = {t["case"]: Shares(t) for t in tables}
    rows.shares = shares.get(names[0] if len(of) == 1 else None)
    rows.by_case = {name: s for name, s in shares.items() if name is not None}
    return rows


_PLAIN = re.compile(r"""(?!(true|false|inf|nan)$)[A-Za-z_]\w*|[-+0-9.e]+ [A-Za-z%°][^"\\#]*""")


def _written(value: Value) -> str:
    """A value as the command line has it: words and quantities without quotes."""
    text = toml(value)
    return text[1:-1] if text[0] == '"' and _PLAIN.fullmatch(text[1:-1]) else text
