//! Tests the limits of detection: an effect at its limit shows in most records, and a smaller one does not.

use allanite_host::simulate::Preset;
use allanite_studies::detection::{Judged, effects, study};

/// `cargo xtask study detection` counts many more records. Of 40, at least 33 show an effect at its limit with a
/// probability of 99.9 % if the limit is right.
#[test]
fn effects_at_their_limits_show_and_smaller_ones_do_not() {
    const RECORDS: u64 = 40;
    let chosen = |name| effects().find(|effect| effect.name() == name);
    for (name, judged) in [
        ("sinusoid", Judged::Octaves),
        ("gauss_markov", Judged::Octaves),
        ("sinusoid", Judged::Spectrum),
        ("gauss_markov", Judged::Spectrum),
    ] {
        let effect = chosen(name).expect("an effect of the catalogue");
        let at_limit = study(Preset::Mems, effect, judged, RECORDS, 1.0);
        assert!(at_limit.records >= 35, "{name}: {at_limit:?}");
        assert!(
            100 * at_limit.shown >= 82 * at_limit.records,
            "{name}: {at_limit:?}"
        );
        // A sixteenth of the noncentrality.
        let smaller = study(Preset::Mems, effect, judged, RECORDS, 0.5);
        assert!(
            100 * smaller.shown <= 25 * smaller.records,
            "{name}: {smaller:?}"
        );
    }
}
