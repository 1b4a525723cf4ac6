//! Motion that never stops.

use allanite_studies::motion::{LEVELS, Moves, Tally, in_motion, rest};

pub(crate) fn print(records: u64, at_rest: u64, seed: u64) {
    println!(
        "{at_rest} records at rest and {records} in motion, of 5 s to 20 min at 50 to 500 Hz, seed {seed}"
    );
    let rests = rest(at_rest, seed);
    let (told, all) = sum(rests.iter().map(|(_, tally)| tally));
    println!(
        "at rest: {told} of {all} are said to move, {:.3} %; {} by one axis",
        percent(told, all),
        rests.iter().map(|(_, tally)| tally.alone).sum::<usize>()
    );
    for (kind, tally) in &rests {
        println!(
            "    {kind:?}: {}, {} by one axis, of {}",
            tally.told, tally.alone, tally.records
        );
    }
    let motions = in_motion(records, seed);
    println!("\nin motion, found by three axes | by one axis | by three axes or integrity, in %");
    print!("{:<12}", "noise times");
    LEVELS.iter().for_each(|level| print!(" {level:>21}"));
    println!();
    let row = |name: &str, of: &dyn Fn(&Moves, f64) -> bool| {
        print!("{name:<12}");
        for level in LEVELS {
            let chosen = motions
                .iter()
                .filter(|(kind, at, _)| *at == level && of(kind, *at));
            let tallies: Vec<&Tally> = chosen.map(|(.., tally)| tally).collect();
            let (told, all) = sum(tallies.iter().copied());
            let with: usize = tallies.iter().map(|tally| tally.with_integrity).sum();
            print!(
                "  {:>5.1} | {:>5.1} | {:>5.1}",
                percent(told, all),
                percent(tallies.iter().map(|tally| tally.alone).sum(), all),
                percent(with, all)
            );
        }
        println!();
    };
    row("all", &|_, _| true);
    for kind in Moves::ALL {
        row(&format!("{kind:?}"), &|other, _| *other == kind);
    }
}

fn sum<'a>(tallies: impl Iterator<Item = &'a Tally>) -> (usize, usize) {
    tallies.fold((0, 0), |(told, all), tally| {
        (told + tally.told, all + tally.records)
    })
}

fn percent(part: usize, of: usize) -> f64 {
    100.0 * part as f64 / of.max(1) as f64
}
