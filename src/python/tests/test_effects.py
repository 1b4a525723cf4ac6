"""Every parameter of every effect of the catalogue: it can be given, comes back, and is refused when it is wrong."""

import dataclasses
import fractions
import itertools
import pickle

import numpy as np
import pytest

import allanite
from allanite import _native

# Shapes that a record of 100 Hz can show.
VALUES = {
    "correlation_time_s": 2.5,
    "corner_hz": 30.5,
    "cutoff_hz": 8.5,
    "drift_hz": 1.25,
    "exponent": 0.75,
    "frequency_hz": 12.5,
    "quality": 4.5,
    "rise_hz": 11.5,
    "time_constant_s": 0.0175,
    "width_s": 0.055,
}
ALTERNATIVES = ("cutoff_hz", "time_constant_s")
WRONG = (0, -1, -0.5, float("nan"), float("inf"), 10**400, "42", b"42", True, np.True_, 1j, [1.0], np.array([1.0, 2.0]))


def parameters(effect):
    """What the command line knows of an effect: its parameters are in its refusal of another one."""
    with pytest.raises(allanite.AllaniteError) as refused:
        _native.check_effect(f"{effect.NAME}:nothing=1", False)
    remedy = refused.value.remedy
    return [] if remedy == "give no parameters" else remedy.removeprefix("choose from ").split(", ")


def fields(effect):
    return [field.name for field in dataclasses.fields(effect) if field.name != "fitted"]


def whole_numbers(effect, name):
    """The least and the greatest whole number, which are in the refusal of a fraction."""
    given = {other: VALUES[other] for other in fields(effect) if other in VALUES and other != ALTERNATIVES[1]}
    with pytest.raises(allanite.AllaniteError, match=f"{name}=1.5 is impossible; give a whole number, ") as refused:
        effect(**given, **{name: 1.5})
    low, high = refused.value.remedy.split(", ")[1].split(" to ")
    return int(low), int(high)


def shapes(effect):
    """Shapes in which every parameter is given, each whole number with its ends."""
    names = fields(effect)
    choices = [[VALUES[name]] if name in VALUES else whole_numbers(effect, name) for name in names]
    complete = [dict(zip(names, values)) for values in itertools.product(*choices)]
    if not set(ALTERNATIVES) <= set(names):
        return complete
    # One of the alternatives has to be left out.
    return [{name: value for name, value in shape.items() if name != left_out} for shape in complete for left_out in ALTERNATIVES]


@pytest.fixture(scope="module")
def five(hidden):
    return allanite.read(hidden).fit().model


every_effect = pytest.mark.parametrize("effect", allanite.CATALOGUE, ids=lambda effect: effect.NAME)


@every_effect
def test_fields_are_the_parameters_of_the_command_line(effect):
    assert fields(effect) == parameters(effect)
    for name in fields(effect):
        unit = {"hz": "In Hz, above 0.", "s": "In s, above 0."}.get(name.rsplit("_")[-1], "number")
        words = effect.__doc__.split(f"    {name} : ")[1].split("\n")[1]
        assert unit in words, words


@every_effect
def test_every_parameter_comes_back(effect, five):
    model = five - effect if effect.NAME in [one.name for one in five.effects] else five
    tried = shapes(effect)
    assert tried and {name for shape in tried for name in shape} == set(fields(effect))
    for shape in tried:
        known = effect(**shape, fitted=False)
        pairs = [f"{name}={value}" for name, value in shape.items()]
        assert known.written() == ":".join([effect.NAME, ",".join(pairs)][: 1 + bool(pairs)])
        assert pickle.loads(pickle.dumps(known)) == known
        found = next(one.parameters for one in (model + known).effects if one.name == effect.NAME)
        for name, value in shape.items():
            # A cut-off is the reciprocal of a time constant, and has been rounded twice.
            assert found[name] == pytest.approx(value, rel=4e-16), name


@every_effect
def test_a_fit_begins_at_the_parameters_that_are_given(effect, five):
    model = five - effect if effect.NAME in [one.name for one in five.effects] else five
    shape = shapes(effect)[-1]
    begun = effect(**shape)
    pairs = [f"{name}{'~' if name in VALUES else '='}{value}" for name, value in shape.items()]
    assert begun.written() == ":".join([effect.NAME, ",".join(pairs)][: 1 + bool(pairs)])
    found = next(one.parameters for one in (model + begun).effects if one.name == effect.NAME)
    assert set(shape) <= set(found)
    for name, value in shape.items():
        assert found[name] > 0 if name in VALUES else found[name] == value, name


@every_effect
def test_wrong_parameters_are_refused_in_one_line(effect):
    shape = shapes(effect)[0]
    for name in shape:
        wrong = [*WRONG]
        if name not in VALUES:
            low, high = whole_numbers(effect, name)
            wrong += [low - 1, high + 1, low + 0.5]
        for value in wrong:
            for fitted in (True, False):
                with pytest.raises(allanite.AllaniteError) as refused:
                    effect(**{**shape, name: value}, fitted=fitted)
                said = str(refused.value)
                assert said.startswith(f"effect {effect.NAME}: {name}") and "; give a " in said, said
                assert "\n" not in said and len(said) < 120, said
    with pytest.raises(TypeError, match="nothing"):
        effect(nothing=1)
    with pytest.raises(allanite.AllaniteError, match=f"effect {effect.NAME}: fitted is a str; give True or False"):
        effect(fitted="no")


@every_effect
def test_a_shape_that_is_not_whole_is_refused(effect):
    shape = shapes(effect)[0]
    fractions_of = [name for name in shape if name in VALUES]
    for name in fractions_of:
        rest = {other: value for other, value in shape.items() if other != name}
        with pytest.raises(allanite.AllaniteError, match=f"{name} is missing; give [a-z_]+=VALUE$"):
            effect(**rest, fitted=False)
        # It may be looked for if no other is given.
        if len(fractions_of) == 1:
            effect(**rest)
        else:
            with pytest.raises(allanite.AllaniteError, match="is missing"):
                effect(**rest)
    if set(ALTERNATIVES) <= set(fields(effect)):
        with pytest.raises(allanite.AllaniteError, match="time_constant_s and cutoff_hz give the same; give one of them"):
            effect(cutoff_hz=8.5, time_constant_s=0.0175)
        # A bare number would not say which of the two it is.
        with pytest.raises(TypeError, match="positional"):
            effect(8.5)


def test_numbers_of_every_kind_are_taken():
    for number in (12.5, np.float64(12.5), np.float32(12.5), fractions.Fraction(25, 2)):
        assert allanite.Sinusoid(number).written() == "sinusoid:frequency_hz~12.5"
    for number in (2, 2.0, np.int8(2), np.uint64(2)):
        assert allanite.MovingAverage(number).written() == "moving_average:samples=2"
    assert allanite.Sinusoid(0.1 + 0.2).written() == "sinusoid:frequency_hz~0.30000000000000004"


def test_the_base_is_no_effect():
    with pytest.raises(allanite.AllaniteError, match="no such effect; .*choose from quantization"):
        allanite.effects.Effect()
