"""Values of a case as the text that changes it."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Union

__all__ = ["Changes", "Value", "assignments", "toml"]

Value = Union[str, bool, int, float, tuple[float, str], Sequence[Any], Mapping[str, Any]]
"""A value of a case: text, a number in SI, ``(number, unit)``, true or false, a list, or a table."""

Changes = Mapping[str, Value]
"""Paths with their new values, ``{"engine.speed": (2000, "rpm")}``."""

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def _key(key: str) -> str:
    return key if _BARE.fullmatch(key) else json.dumps(key)


def _number(value: float) -> str:
    if math.isnan(value):
        return "nan"
    if math.isinf(value):
        return "inf" if value > 0 else "-inf"
    return repr(value)


def _is_quantity(value: Any) -> bool:
    return isinstance(value, tuple) and len(value) == 2 and isinstance(value[1], str) and not isinstance(value[0], str)


def toml(value: Any) -> str:
    """The text of a value in a case file.

    >>> toml((2000, "rpm")), toml(0.5), toml(True), toml("barus")
    ('"2000 rpm"', '0.5', 'true', '"barus"')
    >>> toml({"model": "constant", "viscosity": (8, "mPa s")})
    '{ model = "constant", viscosity = "8 mPa s" }'
    """
    # What NumPy and pandas hold, as Python has it.
    if hasattr(value, "tolist"):
        value = value.tolist()
    elif hasattr(value, "item") and not isinstance(value, (str, bytes)):
        value = value.item()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        # The escapes of JSON are those of TOML.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return _number(value)
    if _is_quantity(value):
        number = value[0].item() if hasattr(value[0], "item") else value[0]
        return json.dumps(f"{_number(number) if isinstance(number, float) else number} {value[1]}".rstrip(), ensure_ascii=False)
    if isinstance(value, Mapping):
        inner = ", ".join(f"{_key(str(k))} = {toml(v)}" for k, v in value.items())
        return f"{{ {inner} }}" if inner else "{}"
    if isinstance(value, Iterable):
        return f"[{', '.join(toml(v) for v in value)}]"
    raise TypeError(f"a case has no value like {value!r}: text, number, (number, unit), true or false, list, or table")


def assignments(changes: Changes) -> list[str]:
    """Changes as the arguments of ``--set``."""
    return [f"{path}={toml(value)}" for path, value in changes.items()]
