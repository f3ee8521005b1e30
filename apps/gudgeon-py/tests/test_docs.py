"""What the documentation shows: docstrings, the README, notebooks."""

import doctest
import importlib
import json
import pkgutil
import re
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import pytest

import gudgeon

PACKAGE = Path(__file__).parents[1]
NOTEBOOKS = sorted((PACKAGE.parents[1] / "docs" / "notebooks").glob("*.ipynb"))
GUIDE = sorted((PACKAGE.parents[1] / "docs" / "guide" / "src").rglob("*.md"))
OPTIONAL = {"gudgeon.draw_plotly"}
"""Modules that need what the tests may be without."""

MODULES = [m.name for m in pkgutil.iter_modules(gudgeon.__path__, "gudgeon.") if m.name not in OPTIONAL and not m.name.endswith("_native")]


@pytest.mark.parametrize("name", ["gudgeon", *MODULES])
def test_docstrings(name):
    told = doctest.testmod(importlib.import_module(name), optionflags=doctest.NORMALIZE_WHITESPACE)
    assert told.failed == 0


def test_every_public_name_is_documented():
    for name in gudgeon.__all__:
        assert name == "__version__" or getattr(gudgeon, name).__doc__, name


def test_readme(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", (PACKAGE / "README.md").read_text(), re.S)
    # Ten lines that draw a map, comments and blank lines apart.
    assert len([line for line in blocks[0].splitlines() if line.strip()]) <= 10
    names: dict = {}
    for block in blocks:
        exec(block, names)  # noqa: S102
    assert (tmp_path / "blow-by.png").stat().st_size > 10_000
    assert (tmp_path / "out" / "report.html").is_file()


@pytest.mark.parametrize("path", [p for p in GUIDE if "```python" in p.read_text()], ids=lambda p: p.stem)
def test_guide(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names: dict = {}
    for block in re.findall(r"```python\n(.*?)```", path.read_text(), re.S):
        exec(block, names)  # noqa: S102


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_notebooks(path, monkeypatch):
    monkeypatch.chdir(path.parent)
    book = json.loads(path.read_text())
    names: dict = {"__name__": "__main__"}
    for number, cell in enumerate(book["cells"]):
        if cell["cell_type"] == "code":
            # Outputs would hold numbers and pictures of another version: whoever opens a notebook makes them anew.
            assert cell["outputs"] == [] and cell["execution_count"] is None
            exec(compile("".join(cell["source"]), f"{path.name}, cell {number}", "exec"), names)  # noqa: S102
