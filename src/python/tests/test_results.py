"""Results: models that grow, tables, pages, pickles, progress, interruptions and failures."""

import dataclasses
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest
from conftest import DATA, FIXTURES

import allanite


@pytest.fixture(scope="module")
def record(hidden):
    return allanite.read(hidden)


@pytest.fixture(scope="module")
def diagnosis(record):
    return record.fit().diagnose()


def test_the_hidden_effect_is_found_step_by_step(record, diagnosis):
    fit = record.fit()
    assert fit["gx"].adequate is False and fit["gx"]["N"].unit == "deg/s/√Hz"
    assert diagnosis.missing == ("sinusoid",) and diagnosis.verdict == "improved"
    errors = [step.error for step in diagnosis.steps]
    assert errors == sorted(errors, reverse=True) and errors[0] > 10 * errors[-1]
    assert diagnosis.steps[0].added == "sinusoid"
    assert diagnosis["gx"].lines[0].frequency_hz == pytest.approx(7.7, rel=1e-3)
    # The model of the diagnosis has been fitted anew from its shapes, and ends at the same place.
    assert diagnosis.model.chi2 == pytest.approx(errors[-1], rel=1e-6)


def test_adding_an_effect_makes_the_error_fall(record):
    five = record.fit().model
    assert five.chi2 == record.fit()["gx"].chi2
    model = five + allanite.Sinusoid(7.7)
    assert model.before is five and model.error < five.error / 10
    assert f"χ² {five.chi2:.1f} → {model.chi2:.1f}" in str(model)
    assert model["sinusoid"].value == pytest.approx(0.02, rel=0.1)
    frequency = model.effects[-1].parameters["frequency_hz"]
    assert frequency != 7.7 and frequency == pytest.approx(7.7, rel=1e-3)
    # An effect that the record does not have changes hardly anything.
    assert (five + allanite.Sinusoid(19.3, fitted=False)).error > 0.9 * five.error
    back = model - allanite.Sinusoid
    assert back.chi2 == five.chi2
    assert (model - "rate_ramp" + "rate_ramp").chi2 == model.chi2


def test_every_effect_of_the_catalogue_can_be_added(record):
    five = record.fit().model
    names = set()
    known = {
        allanite.RandomTelegraph: (2.0,),
        allanite.DriftingResonance: (12.0, 20.0, 1.0),
        allanite.DriftingSinusoid: (12.0, 1.0),
    }
    for effect in allanite.CATALOGUE:
        names.add(effect.NAME)
        if effect.NAME in {"quantization", "angle_random_walk", "bias_instability", "rate_random_walk", "rate_ramp"}:
            continue
        # A shape that no octave of this record tells is not found by looking for it.
        shape = known.get(effect)
        added = effect() if shape is None else effect(*shape, fitted=False)
        assert (five + added).chi2 > 0, effect
    with pytest.raises(allanite.AllaniteError) as refused:
        five + "sinusiod"
    said = refused.value.remedy
    assert "did you mean sinusoid?" in said
    known = said.split("choose from ")[1].split(", ")
    assert names == set(known)


def test_shapes_are_written_as_on_the_command_line():
    assert allanite.Sinusoid(47).written() == "sinusoid:frequency_hz~47.0"
    assert allanite.Sinusoid(47, fitted=False).written() == "sinusoid:frequency_hz=47.0"
    assert allanite.LowPass(cutoff_hz=42, poles=2, fitted=False).written() == "low_pass:cutoff_hz=42.0,poles=2"
    assert allanite.Sinusoid().written() == "sinusoid"


def test_results_are_frozen(record, diagnosis):
    for result in (record.fit()["gx"], record.fit(), diagnosis, diagnosis["gx"], diagnosis.steps[0], diagnosis.model):
        with pytest.raises(dataclasses.FrozenInstanceError):
            result.axis = "gz"


def test_tables(record, diagnosis, monkeypatch):
    pandas = pytest.importorskip("pandas")
    table = record.fit().table()
    assert isinstance(table, pandas.DataFrame) and list(table["symbol"]) == ["Q", "N", "B", "K", "R"]
    assert list(diagnosis.table()["error"]) == [step.error for step in diagnosis.steps]
    assert len(record.table()) == len(record["gx"].octaves)
    monkeypatch.setitem(sys.modules, "pandas", None)
    rows = record.fit().table()
    assert rows[1]["symbol"] == "N" and rows[1]["axis"] == "gx"


def test_pages_have_the_pictures(record, diagnosis):
    for page in (record.fit()._repr_html_(), diagnosis._repr_html_(), diagnosis.model._repr_html_()):
        assert page.count("<svg") == 1 and "<table>" in page and "Allan deviation" in page
    assert "sinusoid" in diagnosis._repr_html_()
    assert "<table>" in record._repr_html_()
    assert diagnosis.plot(what=["spectrum"]).svg != diagnosis.plot(what="deviation").svg


def test_matplotlib_is_optional(diagnosis):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    ax = diagnosis.plot(ax=pyplot.figure().add_subplot())
    assert len(ax.lines) == 2 and "deg/s" in ax.get_ylabel()
    pyplot.close("all")
    program = "import sys; sys.modules['matplotlib'] = sys.modules['pandas'] = None; import allanite"
    subprocess.run([sys.executable, "-c", program], check=True)


def test_pickles_tell_the_same(record, diagnosis):
    for result in (record, record.fit(), diagnosis):
        again = pickle.loads(pickle.dumps(result))
        assert again == result and again.to_dict() == result.to_dict()
    again = pickle.loads(pickle.dumps(record))
    # What is beside the curve is kept too.
    assert again.diagnose().to_dict() == diagnosis.to_dict()
    again = pickle.loads(pickle.dumps(diagnosis))
    assert again.plot().svg == diagnosis.plot().svg
    assert again.model == diagnosis.model == pickle.loads(pickle.dumps(diagnosis.model))


def test_pickles_keep_why_a_record_is_not_valid():
    rng = np.random.default_rng(2)
    samples = rng.normal(0, 0.05, (60_000, 3))
    samples[20_000:23_000, 2] += 30
    record = allanite.Record.from_numpy(samples, names=["gx", "gy", "gz"], rate=100, unit="deg/s")
    assert record["gz"].invalid
    again = pickle.loads(pickle.dumps(record))
    assert again == record and again.diagnose().to_dict() == record.diagnose().to_dict()
    with pytest.raises(allanite.AllaniteError, match="read the log again"):
        allanite._native.Record.from_bytes(b"nothing of the kind")


def test_failures_have_a_place_and_a_remedy(tmp_path):
    path = tmp_path / "log.csv"
    path.write_text("gx\n" + "1\n2\n" * 50 + "three\n" + "1\n2\n" * 500)
    with pytest.raises(allanite.AllaniteError) as refused:
        allanite.read(path, rate=100, unit="deg/s", columns=["gy"])
    error = refused.value
    assert error.path == str(path) and error.remedy and str(error).startswith(f"{path}: ")
    with pytest.raises(allanite.AllaniteError, match="no such file; check the path"):
        allanite.read(tmp_path / "nothing.csv")
    with pytest.raises(allanite.AllaniteError, match="choose from deg/s, rad/s"):
        allanite.read(path, unit="mph")
    with pytest.raises(TypeError, match="unexpected argument 'speed'"):
        allanite.Record.from_numpy([1, 2, 3], speed=1)
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error) and again.row == error.row
    record = allanite.read(DATA / "adis16405.json")
    with pytest.raises(allanite.AllaniteError, match="there are 3 axes; choose from gx, gy, gz"):
        record.diagnose().steps
    with pytest.raises(allanite.AllaniteError, match='no axis "ga"; choose from'):
        record.fit()["ga"]


def test_a_row_is_named():
    with pytest.raises(allanite.AllaniteError) as refused:
        allanite.deviations(np.array([1.5, 2.0, np.nan] * 100), rate=1)
    assert refused.value.row == 3 and str(refused.value).startswith("array:3: ")


def test_progress_is_told_and_ends_the_work():
    array = np.random.default_rng(0).normal(0, 1, 20_000_000)
    shares = []
    allanite.Record.from_numpy(array, rate=100, unit="deg/s", progress=shares.append)
    assert len(shares) > 2 and shares[-1] == 1.0 and all(0 <= share <= 1 for share in shares)

    def enough(share):
        raise RuntimeError("enough")

    start = time.perf_counter()
    with pytest.raises(RuntimeError, match="enough"):
        allanite.Record.from_numpy(array, rate=100, unit="deg/s", progress=enough)
    assert time.perf_counter() - start < 1
    diagnosed = []
    allanite.read(DATA / "adis16405.json").diagnose(progress=diagnosed.append)
    assert diagnosed[-1] == 1.0


@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.parametrize("source", ["array", "file"])
def test_ctrl_c_ends_the_reading(source, tmp_path):
    array = np.random.default_rng(0).normal(0, 1, 40_000_000)
    path = tmp_path / "log.npy"
    if source == "file":
        np.save(path, array)
    interrupt = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
    interrupt.start()
    start = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        if source == "array":
            allanite.Record.from_numpy(array, rate=100, unit="deg/s")
        else:
            allanite.read(path, rate=100, unit="deg/s")
    assert time.perf_counter() - start < 1.5
    # The package goes on.
    assert allanite.Record.from_numpy(array[:1000], rate=100, unit="deg/s").samples == 1000


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_ends_a_diagnosis():
    record = allanite.read(DATA / "adis16405.json")
    begun = time.perf_counter()
    diagnosis = record.diagnose()
    took = time.perf_counter() - begun
    threading.Timer(0.1 * took, os.kill, (os.getpid(), signal.SIGINT)).start()
    begun = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        record.diagnose()
        time.sleep(took)
    assert time.perf_counter() - begun < 0.6 * took + 0.1
    assert record.diagnose() == diagnosis


def test_types_are_strict(tmp_path):
    pytest.importorskip("mypy")
    user = tmp_path / "user.py"
    user.write_text(
        textwrap.dedent(
            """
            import allanite

            fit: allanite.Fit = allanite.read("log.csv", rate=100).fit()
            value: float | None = fit["gx"]["N"].value
            model: allanite.Model = fit["gx"].model + allanite.Sinusoid(47)
            """
        )
    )
    command = [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports"]
    for what in (["-p", "allanite"], [str(user)]):
        done = subprocess.run([*command, *what], capture_output=True, text=True, check=False, cwd=tmp_path)
        assert done.returncode == 0, done.stdout


def test_a_record_of_an_ulog():
    record = allanite.read(FIXTURES / "gyro.ulg")
    assert record.samples > 0 and "Record of" in repr(record)
