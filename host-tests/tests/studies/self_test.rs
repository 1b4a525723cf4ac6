//! A short run of the study of self-tests.

use allanite_studies::self_test::{CASES, Looks, PROBABILITY, study};

/// The figures come from `cargo xtask study self-test`. This test is a guard: it repeats the study for a
/// quarter of its devices, whose seeds are fixed.
#[test]
fn devices_at_the_limit_are_seldom_passed_or_failed_whatever_noise_hides_it() {
    for case in &CASES[..3] {
        let tallies = study(*case, &[1.0, 1.3], 1000, Looks::Early);
        let (at_the_limit, above) = (tallies[0], tallies[1]);
        assert!(
            at_the_limit.passed <= PROBABILITY && at_the_limit.failed <= PROBABILITY,
            "{case:?}: {at_the_limit:?}"
        );
        // Some do pass or fail: a test without verdicts would not err either.
        assert!(at_the_limit.passed + at_the_limit.failed > 0.0);
        assert_eq!(above.passed, 0.0, "{case:?}: {above:?}");
    }
}

#[test]
fn devices_off_the_limit_get_the_right_verdict_soon() {
    let tallies = study(CASES[0], &[0.5, 1.3, 2.0], 200, Looks::Early);
    let (half, above, twice) = (tallies[0], tallies[1], tallies[2]);
    assert_eq!((half.passed, half.median_s), (1.0, 1.0));
    assert_eq!((above.failed, twice.failed), (1.0, 1.0));
    assert!(above.median_s <= 8.0, "{above:?}");
    assert!(twice.median_s <= 4.0, "{twice:?}");
}
