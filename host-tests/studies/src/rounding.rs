//! Studies what is said of noise behind a digital filter that is rounded to whole counts.

use super::{OCTAVES, RATE_HZ, measured::Sums, said::Said};
use allanite::{Axis, Scale, fit::State};
use allanite_host::{
    rounding,
    simulate::{Coefficients, Hidden, Random, Simulator},
};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// The root mean squares of the rounded noise, in steps.
pub const STEPS: [f64; 8] = [0.3, 0.5, 0.75, 1.0, 1.5, 2.5, 4.0, 30.0];

/// The numbers of poles of the filter. Without a filter, the noise is white.
pub const POLES: [u32; 5] = [0, 1, 2, 3, 4];

/// The corners of the filter, as shares of the sample rate.
const CORNERS: [f64; 2] = [0.03, 0.2];

/// The names by which the filter may go: white noise alone does not tell what else would pass it.
const FILTERS: [&str; 5] = [
    "low_pass",
    "digital_low_pass",
    "cascade",
    "decimation_filter",
    "output_low_pass",
];

/// The number of samples of a record, and of those that measure the noise behind a filter.
const SAMPLES: usize = 1 << 17;
const SCALED: usize = 1 << 13;

/// The angle random walk, in deg/s/√Hz. The step follows it.
const WHITE: f64 = 0.005;

/// The records of a size and a filter.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// All records.
    pub records: usize,
    /// Records that are refused as too coarse. The others are diagnosed.
    pub refused: usize,
    /// Records without a diagnosis, or of which something is left that has no name.
    pub unexplained: usize,
    /// Records in which an effect is named that is neither the filter nor white noise behind it.
    pub wrong: usize,
    /// Records in which the filter is not named, though there is one.
    pub missing: usize,
    /// Records in which white noise behind the filter is named.
    pub behind: usize,
    /// Records in which the interval of N contains its true value. Without a filter, it is that of N without rounding.
    pub covered: usize,
    /// What was said of the wrong ones.
    pub others: Vec<String>,
}

/// Diagnoses records of noise of this many steps behind a filter of so many poles.
pub fn study(steps: f64, poles: u32, seed: u64, records: u64) -> Tally {
    let tallies: Vec<Tally> = (seed..seed.saturating_add(records))
        .into_par_iter()
        .map(|seed| one(steps, poles, seed))
        .collect();
    let mut all = Tally::default();
    for one in tallies {
        all.records += 1;
        all.refused += one.refused;
        all.unexplained += one.unexplained;
        all.wrong += one.wrong;
        all.missing += one.missing;
        all.behind += one.behind;
        all.covered += one.covered;
        all.others.extend(one.others);
    }
    all
}

fn one(steps: f64, poles: u32, seed: u64) -> Tally {
    let mut random = Random::seed_from_u64(seed ^ 0x726f_756e);
    let [low, high] = CORNERS;
    let corner = low * (high / low).powf(random.random::<f64>());
    let base = Coefficients {
        angle_random_walk: WHITE,
        ..Coefficients::default()
    };
    let time_s = 1.0 / (std::f64::consts::TAU * corner * RATE_HZ);
    let filter = Hidden::new("digital_low_pass", [time_s, f64::from(poles)], WHITE);
    let hidden: Vec<Hidden> = filter.filter(|_| poles > 0).into_iter().collect();
    let rates = || Simulator::with_hidden(base, &hidden, RATE_HZ, seed);
    let square: f64 = rates().take(SCALED).map(|rate| rate * rate).sum();
    let quantum = (square / SCALED as f64).sqrt() / steps;
    let mut sums = Sums::new();
    // The conversion saturates. An offset of a part of a step is what a gyro has.
    let offset = random.random::<f64>();
    let counts = rates().map(|rate| (rate / quantum + offset).round() as i32);
    let counts: Vec<i32> = counts.take(SAMPLES).collect();
    let scale = Scale::new(quantum, RATE_HZ).expect("positive");
    let mut gyro = Axis::<OCTAVES>::new();
    counts.iter().for_each(|&count| gyro.push(count));
    if gyro
        .record_so_far(0, scale)
        .is_ok_and(|record| record.invalid.is_some())
    {
        return Tally {
            records: 1,
            refused: 1,
            ..Tally::default()
        };
    }
    sums.push_slice(&counts);
    let measured = sums.measured(scale);
    let said = Said::of(&measured);
    let is_behind = |(name, others): &(&str, Vec<&str>)| {
        let mut names = others.iter().chain(std::iter::once(name));
        names.any(|name| *name == "angle_random_walk")
    };
    let is_filter = |(name, others): &(&str, Vec<&str>)| {
        let mut names = others.iter().chain(std::iter::once(name));
        names.any(|name| FILTERS.contains(name))
    };
    let mut named = said.named.iter();
    let has_filter = named.any(&is_filter);
    let filters = said.named.iter().filter(|one| is_filter(one)).count();
    let behind = said.named.iter().filter(|one| is_behind(one)).count();
    let wrong = said.named.len() > filters + behind || filters > usize::from(poles > 0);
    Tally {
        records: 1,
        refused: 0,
        unexplained: usize::from(said.is_unexplained()),
        wrong: usize::from(wrong),
        missing: usize::from(poles > 0 && !has_filter),
        behind: usize::from(behind > 0),
        covered: usize::from(covers(&said, poles, quantum)),
        others: if wrong {
            vec![said.words()]
        } else {
            Vec::new()
        },
    }
}

/// Whether the interval of N holds. Without a filter, the note's interval is meant, from which rounding is taken away.
fn covers(said: &Said, poles: u32, quantum: f64) -> bool {
    let Some(found) = said
        .coefficient("N")
        .filter(|found| found.state == State::Measured)
    else {
        return false;
    };
    let [_, lower, upper] = match poles {
        0 => rounding::without(found, quantum, RATE_HZ),
        _ => [found.value, found.lower, found.upper],
    };
    (lower..=upper).contains(&WHITE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_behind_a_filter_is_named_white_noise() {
        let tally = study(2.5, 2, 0, 8);
        let judged = tally.records - tally.refused;
        assert!(judged > 2, "{tally:?}");
        assert_eq!(tally.wrong, 0, "{tally:?}");
        assert!(tally.behind + 1 >= judged, "{tally:?}");
        assert!(tally.covered + 1 >= judged, "{tally:?}");
    }
}
