"""Many runs."""

import pickle
import signal
import subprocess
import sys
import time

import numpy as np
import pandas as pd
import pytest

import gudgeon

INNER = [12.0, 12.5, 25.0, 13.0]
"""Inner diameters of a pin of 21.85 mm; the third does not fit."""


def test_rows_come_in_order_and_failures_are_rows(pin):
    rows = pin.run_many([{"pin.inner": (d, "mm")} for d in INNER])
    assert rows["pin.inner"].tolist() == INNER
    expected = [pin.set({"pin.inner": (d, "mm")}).run()["pin_mass"] for d in (12.0, 12.5, 13.0)]
    assert rows["pin_mass"][[0, 1, 3]].tolist() == expected
    assert np.isnan(rows["pin_mass"][2]) and rows.ok.tolist() == [True, True, False, True]
    assert rows.units["pin_mass"] == "g"
    (failure,) = rows.failures
    assert (failure.row, failure.code, failure.path) == (2, "impossible", "pin.inner")
    assert rows["message"][2] == failure.message != ""


def test_any_number_of_threads_gives_the_same(diesel):
    points = [{"engine.speed": (n, "rpm")} for n in (1400, 1800, 2000)]
    one, two = (diesel.run_many(points, threads=n) for n in (1, 2))
    assert list(one) == list(two)
    for name in one.results:
        assert one[name].tobytes() == two[name].tobytes()


def test_points_as_columns(pin):
    listed = pin.run_many([{"pin.inner": (d, "mm")} for d in INNER])
    frame = pd.DataFrame({"pin.inner": INNER}, index=list("abcd"))
    for points in (frame, {"pin.inner": INNER}):
        rows = pin.run_many(points, units={"pin.inner": "mm"})
        np.testing.assert_array_equal(rows["pin_mass"], listed["pin_mass"])
    told = pin.run_many(frame, units={"pin.inner": "mm"}).to_dataframe()
    assert told.index.tolist() == list("abcd") and told.attrs["units"]["pin_mass"] == "g"
    assert told.loc["c", "code"] == "impossible"
    with pytest.raises(ValueError, match="different lengths"):
        pin.run_many({"pin.inner": [1.0], "pin.outer": [1.0, 2.0]})


def test_points_may_leave_inputs_as_they_are(pin):
    rows = pin.run_many([{}, {"pin.inner": (12, "mm")}, {"models.pin_strength.model": "shear_beam"}])
    assert rows.ok.all() and rows["pin_mass"][0] == rows["pin_mass"][2] < rows["pin_mass"][1]


def test_no_points(pin):
    assert len(pin.run_many([])["code"]) == 0


def test_rows_can_be_shown(pin):
    rows = pin.run_many([{"pin.inner": (12, "mm")}])
    assert "pin_mass" in rows._repr_html_() and "1 runs" in repr(rows)


def test_what_is_done_is_kept_when_it_is_stopped(diesel):
    points = [{"engine.speed": (n, "rpm")} for n in np.linspace(1200, 2000, 40)]
    rows = diesel.run_many(points, threads=1, progress=lambda phase, fraction: fraction < 0.05)
    codes = rows["code"].tolist()
    assert "stopped" in codes and codes == sorted(codes)
    done = rows.ok
    assert np.isfinite(rows["blow_by"][done]).all() and np.isnan(rows["blow_by"][~done]).all()


# A process that a shell started in the background ignores Ctrl-C, and so do its children until they say otherwise.
LOOP = """
import gudgeon, signal, numpy as np
signal.signal(signal.SIGINT, signal.default_int_handler)
case = gudgeon.example("turbo-diesel-120")
points = [{"engine.speed": (float(n), "rpm")} for n in np.linspace(1200, 2000, 2000)]
print("begun", flush=True)
try:
    %s
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


@pytest.mark.parametrize("work", ["case.run_many(points)", "case.run(verify=True)"])
def test_ctrl_c(work):
    process = subprocess.Popen([sys.executable, "-c", LOOP % work], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begun\n"
    time.sleep(0.5)
    begin = time.perf_counter()
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=60)
    assert rest == "interrupted\n" and process.returncode == 0
    # Asked every 50 ms; the rest is the step under way, and a busy machine.
    assert time.perf_counter() - begin < 5


def test_functions(pin):
    one = pin.function({"pin.inner": "mm"}, "pin_mass")
    assert one([12.0]) == pin.set({"pin.inner": (12, "mm")}).run()["pin_mass"]
    y = one(np.array(INNER)[:, None])
    assert y.shape == (4,) and np.isnan(y[2])
    two = pin.function({"pin.inner": "mm", "pin.outer": "mm"}, ["pin_mass", "deflection"])
    assert two([12.0, 21.85]).shape == (2,) and two([[12.0, 21.85]] * 3).shape == (3, 2)
    assert two([12.0, 21.85])[0] == one([12.0])
    si = pin.function(["pin.inner"], "pin_mass")
    # 12 mm and 0.012 m are one bit apart at most, and the mass goes with the square.
    assert si([0.012]) == pytest.approx(one([12.0]), rel=1e-15)
    with pytest.raises(ValueError, match="1 inputs"):
        one([1.0, 2.0])
    with pytest.raises(KeyError, match="pin_mass"):
        pin.function({"pin.inner": "mm"}, "weight")


def test_failed_points_of_functions(pin):
    f = lambda failed, outputs="pin_mass": pin.function({"pin.inner": "mm"}, outputs, failed=failed)  # noqa: E731
    assert np.isnan(f("nan")([25.0]))
    with pytest.raises(gudgeon.RunError) as e:
        f("raise")([[12.0], [25.0]])
    assert e.value.code == "impossible" and "point 1" in str(e.value)
    assert f(7.0)([25.0]) == 7.0
    assert f({"pin_mass": 9.0}, ["pin_mass"])([[25.0], [12.0]])[0].tolist() == [9.0]
    with pytest.raises(ValueError, match="failed is"):
        f("never")


def test_functions_pickle(pin):
    f = pin.function({"pin.inner": "mm"}, "pin_mass")
    assert pickle.loads(pickle.dumps(f))([12.0]) == f([12.0])
