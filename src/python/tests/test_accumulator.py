"""Samples that arrive while Python runs."""

import numpy as np
import pytest

import allanite


def test_pieces_of_any_length_make_the_record_of_the_whole():
    counts = np.random.default_rng(3).normal(0, 40, (50_000, 2)).round().astype("i4")
    accumulator = allanite.Accumulator(rate=200, scale=0.01, unit="deg/s", axes=["gx", "gy"])
    for piece in np.array_split(counts, [1, 2, 100, 4097, 30_000]):
        accumulator.push(piece)
    assert accumulator.samples == 50_000
    live = accumulator.record()
    whole = allanite.Record.from_numpy(counts, names=["gx", "gy"], rate=200, scale=0.01, unit="deg/s")
    assert live.fit().to_dict() == whole.fit().to_dict()
    # It goes on after it has been looked at.
    accumulator.push(counts)
    assert accumulator.samples == 100_000 and accumulator.record() != live


def test_rates_are_rounded_to_counts():
    counts = np.random.default_rng(4).normal(0, 40, 5_000).round().astype("i4")
    of_counts, of_rates = (allanite.Accumulator(rate=100, scale=0.01) for _ in range(2))
    of_counts.push(counts)
    of_rates.push(counts * 0.01)
    assert of_counts.record().fit().to_dict() == of_rates.record().fit().to_dict()


def test_a_gap_ends_a_stretch():
    accumulator = allanite.Accumulator(rate=100)
    accumulator.push(np.arange(100) % 7)
    accumulator.gap()
    accumulator.push(np.arange(100) % 5)
    assert accumulator.record().axes[0].gaps == 1


@pytest.mark.parametrize("samples", [[1, 2**31], [0.5, np.nan], ["a"], [[1, 2]]])
def test_what_is_no_sample_is_refused(samples):
    accumulator = allanite.Accumulator(rate=100)
    with pytest.raises(allanite.AllaniteError):
        accumulator.push(samples)
    assert accumulator.samples == 0
    with pytest.raises(allanite.AllaniteError, match="0 samples are too few; push at least 9"):
        accumulator.record()


def test_a_rate_has_to_be_possible():
    for options in ({"rate": 0}, {"rate": 100, "scale": -1}, {"rate": 100, "axes": ["gx", "gx"]}):
        with pytest.raises(allanite.AllaniteError):
            allanite.Accumulator(**options)
