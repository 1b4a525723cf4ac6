//! What rounding to whole counts does to the coefficients of a fit.

use crate::{curve_file::AxisCurve, number::number, words};
use allanite::{
    Coefficient,
    effect::{AngleRandomWalk, Effect},
    fit::{Fit, State},
};
use std::f64::consts::PI;

/// The smallest excess of angle random walk that is worth a note, in percent. Chosen by hand: rounding
/// exceeds it at a noise of two counts rms or less.
const LEAST_PERCENT: f64 = 1.0;

/// The smallest share of rounding in white noise behind a filter that is worth a note. Chosen by hand.
const LEAST_SHARE: f64 = 0.3;

/// A note on the share of rounding in an axis, or `None` if there is nothing to tell.
///
/// Rounding to whole counts adds white noise of 1/12 count² to a noise of half a count rms or more
/// (Widrow & Kollár 2008, chapter 4). Below that, the result of the fit follows from the constant offset.
pub fn note(axis: &AxisCurve, fit: &Fit) -> Option<String> {
    let name = AngleRandomWalk.description().name;
    let mut coefficients = fit.coefficients.iter();
    let white = coefficients.find(|one| one.name == name && one.state == State::Measured)?;
    let mut others = fit.coefficients.iter();
    if others.any(|other| other.name != name && other.symbol == white.symbol) {
        return behind_filter(axis, white);
    }
    let without = without(white, axis.rate_per_count, axis.rate_hz);
    let percent = 100.0 * (white.value / without[0] - 1.0);
    if percent < LEAST_PERCENT || !percent.is_finite() {
        return None;
    }
    let (factor, unit) = words::customary(axis.unit, white.half_seconds);
    let [value, lower, upper] = without.map(|end| number(factor * end));
    Some(format!(
        "rounding of the values raises angle random walk by {percent:.0} %: without it, it is {value} {unit}, \
         95 % interval {lower} … {upper}"
    ))
}

/// What rounding alone adds behind a filter, if that is some of the white noise there.
fn behind_filter(axis: &AxisCurve, white: &Coefficient) -> Option<String> {
    let rounding = axis.rate_per_count / (12.0 * axis.rate_hz).sqrt();
    let (factor, unit) = words::customary(axis.unit, white.half_seconds);
    (rounding > LEAST_SHARE * white.value).then(|| {
        format!(
            "rounding of the values to steps of {} {} adds {} {unit} of white noise behind the filter",
            number(axis.rate_per_count),
            axis.unit,
            number(factor * rounding),
        )
    })
}

/// Value, lower and upper end of a white noise without the rounding to multiples of `step`.
///
/// The variance of rounded normal noise of `s` steps rms is `s² + 1/12 + a cos 2πx` steps², where `x` is the place of the mean
/// between two steps and `a ≈ (4s² + 1/π²) exp(−2π²s²)` (Widrow & Kollár 2008, chapter 4). A mean that drifts passes all places,
/// so that the ends allow for any.
pub fn without(white: &Coefficient, step: f64, rate_hz: f64) -> [f64; 3] {
    let variance = |end: f64| end * end * rate_hz / (step * step) - 1.0 / 12.0;
    let square = variance(white.value).max(0.0);
    let place = (4.0 * square + 1.0 / PI.powi(2)) * (-2.0 * PI * PI * square).exp();
    let root = |variance: f64| step * (variance.max(0.0) / rate_hz).sqrt();
    [
        root(square),
        root(variance(white.lower) - place),
        root(variance(white.upper) + place),
    ]
}
