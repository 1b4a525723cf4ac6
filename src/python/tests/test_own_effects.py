"""Effects that are written in Python."""

import math

import numpy as np
import pytest

import allanite

RATE = 50.0


def correlated(time_s):
    """The covariance of exponentially correlated noise with a variance of one, in samples."""
    interval = 1 / RATE
    z = math.exp(-interval / time_s)

    def covariance(lag_s):
        n = lag_s / interval
        return -0.5 * interval**2 * (n * (1 + z) / (1 - z) - 2 * z * (1 - z**n) / (1 - z) ** 2)

    return covariance


@pytest.fixture(scope="module")
def five():
    rng = np.random.default_rng(11)
    n, z = 100_000, math.exp(-1 / RATE / 0.8)
    markov = np.zeros(n)
    steps = rng.normal(0, 0.02 * math.sqrt(1 - z * z), n)
    for at in range(1, n):
        markov[at] = z * markov[at - 1] + steps[at]
    samples = markov + rng.normal(0, 0.05, n)
    return allanite.Record.from_numpy(samples, rate=RATE, unit="deg/s").fit().model


def test_an_own_effect_fits_as_that_of_the_catalogue(five):
    own = five + allanite.OwnEffect("bench", correlated(0.8), symbol="b")
    catalogue = five + allanite.GaussMarkov(0.8, fitted=False)
    assert own.error < 0.5 * five.error
    assert own.chi2 == pytest.approx(catalogue.chi2, rel=1e-3)
    # The closed form has finer weights, so that the coefficients agree within a standard error.
    theirs = catalogue["gauss_markov"]
    assert abs(own["b"].value - theirs.value) < 0.25 * (theirs.upper - theirs.lower)
    assert own["b"].unit == "deg/s" and "+ bench" in str(own)
    assert (own - "bench").chi2 == five.chi2


def test_what_a_function_raises_is_raised(five):
    def wrong(lag_s):
        raise ZeroDivisionError("of mine")

    with pytest.raises(ZeroDivisionError, match="of mine"):
        five + allanite.OwnEffect("wrong", wrong)


def test_names_are_checked():
    for name in ("sinusoid", "My Effect", ""):
        with pytest.raises(allanite.AllaniteError):
            allanite.OwnEffect(name, correlated(1))


SERVO = "density: 1/(1 + (f/corner_hz)^2); corner_hz=0.02..5; name=servo"


def test_a_formula_is_an_effect_of_a_model(five):
    servo = five + SERVO
    assert servo.error < 0.5 * five.error
    corner = servo.effects[-1].parameters["corner_hz"]
    # Noise with a correlation time of 0.8 s falls from 0.2 Hz on.
    assert corner == pytest.approx(1 / (2 * math.pi * 0.8), rel=0.1)
    assert "+ servo" in str(servo)
    assert (servo - "servo").chi2 == five.chi2
    with pytest.raises(allanite.AllaniteError, match="close the parenthesis"):
        five + "density: 1/(1 + f"


def test_a_formula_is_tried_beside_the_catalogue(five):
    record = five._of
    found = record.diagnose(own=SERVO)
    assert [one for one in found.axes[0].missing] in (["servo"], ["gauss_markov"])
