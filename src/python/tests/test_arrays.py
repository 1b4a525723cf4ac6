"""Arrays of any type and layout, without copies and without the interpreter's lock."""

import gc
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest
from conftest import document

import allanite

OPTIONS = {"rate": 100, "unit": "deg/s", "scale": 0.01}
WORDS = ["--rate", 100, "--unit", "deg/s", "--scale", 0.01]


def counts(rows=20_000, axes=3, seed=7):
    return np.random.default_rng(seed).normal(0, 50, (rows, axes)).round().astype("i4")


def saved(tmp_path, array):
    path = tmp_path / "array.npy"
    np.save(path, array)
    return path


@pytest.mark.parametrize("kind", ["i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", "f4", "f8"])
def test_every_type_is_read_as_from_a_file(kind, tmp_path):
    array = counts()
    array = (array % 100 if kind in ("i1", "u1") else np.abs(array) if kind[0] == "u" else array).astype(kind)
    record = allanite.Record.from_numpy(array, **OPTIONS)
    expected = document("fit", saved(tmp_path, array), *WORDS)
    assert record.fit().to_dict() == expected


def test_decimals_are_read_as_from_a_file(tmp_path):
    array = counts() * 0.0123
    record = allanite.Record.from_numpy(array, rate=100, unit="deg/s")
    path = saved(tmp_path, array)
    assert record.fit().to_dict() == document("fit", path, "--rate", 100, "--unit", "deg/s")
    assert record.diagnose().to_dict() == document("diagnose", path, "--rate", 100, "--unit", "deg/s")


def test_every_layout_gives_the_same_record():
    array = counts()
    wide = np.zeros((len(array), 7), "i4")
    wide[:, 1:7:2] = array
    packed = np.zeros(len(array), np.dtype([("tag", "u1"), ("g", "i4", 3)], align=False))
    packed["g"] = array
    layouts = {
        "rows": array,
        "columns": np.asfortranarray(array),
        "strided": wide[:, 1:7:2],
        "backwards": array[::-1][::-1],
        "big-endian": array.astype(">i4"),
        "not aligned": packed["g"],
        "read-only": np.lib.stride_tricks.as_strided(array, writeable=False),
        "mapping": {"c1": array[:, 0], "c2": array[:, 1].copy(), "c3": array[:, 2]},
    }
    names = ["c1", "c2", "c3"]
    expected = allanite.Record.from_numpy(array, names=names, **OPTIONS).fit().to_dict()
    for name, layout in layouts.items():
        record = allanite.Record.from_numpy(layout, columns=["c1=1", "c2=2", "c3=3"], **OPTIONS)
        assert record.fit().to_dict() == expected, name


def test_names_and_columns():
    record = allanite.Record.from_numpy(counts(), names=["gx", "gy", "temp"], columns=["gy"], **OPTIONS)
    assert [axis.axis for axis in record] == ["gy"]
    assert record["gy"].samples == 20_000 == record.samples
    assert record.rate_hz == 100 and record.unit == "deg/s"


@pytest.mark.parametrize("stamps", ["datetime64", "seconds", "microseconds"])
def test_time_stamps_tell_the_rate_and_the_gaps(stamps):
    ticks = np.arange(20_000) * 10_000
    ticks[12_000:] += 5_000_000
    time_ = {"datetime64": ticks.astype("datetime64[us]"), "seconds": ticks * 1e-6, "microseconds": ticks}[stamps]
    unit = {"datetime64": None, "seconds": "s", "microseconds": "us"}[stamps]
    record = allanite.Record.from_numpy(counts(), time=time_, time_unit=unit, unit="deg/s", scale=0.01)
    assert abs(record.rate_hz - 100) < 1e-6
    assert record.axes[0].gaps == 1 or any("gap" in note for note in record.notes)
    # A single long step of the stamps leaves all samples.
    assert record.samples == 20_000


def test_a_row_that_is_no_number_is_lost():
    array = counts() * 0.01
    whole = allanite.Record.from_numpy(array, rate=100, unit="deg/s")
    array[5000, 1] = np.nan
    record = allanite.Record.from_numpy(array, rate=100, unit="deg/s")
    assert record.samples == whole.samples - 1
    assert any("row" in note for note in record.notes)
    masked = np.ma.masked_array(counts(), mask=np.zeros_like(counts(), bool))
    masked.mask[5000, 1] = True
    assert allanite.Record.from_numpy(masked, **OPTIONS).samples == whole.samples - 1


def test_a_structured_array_is_a_table():
    array = np.zeros(20_000, [("gx", "i2"), ("temp_C", "f4"), ("gy", "i4")])
    array["gx"], array["gy"] = counts().T[:2]
    record = allanite.Record.from_numpy(array, **OPTIONS)
    assert [axis.axis for axis in record] == ["gx", "gy"]
    columns = {name: array[name].copy() for name in array.dtype.names}
    assert record == allanite.Record.from_numpy(columns, **OPTIONS)


def test_covariates(tmp_path):
    rng = np.random.default_rng(1)
    temperature = 20 + 5 * np.sin(np.arange(60_000) / 4000)
    columns = {"gx": rng.normal(0, 0.05, 60_000) + 0.01 * temperature, "temp_C": temperature}
    record = allanite.Record.from_numpy(columns, rate=100, unit="deg/s")
    assert record["gx"].covariates == ("temp_C", "rate(temp_C)")
    diagnosis = record.diagnose()
    assert diagnosis.missing[0] == "covariate"
    path = tmp_path / "log.csv"
    rows = np.column_stack(list(columns.values()))
    np.savetxt(path, rows, delimiter=",", header="gx,temp_C", comments="", fmt="%.17g")
    assert diagnosis.to_dict() == document("diagnose", path, "--rate", 100, "--unit", "deg/s")
    # The model that effects are added to is what is left when the covariate is subtracted.
    assert diagnosis.model.chi2 == pytest.approx(diagnosis.steps[-1].chi2, rel=1e-2)
    without = allanite.Record.from_numpy(columns, rate=100, unit="deg/s", covariates=False)
    assert without["gx"].covariates == ()


@pytest.mark.parametrize(
    ("samples", "options", "what"),
    [
        (np.zeros((10, 3, 2)), {}, "3 dimensions"),
        (np.zeros((3, 1000)), {}, "its transpose"),
        (np.array(["a", "b"]), {}, "not plain numbers"),
        (np.zeros(0), {}, "no rows"),
        (np.zeros(1000), {}, "never changes"),
        (np.arange(5.0) ** 2, {}, "5 samples are too few"),
        (counts(), {"unit": "mph"}, "choose from deg/s, rad/s"),
        (counts(), {"rate": -1}, "rate=-1 is impossible"),
        (counts(), {"columns": ["7"]}, "there is no column"),
        ({"a": np.zeros(3), "b": np.zeros(4)}, {}, "columns of one length"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(samples, options, what):
    with pytest.raises(allanite.AllaniteError) as refused:
        allanite.Record.from_numpy(samples, **{**OPTIONS, **options})
    line = str(refused.value)
    assert what in line and "; " in line and "\n" not in line and "--" not in line, line


def test_a_rate_is_needed():
    with pytest.raises(allanite.AllaniteError, match="give it with rate="):
        allanite.Record.from_numpy(counts())


def test_the_lock_is_released():
    array = np.random.default_rng(0).normal(0, 50, 20_000_000).astype("i4")
    begun = threading.Event()
    turns = []

    def count():
        begun.wait()
        while not done:
            turns.append(time.perf_counter())
            time.sleep(0.001)

    done = False
    thread = threading.Thread(target=count)
    thread.start()
    begun.set()
    start = time.perf_counter()
    allanite.Record.from_numpy(array, **OPTIONS)
    took = time.perf_counter() - start
    done = True
    thread.join()
    # With the lock held, this thread would not have run at all meanwhile.
    assert len(turns) > 20 * took


def test_an_array_is_not_copied():
    """The peak of a process that reads an array of 320 MB lies less than 40 MB above that of one that has it."""
    program = """
        import resource, sys
        import numpy as np
        import allanite
        peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        allanite.Record.from_numpy(np.random.default_rng(0).normal(0, 1, (1000, 2)), rate=100, unit="deg/s")
        array = np.random.default_rng(0).normal(0, 1, (20_000_000, 2))
        before = peak()
        allanite.Record.from_numpy(array, rate=100, unit="deg/s")
        allanite.Record.from_numpy(np.asfortranarray(array[:100]), rate=100, unit="deg/s")
        print(before, peak())
    """
    command = [sys.executable, "-c", textwrap.dedent(program)]
    before, after = map(float, subprocess.run(command, capture_output=True, text=True, check=True).stdout.split())
    assert before > 300
    assert after - before < 40, (before, after)
    gc.collect()
