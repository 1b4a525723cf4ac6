#!/usr/bin/env bash
# One would guess: the third result of allantools.oadev is a standard error at each averaging time, fit to be a weight or
# an error bar.
# What happens: it is the deviation over the square root of the number of overlapping differences, as if these were
# independent. At a twentieth of the record it is some eighteen times too small; the function of the same
# package that computes equivalent degrees of freedom is not called.
# Versions: allantools 2024.6, numpy 2.4.6, scipy 1.17.1 on Python 3.11.
# Why it matters: a fit weighted by these errors follows the chance of the longest averaging times, and finds rate random
# walk or bias instability in pure white noise.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python3 -m venv "$dir/venv"
"$dir/venv/bin/pip" install -q allantools==2024.6 numpy==2.4.6 scipy==1.17.1
"$dir/venv/bin/python" - <<'PY'
import allantools
import numpy as np

print("allantools", allantools.__version__)
count, repeats = 20_000, 200
generator = np.random.default_rng(5)
taus = [0.01, 0.1, 1.0, 10.0]
deviations, errors = [], []
for _ in range(repeats):
    _, deviation, error, _ = allantools.oadev(generator.standard_normal(count), rate=100, data_type="freq", taus=taus)
    deviations.append(deviation)
    errors.append(error)
scatter, reported = np.std(deviations, axis=0), np.mean(errors, axis=0)
ratio = scatter / reported
for tau, s, r, q in zip(taus, scatter, reported, ratio):
    print(f"tau {tau:5.2f} s: scatter over {repeats} records {s:.5f}, reported error {r:.5f}, ratio {q:.1f}")
print("guess: a ratio near 1 at each averaging time")
assert 0.7 < ratio[0] < 1.3
assert ratio[3] > 12, "the reported error is wider than before"
print(f"seen: at a twentieth of the record the true scatter is {ratio[3]:.0f} times the reported error")
PY
