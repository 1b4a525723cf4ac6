//! A short run of the study of thermal dependences.

use allanite_studies::thermal;

/// Strong noise of another kind is taken for the noise of the rate where it follows a temperature, until it is known.
#[test]
fn a_temperature_behind_strong_gauss_markov_noise_is_found_beside_it() {
    for (_, course, kelvin, _) in thermal::CASES {
        let both = thermal::with_gauss_markov(course, kelvin, 10);
        assert!(both >= 0.9, "{course:?}: {both}");
    }
}
