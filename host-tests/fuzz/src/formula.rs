//! Effects of a user's own, as texts: they are refused in one line, or they are written back as they were read, and all of their
//! covariances come soon.

use allanite::effect::{Effect as _, SampledShape};
use allanite_host::own::{Given, is_formula};
use std::time::{Duration, Instant};

/// The longest time for a formula. Chosen by hand: it takes some milliseconds.
const PATIENCE: Duration = Duration::from_secs(5);

/// Reads the bytes as a text, and asks for covariances of what it describes.
pub fn check(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    // A file of this machine has no part in this.
    if !is_formula(&text) || text.contains('@') {
        return;
    }
    let begin = Instant::now();
    let given = match Given::parse("--with", &text) {
        Ok(given) => given,
        Err(failure) => {
            let told = failure.to_string();
            assert!(!told.contains('\n'), "{told:?}");
            return;
        }
    };
    let written = given.effect.written(&given.parameters, given.is_fitted);
    match Given::parse("--with", &written) {
        Ok(again) => {
            assert!(
                std::ptr::eq(again.effect, given.effect),
                "{text:?}: {written:?}"
            );
            assert_eq!(again.parameters, given.parameters, "{written:?}");
        }
        Err(failure) => panic!("{text:?} is written as {written:?}: {failure}"),
    }
    let mut shape = SampledShape {
        interval_s: 0.004,
        parameters: given.parameters,
    };
    for parameter in &mut shape.parameters {
        if *parameter == 0.0 {
            *parameter = 1.0;
        }
    }
    for octave in 0..18 {
        let _ = given.effect.variance(f64::from(1_u32 << octave), &shape);
    }
    assert!(begin.elapsed() < PATIENCE, "{text:?} takes long");
}
