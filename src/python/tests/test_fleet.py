"""Many devices on an engine for tables: the same states and coefficients, whatever the partitions."""

import concurrent.futures.process
import multiprocessing
import os
import random
import shutil
import signal
import sys

import numpy as np
import pytest

import allanite
from allanite import fleet

pa = pytest.importorskip("pyarrow")
pq = pytest.importorskip("pyarrow.parquet")
datafusion = pytest.importorskip("datafusion")

DEVICES = 3
SAMPLES = 40_000


def samples(device, axis):
    generator = np.random.default_rng(100 * device + axis)
    drift = np.cumsum(generator.integers(-1, 2, SAMPLES)) // 8
    return (generator.normal(0, 30 + 10 * axis, SAMPLES).round() + drift).astype("i4")


def rows(lengths):
    """Rows of batches, of lengths that are drawn."""
    found = []
    for device in range(DEVICES):
        for axis in range(2):
            counts = samples(device, axis)
            start = 0
            while start < SAMPLES:
                length = lengths()
                part = counts[start : start + length]
                found.append({"device": f"d{device}", "axis": "xy"[axis], "start": start, "rate": 200.0, "scale": 0.01, "counts": part})
                start += length
    return found


SCHEMA = pa.schema(
    [("device", pa.string()), ("axis", pa.string()), ("start", pa.int64()), ("rate", pa.float64()), ("scale", pa.float64()),
     ("counts", pa.list_(pa.int32()))]
)


def write(folder, rows, files, generator):
    generator.shuffle(rows)
    folder.mkdir()
    for at in range(files):
        table = pa.Table.from_pylist(rows[at::files], SCHEMA)
        pq.write_table(table, folder / f"{at}.parquet", row_group_size=generator.choice([3, 1000]))


def session(partitions=2):
    settings = datafusion.SessionConfig().with_target_partitions(partitions).with_batch_size(random.Random(partitions).choice([16, 8192]))
    return fleet.register(datafusion.SessionContext(settings))


def table(context, query):
    return pa.Table.from_batches(context.sql(query).collect())


STATES = "SELECT device, axis, allan_state(start, counts, rate, scale) AS state FROM logs GROUP BY device, axis ORDER BY device, axis"


@pytest.fixture(scope="module")
def expected():
    found = []
    for device in range(DEVICES):
        for axis in range(2):
            pieces = allanite.Pieces(rate=200, scale=0.01)
            pieces.push(samples(device, axis))
            found.append({"device": f"d{device}", "axis": "xy"[axis], "state": bytes(pieces)})
    return found


@pytest.mark.parametrize("partitions", [1, 2, 7, 64])
def test_no_partition_changes_a_byte(tmp_path, expected, partitions):
    generator = random.Random(partitions)
    lengths = {1: lambda: SAMPLES, 2: lambda: 5000}.get(partitions, lambda: generator.randrange(1, 4000))
    write(tmp_path / "logs", rows(lengths), partitions, generator)
    context = session(partitions)
    context.register_parquet("logs", str(tmp_path / "logs"))
    assert table(context, STATES).to_pylist() == expected

    # The states of each part, merged from a column.
    parts = table(
        context,
        "SELECT device, axis, allan_state(start, counts, rate, scale) AS state FROM logs GROUP BY device, axis, start / 5000",
    )
    assert len(parts) > len(expected) or partitions == 1
    context.from_arrow(parts, "parts")
    merged = "SELECT device, axis, allan_merge(state) AS state FROM parts GROUP BY device, axis ORDER BY device, axis"
    assert table(context, merged).to_pylist() == expected


def test_one_sample_a_row_gives_the_same(tmp_path, expected):
    columns = {"device": [], "axis": [], "number": [], "count": []}
    for device in range(1):
        for axis in range(2):
            columns["device"] += [f"d{device}"] * SAMPLES
            columns["axis"] += ["xy"[axis]] * SAMPLES
            columns["number"].append(np.arange(SAMPLES))
            columns["count"].append(samples(device, axis))
    columns["number"], columns["count"] = np.concatenate(columns["number"]), np.concatenate(columns["count"])
    order = np.random.default_rng(5).permutation(len(columns["count"]))
    shuffled = pa.table(columns).take(pa.array(order))
    for number in range(4):
        pq.write_table(shuffled.slice(number * SAMPLES // 2, SAMPLES // 2), tmp_path / f"{number}.parquet")
    context = session(3)
    context.register_parquet("samples", str(tmp_path))
    query = (
        "SELECT device, axis, allan_state_of_samples(number, count, 200.0, 0.01) AS state FROM samples "
        "GROUP BY device, axis ORDER BY device, axis"
    )
    assert table(context, query).to_pylist() == expected[:2]


def test_coefficients_are_those_of_the_command_line_and_diagnoses_in_sql(tmp_path, expected):
    write(tmp_path / "logs", rows(lambda: 3000), 3, random.Random(1))
    context = session()
    context.register_parquet("logs", str(tmp_path / "logs"))
    query = f"SELECT device, axis, allan_samples(state) AS samples, allan_fit(state, 'deg/s') AS fit, allan_diagnose(state, 'deg/s') AS found FROM ({STATES}) ORDER BY device, axis"
    for row, known in zip(table(context, query).to_pylist(), expected, strict=True):
        record = allanite.Pieces.from_bytes(known["state"]).record()
        fit = record.fit().axes[0]
        assert row["samples"] == SAMPLES
        assert row["fit"]["N"] == fit["N"].value and row["fit"]["N_upper"] == fit["N"].upper
        assert row["fit"]["adequate"] == fit.adequate and row["fit"]["chi2"] == fit.chi2
        assert row["found"]["verdict"] == record.diagnose().axes[0].verdict
    # N is that of the noise that was written, in deg/s/√Hz.
    assert row["fit"]["N"] == pytest.approx(0.01 * 40 / np.sqrt(200), rel=0.05)


def test_wrong_joins_are_refused(tmp_path):
    twice = rows(lambda: 20_000)
    write(tmp_path / "logs", [*twice, twice[0]], 2, random.Random(1))
    context = session()
    context.register_parquet("logs", str(tmp_path / "logs"))
    with pytest.raises(Exception, match="samples 0 to 19999 come twice"):
        context.sql(STATES).collect()
    with pytest.raises(Exception, match="has the rates 200.0 and 400.0"):
        context.sql(STATES.replace("rate,", "CASE WHEN start > 0 THEN rate ELSE 2 * rate END,")).collect()


def _states(batch, killed=None):
    if killed is not None and not killed.exists():
        killed.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return next(fleet.states([batch]))


def in_order(batches):
    return pa.Table.from_batches(batches).sort_by([("device", "ascending"), ("axis", "ascending")]).to_pylist()


def test_a_worker_that_is_killed_half_way_changes_no_byte(tmp_path, expected):
    generator = random.Random(9)
    shuffled = rows(lambda: generator.randrange(1, 4000))
    generator.shuffle(shuffled)
    left = dict(enumerate(pa.Table.from_pylist(shuffled, SCHEMA).to_batches(max_chunksize=17)))
    found, attempts = {}, 0
    while left:
        attempts += 1
        with concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as workers:
            half = len(left) // 2
            works = {at: workers.submit(_states, batch, tmp_path / "killed" if at == half else None) for at, batch in left.items()}
            for at, work in works.items():
                try:
                    found[at] = work.result()
                except concurrent.futures.process.BrokenProcessPool:
                    continue
                del left[at]
    assert attempts == 2 and (tmp_path / "killed").exists()
    assert in_order(fleet.merged(found.values())) == expected


def test_spark_gives_the_same(tmp_path, expected, monkeypatch):
    pyspark = pytest.importorskip("pyspark.sql")
    if shutil.which("java") is None:
        pytest.skip("Spark needs Java")
    # Its workers are other processes, of the Python that runs here.
    monkeypatch.setenv("PYSPARK_PYTHON", sys.executable)
    generator = random.Random(11)
    write(tmp_path / "logs", rows(lambda: generator.randrange(1, 4000)), 7, generator)
    spark = pyspark.SparkSession.builder.master("local[2]").config("spark.ui.enabled", "false").getOrCreate()
    schema = "device string, axis string, state binary"
    states = spark.read.parquet(str(tmp_path / "logs")).repartition(5).mapInArrow(fleet.states, schema)
    merged = states.repartition(3, "device", "axis").mapInArrow(fleet.merged, schema).toArrow()
    spark.stop()
    assert in_order(merged.to_batches()) == expected


def test_lost_samples_are_gaps():
    batch = {"device": ["a"], "axis": ["x"], "start": [10], "rate": [100.0], "scale": [1.0], "counts": [[1, None, 3, 4]]}
    state = next(fleet.states([pa.table(batch, SCHEMA)])).to_pylist()[0]["state"]
    assert allanite.Pieces.from_bytes(state).stretches == ((10, 11), (12, 14))


def test_samples_that_hang_are_told():
    counts = samples(0, 0)
    counts[5000:7000] = 40
    batch = {"device": ["a"] * 2, "axis": ["x"] * 2, "start": [0, 6000], "rate": [200.0] * 2, "scale": [0.01] * 2,
             "counts": [counts[:6000], counts[6000:]]}
    state = next(fleet.states([pa.table(batch, SCHEMA)])).to_pylist()[0]["state"]
    assert "stuck values" in fleet.fit(state)["invalid"]
    assert fleet.diagnose(state)["verdict"] == "invalid"
    good = allanite.Pieces(rate=200, scale=0.01)
    good.push(samples(0, 0))
    assert fleet.fit(bytes(good))["invalid"] is None


def test_an_axis_that_cannot_be_fitted_is_a_row_and_a_wrong_unit_an_error():
    for counts, said in [([1, 2], "a fit needs two octaves"), ([5] * 5000, "the counts never change")]:
        pieces = allanite.Pieces(rate=200, scale=0.01)
        pieces.push(np.array(counts, "i4"))
        row = fleet.fit(bytes(pieces))
        assert said in row["invalid"] and "N" not in row and row["samples"] == len(counts)
        found = fleet.diagnose(bytes(pieces))
        assert found["verdict"] is None and said in found["conclusion"]
        with pytest.raises(allanite.AllaniteError, match="furlong"):
            fleet.fit(bytes(pieces), "furlong")
