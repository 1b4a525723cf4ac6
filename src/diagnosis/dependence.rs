//! The slope and the lag with which a rate follows a quantity.

use super::step::FollowedCovariate;
use crate::{
    evidence::covariate::{Lags, Slope},
    numerics::{
        math,
        real::{Real, real},
    },
};

/// What a sum of two lags changes of the slope of a third one, as a share of the slope, and of its lag, as a share of the distance of the
/// two: a standard error. A rate that follows steps of a temperature, which is the hardest course, sets them in the test
/// `host-tests/tests/library/covariate_lag.rs`.
const OF_SLOPE: Real = 0.02;
const OF_DISTANCE: Real = 0.17;

/// How a rate follows a quantity that changes slowly.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Dependence {
    /// The change of the rate that remains when the quantity has changed by one unit. The error includes what the bank of lags changes,
    /// 2 % of the slope, as long as the true lag is no longer than a third of the longest one.
    pub slope: Slope,
    /// By how much the rate is late, in seconds. Below zero, it is early.
    pub lag_s: Real,
    /// The standard error of the lag, with a sixth of the distance of the two lags. `None` if a single covariate is followed, whose lag is
    /// then near the true one.
    pub lag_error_s: Option<Real>,
}

impl FollowedCovariate {
    /// The slope and the lag, if the covariates of the diagnosis are those of a bank of lags. Two covariates `x₁`, `x₂` behind lags
    /// `T₁`, `T₂` with slopes `α₁`, `α₂` follow a slow change like one with the slope `α₁ + α₂` behind the lag
    /// `(α₁ T₁ + α₂ T₂)/(α₁ + α₂)`.
    ///
    /// `rate_hz` is the sampling rate. `None` if the covariate is not one of the bank, or if the slopes cancel.
    pub fn dependence<const COVARIATES: usize>(
        &self,
        lags: &Lags<COVARIATES>,
        rate_hz: Real,
    ) -> Option<Dependence> {
        let ages = lags.ages();
        let lag_s = |index: usize| Some(real(*ages.get(index)?) / rate_hz);
        let (one, own_s) = (self.slope, lag_s(self.index)?);
        let Some(beside) = self.beside else {
            return Some(Dependence {
                slope: Slope {
                    error: hypotenuse(one.error, OF_SLOPE * one.value),
                    ..one
                },
                lag_s: own_s,
                lag_error_s: None,
            });
        };
        let (other, other_s) = (beside.slope, lag_s(beside.index)?);
        let both = 2.0 * beside.correlation * one.error * other.error;
        // The standard error of w α₁ + w' α₂.
        let error = |weight: Real, other_weight: Real| {
            let (own, of_other) = (weight * one.error, other_weight * other.error);
            let variance = own * own + of_other * of_other + weight * other_weight * both;
            math::sqrt(if variance > 0.0 { variance } else { 0.0 })
        };
        let value = one.value + other.value;
        let lag_s = (one.value * own_s + other.value * other_s) / value;
        let of_noise = error((own_s - lag_s) / value, (other_s - lag_s) / value);
        let lag_error_s = hypotenuse(of_noise, OF_DISTANCE * (other_s - own_s));
        let slope = Slope {
            value,
            error: hypotenuse(error(1.0, 1.0), OF_SLOPE * value),
        };
        (lag_s.is_finite() && lag_error_s.is_finite()).then_some(Dependence {
            slope,
            lag_s,
            lag_error_s: Some(lag_error_s),
        })
    }
}

fn hypotenuse(one: Real, other: Real) -> Real {
    math::sqrt(one * one + other * other)
}
