//! Studies what lost samples cost: records of which single samples are lost, beside the same records without losses.

use super::{
    RATE_HZ,
    measured::{Measured, Sums},
    quantum,
    said::Said,
    theory::squares,
};
use allanite::{
    Model, Scale,
    fit::{Fit, Options, State, fit},
};
use allanite_host::simulate::{Hidden, Preset, Random, Simulator};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// The shares of samples that are lost, and the samples of each gap.
pub const LOSSES: [(f64, u64); 5] = [(0.001, 1), (0.01, 1), (0.05, 1), (0.01, 3), (0.02, 20)];

/// The frequency of the line, in Hz.
pub const LINE_HZ: f64 = 17.3;

/// What a coefficient of many records shows.
#[derive(Clone, Copy, Debug, Default)]
pub struct Accuracy {
    /// The root-mean-square error of its square with losses, relative to that without.
    pub error_ratio: f64,
    /// The mean change of its square by the losses, in standard errors of the square.
    pub shift: f64,
    /// The share of records whose 95 % interval contains the true value, without losses and with them.
    pub coverage: [f64; 2],
    /// The share of records in which it was measured, without losses and with them.
    pub measured: [f64; 2],
}

/// What the fits of many records show.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The records in which both fits succeeded.
    pub records: usize,
    /// Those whose curve with losses has fewer octaves.
    pub fewer_octaves: usize,
    /// Those whose spectrum with losses has fewer bins.
    pub fewer_bins: usize,
    /// The share of p-values below 5 %, without losses and with them.
    pub low_p: [f64; 2],
    /// The coefficients, in the order of the model.
    pub accuracies: [Accuracy; 5],
}

/// What diagnoses of many records say, without losses and with them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Words {
    /// The records.
    pub records: usize,
    /// Those in which all that is hidden was named, and nothing else.
    pub exact: [usize; 2],
    /// Those in which something was named that is not hidden.
    pub wrong: [usize; 2],
}

/// A record without losses and with them.
struct Pair {
    whole: Measured,
    lossy: Measured,
}

impl Pair {
    fn each(&self) -> [&Measured; 2] {
        [&self.whole, &self.lossy]
    }
}

/// Fits records of a preset with and without losses: their curves alone, and beside their spectra.
pub fn study(preset: Preset, samples: usize, losses: (f64, u64), records: u64) -> [Outcome; 2] {
    let pairs = (0..records).into_par_iter();
    let fits = pairs.map(|seed| {
        let pair = pair(preset, &[], samples, losses, seed);
        let [whole, lossy] = pair.each();
        let fewer = [
            lossy.curve.points().len() < whole.curve.points().len(),
            lossy.spectrum.bins().len() < whole.spectrum.bins().len(),
        ];
        let model = Model::ieee_952();
        let options = Options::default();
        let curves = pair.each().map(|one| fit(&one.curve, &model, options).ok());
        let records = pair
            .each()
            .map(|one| fit(one.record(), &model, options).ok());
        [curves, records].map(|fits| {
            let [Some(whole), Some(lossy)] = fits else {
                return None;
            };
            Some(([whole, lossy], fewer))
        })
    });
    let fits: Vec<_> = fits.collect();
    [0, 1].map(|which| {
        outcome(
            preset,
            fits.iter().filter_map(|both| both[which].clone()).collect(),
        )
    })
}

/// Diagnoses records of a preset with and without losses, with a line or without.
pub fn words(
    preset: Preset,
    line: bool,
    samples: usize,
    losses: (f64, u64),
    records: u64,
) -> Words {
    // 0.15 standard deviations of white noise, which a spectrum of 2^17 samples shows.
    let amplitude = 0.15 * preset.coefficients().angle_random_walk * RATE_HZ.sqrt();
    let hidden: Vec<_> = line
        .then(|| Hidden::new("sinusoid", [LINE_HZ], amplitude).expect("an effect"))
        .into_iter()
        .collect();
    let names: &[&str] = if line { &["sinusoid"] } else { &[] };
    let said = (0..records).into_par_iter().map(|seed| {
        let pair = pair(preset, &hidden, samples, losses, seed ^ 0x5A1D);
        pair.each().map(|one| Said::of(one).compared(names))
    });
    let said: Vec<_> = said.collect();
    let mut words = Words {
        records: said.len(),
        ..Words::default()
    };
    for both in &said {
        for (which, one) in both.iter().enumerate() {
            words.exact[which] += usize::from(one.exact);
            words.wrong[which] += usize::from(one.wrong);
        }
    }
    words
}

fn outcome(preset: Preset, fits: Vec<([Fit; 2], [bool; 2])>) -> Outcome {
    let truth = squares(preset.coefficients());
    let all = fits.len() as f64;
    let share = |of: &dyn Fn(&Fit) -> bool| {
        let count = |which: usize| fits.iter().filter(|(fits, _)| of(&fits[which])).count();
        [0, 1].map(|which| count(which) as f64 / all)
    };
    let accuracies = std::array::from_fn(|i| {
        let mean_square = |which: usize| {
            let error = |(fits, _): &([Fit; 2], _)| fits[which].coefficients[i].square - truth[i];
            fits.iter().map(|one| error(one).powi(2)).sum::<f64>()
        };
        let shift = |(fits, _): &([Fit; 2], _)| {
            let [whole, lossy] = fits.each_ref().map(|fit| fit.coefficients[i]);
            (lossy.square - whole.square) / whole.square_error
        };
        let shifts = fits.iter().map(shift).filter(|shift| shift.is_finite());
        Accuracy {
            error_ratio: (mean_square(1) / mean_square(0)).sqrt(),
            shift: shifts.sum::<f64>() / all,
            coverage: share(&|fit| {
                let (coefficient, truth) = (&fit.coefficients[i], truth[i].sqrt());
                coefficient.lower <= truth && truth <= coefficient.upper
            }),
            measured: share(&|fit| fit.coefficients[i].state == State::Measured),
        }
    });
    let fewer = |what: usize| fits.iter().filter(|(_, fewer)| fewer[what]).count();
    Outcome {
        records: fits.len(),
        fewer_octaves: fewer(0),
        fewer_bins: fewer(1),
        low_p: share(&|fit| fit.p_value < 0.05),
        accuracies,
    }
}

/// A record without losses and with them.
fn pair(
    preset: Preset,
    hidden: &[Hidden],
    samples: usize,
    (share, gap): (f64, u64),
    seed: u64,
) -> Pair {
    let coefficients = preset.coefficients();
    let quantum = quantum(coefficients, RATE_HZ);
    let mut random = Random::seed_from_u64(seed ^ 0x10_55);
    let [mut whole, mut lossy] = [(); 2].map(|()| Sums::new());
    let starts = share / gap as f64;
    let mut lost = 0;
    let simulator = Simulator::with_hidden(coefficients, hidden, RATE_HZ, seed);
    for rate in simulator.take(samples) {
        let count = (rate / quantum).round() as i32;
        whole.push_slice(&[count]);
        if lost == 0 && random.random_bool(starts) {
            lost = gap;
            lossy.lost(gap);
        }
        match lost {
            0 => lossy.push_slice(&[count]),
            _ => lost -= 1,
        }
    }
    let scale = Scale::new(quantum, RATE_HZ).expect("positive");
    let [whole, lossy] = [whole, lossy].map(|sums| sums.measured(scale));
    Pair { whole, lossy }
}
