//! What rounding to whole counts does to the coefficients of a fit.

use crate::{curve_file::AxisCurve, number::number, words};
use allanite::{
    effect::{AngleRandomWalk, Effect},
    fit::{Fit, State},
};

/// The smallest excess of angle random walk that is worth a note, in percent. Chosen by hand: rounding
/// exceeds it at a noise of two counts rms or less.
const LEAST_PERCENT: f64 = 1.0;

/// A note on the share of rounding in an axis, or `None` if there is nothing to tell.
///
/// Rounding to whole counts adds white noise of 1/12 count² to a noise of half a count rms or more
/// (Widrow & Kollár 2008, chapter 4). Below that, the result of the fit follows from the constant offset.
pub fn note(axis: &AxisCurve, fit: &Fit) -> Option<String> {
    let square = axis.rate_per_count * axis.rate_per_count;
    let name = AngleRandomWalk.description().name;
    let mut coefficients = fit.coefficients.iter();
    let white = coefficients.find(|one| one.name == name && one.state == State::Measured)?;
    let rounding = square / (12.0 * axis.rate_hz);
    let without = white.value * white.value - rounding;
    let percent = 100.0 * (white.value / without.max(0.0).sqrt() - 1.0);
    if percent < LEAST_PERCENT || !percent.is_finite() {
        return None;
    }
    let (factor, unit) = words::customary(axis.unit, white.half_seconds);
    let less = |value: f64| (value * value - rounding).max(0.0).sqrt();
    let [value, lower, upper] =
        [white.value, white.lower, white.upper].map(|end| number(factor * less(end)));
    Some(format!(
        "rounding of the values raises angle random walk by {percent:.0} %: without it, it is {value} {unit}, \
         95 % interval {lower} … {upper}"
    ))
}
