"""Reads tables as other programs do: readers.py make|parquet|csv|pyramid FOLDER

`make` writes what the others read: a table of a time and three axes of white noise in Parquet and as text, and an array of one axis.
"""

import sys
from pathlib import Path

ROWS, SAMPLES, RATE_HZ = 3_000_000, 10_000_000, 1000.0
task, folder = sys.argv[1], Path(sys.argv[2])

if task == "make":
    import numpy as np
    import pyarrow as pa
    import pyarrow.csv
    import pyarrow.parquet

    random = np.random.default_rng(1)
    columns = {"time [s]": np.arange(ROWS) / RATE_HZ}
    columns |= {f"g{axis} [deg/s]": random.normal(0.0, 0.1, ROWS) for axis in "xyz"}
    table = pa.table(columns)
    pa.parquet.write_table(table, folder / "log.parquet")
    pa.csv.write_csv(table, folder / "log.csv")
    np.save(folder / "axis.npy", random.normal(0.0, 0.1, SAMPLES))
elif task == "parquet":
    import pyarrow.parquet

    columns = [column.to_numpy() for column in pyarrow.parquet.read_table(folder / "log.parquet").columns]
    assert len(columns) == 4
elif task == "csv":
    import polars

    assert polars.read_csv(folder / "log.csv").shape == (ROWS, 4)
elif task == "pyramid":
    import numpy as np

    # The Allan variance at each octave without overlap, and nothing beside it.
    means, variances = np.load(folder / "axis.npy"), []
    while len(means) >= 4:
        steps = np.diff(means)
        variances.append(0.5 * np.mean(steps * steps))
        pairs = means[: len(means) // 2 * 2]
        means = 0.5 * (pairs[::2] + pairs[1::2])
    assert abs(variances[0] / 0.01 - 1.0) < 0.01
else:
    sys.exit(f"unknown task {task}")
