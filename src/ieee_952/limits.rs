//! Limits of the five terms, for a station that measures once and decides.

use super::{Fit, terms::TERMS};
use crate::numerics::real::Real;

/// The largest values that the five terms may have.
///
/// The rule is that of ISO 14253-1: what is known to keep a limit passes, what is known to exceed one fails, and what the
/// interval leaves open lies in the guard band, where a longer record may decide. Each interval holds its coefficient in
/// 95 % of records. A [`SelfTest`](crate::self_test::SelfTest) also decides early, and holds the errors of all its looks.
///
/// ```
/// use allanite::{Curve, Real, ieee_952::{self, Checked, Limits}};
///
/// let white = (0..10).map(|k| (1 << k, (40_000 >> k) - 7, 1.0 / (1 << k) as Real));
/// let fit = ieee_952::fit(&Curve::<10>::new(100.0, white)?)?;
/// // N is 0.1.
/// let limits = Limits { most: [Real::INFINITY, 0.12, Real::INFINITY, Real::INFINITY, Real::INFINITY] };
/// assert_eq!(limits.check(&fit), Checked::Pass);
/// # Ok::<(), allanite::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limits {
    /// The largest values of quantization, angle random walk, bias instability, rate random walk and rate ramp, in the units of
    /// their coefficients. An infinite one requires nothing.
    pub most: [Real; TERMS],
}

/// What limits say of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Checked {
    /// The interval of each coefficient keeps its limit.
    Pass,
    /// The interval of a coefficient lies above its limit.
    Fail {
        /// The place of the first such coefficient among the five terms.
        place: usize,
    },
    /// The interval of a coefficient contains its limit, or reaches beyond it from below.
    GuardBand {
        /// The place of the first such coefficient among the five terms.
        place: usize,
    },
    /// The five terms do not explain the curve, so that their intervals say nothing about limits: the
    /// [`birge_ratio`](Fit::birge_ratio) is above 1, which is where [`Fit::is_adequate`] says so, to the rounding of the quantile
    /// of χ².
    Misfit,
}

impl Limits {
    /// Compares the intervals of a fit with the limits. A limit that is not a number is in the guard band.
    pub fn check(&self, fit: &Fit) -> Checked {
        // A p-value would link an exponential function for the same answer.
        if 1.0 < fit.birge_ratio {
            return Checked::Misfit;
        }
        let mut open = None;
        for ((place, most), found) in (0..TERMS).zip(self.most).zip(&fit.coefficients) {
            if most < found.lower {
                return Checked::Fail { place };
            }
            // Without `<=`, which is a function of its own on a core that has no unit for floats. Both may be infinite.
            let is_kept = found.upper < most || found.upper.to_bits() == most.to_bits();
            if !is_kept && open.is_none() {
                open = Some(place);
            }
        }
        match open {
            Some(place) => Checked::GuardBand { place },
            None => Checked::Pass,
        }
    }
}
