//! Whole products that survive power cuts.

use host_tests::demonstration::{
    appliance::{BUFFER, Cut, EVERY, Gyro, SAMPLES, replay},
    simulated::Random,
};

fn here(seed: u64, cuts: &[Cut]) -> Vec<String> {
    let mut gyro = Box::new(Gyro::new());
    let mut buffer = vec![0; BUFFER];
    let mut lines = Vec::new();
    let done = replay(seed, cuts, &mut gyro, &mut buffer, |line| {
        lines.push(line.to_string());
    });
    done.unwrap_or_else(|failure| panic!("{failure:?}"));
    lines
}

/// The number that follows a word in a line.
fn number(line: &str, name: &str) -> u32 {
    let mut words = line.split([' ', ',', ':', '(', ')', '{', '}']);
    let mut words = words.by_ref().filter(|word| !word.is_empty());
    let found = words.find(|word| *word == name).and_then(|_| words.next());
    let number = found.and_then(|word| if word == "Some" { words.next() } else { Some(word) });
    number
        .and_then(|word| word.parse().ok())
        .unwrap_or_else(|| panic!("{line:?} does not contain {name}"))
}

/// The number of the next snapshot after a start.
fn next_snapshot(start: &str) -> u32 {
    if start.contains("snapshot: None") {
        0
    } else {
        number(start, "snapshot") + 1
    }
}

fn of<'l>(lines: &'l [String], start: &str) -> Vec<&'l str> {
    let lines = lines.iter().map(String::as_str);
    lines.filter(|line| line.starts_with(start)).collect()
}

#[test]
fn product_without_a_power_cut_keeps_every_sample() {
    let lines = here(1, &[]);
    let [start] = of(&lines, "start ")[..] else {
        panic!("{lines:?}");
    };
    assert!(start.starts_with("start 1 Restart { snapshot: None, accounted: 0, missing: 0"));
    let [record] = of(&lines, "record ")[..] else {
        panic!("{lines:?}");
    };
    // Of the simulated corruptions, two lie within this record.
    assert_eq!(
        ["samples", "left_out", "missing", "accounted"].map(|name| number(record, name)),
        [SAMPLES - 2, 2, 0, SAMPLES]
    );
    assert_eq!(of(&lines, "verdict "), ["verdict Improved"]);
    assert!(of(&lines, "certificate ").len() > 3);
}

/// The moments of ten cuts at random. The flash is cut after some of its operations, or after all of them.
fn random_cuts(random: &mut Random) -> Vec<Cut> {
    let mut made = [(); 10].map(|()| random.bits() % (SAMPLES + 2000));
    made.sort_unstable();
    let cuts = made.iter().map(|&made| Cut {
        made,
        taken: made.saturating_sub(random.bits() % 9).min(SAMPLES),
        operations: match random.bits() % 4 {
            0 => u32::MAX,
            _ => random.bits() % 1_000_000,
        },
    });
    cuts.collect()
}

#[test]
fn every_start_restores_the_newest_complete_snapshot_and_accounts_for_every_sample() {
    let mut random = Random::new(77);
    let (mut newest, mut before) = (0, 0);
    for _ in 0..6 {
        let cuts = random_cuts(&mut random);
        let lines = here(1, &cuts);
        println!("{cuts:?}\n{}", lines[..13].join("\n"));
        let starts = of(&lines, "start ");
        assert_eq!(starts.len(), cuts.len() + 1);
        let (mut next, mut first, mut kept) = (0, 0, 0);
        for (index, (cut, start)) in cuts.iter().zip(&starts[1..]).enumerate() {
            // A life counts on from the sample that the gyro makes first, and saves at every multiple.
            let saved = cut.taken.max(first) / EVERY - first / EVERY;
            let number_here = next_snapshot(start);
            let case = format!("start {}: {start}", index + 2);
            if cut.operations == u32::MAX {
                assert_eq!(number_here, next + saved, "{case}");
            }
            assert!((next..=next + saved).contains(&number_here), "{case}");
            if number_here > next {
                // The gate holds back up to 128 samples, which are not in a snapshot.
                let at = (first / EVERY + number_here - next) * EVERY;
                let held = at.checked_sub(number(start, "accounted"));
                assert!(held.is_some_and(|held| held <= 128), "{case}");
            } else {
                assert_eq!(number(start, "accounted"), kept, "{case}");
            }
            newest += usize::from(saved > 0 && number_here == next + saved);
            before += usize::from(number_here < next + saved);
            let made = cut.made.min(SAMPLES);
            kept = number(start, "accounted");
            assert_eq!(kept + number(start, "missing"), made, "{case}");
            (next, first) = (number_here, made);
        }
        let record = of(&lines, "record ")[0];
        assert_eq!(number(record, "accounted"), SAMPLES);
    }
    assert!(newest > 10 && before > 10, "{newest} {before}");
}
