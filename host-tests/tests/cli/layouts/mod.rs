//! Sources and quantities in layouts that nobody listed: ids and tags, orders of rows, increments and angles, characters around
//! rows, and stamps, drawn at random by a generator that shares no code with the reader. No log is read wrong in silence.

mod answer;
mod glue;
mod layout;
mod names;
mod quantity;
mod random;
mod stamp;

use answer::{Outcome, outcome};
use layout::{Header, Kind, Layout};
use std::{collections::BTreeMap, ops::Range};
use tempfile::TempDir;

/// Outcomes by kind and header.
type Tally = BTreeMap<(Kind, Header), BTreeMap<Outcome, usize>>;

fn read(seeds: Range<u64>, mut each: impl FnMut(u64, &Layout, &Outcome, &str)) -> Tally {
    let folder = TempDir::new().unwrap();
    let mut tally = Tally::new();
    for seed in seeds {
        let layout = Layout::new(seed);
        let (outcome, said) = outcome(&layout, folder.path());
        each(seed, &layout, &outcome, &said);
        let counts = tally.entry((layout.kind, layout.header)).or_default();
        *counts.entry(outcome).or_default() += 1;
    }
    tally
}

fn print(tally: &Tally) {
    println!(
        "kind, header: right | assumed | asked, spelled out | asked, not spelled out | wrong after the answer | refused | wrong"
    );
    let outcomes = [
        Outcome::Right,
        Outcome::Assumed,
        Outcome::Asked(true),
        Outcome::Asked(false),
        Outcome::WrongAfterAnswer,
        Outcome::Refused,
        Outcome::SilentlyWrong,
    ];
    let mut sums = [0; 7];
    for ((kind, header), counts) in tally {
        let counts = outcomes
            .each_ref()
            .map(|outcome| counts.get(outcome).copied().unwrap_or(0));
        sums.iter_mut()
            .zip(counts)
            .for_each(|(sum, count)| *sum += count);
        println!(
            "{kind:?}, {header:?}: {counts:?} of {}",
            counts.iter().sum::<usize>()
        );
    }
    println!("all: {sums:?} of {}", sums.iter().sum::<usize>());
}

/// Asserts what is promised of layouts that nobody listed.
fn assert_promises(tally: &Tally) {
    print(tally);
    let count = |is: &dyn Fn(&(Kind, Header), &Outcome) -> bool| -> usize {
        let counts = tally
            .iter()
            .flat_map(|(key, counts)| counts.iter().map(move |one| (key, one)));
        let counts = counts.filter(|(key, (outcome, _))| is(key, outcome));
        counts.map(|(_, (_, count))| count).sum()
    };
    let all = count(&|_, _| true);
    // What is left are mostly sensors without a mark whose rows share a stamp and differ in noise alone, as two rows of a burst do. The
    // aim is none.
    let silent = count(&|_, outcome| *outcome == Outcome::SilentlyWrong);
    assert!(
        100 * silent <= all,
        "{silent} of {all} are wrong in silence"
    );
    let refused = count(&|_, outcome| *outcome == Outcome::Refused);
    assert!(
        100 * refused <= 2 * all,
        "{refused} of {all} are refused for good"
    );
    let wrong = count(&|_, outcome| *outcome == Outcome::WrongAfterAnswer);
    assert!(
        100 * wrong <= 2 * all,
        "{wrong} of {all} are wrong after a true answer"
    );
    // One gyro whose header tells quantity and unit.
    let is_told = |key: &(Kind, Header)| *key == (Kind::Single, Header::Full);
    let told = count(&|key, _| is_told(key));
    let right = count(&|key, outcome| is_told(key) && *outcome == Outcome::Right);
    assert!(
        100 * right >= 90 * told,
        "{right} of {told} are right at once"
    );
}

#[test]
fn layouts_of_sources_and_quantities_are_read_right_or_asked_for() {
    assert_promises(&read(0..150, |_, _, _, _| {}));
}

mod thorough {
    #[test]
    fn three_thousand_layouts_of_sources_and_quantities_are_read_right_or_asked_for() {
        super::assert_promises(&super::read(1_000_000..1_003_000, |_, _, _, _| {}));
    }
}

/// The seeds of the environment's variable `ALLANITE_LAYOUTS`, such as `0..300`, with what is said of each.
#[test]
#[ignore = "it lists the layouts of ALLANITE_LAYOUTS for whoever mends the reader, and judges nothing"]
fn layouts_of_the_environment_are_listed() {
    list();
}

pub(crate) fn list() {
    let Ok(seeds) = std::env::var("ALLANITE_LAYOUTS") else {
        return;
    };
    let (from, to) = seeds.split_once("..").unwrap();
    let seeds = from.parse().unwrap()..to.parse().unwrap();
    let folder = std::env::var("ALLANITE_LAYOUTS_FOLDER").ok();
    let tally = read(seeds, |seed, layout, outcome, said| {
        if *outcome == Outcome::Right && folder.is_none() {
            return;
        }
        let head: Vec<&str> = layout.text.lines().take(5).collect();
        println!(
            "{seed}: {outcome:?}: {}\n  {said}\n    {}",
            layout.drawn,
            head.join("\n    ")
        );
        for source in &layout.sources {
            println!(
                "  truth {} {:?} at {} Hz",
                source.id, source.noise, source.rate_hz
            );
        }
        if let Some(folder) = &folder {
            std::fs::write(format!("{folder}/{seed}.txt"), &layout.text).unwrap();
        }
    });
    print(&tally);
}
