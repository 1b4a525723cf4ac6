"""Noise coefficients of gyros and accelerometers, and the effects that the five terms of IEEE Std 952 lack.

>>> import allanite
>>> diagnosis = allanite.read("log.csv", rate=100).fit().diagnose()     # doctest: +SKIP
>>> print(diagnosis)                                                     # doctest: +SKIP
"""

from . import effects, fleet
from ._accumulator import Accumulator
from ._curve import Curve
from ._deviations import Deviation, deviations
from ._diagnosis import AxisDiagnosis, Diagnosis
from ._error import AllaniteError
from ._fit import AxisFit, Fit
from ._model import Model
from ._own import OwnEffect
from ._page import Picture
from ._parts import (
    Bin,
    Candidate,
    Coefficient,
    Comb,
    ComparedOctave,
    Covariate,
    DetectionLimit,
    FilterShape,
    Limit,
    ModelEffect,
    Octave,
    SpectralLine,
    Step,
    Stretch,
    Worst,
)
from ._pieces import Pieces
from ._record import Record, read
from .effects import *  # noqa: F403
from .effects import CATALOGUE

__all__ = [
    "Accumulator",
    "AllaniteError",
    "AxisDiagnosis",
    "AxisFit",
    "Bin",
    "Candidate",
    "Coefficient",
    "Comb",
    "ComparedOctave",
    "Covariate",
    "Curve",
    "DetectionLimit",
    "Deviation",
    "Diagnosis",
    "FilterShape",
    "Fit",
    "Limit",
    "Model",
    "ModelEffect",
    "Octave",
    "OwnEffect",
    "Picture",
    "Pieces",
    "Record",
    "SpectralLine",
    "Step",
    "Stretch",
    "Worst",
    "deviations",
    "effects",
    "fleet",
    "read",
    *(effect.__name__ for effect in CATALOGUE),
]
