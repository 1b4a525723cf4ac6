"""Deviations agree with those of allantools, for a fraction of the CPU time."""

import os
import sys

import numpy as np
import pytest
from conftest import ROOT

sys.path.insert(0, str(ROOT / "src/python/studies"))
pytest.importorskip("allantools")
import allantools_times  # noqa: E402


@pytest.mark.parametrize("kind", ["i4", "f8"])
def test_deviations_agree_and_take_a_fraction_of_the_time(kind):
    rng = np.random.default_rng(1)
    counts = (rng.normal(0, 100, 4_000_000) + np.cumsum(rng.normal(0, 0.1, 4_000_000))).round()
    x = counts.astype(kind) if kind == "i4" else counts * 0.01
    found = allantools_times.compared(x, 100.0)
    assert found["octaves"] >= 18
    # Decimals are rounded to 2^-30 of their range.
    assert found["difference"] < 1e-9, found
    if "ALLANITE_TIMES" in os.environ:
        # On a quiet machine, counts of the wheel take less than a thirtieth: see the README. Decimals take a second pass for their
        # range. What a debug build takes says nothing.
        assert found["ratio_octaves"] > (15 if kind == "i4" else 7), found
