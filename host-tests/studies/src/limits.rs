//! Studies what is called adequate, which limits pass, and which promised lengths come true, where slow noise lies beside the
//! five terms.

use super::{
    OCTAVES, RATE_HZ, curve,
    measured::{Measured, Sums},
    quantum,
    said::Said,
    slow::{ideal_size, lorentzian},
};
use allanite::{
    Coefficient, Curve, Model, Scale,
    diagnosis::Verdict,
    fit::{self, Options, State},
    ieee_952::{self, Checked, Limits},
};
use allanite_host::simulate::{Coefficients, Hidden, Preset, Random, Simulator};
use rand::{RngExt, SeedableRng, seq::IndexedRandom};
use rayon::prelude::*;

/// The ideal gains that are drawn: by how much `−2 ln L` of the whole periodogram is expected to fall with the noise.
pub const GAINS: [f64; 2] = [40.0, 130.0];

/// The numbers of samples of a record.
const LENGTHS: [usize; 3] = [1 << 15, 1 << 17, 1 << 18];

/// The shortest correlation time in s, and the longest one as a share of the record.
const SHORTEST_S: f64 = 0.1;
const LONGEST: f64 = 0.02;

/// What lies beside the five terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Gauss–Markov noise.
    GaussMarkov,
    /// Random telegraph noise.
    Telegraph,
    /// Gauss–Markov noise of two correlation times, three to ten times apart, of equal size.
    Two,
    /// A bias that follows a temperature behind a low pass. No thermometer is recorded, and it has no ideal gain.
    Temperature,
}

/// All kinds.
pub const KINDS: [Kind; 4] = [
    Kind::GaussMarkov,
    Kind::Telegraph,
    Kind::Two,
    Kind::Temperature,
];

/// The terms that are limited, by their places among the five, with their symbols.
pub const LIMITED: [(usize, &str); 3] = [(1, "N"), (2, "B"), (3, "K")];

/// The records of a kind.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// All records.
    pub records: usize,
    /// Those whose five terms are called adequate by the diagnosis, and by the small fit of a device.
    pub adequate: [usize; 2],
    /// Those that pass a limit of each term of [`LIMITED`], by the diagnosis, and by the small fit.
    pub passed: [[usize; LIMITED.len()]; 2],
}

/// Judges records of a kind by limits that are `factor` times the truth.
pub fn study(kind: Kind, factor: f64, seed: u64, records: u64) -> Tally {
    let judged: Vec<Tally> = (seed..seed.saturating_add(records))
        .into_par_iter()
        .filter_map(|seed| one(kind, factor, seed))
        .collect();
    let mut tally = Tally::default();
    for one in judged {
        tally.records += one.records;
        for (door, adequate) in one.adequate.into_iter().enumerate() {
            tally.adequate[door] += adequate;
            for (place, passed) in one.passed[door].into_iter().enumerate() {
                tally.passed[door][place] += passed;
            }
        }
    }
    tally
}

fn one(kind: Kind, factor: f64, seed: u64) -> Option<Tally> {
    let mut random = Random::seed_from_u64(seed ^ 0x006c_696d);
    let preset = *[Preset::Mems, Preset::Fog, Preset::Tactical].choose(&mut random)?;
    let base = preset.coefficients();
    let samples = *LENGTHS.choose(&mut random)?;
    let measured = record(kind, base, samples, &mut random, seed)?;
    let said = Said::of(&measured);
    let fitted = ieee_952::fit(&measured.curve).ok();
    let truths = [
        base.angle_random_walk,
        base.bias_instability,
        base.rate_random_walk,
    ];
    let passes = |place: usize| {
        let (term, symbol) = LIMITED[place];
        let most = factor * truths[place];
        let of_diagnosis = !said.is_unexplained()
            && said
                .coefficient(symbol)
                .is_some_and(|found| found.upper <= most);
        let mut limits = Limits {
            most: [f64::INFINITY; 5],
        };
        limits.most[term] = most;
        let of_fit = fitted.as_ref().map(|fit| limits.check(fit));
        [of_diagnosis, of_fit == Some(Checked::Pass)].map(usize::from)
    };
    let passes: [[usize; 2]; LIMITED.len()] = std::array::from_fn(passes);
    let is_adequate = fitted.and_then(|fit| fit.is_adequate()) == Some(true);
    Some(Tally {
        records: 1,
        adequate: [said.verdict == Some(Verdict::Adequate), is_adequate].map(usize::from),
        passed: [0, 1].map(|door| passes.map(|passes| passes[door])),
    })
}

/// A record with noise of a random correlation time and gain. `None` if the five terms imitate it at any size.
fn record(
    kind: Kind,
    base: Coefficients,
    samples: usize,
    random: &mut Random,
    seed: u64,
) -> Option<Measured> {
    let mut uniform = |low: f64, high: f64| low * (high / low).powf(random.random::<f64>());
    let duration_s = samples as f64 / RATE_HZ;
    let time_s = uniform(SHORTEST_S, LONGEST * duration_s);
    let gain = uniform(GAINS[0], GAINS[1]);
    let slower_s = time_s * uniform(3.0, 10.0);
    if kind == Kind::Temperature {
        let slope = uniform(0.3, 30.0) * base.bias_instability;
        let swing_s = duration_s * uniform(0.02, 2.0);
        return Some(with_temperature(
            base,
            samples,
            seed,
            [slope, swing_s, time_s],
        ));
    }
    let one = lorentzian(time_s);
    let other = lorentzian(slower_s);
    let is_two = kind == Kind::Two;
    let density = |x: f64| one(x) + if is_two { other(x) } else { 0.0 };
    let rms = ideal_size(base, samples, &density, gain)?;
    let name = match kind {
        Kind::Telegraph => "random_telegraph",
        _ => "gauss_markov",
    };
    let mut hidden = vec![Hidden::new(name, [time_s], rms)?];
    if is_two {
        hidden.push(Hidden::new(name, [slower_s], rms)?);
    }
    let mut simulator = Simulator::with_hidden(base, &hidden, RATE_HZ, seed);
    Some(Measured::of(&mut simulator, base, samples))
}

/// A gyro whose bias follows a swinging temperature with a lag.
fn with_temperature(
    base: Coefficients,
    samples: usize,
    seed: u64,
    [slope, swing_s, lag_s]: [f64; 3],
) -> Measured {
    let quantum = quantum(base, RATE_HZ);
    let mut sums = Sums::new();
    let pole = (-1.0 / (RATE_HZ * lag_s)).exp();
    let mut followed = 0.0;
    let rates = Simulator::new(base, RATE_HZ, seed)
        .take(samples)
        .enumerate();
    let counts: Vec<i32> = rates
        .map(|(n, rate)| {
            let seconds = n as f64 / RATE_HZ;
            let swing = (std::f64::consts::TAU * seconds / swing_s).sin();
            followed = pole * followed + (1.0 - pole) * swing;
            // The conversion saturates.
            ((rate + slope * followed) / quantum).round() as i32
        })
        .collect();
    sums.push_slice(&counts);
    sums.measured(Scale::new(quantum, RATE_HZ).expect("positive"))
}

/// The promises for a term: how many records say what a longer one would show, and in how many it comes true.
#[derive(Clone, Copy, Debug, Default)]
pub struct Promises {
    /// The records that say so.
    pub made: usize,
    /// Those of which a record of the promised length, of a gyro with as much of the term as the promise says, measures it.
    pub kept: usize,
}

/// The number of samples of the records that promise, and of the longest record that is simulated.
const PROMISING: usize = 1 << 13;
const LONGEST_PROMISED: f64 = (1_u64 << 24) as f64;

/// Follows up what `records` records of a gyro with N, and in the mean as much B as shows in a longer record, promise of the term
/// at this place of the model, which the gyro may lack.
pub fn promises(door: Door, place: usize, seed: u64, records: u64) -> Promises {
    let kept: Vec<bool> = (seed..)
        .take(usize::try_from(4 * records).unwrap_or(usize::MAX))
        .collect::<Vec<u64>>()
        .into_par_iter()
        .filter_map(|seed| promise(door, place, seed))
        .collect();
    let of = usize::try_from(records)
        .unwrap_or(usize::MAX)
        .min(kept.len());
    Promises {
        made: of,
        kept: kept.iter().take(of).filter(|kept| **kept).count(),
    }
}

/// Whether what a record promises comes true. `None` if it promises nothing, or a longer record than is simulated.
fn promise(door: Door, place: usize, seed: u64) -> Option<bool> {
    let mut random = Random::seed_from_u64(seed ^ 0x7072_6f6d);
    let white = 0.005;
    let base = Coefficients {
        angle_random_walk: white,
        // Flicker noise crosses white noise at τ = N²/(0.664² B²), here between a hundredth and ten times the record.
        bias_instability: white
            / (0.664 * (PROMISING as f64 / RATE_HZ * 0.01 * 1000_f64.powf(random.random())).sqrt()),
        ..Coefficients::default()
    };
    let (found, after_s) = door.promise(&curve(base, PROMISING, seed), place)?;
    let samples = after_s * RATE_HZ;
    if samples > LONGEST_PROMISED {
        return None;
    }
    let mut later = base;
    match place {
        2 => later.bias_instability = found.upper,
        _ => later.rate_random_walk = found.upper,
    }
    let longer = curve(later, samples.ceil() as usize, seed ^ 0x006c_6f6e_6765_7200);
    Some(door.fitted(&longer, place)?.state == State::Measured)
}

/// Which fit promises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Door {
    /// The general one.
    Fit,
    /// The small one of a device.
    FiveTerms,
}

impl Door {
    fn fitted(self, curve: &Curve<OCTAVES>, place: usize) -> Option<Coefficient> {
        match self {
            Self::Fit => {
                let fit = fit::fit(curve, &Model::ieee_952(), Options::default()).ok()?;
                fit.coefficients.get(place).copied()
            }
            Self::FiveTerms => ieee_952::fit(curve).ok()?.coefficients.get(place).copied(),
        }
    }

    /// A coefficient that is not observable, and the length in s of the record that would show its upper end.
    fn promise(self, curve: &Curve<OCTAVES>, place: usize) -> Option<(Coefficient, f64)> {
        let found = self.fitted(curve, place)?;
        let State::NotObservable { after_s } = found.state else {
            return None;
        };
        let after_s = match self {
            Self::Fit => after_s,
            Self::FiveTerms => ieee_952::fit(curve).ok()?.measured_after_s(curve, place),
        };
        Some((found, after_s?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_of_a_large_gain_is_not_adequate_and_passes_no_limit() {
        let tally = study(Kind::GaussMarkov, 0.9, 500, 6);
        assert!(tally.records >= 4, "{tally:?}");
        assert_eq!(tally.adequate[0], 0, "{tally:?}");
        assert_eq!(tally.passed, [[0; 3]; 2], "{tally:?}");
    }

    #[test]
    fn what_a_record_promises_of_a_large_walk_is_kept() {
        let promises = promises(Door::Fit, 2, 0, 6);
        assert!(promises.made > 0, "{promises:?}");
        assert!(promises.kept <= promises.made, "{promises:?}");
    }
}
