//! Checks a user's own effect for the most frequent mistakes, in a unit test.

use super::{CATALOGUE, CODES, Effect, FIRST_OWN_CODE, MAX_PARAMETERS, SampledShape};
use crate::{
    curve::Span,
    list::numbered,
    numerics::{
        math::sqrt,
        real::{Real, real},
    },
};
use core::fmt;

/// The averaging factors at which variances are asked for, as powers of two.
const OCTAVES: u32 = 14;

/// Up to this octave, the variance follows from the second differences of the kernel without much cancelling.
const EXACT: u32 = 4;

/// The relative difference of two numbers that should be equal but for rounding. Chosen by hand.
const ROUNDING: Real = 1e-2;

/// The factor by which times are stretched. A power of two, so that nothing is rounded.
const STRETCH: Real = 4.0;

/// What is wrong with an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Flaw {
    /// The name is empty, has other characters than `a` to `z`, digits and `_`, or is that of an effect of the catalogue.
    Name,
    /// The code belongs to the catalogue: 1 to 127.
    Code(u8),
    /// There are more parameters than [`MAX_PARAMETERS`].
    Parameters(usize),
    /// The range that a search tries of a parameter is empty, not positive or not finite.
    Range(&'static str),
    /// A variance is negative or not a finite number, or so is a value of the kernel or of a second difference.
    NotFinite {
        /// The averaging factor, in samples.
        m: u32,
        /// The shape parameters.
        parameters: [Real; MAX_PARAMETERS],
    },
    /// The variance does not follow from the second differences of the kernel.
    Inconsistent {
        /// The averaging factor, in samples.
        m: u32,
        /// The shape parameters.
        parameters: [Real; MAX_PARAMETERS],
    },
    /// The variances follow another power of time than the unit of the coefficient says: the sample interval is forgotten,
    /// or the unit is another one.
    Interval {
        /// The shape parameters.
        parameters: [Real; MAX_PARAMETERS],
    },
}

impl fmt::Display for Flaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Name => f.write_str(
                "the name is none, or taken: choose one of lower-case letters, digits and underscores",
            ),
            Self::Code(code) => write!(
                f,
                "the code {code} is kept for the catalogue: choose 0, or one from {FIRST_OWN_CODE} on"
            ),
            Self::Parameters(count) => write!(
                f,
                "there are {count} parameters: at most {MAX_PARAMETERS} are possible"
            ),
            Self::Range(name) => write!(
                f,
                "the search of {name} has no range: give a low end above zero, and steps"
            ),
            Self::NotFinite { m, parameters } => write!(
                f,
                "at m = {m} and {parameters:?} a variance is negative or no number"
            ),
            Self::Inconsistent { m, parameters } => write!(
                f,
                "at m = {m} and {parameters:?} the variance is not that of the kernel: leave it to its default, or mend one of the two"
            ),
            Self::Interval { parameters } => write!(
                f,
                "at {parameters:?} the variance does not scale with time as the unit says: use interval_s, or mend half_seconds"
            ),
        }
    }
}

impl core::error::Error for Flaw {}

/// Checks a user's own effect, in a unit test: name, code and ranges, that variances are numbers, that they are
/// those of the kernel, and that they scale with time as the unit of the coefficient says. Effects of the catalogue pass. An
/// effect may pass and be wrong.
///
/// # Errors
/// The first [`Flaw`] that is found.
///
/// ```
/// use allanite::effect::{BiasInstability, GaussMarkov, check};
///
/// assert_eq!(check(&GaussMarkov), Ok(()));
/// assert_eq!(check(&BiasInstability), Ok(()));
/// ```
pub fn check(effect: &dyn Effect) -> Result<(), Flaw> {
    let description = effect.description();
    let is_known = CATALOGUE
        .iter()
        .any(|known| core::ptr::eq(known.description(), description));
    if !is_known {
        let is_letter =
            |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_';
        let is_word = !description.name.is_empty() && description.name.bytes().all(is_letter);
        if !is_word || CODES.iter().any(|(_, name)| *name == description.name) {
            return Err(Flaw::Name);
        }
        if (1..FIRST_OWN_CODE).contains(&description.code) {
            return Err(Flaw::Code(description.code));
        }
    }
    let count = description.parameters.len();
    if count > MAX_PARAMETERS {
        return Err(Flaw::Parameters(count));
    }
    let interval_s = 0.01;
    let span = Span {
        interval_s,
        longest_tau_s: interval_s * real(1_u32 << OCTAVES),
    };
    let mut ranges = [[1.0; 3]; MAX_PARAMETERS];
    for (place, (range, parameter)) in numbered(ranges.iter_mut().zip(description.parameters)) {
        let Some(tried) = effect.search_range(place, &span) else {
            return Err(Flaw::Range(parameter.name));
        };
        let is_positive = |x: Real| x.is_finite() && x > 0.0;
        let is_range = is_positive(tried.low) && tried.high.is_finite() && tried.high >= tried.low;
        if !is_range || !is_positive(tried.steps_per_octave) {
            return Err(Flaw::Range(parameter.name));
        }
        let middle = sqrt(tried.low) * sqrt(tried.high);
        *range = [middle, tried.low, tried.high].map(|value| match parameter.is_whole {
            true => crate::numerics::math::floor(value + 0.5),
            false => value,
        });
    }
    // All parameters in the middle of their ranges, and each of them at both ends.
    check_at(effect, interval_s, ranges.map(|[middle, ..]| middle))?;
    for (place, [_, low, high]) in numbered(ranges).take(count) {
        for end in [low, high] {
            let mut parameters = ranges.map(|[middle, ..]| middle);
            if let Some(own) = parameters.get_mut(place) {
                *own = end;
            }
            check_at(effect, interval_s, parameters)?;
        }
    }
    Ok(())
}

/// Checks an effect with these parameters.
fn check_at(
    effect: &dyn Effect,
    interval_s: Real,
    parameters: [Real; MAX_PARAMETERS],
) -> Result<(), Flaw> {
    let description = effect.description();
    let shape = SampledShape {
        interval_s,
        parameters,
    };
    let is_deterministic = effect.response(1.0, &shape).is_some();
    let differs =
        |one: Real, other: Real| (one - other).abs() > ROUNDING * one.abs().max(other.abs());
    let (mut is_power, mut first_ratio) = (true, None);
    for octave in 0..OCTAVES {
        let factor = 1_u32 << octave;
        let m = real(factor);
        let variance = effect.variance(m, &shape);
        let (at_m, at_zero) = (
            effect.second_difference(m, m, &shape),
            effect.second_difference(0.0, m, &shape),
        );
        let numbers = [effect.kernel(m, &shape), at_m, at_zero, variance];
        // Where a line has a zero, rounding may leave a variance of either sign.
        let rounding = ROUNDING * at_zero.abs() / (m * interval_s * (m * interval_s));
        if numbers.iter().any(|number| !number.is_finite()) || variance < -rounding {
            return Err(Flaw::NotFinite {
                m: factor,
                parameters,
            });
        }
        let tau_s = m * interval_s;
        let of_kernel = (at_m - at_zero) / (tau_s * tau_s);
        let cancelled = at_zero.abs() / (tau_s * tau_s) > variance / ROUNDING;
        if octave < EXACT && !is_deterministic && !cancelled && differs(variance, of_kernel) {
            return Err(Flaw::Inconsistent {
                m: factor,
                parameters,
            });
        }
        if let Some(ratio) = power_of_time(effect, octave, &shape) {
            is_power = is_power && first_ratio.is_none_or(|first| !differs(first, ratio));
            first_ratio = first_ratio.or(Some(ratio));
        } else {
            is_power = false;
        }
    }
    // Where all variances follow one power of time, it is that of the coefficient's unit.
    let mut expected = 1.0;
    for _ in 0..description.half_seconds.unsigned_abs() {
        expected *= match description.half_seconds > 0 {
            true => 1.0 / STRETCH,
            false => STRETCH,
        };
    }
    match first_ratio {
        Some(ratio)
            if is_power && description.reference_s.is_none() && differs(ratio, expected) =>
        {
            Err(Flaw::Interval { parameters })
        }
        _ => Ok(()),
    }
}

/// By what the variance of an octave grows if all times are stretched, that of the samples and those of the parameters;
/// `None` if it does not follow a power of time, as an effect with a time or a frequency of its own does not.
fn power_of_time(effect: &dyn Effect, octave: u32, shape: &SampledShape) -> Option<Real> {
    let m = real(1_u32 << octave);
    let stretched = |factor: Real| {
        let mut stretched = *shape;
        stretched.interval_s *= factor;
        let parameters = stretched.parameters.iter_mut();
        for (own, parameter) in parameters.zip(effect.description().parameters) {
            match parameter.unit {
                "s" => *own *= factor,
                "Hz" => *own /= factor,
                _ => {}
            }
        }
        effect.variance(m, &stretched) / effect.variance(m, shape)
    };
    let (once, twice) = (stretched(STRETCH), stretched(STRETCH * STRETCH));
    (!differs(once * once, twice)).then_some(once)
}

/// Whether two numbers differ by more than rounding.
fn differs(one: Real, other: Real) -> bool {
    let is_equal = (one - other).abs() <= ROUNDING * one.abs().max(other.abs());
    !is_equal
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::super::{Description, Distribution, Parameter, SearchRange};
    use super::*;
    use std::string::ToString as _;

    #[test]
    fn effects_of_the_catalogue_pass() {
        for effect in CATALOGUE {
            assert_eq!(check(effect), Ok(()), "{}", effect.name());
        }
    }

    const RIGHT: Description = Description {
        name: "own",
        symbol: "o",
        coefficient: "rms",
        half_seconds: 1,
        reference_s: None,
        parameters: &[],
        code: FIRST_OWN_CODE,
        replaces: None,
        mirror: None,
        special_case: None,
        distribution: Distribution::Gaussian,
    };

    /// White noise of the coefficient N, with the kernel of a lag and an interval.
    struct Own(&'static Description, fn(Real, Real) -> Real);

    impl Effect for Own {
        fn description(&self) -> &'static Description {
            self.0
        }

        fn kernel(&self, lag: Real, shape: &SampledShape) -> Real {
            (self.1)(lag, shape.interval_s)
        }
    }

    fn white(lag: Real, interval_s: Real) -> Real {
        -0.5 * interval_s * lag
    }

    fn hum(lag: Real, interval_s: Real) -> Real {
        let (_, cosine) = crate::numerics::math::sincos_of_turns(3.1 * lag * interval_s);
        cosine
    }

    #[test]
    fn what_is_wrong_is_told() {
        assert_eq!(check(&Own(&RIGHT, white)), Ok(()));
        // A frequency of its own is no flaw.
        const HUM: Description = Description {
            half_seconds: 0,
            ..RIGHT
        };
        assert_eq!(check(&Own(&HUM, hum)), Ok(()));

        const TAKEN: Description = Description {
            name: "sinusoid",
            ..RIGHT
        };
        const NAMELESS: Description = Description { name: "", ..RIGHT };
        const RESERVED: Description = Description { code: 7, ..RIGHT };
        const OTHER_UNIT: Description = Description {
            half_seconds: -1,
            ..RIGHT
        };
        const NO_RANGE: Description = Description {
            parameters: &[Parameter {
                name: "time_s",
                unit: "s",
                is_whole: false,
                search_range: |_| SearchRange {
                    low: 0.0,
                    high: 1.0,
                    steps_per_octave: 1.0,
                },
                reciprocal: None,
            }],
            ..RIGHT
        };
        let none = [1.0; MAX_PARAMETERS];
        let interval = Err(Flaw::Interval { parameters: none });
        let not_finite = Err(Flaw::NotFinite {
            m: 1,
            parameters: none,
        });
        let cases: [(Own, Result<(), Flaw>); 8] = [
            (Own(&TAKEN, white), Err(Flaw::Name)),
            (Own(&NAMELESS, white), Err(Flaw::Name)),
            (Own(&RESERVED, white), Err(Flaw::Code(7))),
            (Own(&NO_RANGE, white), Err(Flaw::Range("time_s"))),
            (Own(&RIGHT, |lag, _| -0.5 * lag), interval),
            (Own(&OTHER_UNIT, white), interval),
            (Own(&RIGHT, |_, _| Real::NAN), not_finite),
            (
                Own(&RIGHT, |lag, interval_s| -white(lag, interval_s)),
                not_finite,
            ),
        ];
        for (effect, expected) in cases {
            assert_eq!(check(&effect), expected);
            let text = expected.unwrap_err().to_string();
            assert!(text.contains(": ") || text.ends_with("no number"), "{text}");
        }
    }
}
