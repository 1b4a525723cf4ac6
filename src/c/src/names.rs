//! Names of effects and of their parameters, which end with NUL.

use crate::codes;
use core::ffi::{CStr, c_char};

/// The name of the effect with a code, such as "angle_random_walk"; "other" for a code that this library does not know.
#[unsafe(no_mangle)]
pub extern "C" fn allanite_effect_name(code: i32) -> *const c_char {
    let (_, name, _) = effect(code);
    name.as_ptr()
}

/// The name of a parameter of the effect with a code, such as "frequency_hz"; an empty text if there is no such parameter.
#[unsafe(no_mangle)]
pub extern "C" fn allanite_parameter_name(code: i32, parameter: i32) -> *const c_char {
    let (_, _, parameters) = effect(code);
    let place = usize::try_from(parameter).unwrap_or(usize::MAX);
    parameters.get(place).copied().unwrap_or(c"").as_ptr()
}

/// A code, its name, and the names of the parameters.
type Named = (i32, &'static CStr, &'static [&'static CStr]);

fn effect(code: i32) -> Named {
    let known = EFFECTS.iter().find(|(known, ..)| *known == code);
    known.copied().unwrap_or((0, c"other", &[]))
}

/// The effects of the catalogue and the five terms of IEEE Std 952. A test compares them with the library.
const EFFECTS: [Named; 21] = [
    (codes::ALLANITE_EFFECT_QUANTIZATION, c"quantization", &[]),
    (
        codes::ALLANITE_EFFECT_ANGLE_RANDOM_WALK,
        c"angle_random_walk",
        &[],
    ),
    (
        codes::ALLANITE_EFFECT_BIAS_INSTABILITY,
        c"bias_instability",
        &[],
    ),
    (
        codes::ALLANITE_EFFECT_RATE_RANDOM_WALK,
        c"rate_random_walk",
        &[],
    ),
    (codes::ALLANITE_EFFECT_RATE_RAMP, c"rate_ramp", &[]),
    (
        codes::ALLANITE_EFFECT_GAUSS_MARKOV,
        c"gauss_markov",
        &[c"correlation_time_s"],
    ),
    (
        codes::ALLANITE_EFFECT_SINUSOID,
        c"sinusoid",
        &[c"frequency_hz"],
    ),
    (
        codes::ALLANITE_EFFECT_RESONANCE,
        c"resonance",
        &[c"frequency_hz", c"quality"],
    ),
    (
        codes::ALLANITE_EFFECT_LOW_PASS,
        c"low_pass",
        &[c"time_constant_s", c"poles"],
    ),
    (
        codes::ALLANITE_EFFECT_DECIMATION_FILTER,
        c"decimation_filter",
        &[c"width_s", c"stages"],
    ),
    (
        codes::ALLANITE_EFFECT_RANDOM_TELEGRAPH,
        c"random_telegraph",
        &[c"correlation_time_s"],
    ),
    (
        codes::ALLANITE_EFFECT_POWER_LAW,
        c"power_law",
        &[c"exponent"],
    ),
    (
        codes::ALLANITE_EFFECT_NOTCH,
        c"notch",
        &[c"frequency_hz", c"quality"],
    ),
    (
        codes::ALLANITE_EFFECT_DIGITAL_LOW_PASS,
        c"digital_low_pass",
        &[c"time_constant_s", c"poles"],
    ),
    (
        codes::ALLANITE_EFFECT_CASCADE,
        c"cascade",
        &[c"time_constant_s", c"stages"],
    ),
    (
        codes::ALLANITE_EFFECT_MODE_SPLIT,
        c"mode_split",
        &[c"rise_hz", c"corner_hz"],
    ),
    (
        codes::ALLANITE_EFFECT_HIGH_PASS,
        c"high_pass",
        &[c"time_constant_s"],
    ),
    (
        codes::ALLANITE_EFFECT_DRIFTING_RESONANCE,
        c"drifting_resonance",
        &[c"frequency_hz", c"quality", c"drift_hz"],
    ),
    (
        codes::ALLANITE_EFFECT_DRIFTING_SINUSOID,
        c"drifting_sinusoid",
        &[c"frequency_hz", c"drift_hz"],
    ),
    (
        codes::ALLANITE_EFFECT_OUTPUT_LOW_PASS,
        c"output_low_pass",
        &[c"time_constant_s", c"poles"],
    ),
    (
        codes::ALLANITE_EFFECT_MOVING_AVERAGE,
        c"moving_average",
        &[c"samples"],
    ),
];

#[cfg(test)]
mod tests {
    use super::*;
    use allanite::effect::{CATALOGUE, IEEE_952};

    #[test]
    fn names_are_those_of_the_library() {
        let all = IEEE_952.iter().chain(&CATALOGUE);
        let mut found = 0;
        for effect in all {
            let code = i32::from(effect.description().code);
            let Some((_, name, parameters)) = EFFECTS.iter().find(|(known, ..)| *known == code)
            else {
                panic!("{} (code {code}) has no name here", effect.name());
            };
            assert_eq!(name.to_str(), Ok(effect.name()));
            let here = parameters.iter().map(|name| name.to_str().unwrap());
            assert!(
                here.eq(effect.parameters().iter().map(|one| one.name)),
                "{name:?}"
            );
            found += 1;
        }
        assert!(found >= EFFECTS.len());
    }

    #[test]
    fn unknown_codes_have_names_too() {
        for code in [-1, 0, 99, i32::MAX, i32::MIN] {
            // SAFETY: the function returns a text that ends with NUL.
            let name = unsafe { CStr::from_ptr(allanite_effect_name(code)) };
            assert_eq!(name, c"other");
        }
        // SAFETY: as before.
        let name = unsafe { CStr::from_ptr(allanite_parameter_name(8, -1)) };
        assert_eq!(name, c"");
        // SAFETY: as before.
        let name = unsafe { CStr::from_ptr(allanite_parameter_name(8, 1)) };
        assert_eq!(name, c"quality");
    }
}
