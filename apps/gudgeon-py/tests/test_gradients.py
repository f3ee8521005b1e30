"""Derivatives of results by inputs."""

import numpy as np
import pytest

import gudgeon


def test_derivatives_of_a_pin(pin):
    told = pin.gradients(["pin.outer", "pin.inner"], ["pin_mass"])
    # Mass of a tube in g; the circle ratio that this case has from its source.
    factor = 7850e3 * 61.9e-3 * 3.14159267 / 2
    # Central differences of a square are exact; what is left is rounding over the step, a thousandth.
    np.testing.assert_allclose(told["pin_mass"], [factor * 21.85e-3, -factor * 13.94e-3], rtol=1e-9)
    assert told.at["pin.outer"] == pytest.approx(21.85e-3) and told.inputs["pin.outer"] == "m" and told.units["pin_mass"] == "g"
    assert told.to_dataframe().loc["pin_mass", "pin.inner"] == told["pin_mass"][1]
    assert told.units_by["pin_mass"] == {"pin.outer": "g/m", "pin.inner": "g/m"} == told.to_dataframe().attrs["units"]["pin_mass"]
    assert set(pin.gradients(["pin.inner"])) == set(pin.run())


def test_derivatives_can_be_ended(diesel):
    # Followed along a cycle, which takes longer than the 50 ms after which Python is asked.
    with pytest.raises(gudgeon.RunError) as e:
        diesel.gradients(["rings.0.cold_gap"], progress=lambda phase, fraction: False)
    assert e.value.code == "stopped"


def test_inputs_that_are_no_quantities(pin):
    with pytest.raises(ValueError, match="pin_strength"):
        pin.gradients(["models.pin_strength.model"])
    with pytest.raises(gudgeon.RunError, match="weight"):
        pin.gradients(["pin.inner"], ["weight"])
