//! Lines so strong that the sum over lags leaves more of them than the noise scatters.

use host_tests::{
    simulate::Preset,
    study::lines::{Said, diagnose, draw},
};

#[test]
fn a_strong_line_never_ends_a_diagnosis_with_an_error() {
    // Records of which the variance of an octave was negative, so that the covariance had no factor.
    for seed in [65, 146, 203, 293] {
        let line = draw(Preset::Mems, seed);
        let (said, _) = diagnose(Preset::Mems, line, seed);
        assert!(matches!(said, Said::Line { .. }), "{seed}: {said:?}");
    }
}
