//! Whether a device is right about a record, of more records than all doors can be asked about.

use super::{
    device,
    simulated::{EVENTS, Event, NOISES, Rows, record},
};
use rand::{RngExt as _, SeedableRng as _};
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;
use std::{collections::BTreeMap, ops::Range};

/// What a device says of records: how often each thing, of each event.
#[derive(Debug)]
pub(crate) struct Truth {
    said: BTreeMap<String, BTreeMap<String, usize>>,
}

impl Truth {
    /// Judges so many records of each event and of each noise at rest by the whole library.
    pub(crate) fn of(each: usize, seed: u64, samples: Range<usize>) -> Self {
        Self::by(each, seed, samples, |rows| device::without_gate(rows).0)
    }

    /// The same by screens.
    pub(crate) fn by_screens(each: usize, seed: u64, samples: Range<usize>) -> Self {
        let judge = |rows: &Rows| device::by_screens(rows).to_owned();
        Self::by(each, seed, samples, judge)
    }

    fn by(
        each: usize,
        seed: u64,
        samples: Range<usize>,
        judge: impl Fn(&Rows) -> String + Sync,
    ) -> Self {
        let round = |number: usize| {
            let sound = NOISES.map(|noise| (noise, Event::Nothing));
            let disturbed = EVENTS.iter().enumerate().map(move |(place, &event)| {
                // Pulses hide what is done to single samples.
                (NOISES[(place + number) % (NOISES.len() - 1)], event)
            });
            sound.into_iter().chain(disturbed)
        };
        let all: Vec<_> = (0..each).flat_map(round).collect();
        let judged = all.into_par_iter().enumerate();
        let judged = judged.map(|(number, (noise, event))| {
            let seed = (seed << 32) + number as u64;
            let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
            let samples = random.random_range(samples.clone());
            let rows = record(noise, event, samples, &mut random);
            let said = judge(&rows);
            if event == Event::Nothing && said != "-" {
                println!("{noise:?}, {samples} samples, at rest: {said}");
            }
            (format!("{event:?}"), said)
        });
        let judged: Vec<(String, String)> = judged.collect();
        let mut said = BTreeMap::<String, BTreeMap<String, usize>>::new();
        for (event, verdict) in judged {
            *said.entry(event).or_default().entry(verdict).or_default() += 1;
        }
        Self { said }
    }

    /// Asserts that screens are right about what they promise to see.
    pub(crate) fn assert_screened(&self) {
        println!("{self:#?}");
        for (event, said) in &self.said {
            let (all, passed) = counts(said);
            let (right, least) = match event.as_str() {
                // Tails of five degrees of freedom may hold a sample that is a spike by any rule.
                "Nothing" => (passed, 97),
                "Vehicle" => (all - passed, 85),
                "Swing" | "HandHeld" | "Knock" | "Stuck" | "Polled(2.0)" => (all - passed, 95),
                _ => continue,
            };
            assert!(right * 100 >= least * all, "{event}: {self:#?}");
        }
    }

    /// Asserts that the device is right as often as it has to be.
    pub(crate) fn assert(&self) {
        println!("{self:#?}");
        for (event, said) in &self.said {
            let (all, passed) = counts(said);
            let (right, least) = match event.as_str() {
                // As for screens.
                "Nothing" => (passed, 99),
                // Slight motion has the shape of noise behind a low pass.
                "Vehicle" => (all - passed, 85),
                // An offset may keep the counts of an axis from zero.
                "Unsigned" => (all - passed, 80),
                _ => (all - passed, 95),
            };
            assert!(right * 100 >= least * all, "{event}: {self:#?}");
        }
    }
}

/// All records, and those of them that passed.
fn counts(said: &BTreeMap<String, usize>) -> (usize, usize) {
    let passed = said.get("-").copied().unwrap_or_default();
    (said.values().sum(), passed)
}
