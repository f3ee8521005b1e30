"""Figures: that they show what the result says. How they look was looked at."""

import json
import re

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest

import gudgeon
from gudgeon import figures


@pytest.fixture(scope="module")
def line() -> gudgeon.Result:
    return gudgeon.example("compressor-6-throw").run()


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def test_pressures_are_those_of_the_series(ran):
    ax = ran.plot("pressures")
    cylinder = next(c for c in ax.lines if c.get_label() == "cylinder")
    # Drawn in bar.
    np.testing.assert_allclose(cylinder.get_ydata(), ran.series["cylinder.p"] * 1e-5)
    assert ax.get_ylabel() == "bar" and ax.get_yscale() == "log"
    assert "behind ring 1" in [c.get_label() for c in ax.lines]


def test_every_figure_can_be_drawn(ran, line, pin):
    for r in (ran, line, pin.run(), gudgeon.example("slider-straight").run()):
        assert r.figures
        for name in r.figures:
            ax = r.plot(name)
            assert ax.get_title(loc="left") and (ax.lines or ax.collections or ax.patches)
            plt.close("all")


def test_figures_go_into_axes(ran):
    _, (a, b) = plt.subplots(2)
    assert ran.plot("lift", ax=a) is a and ran.plot("film", ax=b) is b


def test_campbell(line):
    ax = line.plot_campbell()
    table = line.tables["interference"]
    first = next(c for c in ax.lines if c.get_label() == "mode 1")
    np.testing.assert_array_equal(first.get_ydata(), table["mode1"])
    marks = next(c for c in ax.lines if c.get_label() == "critical speeds")
    # A critical speed is where an order meets a mode: its frequency is a whole multiple of half the speed, to the digits of the table.
    orders = 60 * np.asarray(marks.get_ydata()) / np.asarray(marks.get_xdata())
    assert np.abs(2 * orders - np.round(2 * orders)).max() < 1e-6


def test_names_that_do_not_exist(ran):
    with pytest.raises(KeyError, match="pressures"):
        ran.plot("pressure")
    with pytest.raises(KeyError, match="campbell"):
        ran.plot_campbell()
    with pytest.raises(ValueError, match="plotly"):
        ran.plot("lift", backend="gnuplot")


def test_plotly(ran, line, pin):
    pytest.importorskip("plotly")
    for r in (ran, line, pin.run(), gudgeon.example("slider-straight").run()):
        for name in r.figures:
            assert r.plot(name, backend="plotly").to_dict()["layout"]["title"]["text"]


def test_curves_are_those_of_the_page(ran, tmp_path):
    ran.write(tmp_path)
    page = (tmp_path / "report.html").read_text()
    groups = json.loads(re.search(r"const OVER_CYCLE = (\[.*?\n\]);", page, re.S)[1])
    named = {g["name"]: g for g in groups if "#" not in g["name"]}
    drawn = {name: f for name, f in figures.of(ran).items() if name in named}
    assert {"pressures", "film", "gas_mass", "friction_power"} <= set(drawn)
    assert all(f.title == named[name]["title"] for name, f in drawn.items())
    # Gas at the cylinder has no colour of a ring, the land below a ring and the space behind it that of the ring.
    colours = {c.label: (c.color, c.dash) for c in drawn["pressures"].curves}
    assert colours["cylinder"] == (None, False) and colours["land 2"] == (0, False) and colours["behind ring 1"] == (0, True)
    assert figures.of(ran)["ring2_forces"].title == "Axial forces on ring 2"
