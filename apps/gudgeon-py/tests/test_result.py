"""What a run produced."""

import json
import pickle
import threading
import time

import numpy as np
import pytest
from conftest import CASES

import gudgeon


def test_results_have_units_and_meaning(ran):
    assert 60 < ran["blow_by"] < 80  # the README says 66 l/min
    assert ran.units["blow_by"] == "l/min"
    assert ran.what["blow_by"].startswith("gas to the crankcase")
    assert ran.ok
    assert ran.counters["steps"] > 0
    assert ran.provenance["file"] == "turbo-diesel-120.toml"
    with pytest.raises(KeyError):
        ran["blow_bye"]


def test_series_are_arrays(ran):
    lift = ran.series["ring1.lift"]
    assert lift.dtype == np.float64 and lift.flags.writeable and lift is ran.series["ring1.lift"]
    assert ran.series.axis == "theta" and len(lift) == len(ran.series["theta"])
    assert ran.series.units["ring1.lift"] == "m"
    assert np.isfinite(lift).all()


def test_frames_and_datasets(ran):
    frame = ran.series.to_dataframe()
    assert frame.index.name == "theta" and frame.attrs["units"]["ring1.lift"] == "m"
    assert (frame["ring1.lift"].to_numpy() == ran.series["ring1.lift"]).all()
    data = ran.series.to_xarray()
    assert data["ring1.lift"].attrs["units"] == "m" and data.sizes["theta"] == len(frame)
    told = ran.to_dataframe()
    assert told.loc["blow_by", "unit"] == "l/min" and told.loc["blow_by", "value"] == ran["blow_by"]


@pytest.mark.parametrize("name", ["turbo-diesel-120", "compressor-4-throw", "pin-85-alcohol", "rigs/slider-straight", "ea111-1400"])
def test_results_pickle(name):
    r = gudgeon.load(CASES / f"{name}.toml").run()
    copy = pickle.loads(pickle.dumps(r))
    assert copy == r and copy is not r
    assert dict(copy) == dict(r) and copy.about == r.about and copy.what == r.what
    assert copy.summary() == r.summary()
    for table, other in [(r.series, copy.series), *((t, copy.tables[n]) for n, t in r.tables.items())]:
        assert table.units == other.units
        for column in table:
            np.testing.assert_array_equal(table[column], other[column])


def test_equal_is_what_was_computed_and_not_how_long_it_took(diesel, ran):
    assert diesel.run() == ran
    assert diesel.set({"engine.speed": (1900, "rpm")}).run() != ran


def test_a_summary_repeats_the_run(ran, tmp_path):
    report = ran.write(tmp_path / "out")
    assert report.name == "report.html" and report.is_file()
    assert gudgeon.load(tmp_path / "out" / "summary.json").run() == ran
    assert json.loads(ran.summary())["results"]["blow_by"]["value"] == ran["blow_by"]


def test_uncertainty_is_told_when_asked_for():
    case = gudgeon.example("slider-straight")
    assert case.run(sweeps=False).uncertainty == {}
    told = case.run(sweeps=False, verify=True)
    # Exact on any grid, says the case: what is left is rounding.
    assert told.uncertainty["load"] < 1e-9 * told["load"]


def test_html(ran):
    text = ran._repr_html_()
    assert "blow_by" in text and "l/min" in text and "gas to the crankcase" in text


def test_other_threads_go_on(diesel):
    turns = 0
    done = threading.Event()

    def count():
        nonlocal turns
        while not done.is_set():
            turns += 1
            time.sleep(0.001)

    other = threading.Thread(target=count)
    other.start()
    diesel.run()
    done.set()
    other.join()
    # A run takes some 100 ms; a thread that waited for it would have turned once or twice.
    assert turns > 10


def test_progress_is_heard_and_may_end_a_run(diesel):
    heard = []
    with pytest.raises(gudgeon.RunError) as e:
        # Long enough to be asked: it is every 50 ms.
        diesel.set({"solver.tolerance": 1e-8}).run(progress=lambda phase, fraction: heard.append((phase, fraction)) or False)
    assert e.value.code == "stopped"
    assert len(heard) == 1 and 0.0 <= heard[0][1] <= 1.0


def test_what_a_callback_raises_comes_back(diesel):
    def refuse(phase, fraction):
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        diesel.set({"solver.tolerance": 1e-8}).run(progress=refuse)
