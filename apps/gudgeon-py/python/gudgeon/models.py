"""What a case may say: kinds, models, scenes."""

from __future__ import annotations

from typing import Any

from . import _native

__all__ = ["describe", "models", "scenes"]


def models(kind: str | None = None) -> dict[str, Any]:
    """The models of one kind, ``{model: summary}``, or of all kinds, ``{kind: {model: summary}}``.

    >>> import gudgeon
    >>> sorted(gudgeon.models("oil"))
    ['constant', 'table', 'vogel', 'vogel_grade', 'walther']
    """
    told = {k["kind"]: {m["model"]: m["summary"] for m in k["models"]} for k in _native.kinds(kind)}
    return told if kind is None else next(iter(told.values()))


def describe(what: str) -> dict[str, Any]:
    """Everything that is known of a model: ``summary``, ``equations``, ``validity``, ``references``, ``example``, ``schema``, ``source``.

    >>> import gudgeon
    >>> gudgeon.describe("piezoviscosity/barus")["equations"]
    ['mu = mu0 exp(alpha p)']
    """
    return _native.model(what)


def scenes() -> dict[str, str]:
    """What can be simulated: ``{scene: summary}``."""
    return dict(_native.scene_names())
