//! Studies which losses a log is said to have whose stamps are late, and which rate.

use super::noise::normal;
use allanite_host::simulate::Random;
use allanite_log::{Options, failure::Failure, read};
use indicatif::ProgressBar;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use std::{fmt::Write, io::Write as _};

/// The number of samples of a record.
pub const SAMPLES: usize = 1 << 14;

/// What happens to the stamps of a record. Times are in intervals of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stamps {
    /// Nothing: they are exact, rounded to microseconds.
    Exact,
    /// They are rounded to milliseconds, between 50 and 400 Hz.
    Milliseconds,
    /// Each has an error with this standard deviation.
    Jitter(f64),
    /// This share of them is late by 0.6 to 1.9 intervals. The rows behind wait, and follow at once.
    Late(f64),
    /// This share of rows meets a reader that is busy for 2 to 8 intervals. The rows that wait follow at once.
    Stalled(f64),
    /// Each is late by an exponential time with this mean, and the rows behind wait.
    Busy(f64),
}

impl Stamps {
    /// The stamps of the study.
    pub const ALL: [Self; 12] = [
        Self::Exact,
        Self::Milliseconds,
        Self::Jitter(0.03),
        Self::Jitter(0.1),
        Self::Jitter(0.2),
        Self::Late(0.002),
        Self::Late(0.02),
        Self::Late(0.1),
        Self::Stalled(0.001),
        Self::Stalled(0.01),
        Self::Busy(0.05),
        Self::Busy(0.2),
    ];
}

/// The share of samples that are lost one by one.
pub const LOSSES: [f64; 3] = [0.0, 0.001, 0.01];

/// What is told of records.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The number of records.
    pub records: usize,
    /// Those that are refused, with the reason of each.
    pub refused: Vec<String>,
    /// Those of which as many losses are told as there are, to 2 % or one loss.
    pub right: usize,
    /// The number of losses that are told, less those that there are, relative to the number of samples.
    pub excess: Vec<f64>,
    /// The relative errors of the rate.
    pub rate_errors: Vec<f64>,
}

enum One {
    Refused(String),
    Read { told: f64, lost: f64, rate: f64 },
}

/// Reads records of these stamps from which a share of the samples is lost.
///
/// # Errors
/// Fails if a log cannot be written.
pub fn study(stamps: Stamps, losses: f64, records: u64, seed: u64) -> Result<Tally, Failure> {
    let folder = tempfile::tempdir().map_err(|error| {
        Failure::option(format!("no folder for logs: {error}"), "free the disk")
    })?;
    let ones: Result<Vec<One>, Failure> = (0..records)
        .into_par_iter()
        .map(|record| {
            let path = folder.path().join(format!("{record}.csv"));
            one(stamps, losses, seed.wrapping_add(record), &path)
        })
        .collect();
    let mut tally = Tally::default();
    for one in ones? {
        tally.records += 1;
        match one {
            One::Refused(why) => tally.refused.push(why),
            One::Read { told, lost, rate } => {
                tally.right += usize::from((told - lost).abs() <= (0.02 * lost).max(1.0));
                tally.excess.push((told - lost) / SAMPLES as f64);
                tally.rate_errors.push(rate);
            }
        }
    }
    Ok(tally)
}

fn one(stamps: Stamps, losses: f64, seed: u64, path: &std::path::Path) -> Result<One, Failure> {
    let mut random = Random::seed_from_u64(seed);
    let slowest_and_octaves = match stamps {
        Stamps::Milliseconds => (50.0, 3.0),
        _ => (50.0, 4.3),
    };
    let rate_hz =
        slowest_and_octaves.0 * 2_f64.powf(slowest_and_octaves.1 * random.random::<f64>());
    let times = times(stamps, &mut random);
    let (mut text, mut lost, mut last) = (String::from("time_us,gx_dps,gy_dps,gz_dps\n"), 0, -1);
    for time in times {
        let row: [f64; 3] = std::array::from_fn(|_| 0.01 * normal(&mut random));
        // The first rows and the last one stay, so that all losses lie between rows.
        if last >= 0 && random.random_bool(losses) {
            lost += 1;
            continue;
        }
        let exact = time / rate_hz;
        let stamp = match stamps {
            Stamps::Milliseconds => (exact * 1e3).floor() as i64 * 1000,
            _ => (exact * 1e6).round() as i64,
        };
        last = stamp.max(last + i64::from(stamps != Stamps::Milliseconds));
        let [x, y, z] = row;
        writeln!(text, "{last},{x:.6},{y:.6},{z:.6}").expect("text grows");
    }
    let unwritten =
        |error: std::io::Error| Failure::option(format!("a log: {error}"), "free the disk");
    let mut file = std::fs::File::create(path).map_err(unwritten)?;
    file.write_all(text.as_bytes()).map_err(unwritten)?;
    let log = read(path, &Options::default(), &ProgressBar::hidden());
    std::fs::remove_file(path).map_err(unwritten)?;
    Ok(match log {
        Err(failure) => One::Refused(failure.to_string()),
        Ok(log) => One::Read {
            told: lost_in(&log.notes),
            lost: f64::from(lost),
            rate: log.rate_hz / rate_hz - 1.0,
        },
    })
}

/// The times of the stamps, in intervals, and before any row is lost.
fn times(stamps: Stamps, random: &mut Random) -> Vec<f64> {
    /// The time that a reader takes for a row that waits.
    const READING: f64 = 0.05;
    let (mut busy_until, mut times) = (0.0, Vec::with_capacity(SAMPLES));
    for n in 0..SAMPLES {
        let due = 10.0 + n as f64;
        let ready = match stamps {
            Stamps::Exact | Stamps::Milliseconds => due,
            Stamps::Jitter(size) => due + size * normal(random),
            Stamps::Late(share) if random.random_bool(share) => due + random.random_range(0.6..1.9),
            Stamps::Stalled(share) if random.random_bool(share) => {
                due + random.random_range(2.0..8.0)
            }
            Stamps::Busy(mean) => due - mean * (1.0 - random.random::<f64>()).ln(),
            Stamps::Late(_) | Stamps::Stalled(_) => due,
        };
        let time = match stamps {
            Stamps::Exact | Stamps::Milliseconds | Stamps::Jitter(_) => ready,
            _ => f64::max(ready, busy_until + READING),
        };
        busy_until = time;
        times.push(time);
    }
    times
}

/// The number of lost samples that notes tell.
fn lost_in(notes: &[String]) -> f64 {
    let told = notes.iter().find_map(|note| {
        let (before, _) = note.split_once(" lost")?;
        let words: Vec<&str> = before.rsplitn(3, ' ').collect();
        words.get(1)?.parse().ok()
    });
    told.unwrap_or(0.0)
}
