"""Models written in Python."""

import math
import pickle

import numpy as np
import pytest
from conftest import CASES

import gudgeon


def sae_30(T):
    """The Vogel equation with the constants of `vogel_grade`: zottin1992, sae_30."""
    return 0.1531e-8 * 9.80665e4 * math.exp(720.015 / (T - 273.15 + 71.123))


def test_an_oil(diesel):
    vogel = diesel.set({"models.oil": {"model": "vogel_grade", "table": "zottin1992", "grade": "sae_30"}})
    own = diesel.with_model("models.oil", gudgeon.tabulated_oil(sae_30, T=(300, 480)))
    a, b = vogel.run(), own.run()
    for name in ("blow_by", "friction_power"):
        # A viscosity off by 1e-5 moves the steps of the integrator, whose tolerance is 1e-4 a step.
        assert b[name] == pytest.approx(a[name], rel=1e-3)
    assert any(m["model"] == "table" and m["kind"] == "oil" for m in b.about["models"])


def test_a_case_with_own_models_is_a_case(diesel, tmp_path):
    own = diesel.with_model("models.oil", gudgeon.tabulated_oil(sae_30, T=(300, 480)))
    r = own.run()
    assert pickle.loads(pickle.dumps(own)).run() == r
    r.write(tmp_path)
    assert gudgeon.load(tmp_path / "summary.json").run() == r


@pytest.mark.parametrize("tolerance", [1e-3, 1e-5])
def test_an_oil_is_within_its_tolerance(tolerance):
    told = gudgeon.tabulated_oil(sae_30, T=(300, 480), tolerance=tolerance)
    rig = gudgeon.load(CASES / "rigs/lubricant.toml")
    case = rig.set({"rig.oil": told, "rig.piezoviscosity": {"model": "off"}, "rig.shear_thinning": {"model": "off"}, "rig.pressure": 0.0})
    T = np.linspace(301, 479, 97)
    rows = case.run_many([{"rig.temperature": (float(t), "K")} for t in T])
    exact = 1e3 * np.array([sae_30(t) for t in T])  # mPa s
    # Errors are looked for at the quarters of the intervals; between them they are larger by a fifth at most (a cubic's error is smooth).
    assert np.abs(rows["viscosity"] / exact - 1).max() < 1.2 * tolerance


def test_a_cylinder_pressure(diesel):
    first = diesel.run()
    theta, p = first.series["theta"], first.series["cylinder.p"]
    own = gudgeon.tabulated_cylinder_pressure(lambda t: float(np.interp(t % 720, theta, p, period=720)) , tolerance=1e-3)
    r = diesel.with_model("models.cylinder_pressure", own).run()
    # The curve is made of straight lines between the rows of the series: its corners cost a thousandth of the peak.
    assert np.abs(np.interp(theta, r.series["theta"], r.series["cylinder.p"]) - p).max() < 3e-3 * p.max()
    assert r["blow_by"] == pytest.approx(first["blow_by"], rel=5e-3)


def test_a_drive():
    drive = gudgeon.tabulated_drive(lambda n: 4000 * math.sin(math.pi * n / 2000) ** 2, rpm=(0, 2000))
    n, torque = np.array(drive["speed_rpm"]), np.array(drive["torque"])
    assert n[0] == 0 and n[-1] == 2000 and (np.diff(n) > 0).all()
    assert torque.max() == pytest.approx(4000)


def test_a_line_with_an_own_drive():
    case = gudgeon.load(CASES / "compressor-4-throw.toml")
    # What the case says: 1895 N m at 1000 rpm, nothing at 1015 rpm.
    drive = gudgeon.tabulated_drive(lambda n: 1895 * (1015 - n) / 15, rpm=(900, 1100))
    own, given = case.with_model("drives.0.drive", drive).run(), case.run()
    assert list(own) == list(given)
    for name in given:
        # Both are straight lines: rounding of the interpolation, through the solution of the line.
        assert own[name] == pytest.approx(given[name], rel=1e-9, abs=1e-9), name


@pytest.mark.parametrize(
    ("f", "said"),
    [(lambda T: -1.0, "positive"), (lambda T: math.nan, "positive"), (lambda T: 0.1 if T > 350 else 0.2, "jump"), (lambda T: 1 / 0, "division")],
)
def test_functions_that_are_no_model(f, said):
    with pytest.raises((ValueError, ZeroDivisionError), match=said):
        gudgeon.tabulated_oil(f)
