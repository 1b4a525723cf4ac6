//! Whether steps, bursts, warm-ups and changes of noise are found in the course of a record.
//!
//! The shares are guards: they repeat `cargo xtask study course` with fewer records.

use allanite_host::simulate::Preset;
use allanite_studies::course::{CASES, Case, Tally, study};

const RECORDS: u64 = 12;

/// The tally of every case, of one preset.
fn tallies(preset: Preset) -> Vec<(Case, Tally)> {
    let tallies = study(preset, &CASES, 5000..5000 + RECORDS);
    CASES.into_iter().zip(tallies).collect()
}

#[test]
fn events_are_told_where_they_are_and_nowhere_else() {
    for preset in Preset::TYPICAL {
        for (case, tally) in tallies(preset) {
            let context = format!("{preset:?}, {case:?}: {tally:?}");
            let all = RECORDS as usize;
            assert_eq!(tally.records, all);
            assert!(tally.any_besides <= 1, "{context}");
            let (told, on_time) = match case {
                Case::Clean => (0, 0),
                // A small change is told at another block in half of the records.
                Case::Noise(factor) if factor < 1.1 => (all * 3 / 4, 0),
                Case::WarmUp => (all - 1, all * 2 / 3),
                _ => (all - 1, all - 2),
            };
            assert!(tally.told >= told, "{context}");
            assert!(tally.on_time >= on_time, "{context}");
            if !matches!(case, Case::Clean | Case::Bursts) {
                assert!(tally.covered * 4 >= tally.told * 3, "{context}");
            }
        }
    }
}
