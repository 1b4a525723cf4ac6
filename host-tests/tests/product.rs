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
        let mut cuts = random_cuts(&mut random);
        let lines = here(1, &cuts);
        println!("{cuts:?}\n{}", lines[..13].join("\n"));
        let starts = of(&lines, "start ");
        assert_eq!(starts.len(), cuts.len() + 1);
        let (mut kept, mut first) = (0, 0);
        for (index, (cut, start)) in cuts.iter().zip(&starts[1..]).enumerate() {
            let accounted = number(start, "accounted");
            // A start continues with the sample that the gyro makes next. Samples that the product had not taken are
            // part of the gap of the next start.
            let due = cut.taken.max(first) / EVERY * EVERY;
            let complete = if due > first { due } else { kept };
            if cut.operations == u32::MAX {
                assert_eq!(accounted, complete, "cut {index}");
            }
            assert!(accounted >= kept && accounted <= complete, "cut {index}");
            if accounted == complete {
                newest += 1;
            } else {
                before += 1;
            }
            let made = cut.made.min(SAMPLES);
            assert_eq!(accounted + number(start, "missing"), made, "cut {index}");
            (kept, first) = (accounted, made);
        }
        let record = of(&lines, "record ")[0];
        assert_eq!(number(record, "accounted"), SAMPLES);
        cuts.clear();
    }
    assert!(newest > 10 && before > 10, "{newest} {before}");
}
