//! The five terms of IEEE Std 952 alone, in a few kilobytes: for a sensor that has no room for the general
//! [fit](crate::fit::fit()).
//!
//! [`fit()`] gives the numbers of the general fit of [`Model::ieee_952`](crate::Model::ieee_952) to a curve within some
//! hundredths of their standard errors: coefficients, 95 % intervals by the likelihood ratio, bounds at the scatter that
//! the curve has there, states, and χ². It knows these terms only, and takes the covariance of the octaves from a
//! [table](self#the-covariance) instead of a sum over their differences. It computes in single precision and in integers
//! alone, in any build, so that every core comes to the same bits.
//!
//! What it leaves out: a spectrum, any model but this one, and the correction of the test against zero for the skewness of
//! variances. The length of a record that would measure more is [asked for](Fit::measured_after_s). [`Fit::p_value`] links an exponential function, and nothing else does.
//!
//! # The covariance
//!
//! Differences of octave `m` start at multiples of `m/4`, and the kernels of the five terms are homogeneous. So the sums over
//! pairs of differences scale with `m`, and 28 sums of 14 pairs of terms hold all octaves, with the ends of the record and
//! its gaps included. `cargo xtask study five-terms` compares the fit with the general one, which sums over the pairs.
//!
//! ```
//! use allanite::{Curve, Real, fit::State, ieee_952};
//!
//! // White noise of 1 count² at 100 Hz: σ²(τ) = N²/τ with N = 0.1.
//! let white = (0..10).map(|k| (1 << k, (40_000 >> k) - 7, 1.0 / (1 << k) as Real));
//! let curve = Curve::<10>::new(100.0, white)?;
//! let fit = ieee_952::fit(&curve)?;
//! let [_, angle_random_walk, ..] = fit.coefficients;
//! assert_eq!(angle_random_walk.state, State::Measured);
//! assert!((angle_random_walk.value - 0.1).abs() < 1e-6);
//! # Ok::<(), allanite::Error>(())
//! ```

mod comparison;
mod covariance;
mod estimate;
mod factor;
mod goodness;
mod limits;
mod memory;
mod paper;
mod record_length;
mod rounds;
mod row;
mod rows;
mod table;
mod tableau;
mod terms;
#[cfg(test)]
mod tests;

pub(crate) use comparison::{above, place};
pub use limits::{Checked, Limits};
pub use paper::fit_by_relative_accuracy;
pub use terms::TERMS;

use crate::{
    curve::Curve,
    error::Error,
    evidence::record::Record,
    fit::{
        ADEQUATE_P,
        coefficient::{Coefficient, State},
    },
    numerics::{
        deviance::p_value,
        math::short_sqrt,
        real::{Real, real},
    },
};
use memory::{Memory, consecutive};
use rounds::{begin, solve};
use tableau::Tableau;

/// How far an octave may be off, relative to its variance, where the scatter alone does not explain the misfit: as in the
/// general fit by default.
const TOLERANCE: f32 = 0.01;

/// The five terms of a curve, with what they are worth.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fit {
    /// Quantization, angle random walk, bias instability, rate random walk and rate ramp.
    pub coefficients: [Coefficient; TERMS],
    /// χ² of the octaves or their deviance, as that of the [general fit](crate::fit::Fit::chi_squared).
    pub chi_squared: Real,
    /// The deviance of the octaves, as that of the [general fit](crate::fit::Fit::deviance).
    pub deviance: Real,
    /// The number of octaves, less the number of coefficients above zero.
    pub degrees_of_freedom: usize,
    /// The tolerance that was granted: 0, or 0.01 where the terms do not explain the curve without it.
    pub tolerance: Real,
    /// The factor by which intervals and bounds are widened because the terms do not explain the curve, as that of the
    /// [general fit](crate::fit::Fit::birge_ratio).
    pub birge_ratio: Real,
}

impl Fit {
    /// The Allan deviation at an averaging time in seconds, in rate units: that of quantization and angle random walk, and of the
    /// other terms if they are [measured](State::Measured).
    pub fn deviation(&self, tau_s: Real) -> Real {
        let shown = |found: &Coefficient| match found.state {
            State::Measured => found.value,
            _ => 0.0,
        };
        let [quantization, white, flicker, walk, ramp] = &self.coefficients;
        let (q, n) = (quantization.value, white.value);
        let [b, k, r] = [flicker, walk, ramp].map(shown);
        let root = short_sqrt(tau_s);
        // Each is squared after its share of the time is taken, so that the squares stay within the range of numbers.
        let parts = [
            (3.0, q / tau_s),
            (1.0, n / root),
            (real(terms::FLICKER), b),
            (1.0 / 3.0, k * root),
            (0.5, r * tau_s),
        ];
        let variance = parts.iter().map(|(factor, part)| factor * part * part);
        short_sqrt(variance.sum())
    }

    /// The probability of a larger χ² or deviance if the five terms explain the curve, as that of the
    /// [general fit](crate::fit::Fit::p_value); NaN without degrees of freedom.
    pub fn p_value(&self) -> Real {
        p_value(self.chi_squared, self.deviance, self.degrees_of_freedom)
    }

    /// Whether the five terms explain the curve: the [p-value](Self::p_value) is [`ADEQUATE_P`] or more. `None` without
    /// degrees of freedom.
    pub fn is_adequate(&self) -> Option<bool> {
        let p_value = self.p_value();
        (!p_value.is_nan()).then_some(p_value >= ADEQUATE_P)
    }
}

/// Fits the five terms to the curve of a record. Only octaves that follow each other from `m = 1` on are fitted.
///
/// # Errors
/// [`Error::Invalid`] if the record is not one of a gyro at rest; its curve alone can be fitted all the same.
/// [`Error::NoNoise`] if an octave has a variance of zero, [`Error::TooFewOctaves`] for fewer than two octaves, and
/// [`Error::Singular`] if the covariance of the octaves is not positive definite.
pub fn fit<'a, const K: usize, const B: usize>(
    record: impl Into<Record<'a, K, B>>,
) -> Result<Fit, Error> {
    let record = record.into();
    record.check()?;
    fit_curve(record.curve)
}

/// [`fit()`] of a curve.
pub(crate) fn fit_curve<const K: usize>(curve: &Curve<K>) -> Result<Fit, Error> {
    let points = consecutive(curve.points());
    crate::fit::check(points, 2)?;
    let mut memory = Memory::<K>::EMPTY;
    let (mut rows, reference) = memory.rows(points);
    let mut tableau = Tableau::EMPTY;
    let mut squares = begin(&mut rows, &mut tableau);
    let mut chi_squared = solve(&mut rows, &mut tableau, &mut squares).ok_or(Error::Singular)?;
    let degrees = |tableau: &Tableau| {
        let free = tableau.free().count_ones() as usize;
        points.len().saturating_sub(free)
    };
    let mut deviance = rows.deviance(&squares);
    let mut tolerance = 0.0;
    if goodness::judged(chi_squared, deviance, degrees(&tableau)).1 > 1.0 {
        tolerance = real(TOLERANCE);
        rows.tolerance = TOLERANCE * TOLERANCE;
        chi_squared = solve(&mut rows, &mut tableau, &mut squares).ok_or(Error::Singular)?;
        deviance = rows.deviance(&squares);
    }
    let degrees_of_freedom = degrees(&tableau);
    let (chi_squared, birge_ratio) = goodness::judged(chi_squared, deviance, degrees_of_freedom);
    let scale = estimate::Scale::new(reference, curve.interval_s(), rows.units);
    Ok(Fit {
        chi_squared: real(chi_squared),
        deviance: real(deviance),
        degrees_of_freedom,
        tolerance,
        birge_ratio: real(birge_ratio),
        // Written where it stays.
        coefficients: estimate::all(&mut rows, &mut tableau, &squares, birge_ratio, scale),
    })
}
