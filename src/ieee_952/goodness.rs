//! Whether chance explains what a fit leaves.

use super::terms::sqrt;

/// The normal deviate that is exceeded with the probability of [`ADEQUATE_P`](crate::fit::ADEQUATE_P), and with a tenth of it.
const INADEQUATE: f32 = 2.326_348;
const INADEQUATE_DEVIANCE: f32 = 3.090_232;

/// χ², or the deviance where no chance explains it, and the factor by which errors are widened if it is too large to be one of an
/// adequate model.
pub(super) fn judged(chi_squared: f32, deviance: f32, degrees_of_freedom: usize) -> (f32, f32) {
    let by_deviance = beyond(deviance, degrees_of_freedom, INADEQUATE_DEVIANCE);
    if 1.0 < by_deviance {
        (deviance, by_deviance)
    } else {
        (chi_squared, birge_ratio(chi_squared, degrees_of_freedom))
    }
}

/// The factor by which errors are widened if χ² is too large to be one of an adequate model.
pub(super) fn birge_ratio(chi_squared: f32, degrees_of_freedom: usize) -> f32 {
    beyond(chi_squared, degrees_of_freedom, INADEQUATE)
}

/// The root of χ² for each degree of freedom, or 1 if it is below the quantile of this normal deviate, which is that of
/// Wilson & Hilferty (1931).
fn beyond(chi_squared: f32, degrees_of_freedom: usize, deviate: f32) -> f32 {
    if degrees_of_freedom == 0 {
        return 1.0;
    }
    let degrees = degrees_of_freedom as f32;
    let share = 2.0 / (9.0 * degrees);
    let root = 1.0 - share + deviate * sqrt(share);
    let ratio = chi_squared / degrees;
    if ratio > root * root * root {
        sqrt(ratio)
    } else {
        1.0
    }
}
