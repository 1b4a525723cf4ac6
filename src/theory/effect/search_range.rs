use crate::{curve::Span, numerics::real::Real};

/// The highest frequency of an oscillation that a search tries, relative to the sample rate. What a record shows changes
/// with the square of the distance from half the rate, so that beyond this frequency it shows the same, and at half the rate
/// itself it would not change with the frequency at all.
const HIGHEST: Real = 0.4999;

impl Span {
    /// The highest frequency of an oscillation that a search tries, in Hz.
    pub(super) fn highest_hz(&self) -> Real {
        HIGHEST / self.interval_s
    }

    /// The end of an interval that reaches the end of a range: from the highest frequency of an oscillation on, it goes up to
    /// half the sample rate.
    pub(crate) fn end_of(&self, high: Real) -> Real {
        if high == self.highest_hz() {
            0.5 / self.interval_s
        } else {
            high
        }
    }
}

/// The values of a shape parameter that a search tries. The ranges and steps of the catalogue are
/// chosen by hand; `cargo xtask study hidden-effect` runs with them and does not vary them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SearchRange {
    /// The lowest value, above zero, in the parameter's unit.
    pub low: Real,
    /// The highest value. If the curve is so short that `high` lies below `low`, a search takes `low`
    /// instead.
    pub high: Real,
    /// The number of values for each factor of two. It has no effect on a parameter that takes whole numbers
    /// only, because a search tries all of these.
    pub steps_per_octave: Real,
}
