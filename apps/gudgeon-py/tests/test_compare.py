"""Comparisons: rows of every combination, and the shares of the choices."""

import math

import pytest

import gudgeon

STRENGTH = {"pin_strength": ["thin_ring", {"model": "shear_beam"}], "pin.modulus": [(200, "GPa"), (210, "GPa")]}


def test_shares_of_one_case(pin):
    told = gudgeon.compare(pin, STRENGTH)
    assert told.ok.all() and list(told)[:2] == ["pin_strength", "pin.modulus"] and told["pin.modulus"].tolist() == [200, 210, 200, 210]
    assert told["deflection"][2] == pin.set({"models.pin_strength.model": "shear_beam", "pin.modulus": (200, "GPa")}).run()["deflection"]
    shares = told.shares
    assert shares.terms == ["pin_strength", "pin.modulus", "pin_strength × pin.modulus"]
    # Of four runs the shares can be taken by hand.
    a, b, c, d = told["deflection"]
    effects = [(a + b - c - d) / 4, (a + c - b - d) / 4, (a + d - b - c) / 4]
    by_hand = [e * e / sum(e * e for e in effects) for e in effects]
    # Sums and differences of four numbers, as deviations from the first.
    assert list(shares["deflection"].values()) == pytest.approx(by_hand, rel=1e-9)
    assert shares.to_dataframe().loc["deflection"].tolist() == list(shares["deflection"].values())
    assert told.by_case["pin-85-alcohol"] is shares and shares.findings and "deflection" in shares.headlines


def test_a_single_choice_has_no_shares(pin):
    told = gudgeon.compare(pin, {"pin_strength": ["thin_ring", "shear_beam"]})
    assert told.shares is None and told.by_case == {} and told.ok.all()


def test_several_cases_are_one_more_choice(pin):
    pin = pin.set({"pin.outer": (22, "mm")})
    told = gudgeon.compare([pin, pin.set({"pin.inner": (12, "mm")})], STRENGTH, results=["pin_mass"])
    names = ["pin-85-alcohol", "pin-85-alcohol, pin.inner=12 mm"]
    assert told["case"].tolist() == [name for name in names for _ in range(4)]
    assert list(told.by_case) == names and told.shares.headlines == ["pin_mass"]
    assert "case × pin_strength" in told.shares.terms
    for result, shares in told.shares.items():
        if told.shares.spread[result] > 0:
            # Sums of eight numbers.
            assert sum(shares.values()) == pytest.approx(1.0, abs=1e-12)


def test_refused_combinations_are_rows_and_left_out(pin):
    told = gudgeon.compare(pin, {"pin_strength": ["thin_ring", "shear_beam"], "pin.inner": [(12, "mm"), (13, "mm"), (25, "mm")]})
    assert told["code"].tolist() == ["", "", "impossible"] * 2 and math.isnan(told["pin_mass"][2])
    assert told.failures[0].path and told.shares.left_out["deflection"] == ["pin.inner=25 mm"]


def test_what_cannot_be_compared(pin, diesel):
    with pytest.raises(gudgeon.CaseError, match="did you mean") as e:
        gudgeon.compare(pin, {"pin_strength": ["thin_rng"]})
    assert e.value.mistakes[0].file == "--swap"
    with pytest.raises(ValueError, match="needs a path"):
        gudgeon.compare(pin, {})
    with pytest.raises(gudgeon.CaseError, match="needs a case"):
        gudgeon.compare([], STRENGTH)
    with pytest.raises(gudgeon.RunError) as stopped:
        gudgeon.compare(diesel, {"gas_flow": ["orifice_network", "narrow_channel"]}, progress=lambda phase, fraction: False)
    assert stopped.value.code == "stopped"
