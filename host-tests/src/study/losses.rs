//! Studies what lost samples cost: records of which single samples are lost, beside the same records without losses.

use super::{OCTAVES, quantum, theory::squares};
use crate::simulate::{Preset, Random, Simulator};
use allanite::{
    Accumulator, Curve, Model, Scale,
    fit::{Fit, Options, State, fit},
};
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// The shares of samples that are lost, and the samples of each gap.
pub const LOSSES: [(f64, u64); 5] = [(0.001, 1), (0.01, 1), (0.05, 1), (0.01, 3), (0.02, 20)];

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

/// What many records show.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The records in which both fits succeeded.
    pub records: usize,
    /// Those whose curve with losses has fewer octaves.
    pub fewer_octaves: usize,
    /// The share of p-values below 5 %, without losses and with them.
    pub low_p: [f64; 2],
    /// The coefficients, in the order of the model.
    pub accuracies: [Accuracy; 5],
}

/// Fits records of a preset with and without losses.
pub fn study(preset: Preset, samples: usize, losses: (f64, u64), records: u64) -> Outcome {
    let fits: Vec<_> = (0..records)
        .into_par_iter()
        .filter_map(|seed| both(preset, samples, losses, seed))
        .collect();
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
    Outcome {
        records: fits.len(),
        fewer_octaves: fits.iter().filter(|(_, fewer)| *fewer).count(),
        low_p: share(&|fit| fit.p_value < 0.05),
        accuracies,
    }
}

/// The fits of a record without losses and with them, and whether these have taken an octave away.
fn both(
    preset: Preset,
    samples: usize,
    (share, gap): (f64, u64),
    seed: u64,
) -> Option<([Fit; 2], bool)> {
    const RATE_HZ: f64 = super::RATE_HZ;
    let coefficients = preset.coefficients();
    let quantum = quantum(coefficients, RATE_HZ);
    let mut random = Random::seed_from_u64(seed ^ 0x10_55);
    let [mut whole, mut lossy] = [(); 2].map(|()| Accumulator::<OCTAVES>::new());
    let starts = share / gap as f64;
    let mut lost = 0;
    for rate in Simulator::new(coefficients, RATE_HZ, seed).take(samples) {
        let count = (rate / quantum).round() as i32;
        whole.push(count);
        if lost == 0 && random.random_bool(starts) {
            lost = gap;
            lossy.lost(gap);
        }
        match lost {
            0 => lossy.push(count),
            _ => lost -= 1,
        }
    }
    let scale = Scale::new(quantum, RATE_HZ).ok()?;
    let curves: [Curve<OCTAVES>; 2] = [whole.curve(scale), lossy.curve(scale)];
    let fewer = curves[1].points().len() < curves[0].points().len();
    let fit = |curve| fit(curve, &Model::ieee_952(), Options::default()).ok();
    Some(([fit(&curves[0])?, fit(&curves[1])?], fewer))
}
