//! Studies white noise behind filters as sensors and drivers have them, which run at a multiple of the rate of the log: what is
//! said of them, and what becomes of N.

use super::{RATE_HZ, measured::Sums, quantum, said::Said};
use allanite::{Scale, effect::CATALOGUE};
use allanite_host::{
    freeform,
    simulate::{Chain, Preset, Random, Simulator},
};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// A kind of chains.
#[derive(Clone, Copy)]
pub struct Kind {
    /// What the noise goes through.
    pub name: &'static str,
    /// The stages, with `CUTOFF` for a frequency that is drawn.
    chain: &'static str,
    /// The frequencies between which it is drawn, as shares of the rate.
    cutoffs: [f64; 2],
}

const fn kind(name: &'static str, chain: &'static str, cutoffs: [f64; 2]) -> Kind {
    Kind {
        name,
        chain,
        cutoffs,
    }
}

/// The corner of one pole.
const ONE: [f64; 2] = [0.03, 0.2];
/// The corners of steeper filters.
const STEEP: [f64; 2] = [0.05, 0.4];

/// All kinds. After the first five, they are in the order in which sensors and drivers have them.
pub const KINDS: [Kind; 20] = [
    kind(
        "one pole at the rate",
        "butterworth:poles=1,cutoff_hz=CUTOFF",
        ONE,
    ),
    kind(
        "one pole at 8 times the rate, every 8th",
        "butterworth:poles=1,cutoff_hz=CUTOFF | every:samples=8",
        ONE,
    ),
    kind(
        "one pole at twice the rate, every 2nd",
        "butterworth:poles=1,cutoff_hz=CUTOFF | every:samples=2",
        ONE,
    ),
    kind(
        "one pole at twice the rate, mean of 2",
        "butterworth:poles=1,cutoff_hz=CUTOFF | average:samples=2 | every:samples=2",
        ONE,
    ),
    kind(
        "one pole at 8 times the rate, mean of 8",
        "butterworth:poles=1,cutoff_hz=CUTOFF | average:samples=8 | every:samples=8",
        ONE,
    ),
    kind(
        "two poles at 8 times the rate, every 8th",
        "butterworth:poles=2,cutoff_hz=CUTOFF | every:samples=8",
        STEEP,
    ),
    kind(
        "two poles at 64 times the rate, every 64th",
        "butterworth:poles=2,cutoff_hz=CUTOFF | every:samples=64",
        STEEP,
    ),
    kind(
        "three poles at 4 times the rate, every 4th",
        "butterworth:poles=3,cutoff_hz=CUTOFF | every:samples=4",
        STEEP,
    ),
    kind(
        "four poles at twice the rate, every 2nd",
        "butterworth:poles=4,cutoff_hz=CUTOFF | every:samples=2",
        STEEP,
    ),
    kind(
        "CIC of 3 stages and half band",
        "cic:stages=3,factor=16 | fir:taps=31,cutoff_hz=50 | every:samples=2",
        STEEP,
    ),
    kind(
        "CIC of 4 stages to the rate",
        "cic:stages=4,factor=16",
        STEEP,
    ),
    kind(
        "FIR of 47 taps, every 4th",
        "fir:taps=47,cutoff_hz=CUTOFF | every:samples=4",
        STEEP,
    ),
    kind(
        "Bartlett window of 2 times 16, every 8th",
        "average:samples=16 | average:samples=16 | every:samples=8",
        STEEP,
    ),
    kind("mean of 4 samples at the rate", "average:samples=4", STEEP),
    kind(
        "PT2 at 8 times the rate, every 8th",
        "pt:stages=2,cutoff_hz=CUTOFF | every:samples=8",
        STEEP,
    ),
    kind(
        "PT3 and a notch at 4 times the rate",
        "pt:stages=3,cutoff_hz=CUTOFF | notch:frequency_hz=30,quality=2 | every:samples=4",
        STEEP,
    ),
    kind(
        "two poles and a driver's EMA",
        "butterworth:poles=2,cutoff_hz=CUTOFF | every:samples=8 | ema:share=0.4",
        STEEP,
    ),
    kind(
        "two poles, one pole and a mean of 2",
        "butterworth:poles=2,cutoff_hz=CUTOFF | every:samples=4 | butterworth:poles=1,cutoff_hz=20 | average:samples=2",
        STEEP,
    ),
    kind("a driver's EMA", "ema:share=0.3", STEEP),
    kind("no filter, every 8th", "every:samples=8", STEEP),
];

/// The counts of records of a kind.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// All records.
    pub records: usize,
    /// One filter is named and nothing else, or nothing where there is no filter.
    pub alone: usize,
    /// Something beside filters is named.
    pub beside: usize,
    /// It is said that something is left.
    pub unexplained: usize,
    /// The interval of N contains what the chain leaves of it at zero frequency.
    pub covered: usize,
    /// N is more than 10 % off.
    pub off: usize,
    /// The filter is none of the catalogue.
    pub freeform: usize,
    /// What was said where it is more than one filter, or something else.
    pub words: Vec<String>,
}

/// The chain and its true N, relative to that before it.
fn drawn(kind: Kind, seed: u64) -> (Chain, f64) {
    let mut random = Random::seed_from_u64(seed ^ 0x6368_6169);
    let [low, high] = kind.cutoffs;
    let cutoff = RATE_HZ * low * (high / low).powf(random.random::<f64>());
    let chain = Chain::parse(&kind.chain.replace("CUTOFF", &cutoff.to_string()));
    let chain = chain.expect("a chain that is written here");
    let density = chain.density(0.0, RATE_HZ).expect("linear stages");
    (chain, density.sqrt())
}

/// Diagnoses records of a kind with so many samples, of mems and fog in turn: as the command line does, or with the catalogue alone,
/// as a device.
pub fn study(kind: Kind, records: u64, samples: usize, as_device: bool) -> Tally {
    let each = |seed: u64| {
        let preset = [Preset::Mems, Preset::Fog][usize::from(seed % 2 == 1)];
        let base = preset.coefficients();
        let (chain, passed) = drawn(kind, seed);
        let once = (RATE_HZ, samples as f64 / RATE_HZ);
        let rates = Simulator::behind(base, &chain, &[], once, seed);
        let quantum = quantum(base, RATE_HZ);
        let counts: Vec<i32> = rates
            .take(samples)
            .map(|rate| (rate / quantum).round() as i32)
            .collect();
        let mut sums = Sums::new();
        sums.push_slice(&counts);
        let measured = sums.measured(Scale::new(quantum, RATE_HZ).expect("positive"));
        let said = match as_device {
            true => Said::of(&measured),
            false => Said::freely(&measured),
        };
        (passed * base.angle_random_walk, said)
    };
    let said: Vec<(f64, Said)> = (0..records).into_par_iter().map(each).collect();
    let is_filter = |name: &str| {
        let mut catalogue = CATALOGUE.iter().filter(|effect| effect.name() == name);
        name == freeform::NAME
            || catalogue.any(|effect| {
                let replaced = effect.replaces().map(|replaced| replaced.name());
                replaced == Some("angle_random_walk") || effect.passes_all()
            })
    };
    let is_none = kind.chain.starts_with("every");
    let mut tally = Tally::default();
    for (truth, said) in said {
        tally.records += 1;
        let filters = said
            .named
            .iter()
            .filter(|(name, _)| is_filter(name))
            .count();
        let alone = said.named.len() == filters && filters == usize::from(!is_none);
        tally.alone += usize::from(alone);
        let is_freeform = |(name, _): &(&str, Vec<&str>)| *name == freeform::NAME;
        tally.freeform += usize::from(said.named.iter().any(is_freeform));
        tally.beside += usize::from(said.named.len() > filters);
        tally.unexplained += usize::from(said.is_unexplained());
        tally.covered += usize::from(said.covers("N", truth));
        let value = said.coefficient("N").map_or(f64::NAN, |found| found.value);
        let is_near = (value / truth - 1.0).abs() < 0.1;
        tally.off += usize::from(!is_near);
        if !alone {
            tally.words.push(said.words());
        }
    }
    tally
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_chain_is_understood_and_leaves_nearly_all_of_n() {
        for kind in KINDS {
            for seed in 0..20 {
                let (_, passed) = drawn(kind, seed);
                assert!((0.9..3.0).contains(&passed), "{}: {passed}", kind.name);
            }
        }
    }
}
