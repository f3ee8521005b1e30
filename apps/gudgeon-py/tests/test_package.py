"""What the wheel carries beside the code, as the index of Python packages and type checkers read it."""

from importlib import metadata
from pathlib import Path

import gudgeon


def test_metadata():
    told = metadata.metadata("gudgeon")
    assert told["Version"] == gudgeon.__version__
    assert told["License-Expression"] == "MIT OR Apache-2.0"
    assert told["Description-Content-Type"].startswith("text/markdown") and "# Gudgeon from Python" in told["Description"]
    assert told["Requires-Python"] == ">=3.10"


def test_licences_types_and_stubs_are_in_the_wheel():
    files = {Path(f).name: f for f in metadata.files("gudgeon")}
    for name in ("LICENSE-MIT", "LICENSE-APACHE", "py.typed", "_native.pyi"):
        assert files[name].locate().stat().st_size >= (0 if name == "py.typed" else 500), name
