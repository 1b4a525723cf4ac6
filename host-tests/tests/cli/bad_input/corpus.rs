//! A generated corpus of more than five thousand hostile inputs of every format that is read.

mod bombs;
mod mutation;

use super::case::{Case, Usage, refused};
use crate::sealed::sealed;
use mutation::{Mutation, text_mutated};
use program::ADIS16405;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use std::{fs, path::Path};

/// The number of changed copies of each good file.
const COPIES: u64 = 110;

/// A good file, and the command that reads it with the name of the file in it.
struct Good {
    name: String,
    bytes: Vec<u8>,
    command: String,
}

/// The files of the tests that are good, one of each format and more.
fn good_files() -> Vec<Good> {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures");
    let mut paths = Vec::new();
    for folder in ["", "origins", "origins/parts", "origins/rosbag2"] {
        let entries = fs::read_dir(fixtures.join(folder)).unwrap().flatten();
        let files = entries.map(|entry| entry.path());
        paths.extend(files.filter(|path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            path.is_file() && !name.ends_with(".py") && !name.ends_with(".md")
        }));
    }
    paths.sort();
    let of_file = |path: &Path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let more = match &*name {
            "counts.npy" | "putty" => " --rate 200",
            "two-imus.mcap" => " --topic /imu/left",
            _ => "",
        };
        Good {
            command: format!("diagnose {name}{more}"),
            bytes: fs::read(path).unwrap(),
            name: name.into_owned(),
        }
    };
    let mut good: Vec<Good> = paths.iter().map(|path| of_file(path)).collect();
    // Without its checksums, more of a changed bag is read.
    let plain = good.iter().filter(|file| file.name.ends_with(".mcap"));
    let unchecked = plain.map(|file| Good {
        name: format!("unchecked-{}", file.name),
        bytes: without_checksums(&file.bytes),
        command: file
            .command
            .replacen(&file.name, &format!("unchecked-{}", file.name), 1),
    });
    let unchecked: Vec<Good> = unchecked.collect();
    good.extend(unchecked);
    let text = super::text::good(300);
    good.push(Good {
        name: "packed.csv.gz".into(),
        bytes: super::text::gzip(text.as_bytes()),
        command: "diagnose packed.csv.gz".into(),
    });
    for (command, name) in [("diagnose", "curve.json"), ("export -f json", "model.json")] {
        good.push(Good {
            name: name.into(),
            bytes: fs::read(ADIS16405).unwrap(),
            command: format!("{command} {name}"),
        });
    }
    good
}

/// A bag of MCAP whose checksums are 0, which means that there are none.
fn without_checksums(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let mut at = 8;
    while at + 9 <= bytes.len() {
        let length = u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap()) as usize;
        let content = at + 9;
        let checksum = match bytes[at] {
            2 => Some(16),
            6 => Some(24),
            15 => Some(0),
            _ => None,
        };
        if let Some(from) = checksum {
            bytes[content + from..content + from + 4].fill(0);
        }
        if bytes[at] == 2 {
            break;
        }
        at = content + length;
    }
    bytes
}

fn is_text(bytes: &[u8]) -> bool {
    std::str::from_utf8(bytes).is_ok() && !bytes.contains(&0)
}

/// Changed copies of every good file, of certificates with right checksums, and what was made to claim much.
pub(crate) fn corpus() -> Vec<Case> {
    let good = good_files();
    let mut cases = Vec::new();
    for (number, file) in good.iter().enumerate() {
        let other = &good[(number + 1) % good.len()].bytes;
        for copy in 0..COPIES {
            let mut random = Xoshiro256PlusPlus::seed_from_u64(number as u64 * 1000 + copy);
            let bytes = match is_text(&file.bytes) && copy % 2 == 0 {
                true => text_mutated(&file.bytes, &mut random),
                false => Mutation::random(&mut random).of(&file.bytes, other, &mut random),
            };
            cases.push(refused(&file.name, bytes, &file.command, "").ambiguous());
        }
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/lot/now");
    let certificates = fs::read_dir(folder).unwrap().flatten();
    let mut certificates: Vec<_> = certificates.map(|entry| entry.path()).collect();
    certificates.sort();
    for (number, path) in certificates.iter().enumerate() {
        let bytes = fs::read(path).unwrap();
        for copy in 0..20 {
            let mut random = Xoshiro256PlusPlus::seed_from_u64(number as u64 * 1000 + copy);
            let mutation = Mutation::random(&mut random);
            // The payload lies between a head of eight bytes and a checksum of four.
            let payload = mutation.of(&bytes[8..bytes.len() - 4], &bytes, &mut random);
            let changed = match copy % 4 {
                0 => mutation.of(&bytes, &payload, &mut random),
                _ => sealed(bytes[4], bytes[5], &payload),
            };
            cases.push(refused("a.bin", changed, "decode a.bin", "").ambiguous());
        }
    }
    for (name, command) in [
        ("imu_9.csv", "diagnose parts"),
        ("rosbag2_1.mcap", "diagnose parts"),
    ] {
        let file = good.iter().find(|file| file.name == name).unwrap();
        for copy in 0..40 {
            let mut random = Xoshiro256PlusPlus::seed_from_u64(copy);
            let bytes = Mutation::random(&mut random).of(&file.bytes, &file.bytes, &mut random);
            let case = refused(&format!("parts/{name}"), bytes, command, "").ambiguous();
            cases.push(case.beside(format!("parts/0-{name}"), file.bytes.clone()));
        }
    }
    cases.extend(bombs::cases());
    cases
}

mod thorough {
    use super::*;

    #[test]
    fn every_input_of_a_generated_corpus_takes_little_time_and_memory() {
        let cases = corpus();
        assert!(cases.len() >= 5000, "{} cases", cases.len());
        let mut slowest = (0.0, String::new());
        let mut largest = (0, String::new());
        crate::bad_input::run_all(&cases, &mut |case, usage: Usage| {
            if usage.seconds > slowest.0 {
                slowest = (usage.seconds, case.name().to_owned());
            }
            if usage.kib > largest.0 {
                largest = (usage.kib, case.name().to_owned());
            }
        });
        println!(
            "{} inputs: at most {:.2} s ({}) and {} KiB ({})",
            cases.len(),
            slowest.0,
            slowest.1,
            largest.0,
            largest.1
        );
    }
}
