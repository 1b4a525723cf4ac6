//! A rate that follows a temperature with a lag: a bank of lags beside the gyro finds the slope and the lag.

use allanite::{
    Axes, Axis, Model, Record, Scale,
    covariate::Lags,
    diagnosis::{Addition, Dependence, FollowedCovariate, Options, Verdict},
    effect::CATALOGUE,
};
use allanite_host::{
    diagnosis::diagnose,
    simulate::{Coefficients, Simulator},
};
use rand::{RngExt as _, SeedableRng as _};
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;
use std::f64::consts::TAU;

const RATE_HZ: f64 = 20.0;
const COUNT: f64 = 1e-4;
/// The size of a count of the thermometer, in kelvin.
const KELVIN: f64 = 1.0 / 16.0;
/// 55 minutes.
const SAMPLES: usize = 1 << 16;
/// The temperature, and behind lags of 13, 51 and 205 s.
const BANK: [u32; 4] = [0, 8, 10, 12];

/// Courses of a temperature over 55 minutes, in kelvin after a time in seconds.
#[derive(Clone, Copy, Debug)]
enum Course {
    WarmUp,
    Swing,
    Steps,
}

impl Course {
    fn celsius(self, time_s: f64, phase: f64) -> f64 {
        25.0 + match self {
            Self::WarmUp => 8.0 * (1.0 - (-time_s / 700.0).exp()),
            Self::Swing => 2.0 * (TAU * (time_s / 1500.0 + phase)).sin(),
            Self::Steps => f64::from((time_s / 600.0 + phase) as u32 % 2) * 3.0,
        }
    }
}

/// A gyro whose rate follows a temperature behind a lag.
struct Gyro {
    course: Course,
    /// In deg/s per kelvin.
    slope: f64,
    lag_s: f64,
}

/// What the diagnosis of a record says.
struct Said {
    followed: Option<FollowedCovariate>,
    dependence: Option<Dependence>,
    /// The rate random walk of the final model, in deg/s/√s, if it is measured.
    walk: Option<f64>,
    /// The effects that were added to the model.
    added: usize,
    is_explained: bool,
}

/// Diagnoses a record, with so many covariates of the bank.
fn diagnosed(gyro: &Gyro, covariates: usize, seed: u64) -> Said {
    let coefficients = Coefficients {
        quantization: 0.0,
        angle_random_walk: 5e-3,
        bias_instability: 0.0,
        rate_random_walk: 0.0,
        rate_ramp: 0.0,
    };
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let phase = random.random_range(0.0..1.0);
    let mut noise = Simulator::new(coefficients, RATE_HZ, seed);
    let mut axis = Axis::<16, 4, (), ()>::new();
    let mut lags = Lags::new(BANK);
    let mut behind = gyro.course.celsius(0.0, phase);
    for n in 0..SAMPLES {
        let celsius = gyro.course.celsius(n as f64 / RATE_HZ, phase);
        behind += (celsius - behind) * (1.0 - (-1.0 / (RATE_HZ * gyro.lag_s)).exp());
        let rate = noise.next().unwrap() + gyro.slope * behind;
        let count = (rate / COUNT).round() as i32;
        axis.push((count, lags.push((celsius / KELVIN).round() as i32)));
    }
    let scale = Scale::new(COUNT, RATE_HZ).unwrap();
    let unit = KELVIN / f64::from(Lags::<4>::PER_COUNT);
    let record = axis.record(0, (scale, [unit; 4])).unwrap();
    let record = Record {
        covariates: &record.covariates[..covariates],
        pairs: &record.pairs[..covariates - 1],
        ..(&record.curve).into()
    };
    let (model, options) = (Model::ieee_952(), Options::default());
    let mut said = Said {
        followed: None,
        dependence: None,
        walk: None,
        added: 0,
        is_explained: false,
    };
    let verdict = diagnose(record, &model, &CATALOGUE, options, |step| {
        match step.added {
            Some(Addition::Covariate(followed)) => said.followed = Some(followed),
            Some(Addition::Effect(_)) => said.added += 1,
            None => {}
        }
        let mut walks = step.fit.coefficients.iter();
        let walk = walks.find(|one| one.name == "rate_random_walk" && one.lower > 0.0);
        said.walk = walk.map(|walk| walk.value);
    });
    said.is_explained = matches!(verdict.unwrap(), Verdict::Adequate | Verdict::Improved);
    said.dependence = said
        .followed
        .and_then(|followed| followed.dependence(&lags, RATE_HZ));
    said
}

/// What was counted of records whose rate follows a temperature.
#[derive(Debug, Default)]
struct Count {
    records: usize,
    followed: usize,
    slopes_inside: usize,
    /// Records in which a pair of lags acts, and those of them whose lag is inside its interval.
    pairs: usize,
    lags_inside: usize,
    walks: usize,
    effects: usize,
    unexplained: usize,
    /// Records that are unexplained, or have a random walk, where the temperature is tried as it is.
    wrong_without_lags: usize,
}

fn count(lags_s: &[f64], records: u64) -> Count {
    let courses = [Course::WarmUp, Course::Swing, Course::Steps];
    let gyros = courses.iter().flat_map(|&course| {
        lags_s.iter().map(move |&lag_s| Gyro {
            course,
            slope: 0.02,
            lag_s,
        })
    });
    let mut count = Count::default();
    for gyro in gyros {
        let both = |seed| [BANK.len(), 1].map(|tried| diagnosed(&gyro, tried, seed));
        let all: Vec<[Said; 2]> = (0..records).into_par_iter().map(both).collect();
        for [bank, own] in all {
            count.records += 1;
            let is_wrong = own.walk.is_some() || !own.is_explained;
            count.wrong_without_lags += usize::from(is_wrong);
            count.walks += usize::from(bank.walk.is_some());
            count.effects += bank.added;
            count.unexplained += usize::from(!bank.is_explained);
            let Some(dependence) = bank.dependence else {
                continue;
            };
            count.followed += 1;
            let (lower, upper) = dependence.slope.interval();
            count.slopes_inside += usize::from((lower..upper).contains(&gyro.slope));
            if let Some(error_s) = dependence.lag_error_s {
                count.pairs += 1;
                let distance_s = (dependence.lag_s - gyro.lag_s).abs();
                count.lags_inside += usize::from(distance_s < 1.96 * error_s);
            }
        }
    }
    count
}

#[test]
fn a_bank_of_lags_finds_slope_and_lag_and_no_random_walk() {
    let count = count(&[5.0, 12.0, 25.0, 60.0], 20);
    println!("{count:?}");
    assert_eq!((count.records, count.followed), (240, 240), "{count:?}");
    assert!(count.slopes_inside >= 228, "{count:?}");
    assert!(count.lags_inside * 100 >= 95 * count.pairs, "{count:?}");
    assert!(count.walks + count.effects <= 2, "{count:?}");
    assert!(count.unexplained <= 2, "{count:?}");
    // The same temperature without the bank.
    assert!(count.wrong_without_lags >= 100, "{count:?}");
}

#[test]
fn a_bank_of_lags_is_not_claimed_where_the_rate_follows_nothing() {
    let claimed = [Course::WarmUp, Course::Swing, Course::Steps].map(|course| {
        let gyro = Gyro {
            course,
            slope: 0.0,
            lag_s: 30.0,
        };
        let all = (0..100_u64).into_par_iter();
        let claimed = all.filter(|&seed| diagnosed(&gyro, BANK.len(), seed).followed.is_some());
        claimed.count()
    });
    println!("claimed in {claimed:?} of 100");
    assert!(claimed.iter().sum::<usize>() <= 2, "{claimed:?}");
}

/// A record of three covariates, with a loss that is filled, a gap and a merge.
fn with_losses(first: i32) -> Axes<10, 3, (), ()> {
    let mut axes = Axes::<10, 3, (), ()>::new();
    for n in first..first + 3000_i32 {
        match n - first {
            900 => axes.lost(2),
            2000 => axes.gap(),
            _ => {}
        }
        let value = |factor: i32| n.wrapping_mul(n).wrapping_mul(factor).wrapping_shr(5) % 97;
        axes.push((
            [value(1), value(3), value(5)],
            [value(7), value(7) + n, value(11)],
        ));
    }
    axes
}

#[test]
fn neighbours_have_the_products_of_an_axis_with_a_covariate() {
    let mut axes = with_losses(0);
    axes.merge(&with_losses(5000));
    // The first covariate as an axis, with the second one as its covariate.
    let mut pair = Axes::<10, 2, (), ()>::new();
    for first in [0, 5000] {
        let mut more = Axes::<10, 2, (), ()>::new();
        for n in first..first + 3000_i32 {
            match n - first {
                900 => more.lost(2),
                2000 => more.gap(),
                _ => {}
            }
            let value = |factor: i32| n.wrapping_mul(n).wrapping_mul(factor).wrapping_shr(5) % 97;
            let counts = [value(7), value(7) + n, value(11)];
            more.push((counts, [counts[1], counts[2]]));
        }
        pair.merge(&more);
    }
    let scale = Scale::new(1.0, 100.0).unwrap();
    let record = axes.record(0, (scale, [0.5, 0.25, 2.0])).unwrap();
    let places: Vec<[usize; 2]> = record.pairs.iter().map(|pair| pair.covariates).collect();
    assert_eq!(places, [[0, 1], [1, 2]]);
    let units = [[0.5, 0.25], [0.25, 2.0]];
    for ((found, place), [unit, other]) in record.pairs.iter().zip(0..).zip(units) {
        let own = Scale::new(unit, 100.0).unwrap();
        let expected = pair.record(place, (own, [units[0][1], other])).unwrap();
        assert_eq!(found.shared, expected.covariates[place]);
    }
}

#[test]
fn neighbours_outlive_a_snapshot() {
    let mut axes = with_losses(0);
    let mut buffer = vec![0; Axes::<10, 3, (), ()>::snapshot_bytes(0)];
    let stored = axes.snapshot(&[], &mut buffer).unwrap();
    let mut restored = Axes::<10, 3, (), ()>::new();
    restored.restore(&mut [], stored).unwrap();
    axes.gap();
    let scale = Scale::new(1.0, 100.0).unwrap();
    let [ours, theirs] = [&axes, &restored].map(|axes| axes.record_so_far(1, (scale, [1.0; 3])));
    assert_eq!(ours.unwrap().pairs, theirs.unwrap().pairs);
}
