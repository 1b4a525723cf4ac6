//! Whole products that survive power cuts.

use demonstration::{
    appliance::{BUFFER, Cut, EVERY, Gyro, SAMPLES, replay},
    simulated::Random,
};
use xtask::firmware::{
    Image, Precision,
    agreement::{first_difference, told_here},
    run_with,
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
    let number = found.and_then(|word| {
        if word == "Some" {
            words.next()
        } else {
            Some(word)
        }
    });
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
            1 => random.bits() % 1_000_000,
            _ => random.bits() % 60_000,
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

/// What an image logged, with a part for each start.
pub(crate) struct There {
    pub(crate) cuts: Vec<Cut>,
    /// The lines that tell what had happened before each cut, and at the end.
    counts: Vec<String>,
    /// The lines from each start to its cut.
    pub(crate) lives: Vec<Vec<String>>,
    longest: String,
}

pub(crate) fn there(image: &str, arguments: &[&str]) -> There {
    let run = Image::build(image).and_then(|image| run_with(&image, arguments));
    let run = run.unwrap_or_else(|error| panic!("{image} {arguments:?}: {error:#}"));
    assert!(run.status.success(), "{image}: {:?}", run.lines);
    let mut there = There {
        cuts: Vec::new(),
        counts: Vec::new(),
        lives: Vec::new(),
        longest: String::new(),
    };
    for line in run.lines {
        let line = line.strip_prefix("info ").unwrap_or(&line).to_owned();
        if let Some(rest) = line.strip_prefix("cut ") {
            let cut = rest.split(' ').next().and_then(Cut::parse);
            there.cuts.push(cut.expect("a cut"));
            there.counts.push(line);
        } else if line.starts_with("end ") {
            there.counts.push(line);
        } else if line.starts_with("longest ") {
            there.longest = line;
        } else {
            if line.starts_with("start ") {
                there.lives.push(Vec::new());
            }
            there.lives.last_mut().expect("a start").push(line);
        }
    }
    there
}

/// Checks that a product lost nothing, that a host which is cut at the same moments prints the same lines, and that
/// every interrupted report is the beginning of the whole one. Returns the last start.
pub(crate) fn check(image: &str, seed: u64, there: &There) {
    let case = format!("{image}, seed {seed}");
    println!("{case}\n{}\n{}", there.counts.join("\n"), there.longest);
    let last = there.lives.last().expect("a start");
    let mut lines = Vec::new();
    for life in &there.lives {
        println!("{}", life[0]);
        lines.push(life[0].clone());
        assert!(last[1..].starts_with(&life[1..]), "{case}: {life:?}");
    }
    lines.extend_from_slice(&last[1..]);
    let arguments = [seed.to_string()].into_iter();
    let cuts = there.cuts.iter().map(Cut::to_string);
    let arguments: Vec<String> = arguments.chain(cuts).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    // The images compute in single precision, and this program in double precision.
    let here = told_here(Precision::Single, "appliance_loop", &arguments);
    let here = here.unwrap_or_else(|error| panic!("{case}: {error:#}"));
    assert_eq!(first_difference(&here, &lines), None, "{case}");

    for (cut, life) in there.cuts.iter().zip(&there.lives[1..]) {
        let [accounted, missing] = ["accounted", "missing"].map(|name| number(&life[0], name));
        assert_eq!(accounted + missing, cut.made.min(SAMPLES), "{case}");
    }
    let sum = |name| -> u32 { there.counts.iter().map(|line| number(line, name)).sum() };
    assert_eq!((sum("lost"), sum("late")), (0, 0), "{case}");
    assert!(sum("during_erase") > 100 && sum("during_look") > 100);
    assert_eq!(number(of(&lines, "record ")[0], "accounted"), SAMPLES);
    assert!(of(&lines, "verdict ").len() == 1 && of(&lines, "certificate ").len() > 3);
    let longest = number(&there.longest, "longest");
    assert!(longest < number(&there.longest, "of") * 3 / 4, "{case}");
}
