"""What goes wrong, as exceptions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

__all__ = ["CaseError", "Mistake", "RunError"]


@dataclass(frozen=True)
class Mistake:
    """One mistake of a case, at its place."""

    message: str
    """What is wrong."""
    help: str | None
    """What would be right, where that is known."""
    path: str
    """Path of the value, ``rings.0.cold_gap``; empty for the whole file."""
    file: str
    """The file; ``--set`` for a change, ``--swap`` for a value that is compared."""
    line: int | None
    """Line from 1; none where no place in the text is to blame."""
    column: int | None
    """Column from 1."""


class CaseError(ValueError):
    """A case that cannot be read or built. Its text shows every mistake where it stands.

    >>> import gudgeon
    >>> try:
    ...     gudgeon.loads('scene = "pin"\\nspeed = 3')
    ... except gudgeon.CaseError as e:
    ...     first = e.mistakes[0]
    >>> first.line, first.column, first.message
    (2, 1, 'unknown key `speed`')
    """

    def __init__(self, text: str, mistakes: list[dict[str, Any]] | None = None) -> None:
        super().__init__(text, mistakes)
        self.mistakes: list[Mistake] = [
            Mistake(m["message"], m["help"], m["path"], m["in"], m["line"], m["column"]) for m in mistakes or []
        ]
        """Every mistake, in the order of the file."""

    def __str__(self) -> str:
        return str(self.args[0])


class RunError(RuntimeError):
    """A case that is well-formed and whose run has no result."""

    def __init__(self, message: str, code: str = "", path: str = "") -> None:
        super().__init__(message, code, path)
        self.code = code
        """A word to tell failures apart by: ``refused`` (the input cannot be read), ``impossible`` (there is no such machine), ``model``, ``integration``, ``not_a_number``, ``scene``, ``stopped``."""
        self.path = path
        """Path of the input that is wrong; empty where none is to blame."""

    def __str__(self) -> str:
        return str(self.args[0])
