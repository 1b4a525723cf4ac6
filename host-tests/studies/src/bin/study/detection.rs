//! How often an effect at its limit of detection shows.

use allanite_host::simulate::Preset;
use allanite_studies::detection::{Judged, effects, study};

pub(crate) fn print(records: u64, only: Option<&str>, judged: Judged, factor: f64) {
    println!(
        "{:<18} {:>7} {:>10} {:>6} {:>6} {:>9} {:>14}",
        "effect", "records", "inadequate", "shown", "named", "ambiguous", "without limits"
    );
    for effect in effects().filter(|effect| only.is_none_or(|only| only == effect.name())) {
        let t = study(Preset::Mems, effect, judged, records, factor);
        let percent = |count: usize| 100.0 * count as f64 / t.records.max(1) as f64;
        println!(
            "{:<18} {:>7} {:>10.1} {:>6.1} {:>6.1} {:>9.1} {:>14}",
            effect.name(),
            t.records,
            percent(t.inadequate),
            percent(t.shown),
            percent(t.named),
            percent(t.ambiguous),
            t.without_limits
        );
    }
}
