"""Cases: what is simulated."""

from __future__ import annotations

import html
from collections.abc import Callable, Iterable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

from . import _native
from .function import Function
from .gradients import Gradients
from .result import Result
from .rows import Rows
from .values import Changes, Value, assignments, toml

if TYPE_CHECKING:
    import pandas

__all__ = ["Case", "Explanation", "example", "load", "loads"]

Progress = Callable[[str, float], Union[bool, None]]
"""Hears what is going on and the fraction done, 0 to 1; ends it by answering ``False``."""


class Explanation(dict[str, Any]):
    """What a case would do, as values; its text is for a person.

    Keys: ``models``, ``runs``, ``skipped``, ``results``, ``states``, ``limits``, ``notes``, ``resolved``.
    """

    def __init__(self, text: str, values: dict[str, Any]) -> None:
        super().__init__(values)
        self.text = text

    def __str__(self) -> str:
        return self.text

    __repr__ = __str__


class Case:
    """A case that was read and found to be possible. It does not change: :meth:`set` answers another one.

    It is its text, the changes to it and the files that it names, and that is what is pickled: a case runs equally in another process, or on
    another machine.

    >>> import gudgeon
    >>> case = gudgeon.example("pin-85-alcohol")
    >>> case.name, case.scene
    ('pin-85-alcohol', 'pin')
    >>> thick = case.set({"pin.inner": (12, "mm")})
    >>> thick.run()["pin_mass"] > case.run()["pin_mass"]
    True
    """

    def __init__(self, native: _native.Case) -> None:
        self._native = native
        self.name, self.title, self.source, self.scene = native.heading()

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (self._native.state(),))

    def __eq__(self, other: object) -> bool:
        return self._native.state() == other._native.state() if isinstance(other, Case) else NotImplemented

    def __hash__(self) -> int:
        return hash((self.text, *self.overrides))

    @property
    def text(self) -> str:
        """Text of the case file."""
        return self._native.state()[1]

    @property
    def overrides(self) -> list[str]:
        """Changes to it, as ``--set`` takes them."""
        return self._native.state()[2]

    @property
    def notes(self) -> list[str]:
        """What a person should know although nothing is wrong: keys that a changed model made meaningless, for example."""
        return self._native.notes()

    @property
    def result_names(self) -> list[str] | None:
        """Names of the results that a run may tell; none where the scene does not know them before."""
        return self._native.result_names()

    @property
    def resolved(self) -> dict[str, Any]:
        """Every value in SI units, changes and defaults filled in."""
        return self._native.resolved()

    def set(self, changes: Changes) -> Case:
        """The same case with some values changed: ``{path: value}``.

        A value is text, a number in SI, ``(number, unit)``, true or false, a list, or a dictionary for a table. ``models.KIND.model`` swaps a model;
        what the new one has in common with the old one stays.

        Raises :class:`gudgeon.CaseError` when the changed case is not possible.
        """
        return Case(self._native.changed(assignments(changes)))

    def with_model(self, path: str, model: Mapping[str, Value]) -> Case:
        """The same case with another model at a path, a table with the key ``model``: :func:`gudgeon.tabulated_oil` makes one from a function."""
        return self.set({path: model})

    def check(self) -> list[str]:
        """Everything that could be said before a run: a case that exists was checked, so this answers its notes."""
        return self.notes

    def explain(self) -> Explanation:
        """Models, equations, every default; what runs, what is skipped and why. Prints as text, and is a dictionary."""
        return Explanation(*self._native.explain())

    def run(self, *, sweeps: bool = True, verify: bool = False, threads: int = 0, progress: Progress | None = None) -> Result:
        """Runs the case, with the sweeps that its file declares unless ``sweeps=False``.

        The points of sweeps run on ``threads`` threads (0: one a core); with 1 the case itself does not use a second core either. Results are the same to the bit.
        ``verify`` refines tolerances and grids until the numerical uncertainty of every result is known. Other Python threads go on meanwhile; Ctrl-C
        ends the run. ``progress(phase, fraction)`` hears how far it is, and ends it by answering ``False``.

        Raises :class:`gudgeon.RunError` when there is no result.
        """
        return Result(self._native.run(sweeps, verify, threads, progress))

    def run_many(
        self,
        points: Iterable[Changes] | pandas.DataFrame | Mapping[str, Sequence[Value]],
        *,
        threads: int = 0,
        units: Mapping[str, str] | None = None,
        progress: Progress | None = None,
    ) -> Rows:
        """Runs the case once for each point, on ``threads`` threads (0: one a core), sweeps apart.

        Points are a list of changes as :meth:`set` takes them, or columns by path: a pandas DataFrame or a dictionary of lists. ``units`` gives the units
        of plain numbers by path; without, they are SI.

        Rows come in the order of the points, equal for any number of threads. A point that fails is a row; :attr:`Rows.failures` says why. When
        ``progress`` answers ``False``, what is done is kept.
        """
        inputs, index = _columns(points)
        count = len(next(iter(inputs.values()), ()))
        units = units or {}

        def words(path: str, values: Sequence[Any]) -> list[str | None]:
            unit = units.get(path)
            return [None if v is _LEFT else f"{path}={toml((v, unit) if unit else v)}" for v in values]

        columns = [words(path, values) for path, values in inputs.items()]
        arguments = [[a for c in columns if (a := c[k]) is not None] for k in range(count)]
        told = self._native.run_many(arguments, threads, progress)
        shown = {path: [None if v is _LEFT else v for v in values] for path, values in inputs.items()}
        return Rows(shown, told.columns(), told.failures(), index)

    def function(
        self,
        inputs: Mapping[str, str] | Sequence[str],
        outputs: str | Sequence[str],
        *,
        failed: str | float | Mapping[str, float] = "nan",
        threads: int = 0,
    ) -> Function:
        """The case as a function of numbers, for SALib, Optuna, pymoo, SciPy and others: see :class:`gudgeon.Function`.

        ``inputs`` are paths with the units of their numbers (a list of paths: SI), ``outputs`` names of results. ``failed`` says what a point without
        results answers: ``"nan"``; ``"raise"``, a :class:`gudgeon.RunError`; or a penalty, one number or a number for each output.

        >>> import gudgeon
        >>> f = gudgeon.example("pin-85-alcohol").function({"pin.inner": "mm"}, "pin_mass")
        >>> f([[12], [13]]).round(1)
        array([127.2, 117.7])
        """
        return Function(self, inputs, outputs, failed, threads)

    def gradients(self, inputs: Sequence[str], results: Sequence[str] = (), *, progress: Progress | None = None) -> Gradients:
        """Derivatives of results by the inputs at some paths; of all results where none is named. See :class:`gudgeon.Gradients`.

        A scene that can follows them through its solution, at the cost of a few runs; others are run with each input a little lower and higher.

        Raises ``ValueError`` for an input that is no continuous quantity.
        """
        return Gradients(self._native.gradients(list(inputs), list(results), progress))

    def __repr__(self) -> str:
        changed = f", {len(self.overrides)} changes" if self.overrides else ""
        return f"<Case {self.name}: {self.scene}{changed}>"

    def _repr_html_(self) -> str:
        models = "".join(
            f"<tr><td style='text-align:left'>{html.escape(m['model']['kind'])}</td><th style='text-align:left'><code>{html.escape(m['model']['model'])}</code></th>"
            f"<td style='text-align:left'>{html.escape(m['summary'])}</td></tr>"
            for m in self.explain()["models"]
        )
        changed = "".join(f"<li><code>{html.escape(o)}</code></li>" for o in self.overrides)
        head = f"<b>{html.escape(self.title or self.name)}</b> <code>{html.escape(self.name)}</code> {html.escape(self.scene.replace('_', ' '))}"
        return head + (f"<ul>{changed}</ul>" if changed else "") + f"<table>{models}</table>"


class _Left:
    """A point that leaves an input as it is."""


_LEFT = _Left()


def _columns(points: Any) -> tuple[dict[str, list[Any]], Any]:
    """Points as columns by path, and the index of a DataFrame."""
    if hasattr(points, "columns") and hasattr(points, "index"):
        return {str(c): points[c].tolist() for c in points.columns}, points.index
    if isinstance(points, Mapping):
        columns = {path: list(values) for path, values in points.items()}
        if len({len(c) for c in columns.values()}) > 1:
            raise ValueError("the columns of the points have different lengths")
        return columns, None
    rows = list(points)
    paths = list(dict.fromkeys(path for row in rows for path in row))
    return {path: [row.get(path, _LEFT) for row in rows] for path in paths}, None


def _restored(state: Any) -> Case:
    return Case(_native.Case.restored(state))


def load(path: str | PathLike[str], changes: Changes | None = None) -> Case:
    """Reads a case file, or the ``summary.json`` of a run as the case that was run.

    Raises :class:`gudgeon.CaseError` with every mistake at its place.
    """
    return Case(_native.Case.load(Path(path), assignments(changes or {})))


def loads(text: str, *, folder: str | PathLike[str] = ".", name: str = "case.toml", changes: Changes | None = None) -> Case:
    """Reads a case from its text. ``folder`` is where the names of files in it start, ``name`` stands for the file in messages."""
    return Case(_native.Case.loads(text, Path(folder), name, assignments(changes or {})))


def example(name: str) -> Case:
    """A case that comes with the package: ``turbo-diesel-120`` (ring pack), ``pin-85-alcohol``, ``compressor-6-throw`` (shaft line), ``slider-straight`` (a rig)."""
    return loads(_native.example(name), name=f"{name}.toml")
