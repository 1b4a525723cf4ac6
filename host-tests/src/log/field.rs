//! One value of a log, before it is a count.

use crate::failure::quoted;

/// A value that is a count or a number, or wants to be one.
pub(super) trait Field {
    /// The value as a count: a whole number within `i32`.
    fn count(&self) -> Option<i32>;

    /// The value as a finite number, or what is wrong with it.
    fn number(&self) -> Result<f64, Flaw>;
}

/// What is wrong with a value, and what to do about it.
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
}

/// A field of a text file.
pub(super) struct Text<'a>(pub(super) &'a [u8]);

impl Field for Text<'_> {
    #[inline]
    fn count(&self) -> Option<i32> {
        // Blanks around it, a leading plus, a point: the slower path of `number` takes those.
        atoi_simd::parse::<i32, false, false>(self.0).ok()
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
        }
    )*};
}

integer_fields!(i64 u64);

impl Field for f64 {
    #[inline]
    fn count(&self) -> Option<i32> {
        // The conversion saturates, and no count survives the way there and back but itself.
        let count = *self as i32;
        (f64::from(count) == *self).then_some(count)
    }

    fn number(&self) -> Result<f64, Flaw> {
        if self.is_finite() {
            Ok(*self)
        } else {
            Err(Flaw::not_finite(&self.to_string()))
        }
    }
}
