//! Random changes of files.

use rand::RngExt;
use rand_xoshiro::Xoshiro256PlusPlus as Random;

/// The longest changed file.
const LONGEST: usize = 1 << 20;

#[derive(Clone, Copy, Debug)]
pub(super) enum Mutation {
    Bits,
    Bytes,
    Ends,
    Block,
    Repeated,
    Number,
    Spliced,
    Inserted,
}

impl Mutation {
    pub(super) fn random(random: &mut Random) -> Self {
        match random.random_range(0..8) {
            0 => Self::Bits,
            1 => Self::Bytes,
            2 => Self::Ends,
            3 => Self::Block,
            4 => Self::Repeated,
            5 => Self::Spliced,
            6 => Self::Inserted,
            _ => Self::Number,
        }
    }

    /// The changed bytes, some of which may come from another file.
    pub(super) fn of(self, good: &[u8], other: &[u8], random: &mut Random) -> Vec<u8> {
        let mut bytes = good.to_vec();
        if bytes.is_empty() {
            return other.to_vec();
        }
        let at = place(bytes.len(), random);
        match self {
            Self::Bits => {
                for _ in 0..random.random_range(1..8) {
                    let at = place(bytes.len(), random);
                    bytes[at] ^= 1 << random.random_range(0..8);
                }
            }
            Self::Bytes => {
                for _ in 0..random.random_range(1..40) {
                    let at = place(bytes.len(), random);
                    bytes[at] = random.random();
                }
            }
            Self::Ends => bytes.truncate(at),
            Self::Block => {
                let end = (at + random.random_range(1..2000)).min(bytes.len());
                let with = [0, 0xff, 0x7f, b' '][random.random_range(0..4)];
                bytes[at..end].fill(with);
            }
            Self::Repeated => {
                let end = (at + random.random_range(1..20_000)).min(bytes.len());
                let block = bytes[at..end].to_vec();
                let most = (LONGEST - bytes.len().min(LONGEST)) / block.len();
                let times = random.random_range(1..=most.clamp(1, 5000));
                bytes.splice(at..at, block.repeat(times));
            }
            Self::Number => {
                for _ in 0..random.random_range(1..4) {
                    let at = place(bytes.len(), random);
                    let value = [
                        0,
                        1,
                        0x7f,
                        0xff,
                        0x7fff,
                        0xffff,
                        0x00ff_ffff,
                        0x7fff_ffff,
                        0xffff_ffff,
                        1 << 40,
                        i64::MAX as u64,
                        u64::MAX,
                    ][random.random_range(0..12)];
                    let size = [1, 2, 4, 8][random.random_range(0..4)];
                    let mut number = value.to_le_bytes()[..size].to_vec();
                    if random.random_bool(0.3) {
                        number.reverse();
                    }
                    let end = (at + size).min(bytes.len());
                    bytes[at..end].copy_from_slice(&number[..end - at]);
                }
            }
            Self::Spliced => {
                bytes.truncate(at);
                bytes.extend(&other[random.random_range(0..=other.len())..]);
            }
            Self::Inserted => {
                let more: Vec<u8> = (0..random.random_range(1..500))
                    .map(|_| random.random())
                    .collect();
                bytes.splice(at..at, more);
            }
        }
        bytes.truncate(LONGEST);
        bytes
    }
}

/// A place, more often near the beginning and the end, where formats say what the rest is.
fn place(length: usize, random: &mut Random) -> usize {
    match random.random_range(0..3) {
        0 => random.random_range(0..length.min(300)),
        1 => random.random_range(length.saturating_sub(600)..length),
        _ => random.random_range(0..length),
    }
}

/// Text in which words and lines are others.
pub(super) fn text_mutated(good: &[u8], random: &mut Random) -> Vec<u8> {
    let text = String::from_utf8_lossy(good).into_owned();
    let mut lines: Vec<String> = text.lines().map(String::from).collect();
    let words = [
        "1e999",
        "nan",
        "-",
        "",
        "\"",
        "=1+1",
        "18446744073709551615",
        "-9223372036854775809",
        "0x10",
        "1,5",
        "#",
        "\t",
        "\u{202e}",
        "\u{0}",
        "1969-12-31T23:59:59Z",
        "24:61:99",
        "é",
        "99999999999999999999999999",
        "true",
        "1e-320",
        "# lost 99999999999999999999 samples",
        "rate_hz=1e9",
        "unit=parsec",
        "[[[[[[",
        "}",
        "null",
    ];
    for _ in 0..random.random_range(1..12) {
        if lines.is_empty() {
            break;
        }
        let at = random.random_range(0..lines.len());
        let word = words[random.random_range(0..words.len())];
        match random.random_range(0..7) {
            0 => lines[at] = word.to_owned(),
            1 => {
                let mut fields: Vec<&str> = lines[at].split([',', ';', '\t', ' ']).collect();
                let field = random.random_range(0..fields.len());
                fields[field] = word;
                lines[at] = fields.join(",");
            }
            2 => {
                lines.remove(at);
            }
            3 => {
                let line = lines[at].clone();
                let times = random
                    .random_range(1..2000)
                    .min((1 << 19) / (line.len() + 1));
                lines.splice(at..at, vec![line; times]);
            }
            4 => {
                let many = random.random_range(1..3000);
                lines[at] += &format!(",{word}").repeat(many);
            }
            5 => {
                let other = random.random_range(0..lines.len());
                lines.swap(at, other);
            }
            _ => {
                let digits = "9".repeat(random.random_range(1..100_000));
                lines[at] += &digits;
            }
        }
    }
    let mut bytes = lines
        .join(["\n", "\r\n", "\r"][random.random_range(0..3)])
        .into_bytes();
    bytes.truncate(LONGEST);
    bytes
}
