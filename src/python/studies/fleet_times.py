"""What states cost on DataFusion beside the decoding of Parquet alone, in CPU time and memory, in one process each.

    python fleet_times.py write FOLDER SAMPLES      # as many samples, in files of 2^24, in batches of 2^16
    python fleet_times.py decode FOLDER             # the batches of the files, one after the other
    python fleet_times.py lengths FOLDER            # the same by DataFusion
    python fleet_times.py state FOLDER              # allan_state of all of them
    python fleet_times.py fit FOLDER                # and the fit of every axis
    python fleet_times.py devices COUNT SAMPLES     # from logs to coefficients of so many devices of three axes
"""

import pathlib
import resource
import sys
import tempfile
import time

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

BATCH = 1 << 16
FILE = 1 << 24
#: Rows of a group of a file and of a batch of the engine: a million samples.
ROWS = 16


def measured(what, samples, work):
    begin, cpu = time.perf_counter(), time.process_time()
    result = work()
    wall, cpu = time.perf_counter() - begin, time.process_time() - cpu
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{what}: {samples} axis-samples, {wall:.2f} s, CPU {cpu:.2f} s = {1e9 * cpu / samples:.2f} ns each, {memory:.0f} MiB")
    return result


def write(folder, samples):
    folder.mkdir(parents=True, exist_ok=True)
    generator = np.random.default_rng(1)
    for number, start in enumerate(range(0, samples, FILE)):
        counts = generator.normal(0, 40, min(FILE, samples - start)).round().astype("i4")
        starts = range(start, start + len(counts), BATCH)
        lists = pa.ListArray.from_arrays(
            pa.array([*(at - start for at in starts), len(counts)], pa.int32()), pa.array(counts)
        )
        same = len(lists)
        table = pa.table({
            "device": ["a"] * same, "axis": ["x"] * same, "start": pa.array(starts, pa.int64()),
            "rate": [1000.0] * same, "scale": [0.01] * same, "counts": lists,
        })
        pq.write_table(table, folder / f"{number}.parquet", compression="zstd", row_group_size=ROWS)


def decode(folder):
    samples = 0
    for file in sorted(folder.glob("*.parquet")):
        for batch in pq.ParquetFile(file).iter_batches(ROWS, use_threads=False):
            samples += len(batch.column("counts").values)
    return samples


def session(folder):
    import datafusion

    from allanite import fleet

    settings = datafusion.SessionConfig().with_batch_size(ROWS)
    context = fleet.register(datafusion.SessionContext(settings))
    context.register_parquet("logs", str(folder))
    return context


STATES = "SELECT device, axis, allan_state(start, counts, rate, scale) AS state FROM logs GROUP BY device, axis"


def devices(count, samples):
    """Logs of devices of three axes, and the query from them to the coefficients."""
    generator = np.random.default_rng(2)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for first in range(0, count, 500):
            rows = {key: [] for key in ("device", "axis", "start", "rate", "scale", "counts")}
            for device in range(first, min(count, first + 500)):
                for axis in "xyz":
                    half = samples // 2
                    counts = generator.normal(0, 40, samples).round().astype("i4")
                    for start in (0, half):
                        part = counts[start : start + half] if start == 0 else counts[half:]
                        for key, value in zip(rows, (f"d{device:06}", axis, start, 100.0, 0.01, part), strict=True):
                            rows[key].append(value)
            schema = {"counts": pa.list_(pa.int32())}
            columns = {key: pa.array(values, schema.get(key)) for key, values in rows.items()}
            pq.write_table(pa.table(columns), folder / f"{first}.parquet", compression="zstd")
        query = f"SELECT device, axis, allan_fit(state, 'deg/s') AS fit FROM ({STATES})"
        found = measured("devices", 3 * count * samples, lambda: session(folder).sql(query).collect())
        fits = [row for batch in found for row in batch.column("fit").to_pylist()]
        white = np.array([fit["N"] for fit in fits])
        print(f"{len(fits)} axes; N over the truth: {np.mean(white) / (0.4 / np.sqrt(100)):.4f} on the mean")


def main():
    what, *rest = sys.argv[1:]
    if what == "devices":
        return devices(int(rest[0]), int(rest[1]))
    folder = pathlib.Path(rest[0])
    if what == "write":
        return write(folder, int(rest[1]))
    files = folder.glob("*.parquet")
    samples = 0
    for file in files:
        metadata = pq.ParquetFile(file).metadata
        samples += sum(metadata.row_group(group).column(5).num_values for group in range(metadata.num_row_groups))
    if what == "decode":
        return measured("decode by Arrow", samples, lambda: decode(folder))
    if what == "lengths":
        query = "SELECT max(array_length(counts)) FROM logs"
        return measured("decode by DataFusion", samples, lambda: session(folder).sql(query).collect())
    query = STATES if what == "state" else f"SELECT device, axis, allan_fit(state, 'deg/s') AS fit FROM ({STATES})"
    return measured(what, samples, lambda: session(folder).sql(query).collect())


if __name__ == "__main__":
    main()
