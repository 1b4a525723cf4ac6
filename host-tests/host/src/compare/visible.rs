//! Whether the effects of a model can be seen in a record.

use allanite::{Curve, Model};
use allanite_log::{OCTAVES, failure::Failure};

/// A variance below this share of the squared coefficient is taken for a rounding error. Chosen by
/// hand: it is some five times the rounding of double precision.
const LEAST_VARIANCE: f64 = 1e-15;

/// Refuses an effect that contributes to no octave, because it cannot be fitted. An example is an
/// oscillation at a multiple of the sample rate.
///
/// # Errors
/// When there is such an effect.
pub fn check_visible(model: &Model, curve: &Curve<OCTAVES>) -> Result<(), Failure> {
    // A shape that is looked for is found where it is visible.
    let known = model.terms().iter();
    for term in known.filter(|term| !term.fitted || term.parameters[0] > 0.0) {
        let shape = term.sampled_shape(curve.interval_s());
        let variance = |m: u32| term.effect.variance(f64::from(m), &shape);
        let mut octaves = curve.points().iter().map(|point| variance(point.m));
        let finite = octaves.clone().all(f64::is_finite);
        if !(finite && octaves.any(|variance| variance > LEAST_VARIANCE)) {
            return Err(Failure::option(
                format!(
                    "--with {}: the effect is invisible at a sample rate of {} Hz",
                    term.effect.name(),
                    curve.rate_hz()
                ),
                "give other parameters",
            ));
        }
    }
    Ok(())
}
