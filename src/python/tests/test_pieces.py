"""Records that are read in pieces."""

import pickle

import numpy as np
import pytest

import allanite


def counts(samples=60_000, seed=1):
    generator = np.random.default_rng(seed)
    drift = np.cumsum(generator.integers(-1, 2, samples))
    return (generator.normal(0, 40, samples).round() + drift // 8).astype("i4")


def pieces():
    return allanite.Pieces(rate=200, scale=0.01)


def test_a_record_is_the_same_however_it_is_cut():
    samples = counts()
    whole = pieces()
    whole.push(samples)
    generator = np.random.default_rng(2)
    for _ in range(20):
        cuts = np.sort(generator.integers(0, len(samples), generator.integers(0, 9)))
        parts = np.split(samples, cuts)
        firsts = [0, *cuts]
        groups = [pieces() for _ in range(3)]
        for at in generator.permutation(len(parts)):
            groups[generator.integers(3)].push(parts[at], first=firsts[at])
        groups = [pickle.loads(pickle.dumps(group)) for group in groups]
        groups[1].merge(groups[2], groups[0])
        assert bytes(groups[1]) == bytes(whole) and groups[1] == whole
    order = generator.permutation(len(samples))
    numbered = pieces()
    for rows in np.array_split(order, 7):
        numbered.push_numbered(rows, samples[rows])
    assert numbered == whole and repr(whole) == "<Pieces: 60000 samples at 200 Hz in 1 stretches>"


def test_the_fit_is_that_of_the_record():
    samples = counts()
    apart = pieces()
    apart.push(samples[30_000:], first=30_000)
    apart.push(samples[:30_000])
    record = apart.record(axis="gx")
    whole = allanite.Record.from_numpy(samples, names=["gx"], rate=200, scale=0.01, unit="deg/s")
    assert record["gx"].octaves == whole["gx"].octaves
    ours, theirs = record.fit()["gx"], whole.fit()["gx"]
    for own, other in zip(ours.coefficients, theirs.coefficients, strict=True):
        # The sums of the spectrum are exact here, and in single precision there.
        assert own.value == pytest.approx(other.value, rel=1e-4) and own.state == other.state
    assert record.diagnose()["gx"].verdict == whole.diagnose()["gx"].verdict


def test_axes_make_one_record_and_curve_files_are_merged(tmp_path):
    axes = {}
    for at, name in enumerate(["gx", "gy"]):
        axes[name] = pieces()
        axes[name].push(counts(20_000, at))
    record = allanite.Pieces.record_of(axes)
    assert [axis.axis for axis in record.axes] == ["gx", "gy"]
    record.save(tmp_path / "curve.json")
    again = allanite.read(tmp_path / "curve.json")
    assert again.to_dict()["axes"] == record.to_dict()["axes"]


@pytest.mark.parametrize(
    ("push", "said"),
    [
        (lambda own: own.push([1, 2], first=99), "sample 99 comes twice"),
        (lambda own: own.push([1.5]), "no whole numbers of 32 bits"),
        (lambda own: own.push([2**31]), "no whole numbers of 32 bits"),
        (lambda own: own.push([[1]]), "no whole numbers of 32 bits"),
        (lambda own: own.push_numbered([300, 300], [1, 2]), "sample 300 comes twice"),
        (lambda own: own.push_numbered([-1], [1]), "no whole numbers from 0 on"),
        (lambda own: own.push_numbered([300], [1, 2]), "1 numbers of 2 samples"),
        (lambda own: own.push([1], first=2**50), "above 2^50"),
        (lambda own: own.merge(allanite.Pieces(rate=100, scale=0.01)), "the rate 100, and the others 200"),
        (lambda own: allanite.Pieces.from_bytes(bytes(own)[:-1]), "not the bytes"),
        (lambda own: allanite.Pieces(rate=0), "rate"),
        (lambda own: own.record(), "a fit needs"),
    ],
)
def test_what_does_not_fit_is_refused_and_nothing_is_added(push, said):
    own = pieces()
    own.push([7], first=99)
    before = bytes(own)
    with pytest.raises(allanite.AllaniteError, match=said.replace("^", r"\^")):
        push(own)
    assert bytes(own) == before
