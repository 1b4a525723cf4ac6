"""Tables of pandas, polars, pyarrow and DuckDB."""

import numpy as np
import pytest

import allanite

duckdb = pytest.importorskip("duckdb")
pandas = pytest.importorskip("pandas")
polars = pytest.importorskip("polars")
pyarrow = pytest.importorskip("pyarrow")

ROWS = 30_000


@pytest.fixture(scope="module")
def frame():
    rng = np.random.default_rng(5)
    return pandas.DataFrame(
        {
            "stamp": pandas.date_range("2026-01-01", periods=ROWS, freq="10ms"),
            "gx": rng.normal(0, 50, ROWS).round().astype("i2"),
            "gy": rng.normal(0, 0.05, ROWS),
            "gz": rng.normal(0, 0.05, ROWS).astype("f4"),
            "label": ["at rest"] * ROWS,
        }
    )


@pytest.fixture(scope="module")
def expected(frame):
    columns = {name: frame[name].to_numpy() for name in ("gx", "gy", "gz")}
    return allanite.Record.from_numpy(columns, rate=100, unit="deg/s", scale=0.5).fit().to_dict()


def tables(frame):
    arrow = pyarrow.Table.from_pandas(frame)
    pieces = pyarrow.concat_tables([arrow.slice(0, 1), arrow.slice(1, 9_998), arrow.slice(9_999)])
    return {
        "pyarrow": arrow,
        "pyarrow in pieces": pieces,
        "a stream": pieces.to_reader(),
        "polars": polars.from_pandas(frame),
        "pandas": frame,
        "DuckDB": duckdb.sql("select * from frame"),
    }


def test_arrow_tables_give_the_same_record(frame, expected):
    for name, table in tables(frame).items():
        by_rate = allanite.Record.from_arrow(table, rate=100, unit="deg/s", scale=0.5)
        assert by_rate.fit().to_dict() == expected, name


@pytest.mark.parametrize("name", ["pyarrow in pieces", "polars", "pandas", "DuckDB"])
def test_arrow_tables_tell_the_rate_by_their_stamps(frame, name):
    table = tables(frame)[name]
    record = allanite.Record.from_arrow(table, time="stamp", unit="deg/s", columns=["gy", "gz"])
    assert record.rate_hz == pytest.approx(100, rel=1e-9)
    assert [axis.axis for axis in record] == ["gy", "gz"]


def test_frames_of_pandas(frame, expected):
    record = allanite.Record.from_pandas(frame, rate=100, unit="deg/s", scale=0.5)
    assert record.fit().to_dict() == expected
    by_index = allanite.Record.from_pandas(frame.set_index("stamp"), unit="deg/s", scale=0.5)
    assert by_index.rate_hz == pytest.approx(100, rel=1e-9)
    zoned = frame.set_index(frame["stamp"].dt.tz_localize("Europe/Berlin")).drop(columns="stamp")
    assert allanite.Record.from_pandas(zoned, unit="deg/s", scale=0.5).fit().to_dict() == by_index.fit().to_dict()
    by_column = allanite.Record.from_pandas(frame, time="stamp", unit="deg/s", scale=0.5)
    assert by_column.fit().to_dict() == by_index.fit().to_dict()
    series = allanite.Record.from_pandas(frame["gy"], rate=100, unit="deg/s")
    assert [axis.axis for axis in series] == ["gy"]


def test_missing_values_are_lost_samples(frame):
    nullable = frame.drop(columns="label").astype({"gx": "Int32"})
    nullable.loc[7, "gx"] = pandas.NA
    records = [
        allanite.Record.from_pandas(nullable, rate=100, unit="deg/s"),
        allanite.Record.from_arrow(pyarrow.Table.from_pandas(nullable), rate=100, unit="deg/s"),
        allanite.Record.from_arrow(polars.from_pandas(nullable), rate=100, unit="deg/s"),
    ]
    assert [record.samples for record in records] == [ROWS - 1] * 3
    assert records[0].fit().to_dict() == records[1].fit().to_dict() == records[2].fit().to_dict()


def test_what_is_no_table_is_refused():
    with pytest.raises(allanite.AllaniteError, match="no __arrow_c_stream__; give a table"):
        allanite.Record.from_arrow([1, 2, 3], rate=100)
    with pytest.raises(allanite.AllaniteError, match="no columns"):
        allanite.Record.from_arrow(pyarrow.table({"a": ["x", "y"]}), rate=100)
    with pytest.raises(allanite.AllaniteError, match="no rows"):
        allanite.Record.from_arrow(pyarrow.table({"gx": pyarrow.array([], "f8")}), rate=100)
