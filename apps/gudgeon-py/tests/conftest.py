"""What the tests share."""

from pathlib import Path

import pytest

import gudgeon

CASES = Path(__file__).parents[3] / "cases"
"""The cases of the checkout."""


@pytest.fixture(scope="session")
def diesel() -> gudgeon.Case:
    """With faces that always find oil: a quarter of the time."""
    return gudgeon.load(CASES / "turbo-diesel-120.toml").set({"models.oil_transport.model": "off"})


@pytest.fixture(scope="session")
def pin() -> gudgeon.Case:
    return gudgeon.example("pin-85-alcohol")


@pytest.fixture(scope="session")
def ran(diesel: gudgeon.Case) -> gudgeon.Result:
    return diesel.run()
