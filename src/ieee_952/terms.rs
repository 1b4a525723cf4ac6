//! The variances of the five terms, in units in which they are near one.

pub(super) use crate::numerics::math::{root as sqrt, truncated};

/// The number of terms.
pub const TERMS: usize = 5;

/// The place of the angle random walk, which takes the white part of the rate random walk.
pub(super) const WHITE: usize = 1;

/// The place of the rate random walk.
pub(super) const WALK: usize = 3;

/// The variance of flicker noise of unit density: `2 ln 2 / π`.
pub(super) const FLICKER: f32 = 2.0 * core::f32::consts::LN_2 / core::f32::consts::PI;

/// The octave from which on the white part of the random walk is below `2^-24` of it.
const NO_LEAK: u32 = 13;

/// The power of two, for exponents from −126 to 127.
pub(super) const fn power(exponent: i32) -> f32 {
    f32::from_bits((exponent.wrapping_add(127) as u32).wrapping_shl(23))
}

/// Whether a number is above zero, by its bits: a comparison is a call on a core that has no unit for floats.
pub(super) const fn is_positive(number: f32) -> bool {
    number.to_bits() as i32 > 0
}

/// The number, or zero if it is not above.
pub(super) const fn positive(number: f32) -> f32 {
    if is_positive(number) { number } else { 0.0 }
}

/// The terms' variances at every octave, in units of the averaging time of a middle one.
#[derive(Clone, Copy)]
pub(super) struct Units {
    middle: i32,
}

impl Units {
    pub(super) const fn new(octaves: usize) -> Self {
        Self {
            middle: (octaves / 2) as i32,
        }
    }

    /// The octave whose averaging time is the unit.
    pub(super) const fn middle(self) -> i32 {
        self.middle
    }

    /// The variance of a term with a coefficient of one.
    pub(super) fn variance(self, term: usize, octave: usize) -> f32 {
        let distance = (octave as i32).wrapping_sub(self.middle);
        match term {
            0 => 3.0 * power(distance.wrapping_mul(-2)),
            WHITE => power(distance.wrapping_neg()),
            2 => FLICKER,
            WALK => power(distance) * (1.0 / 3.0) + self.leak(octave),
            _ => 0.5 * power(distance.wrapping_mul(2)),
        }
    }

    /// The white part of the variance of the random walk: its steps scatter within a sample.
    pub(super) fn leak(self, octave: usize) -> f32 {
        if octave as u32 >= NO_LEAK {
            return 0.0;
        }
        let exponent = (octave as i32).wrapping_add(self.middle);
        power(exponent.wrapping_neg()) * (1.0 / 6.0)
    }

    /// The variance of all terms with these squared coefficients.
    pub(super) fn model(self, squares: &[f32; TERMS], octave: usize) -> f32 {
        let mut sum = 0.0;
        for (term, &square) in (0..TERMS).zip(squares) {
            if is_positive(square) {
                sum += square * self.variance(term, octave);
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variances_are_those_of_the_model() {
        use crate::{
            Model,
            numerics::real::{double, real},
            theory::effect::SampledShape,
        };
        let (model, units) = (Model::ieee_952(), Units::new(20));
        // The averaging time of octave 10 is the unit of time.
        let shape = SampledShape::new(real(1.0 / 1024.0));
        for (term, effect) in model.terms().iter().enumerate() {
            for octave in 0..20 {
                let m = real(1_u32 << octave);
                let expected = double(effect.effect.variance(m, &shape));
                let found = f64::from(units.variance(term, octave));
                assert!((found / expected - 1.0).abs() < 1e-5, "{term} {octave}");
            }
        }
    }
}
