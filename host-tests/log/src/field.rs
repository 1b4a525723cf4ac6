//! A single value of a log, before it becomes a count.

use crate::failure::{Failure, Place, quoted};

/// A value that can be read as a count, as a number or as a time stamp.
pub(super) trait Field: Copy {
    /// The value as a count, or `None` if it is not a whole number within `i32`.
    fn count(&self) -> Option<i32>;

    /// Whether the value is a finite number.
    fn is_number(&self) -> bool {
        true
    }

    /// The value as a finite number, or the reason why it is none.
    fn number(&self) -> Result<f64, Flaw>;

    /// The value as a finite number that keeps every digit of a whole number.
    #[inline]
    fn exact(&self) -> Result<Exact, Flaw> {
        self.number().map(Exact::Float)
    }

    /// The value as a time stamp, which is exact if it is a whole number.
    fn stamp(&self) -> Result<Stamp, Flaw> {
        self.number().map(Stamp::Real)
    }

    /// The values as floats, if this type is a float, so that many of them are handled at once.
    fn floats(_values: &[Self]) -> Option<&[f64]> {
        None
    }
}

/// A finite number. Whole numbers beyond [`EXACT_BELOW`] are kept apart because they do not fit into
/// a float.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Exact {
    /// A number that a float holds.
    Float(f64),
    /// A whole number beyond what a float holds.
    Whole(i128),
}

/// A float holds every whole number below this one, 2^53.
const EXACT_BELOW: f64 = (1u64 << 53) as f64;

/// A time stamp in the unit of its log. Whole numbers are kept apart because nanoseconds since 1970
/// do not fit into a float.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Stamp {
    /// A whole number.
    Whole(i64),
    /// Any other number.
    Real(f64),
}

impl Stamp {
    /// The time from another stamp to this one, negative if this one is earlier.
    pub(super) fn since(self, other: Self) -> f64 {
        match (self, other) {
            (Self::Whole(now), Self::Whole(then)) => (i128::from(now) - i128::from(then)) as f64,
            (now, then) => now.to_f64() - then.to_f64(),
        }
    }

    /// The stamp that is so many ticks later.
    pub(super) fn later(self, ticks: f64) -> Self {
        match self {
            Self::Whole(now) if ticks.fract() == 0.0 => {
                Self::Whole(now.saturating_add(ticks as i64))
            }
            now => Self::Real(now.to_f64() + ticks),
        }
    }

    /// This stamp, in nanoseconds, plus the given number of seconds.
    pub(super) fn behind_seconds(self, seconds: Self) -> Self {
        match (seconds, self) {
            (Self::Whole(seconds), Self::Whole(nanoseconds)) => {
                let seconds = seconds.saturating_mul(1_000_000_000);
                Self::Whole(seconds.saturating_add(nanoseconds))
            }
            (seconds, nanoseconds) => Self::Real(1e9 * seconds.to_f64() + nanoseconds.to_f64()),
        }
    }

    fn to_f64(self) -> f64 {
        match self {
            Self::Whole(ticks) => ticks as f64,
            Self::Real(ticks) => ticks,
        }
    }
}

impl std::fmt::Display for Stamp {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Whole(ticks) => ticks.fmt(f),
            Self::Real(ticks) => ticks.fmt(f),
        }
    }
}

/// What is wrong with a value, and how to remedy it.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Flaw {
    pub(super) what: String,
    pub(super) remedy: &'static str,
}

impl Flaw {
    fn not_finite(value: &str) -> Self {
        Self {
            what: format!("{value} is not a finite number"),
            remedy: "cut the record there or remove the value",
        }
    }

    /// The failure that reports this flaw at a place.
    pub(super) fn at(&self, place: Place) -> Failure {
        place.failure(&self.what, self.remedy)
    }

    /// A flaw of time stamps.
    pub(super) fn stamps(what: String) -> Self {
        Self {
            what,
            remedy: "cut the record there, or give --rate to ignore the stamps",
        }
    }
}

/// A field of a text file.
#[derive(Clone, Copy)]
pub(super) struct Text<'a>(pub(super) &'a [u8]);

impl Field for Text<'_> {
    #[inline]
    fn count(&self) -> Option<i32> {
        // Blanks around the number, a leading plus and a decimal point are left to `number`, which
        // is slower.
        atoi_simd::parse::<i32, false, false>(self.0).ok()
    }

    fn is_number(&self) -> bool {
        self.number().is_ok()
    }

    fn number(&self) -> Result<f64, Flaw> {
        let text = match fast_float2::parse::<f64, _>(self.0) {
            Ok(value) if value.is_finite() => return Ok(value),
            _ => self.0.trim_ascii(),
        };
        match fast_float2::parse::<f64, _>(text) {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(_) => Err(Flaw::not_finite(&quoted(text))),
            Err(_) if text.is_empty() => Err(Flaw {
                what: "a value is missing".into(),
                remedy: "cut the record there or fill it in",
            }),
            Err(_) => Err(Flaw {
                what: format!("{} is not a number", quoted(text)),
                remedy: "correct it or choose other columns with --columns",
            }),
        }
    }

    #[inline]
    fn exact(&self) -> Result<Exact, Flaw> {
        let number = self.number()?;
        Ok(match number.abs() < EXACT_BELOW {
            true => Exact::Float(number),
            false => self.whole().map_or(Exact::Float(number), Exact::Whole),
        })
    }

    fn stamp(&self) -> Result<Stamp, Flaw> {
        match atoi_simd::parse::<i64, false, false>(self.0.trim_ascii()) {
            Ok(ticks) => Ok(Stamp::Whole(ticks)),
            Err(_) => match self.number() {
                Ok(ticks) => Ok(Stamp::Real(ticks)),
                Err(flaw) => self.date_or_time().ok_or(flaw),
            },
        }
    }
}

impl Text<'_> {
    /// The date and time of ISO 8601, or the time of day, that is written here, in nanoseconds since 1970 or since
    /// midnight.
    pub(super) fn date_or_time(&self) -> Option<Stamp> {
        super::date_time::nanoseconds(self.0).map(Stamp::Whole)
    }

    /// Whether a date and time of ISO 8601, or a time of day, is written here.
    pub(super) fn is_date_or_time(&self) -> bool {
        self.date_or_time().is_some()
    }

    /// The whole number that is written here, if it is one: `17`, `+17` or `17.0`.
    #[cold]
    fn whole(&self) -> Option<i128> {
        let text = std::str::from_utf8(self.0.trim_ascii()).ok()?;
        let digits = match text.split_once('.') {
            Some((digits, fraction)) => fraction
                .bytes()
                .all(|digit| digit == b'0')
                .then_some(digits)?,
            None => text,
        };
        digits.parse().ok()
    }
}

macro_rules! integer_fields {
    ($($integer:ty)*) => {$(
        impl Field for $integer {
            #[inline]
            fn count(&self) -> Option<i32> {
                i32::try_from(*self).ok()
            }

            fn number(&self) -> Result<f64, Flaw> {
                Ok(*self as f64)
            }

            #[inline]
            fn exact(&self) -> Result<Exact, Flaw> {
                let number = *self as f64;
                Ok(match number.abs() < EXACT_BELOW {
                    true => Exact::Float(number),
                    false => Exact::Whole((*self).into()),
                })
            }

            fn stamp(&self) -> Result<Stamp, Flaw> {
                Ok(i64::try_from(*self).map_or(Stamp::Real(*self as f64), Stamp::Whole))
            }
        }
    )*};
}

integer_fields!(i64 u64);

/// A date and time in nanoseconds since 1970, or a time of day in nanoseconds since midnight.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Nanoseconds(pub(super) i64);

impl Field for Nanoseconds {
    fn count(&self) -> Option<i32> {
        None
    }

    fn is_number(&self) -> bool {
        false
    }

    fn number(&self) -> Result<f64, Flaw> {
        Err(Flaw {
            what: "a date or a time is not a number".into(),
            remedy: "choose other columns with --columns",
        })
    }

    fn stamp(&self) -> Result<Stamp, Flaw> {
        Ok(Stamp::Whole(self.0))
    }
}

impl Field for i32 {
    #[inline]
    fn count(&self) -> Option<i32> {
        Some(*self)
    }

    #[inline]
    fn number(&self) -> Result<f64, Flaw> {
        Ok((*self).into())
    }

    fn stamp(&self) -> Result<Stamp, Flaw> {
        Ok(Stamp::Whole((*self).into()))
    }
}

impl Field for f64 {
    #[inline]
    fn count(&self) -> Option<i32> {
        // The conversion saturates, so only a count is equal to itself after the conversion there
        // and back.
        let count = *self as i32;
        (f64::from(count) == *self).then_some(count)
    }

    #[inline]
    fn number(&self) -> Result<f64, Flaw> {
        #[cold]
        #[inline(never)]
        fn flaw(value: f64) -> Flaw {
            Flaw::not_finite(&value.to_string())
        }
        if self.is_finite() {
            Ok(*self)
        } else {
            Err(flaw(*self))
        }
    }

    #[inline]
    fn is_number(&self) -> bool {
        self.is_finite()
    }

    fn floats(values: &[Self]) -> Option<&[f64]> {
        Some(values)
    }
}
