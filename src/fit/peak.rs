//! The largest peak of a spectrum above a model.

use crate::numerics::real::Real;

/// A model is not adequate if the probability of its peak is below this, whatever its χ² is. A line adds little to a
/// χ² of a hundred bins. Chosen by hand: true models are then called inadequate in one more of 1000 records.
pub(super) const LEAST_P: Real = 1e-3;

/// The bin of a spectrum that lies farthest above a model.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Peak {
    /// The frequency of the bin, in Hz.
    pub frequency_hz: Real,
    /// How far the density lies above the model's, in standard deviations of a normal distribution. The cube root of
    /// a density is nearly normal (Wilson & Hilferty 1931, PNAS 17, 684), while the density itself is not.
    pub z: Real,
    /// The probability that any of the bins lies as far above the model if the model is true.
    pub p_value: Real,
}

impl Peak {
    /// Whether a true model has such a peak too rarely.
    pub(super) fn is_significant(&self) -> bool {
        self.p_value < LEAST_P
    }
}
