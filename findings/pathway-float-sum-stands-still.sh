#!/usr/bin/env bash
# One would guess: if one row of a table is replaced, sums and averages of Pathway are those of the new rows.
# What happens: a sum of floats stays as it was if as many rows come as go in one step, and so does its average. The greatest
# value of the same reduction is new, and sums of whole numbers are right.
# Versions: pathway 0.33.0.
# Why it matters: a correction of a record, such as a spike of 500 deg/s that is replaced by 0.25, does not reach the mean rate.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
python3 -m venv venv
venv/bin/pip install -q --no-compile --disable-pip-version-check pathway==0.33.0
cat >probe.py <<'PY'
import pathway as pw

def reduced(rates):
    """The sum, the average, the number and the greatest after the row 2 was replaced."""
    kept, spike, corrected = rates
    table = pw.debug.table_from_markdown(f'''
     id | gx          | __time__ | __diff__
     1  | {kept}      | 2        | 1
     2  | {spike}     | 2        | 1
     2  | {spike}     | 4        | -1
     2  | {corrected} | 4        | 1
    ''')
    found = table.reduce(
        sum=pw.reducers.sum(pw.this.gx), mean=pw.reducers.avg(pw.this.gx),
        rows=pw.reducers.count(), greatest=pw.reducers.max(pw.this.gx),
    )
    return pw.debug.table_to_pandas(found, include_id=False).iloc[0].to_dict()

print('pathway', pw.__version__)
whole, single = reduced((5, 500, 25)), reduced((0.5, 500.0, 0.25))
print('5 and 500, then 25 instead of 500:       ', whole, 'guess: sum 30')
print('0.5 and 500.0, then 0.25 instead of 500.0:', single, 'guess: sum 0.75')
assert whole['sum'] == 30 and whole['mean'] == 15
assert single['rows'] == 2 and single['greatest'] == 0.5
assert single['sum'] == 500.5 and single['mean'] == 250.25
print('SURPRISE: two rates of at most 0.5 have the average 250.25')
PY
venv/bin/python probe.py 2>/dev/null
