"""Reading, changing and explaining cases."""

import pickle

import numpy as np
import pytest
from conftest import CASES

import gudgeon
from gudgeon.values import toml


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.1, "0.1"),
        (1e-5, "1e-05"),
        (3, "3"),
        (np.float64(2.5), "2.5"),
        (np.int64(4), "4"),
        (True, "true"),
        (np.True_, "true"),
        ("off", '"off"'),
        ('a "b" \\ c\n', '"a \\"b\\" \\\\ c\\n"'),
        ((0.5, "mm"), '"0.5 mm"'),
        ((np.float64(1e-9), "m"), '"1e-09 m"'),
        ([1, 2.0], "[1, 2.0]"),
        (np.array([1.0, 2.0]), "[1.0, 2.0]"),
        ([(1, "mm"), "2 mm"], '["1 mm", "2 mm"]'),
        ({"model": "off", "a b": {"c": []}}, '{ model = "off", "a b" = { c = [] } }'),
        ({}, "{}"),
    ],
)
def test_values_as_text(value, text):
    assert toml(value) == text


def test_what_is_no_value_is_refused():
    with pytest.raises(TypeError, match="object"):
        toml(object())


def test_numbers_survive_to_the_bit(diesel):
    for speed in (123.456789012345678, 1 / 3 * 1e3, 1e2 + 1e-13):
        assert diesel.set({"engine.speed": speed}).resolved["engine"]["speed"] == f"{speed!r} rad/s"


def test_a_case_does_not_change(diesel):
    before = list(diesel.overrides)
    changed = diesel.set({"engine.speed": (1500, "rpm"), "models.gas_flow.model": "narrow_channel"})
    assert diesel.overrides == before
    assert changed.overrides == before + ['engine.speed="1500 rpm"', 'models.gas_flow.model="narrow_channel"']
    # 1500 turns a minute in rad/s.
    number, unit = changed.resolved["engine"]["speed"].split()
    assert float(number) == pytest.approx(50 * np.pi, rel=1e-15) and unit == "rad/s"
    # Keys that a model does not have go with it, and that is said.
    other = diesel.set({"models.film_temperature.model": "land_wall_mean"})
    assert "`tdc`, `bdc`, dropped" in other.notes[0] and other.check() == other.notes


def test_mistakes_have_places():
    with pytest.raises(gudgeon.CaseError) as e:
        gudgeon.loads('scene = "rig"\n[rig]\nmodel = "slyder"\n', name="mine.toml")
    first = e.value.mistakes[0]
    assert (first.file, first.line, first.path) == ("mine.toml", 3, "rig")
    assert "slider" in first.help
    assert "mine.toml:3:" in str(e.value) and "──" in str(e.value)


def test_mistakes_of_changes_have_places(diesel):
    with pytest.raises(gudgeon.CaseError) as e:
        diesel.set({"engine.bore": (120, "bar")})
    assert e.value.mistakes[0].file == "--set"
    assert e.value.mistakes[0].path == "engine.bore"
    copy = pickle.loads(pickle.dumps(e.value))
    assert (str(copy), copy.mistakes) == (str(e.value), e.value.mistakes)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(gudgeon.CaseError, match="cannot read"):
        gudgeon.load(tmp_path / "nothing.toml")


def test_cases_pickle_with_the_files_they_name():
    case = gudgeon.load(CASES / "pin-120-turbo-diesel.toml").set({"pin.length": (80, "mm")})
    state = pickle.dumps(case)
    copy = pickle.loads(state)
    assert copy == case and hash(copy) == hash(case)
    assert str(CASES).encode() not in state
    assert copy.run(sweeps=False) == case.run(sweeps=False)


def test_explanation(diesel):
    told = diesel.explain()
    assert "narrow_channel" in str(told)
    assert any(m["model"]["model"] == "narrow_channel" for m in told["models"])
    assert told["resolved"] == diesel.resolved
    assert "narrow_channel" in diesel._repr_html_()


def test_models_are_told():
    assert "narrow_channel" in gudgeon.models("gas_flow")
    assert gudgeon.models()["gas_flow"] == gudgeon.models("gas_flow")
    assert gudgeon.describe("barus") == gudgeon.describe("piezoviscosity/barus")
    assert "ring_pack" in gudgeon.scenes()
    with pytest.raises(KeyError, match="gas_flow"):
        gudgeon.models("gas_flo")
    with pytest.raises(KeyError, match="several kinds"):
        gudgeon.describe("table")
    with pytest.raises(KeyError, match="turbo-diesel-120"):
        gudgeon.example("turbo-diesel")
