//! Sizes of the library's lists, and the quantiles that decide at 95 %.
//!
//! Every other module may use these numbers, so this module imports no other module.

/// The number of effects that one model has room for.
pub const MAX_EFFECTS: usize = 8;

/// The number of shape parameters that one effect has room for.
pub const MAX_PARAMETERS: usize = 3;

/// The number of fitted shape parameters that one model has room for.
pub const MAX_SHAPE: usize = 6;

/// The largest number of blocks in a segment of a spectrum.
pub const MAX_SEGMENT: usize = 256;

/// The number of unknowns in the largest system of normal equations. The coefficients of a model come
/// first, its fitted shape parameters follow.
pub(crate) const UNKNOWNS: usize = MAX_EFFECTS + MAX_SHAPE;

/// The number of pairs of different effects in the largest model.
pub(crate) const PAIRS: usize = MAX_EFFECTS * (MAX_EFFECTS - 1) / 2;

/// A normal variable lies within this many standard errors of its mean with a probability of 95 %
/// (Abramowitz & Stegun 1964, table 26.5).
pub(crate) const TWO_SIDED_95: f64 = 1.959_964;

/// A normal variable lies below its mean plus this many standard errors with a probability of 95 %
/// (Abramowitz & Stegun 1964, table 26.5).
pub(crate) const ONE_SIDED_95: f64 = 1.644_854;

/// χ² with one degree of freedom lies below this number with a probability of 95 %. It is the square of
/// [`TWO_SIDED_95`] (Abramowitz & Stegun 1964, table 26.8).
pub(crate) const CHI_SQUARED_95: f64 = 3.841_459;

/// An estimate whose expected square is this many variances exceeds [`TWO_SIDED_95`] standard errors in four of five records: the
/// square of the sum of that quantile and the one that a normal variable lies below with a probability of 80 %, 0.841621
/// (Abramowitz & Stegun 1964, table 26.5).
pub(crate) const SHOWN_IN_80: f64 = 7.848_879;

/// A model with a lower p-value is not adequate: if it were true, a χ² as large would come out in one
/// of a hundred records. Fit, comparison and diagnosis share this threshold. By convention; with it,
/// `cargo xtask study hidden-effect` claims an effect in less than 1 % of the records that hide none.
pub(crate) const ADEQUATE_P: f64 = 0.01;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::{chi_squared::chi_squared_tail, real::real};

    #[test]
    fn quantiles_leave_five_per_cent() {
        // A normal variable lies beyond x standard errors, on one side, with a probability of
        // erfc(x/√2)/2.
        let beyond = |x: f64| 0.5 * libm::erfc(x / core::f64::consts::SQRT_2);
        assert!((2.0 * beyond(TWO_SIDED_95) - 0.05).abs() < 1e-7);
        assert!((beyond(ONE_SIDED_95) - 0.05).abs() < 1e-7);
        assert!((CHI_SQUARED_95 - TWO_SIDED_95 * TWO_SIDED_95).abs() < 2e-6);
        assert!((chi_squared_tail(real(CHI_SQUARED_95), 1) - 0.05).abs() < 1e-6);
        assert!((beyond(TWO_SIDED_95 - libm::sqrt(SHOWN_IN_80)) - 0.8).abs() < 1e-6);
    }
}
