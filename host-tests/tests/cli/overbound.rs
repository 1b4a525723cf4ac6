//! Overbounds lie above the curve everywhere, and no higher than necessary.

use allanite::{Curve, Model, fit::Options};
use allanite_host::{
    confidence::{Limits, limits},
    curve_file::CurveFile,
    equivalent::Equivalent,
    overbound::Overbound,
};
use allanite_log::OCTAVES;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::path::Path;

/// The curves of real gyros with their limits.
fn curves() -> Vec<(Curve<OCTAVES>, Vec<Limits>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data");
    let model = Model::ieee_952();
    let files = ["adis16405.json", "mpu6050.json"].map(|name| CurveFile::read(&folder.join(name)));
    let axes = files.into_iter().flat_map(|file| file.unwrap().axes);
    let with_limits = axes.map(|axis| {
        let curve = axis.curve().unwrap();
        let fit = allanite::fit::fit(&curve, &model, Options::default()).unwrap();
        let limits = limits(&curve, &model, &fit);
        (curve, limits)
    });
    with_limits.collect()
}

/// The smallest ratio of a model to the limits, in variance.
fn lowest(overbound: &Overbound, curve: &Curve<OCTAVES>, limits: &[Limits]) -> f64 {
    let ratios = ratios(overbound, curve, limits);
    ratios.into_iter().fold(f64::INFINITY, f64::min)
}

fn ratios(overbound: &Overbound, curve: &Curve<OCTAVES>, limits: &[Limits]) -> Vec<f64> {
    let octaves = curve.points().iter().zip(limits);
    octaves
        .map(|(point, limit)| overbound.variance(point.m, curve.interval_s()) / limit.upper)
        .collect()
}

/// The same model with one coefficient lowered by a millionth, once for each coefficient.
fn lowered(overbound: &Overbound) -> Vec<Overbound> {
    const LESS: f64 = 1.0 - 1e-6;
    let (mut white, mut walk, mut process) = (*overbound, *overbound, *overbound);
    white.noise_density *= LESS;
    walk.random_walk *= LESS;
    if let Some(process) = &mut process.gauss_markov {
        process.sigma *= LESS;
    }
    let all = [white, walk, process].into_iter();
    all.filter(|one| one != overbound).collect()
}

#[test]
fn overbound_is_above_every_octave_and_lowering_any_coefficient_breaks_it() {
    let mut with_process = 0;
    for (curve, limits) in curves() {
        let plain = Overbound::of(&curve, &limits).unwrap();
        let process = Overbound::with_gauss_markov(&curve, &limits).unwrap();
        with_process += usize::from(process.gauss_markov.is_some());
        for overbound in [plain, process] {
            assert!(lowest(&overbound, &curve, &limits) >= 1.0);
            let lowered = lowered(&overbound);
            assert!(!lowered.is_empty());
            for less in lowered {
                assert!(lowest(&less, &curve, &limits) < 1.0, "{overbound:?}");
            }
        }
    }
    assert!(with_process >= 2);
}

#[test]
fn no_other_model_above_the_limits_has_less_excess() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    for (curve, limits) in curves() {
        let best = Overbound::of(&curve, &limits).unwrap();
        let process = Overbound::with_gauss_markov(&curve, &limits).unwrap();
        let excess = |one: &Overbound| ratios(one, &curve, &limits).iter().sum::<f64>();
        assert!(excess(&process) <= excess(&best) * (1.0 + 1e-9));
        for _ in 0..2000 {
            let mut other = best;
            other.noise_density *= random.random_range(0.5..1.5);
            other.random_walk *= random.random_range(0.0..3.0);
            // The other model is raised or lowered as a whole until it touches the limits.
            let other = other.scaled(lowest(&other, &curve, &limits).sqrt().recip());
            assert!(excess(&other) >= excess(&best) * (1.0 - 1e-9), "{other:?}");
        }
    }
}

#[test]
fn white_noise_alone_needs_no_random_walk() {
    let octaves = (0..12_u32).map(|k| (1 << k, (1_u64 << (20 - k)) - 7, 1.0 / f64::from(1 << k)));
    let curve = Curve::<OCTAVES>::new(100.0, octaves).unwrap();
    let limits: Vec<Limits> = curve
        .points()
        .iter()
        .map(|point| Limits {
            lower: 0.9 * point.variance,
            upper: 1.21 * point.variance,
        })
        .collect();
    let overbound = Overbound::of(&curve, &limits).unwrap();
    // The coefficient N is 0.1 at 100 Hz, and the limit is 10 % above.
    assert!(
        (overbound.noise_density / 0.11 - 1.0).abs() < 1e-9,
        "{overbound:?}"
    );
    assert_eq!(overbound.random_walk, 0.0);
}

#[test]
fn equivalent_process_has_the_smallest_difference_and_reports_it() {
    let model = Model::ieee_952();
    for (curve, _) in curves() {
        let fit = allanite::fit::fit(&curve, &model, Options::default()).unwrap();
        let squares = fit.squares();
        let flicker = fit.coefficients[2].value;
        let Some(found) = Equivalent::of(&curve, &model, &squares, flicker) else {
            assert_eq!(flicker, 0.0);
            continue;
        };
        let mut rest = squares;
        rest[2] = 0.0;
        let interval_s = curve.interval_s();
        let misfit = |sigma: f64| -> (f64, f64) {
            let mut process = found.process;
            process.sigma = sigma;
            let ratios = curve.points().iter().map(|point| {
                let wanted = model.variance(&squares, point.m, interval_s);
                let rest = model.variance(&rest, point.m, interval_s);
                (rest + process.variance(point.m, interval_s)) / wanted
            });
            let ratios: Vec<f64> = ratios.collect();
            let squares: f64 = ratios.iter().map(|ratio| (ratio - 1.0).powi(2)).sum();
            let percent = ratios
                .iter()
                .map(|ratio| 100.0 * (ratio.sqrt() - 1.0).abs());
            (squares, percent.fold(0.0, f64::max))
        };
        let (least, worst) = misfit(found.process.sigma);
        assert!((found.max_percent - worst).abs() < 1e-9);
        assert!(found.rms_percent <= found.max_percent && found.rms_percent > 0.0);
        for factor in [0.99, 1.01] {
            assert!(misfit(factor * found.process.sigma).0 > least);
        }
    }
}
