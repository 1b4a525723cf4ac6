//! Compares each term of the simulator with its own Allan variance, and checks that a seed always
//! gives the same record.

use allanite::Model;
use allanite_host::simulate::{
    Coefficients, Preset, Random, Simulator, band_limited_flicker,
    record::{self, RATE_HZ},
};
use rand::SeedableRng as _;
use rayon::prelude::*;

/// The number of samples of every averaged record.
const SAMPLES: usize = 1 << 13;

const NONE: Coefficients = Coefficients {
    quantization: 0.0,
    angle_random_walk: 0.0,
    bias_instability: 0.0,
    rate_random_walk: 0.0,
    rate_ramp: 0.0,
};

/// The estimate of an octave, averaged over records, relative to the Allan variance.
struct Average {
    m: u32,
    mean: f64,
    standard_error: f64,
}

/// The squares of the model's five terms.
fn squares(c: Coefficients) -> [f64; 5] {
    let terms = [
        c.quantization,
        c.angle_random_walk,
        c.bias_instability,
        c.rate_random_walk,
        c.rate_ramp,
    ];
    terms.map(|x| x * x)
}

fn averages(coefficients: Coefficients, records: u64) -> Vec<Average> {
    let model = Model::ieee_952();
    let squares = squares(coefficients);
    let curves: Vec<Vec<(u32, f64)>> = (0..records)
        .into_par_iter()
        .map(|seed| {
            let curve = record::curve(coefficients, SAMPLES, seed);
            let relative = curve.points().iter().map(|point| {
                let variance = model.variance(&squares, point.m, curve.interval_s());
                (point.m, point.variance / variance)
            });
            relative.collect()
        })
        .collect();
    let n = records as f64;
    (0..curves[0].len())
        .map(|k| {
            let ratios = curves.iter().map(|curve| curve[k].1);
            let mean = ratios.clone().sum::<f64>() / n;
            let squares: f64 = ratios.map(|ratio| (ratio - mean).powi(2)).sum();
            let standard_error = (squares / (n * (n - 1.0))).sqrt();
            Average {
                m: curves[0][k].0,
                mean,
                standard_error,
            }
        })
        .collect()
}

/// Every octave that is known to 0.3 % or better must be right to 1 %, and there must be `octaves`
/// of them. The longer ones must be right within their uncertainty.
fn assert_averages(coefficients: Coefficients, records: u64, octaves: usize) {
    let averages = averages(coefficients, records);
    let known = |average: &&Average| average.standard_error <= 0.003;
    for Average {
        m,
        mean,
        standard_error,
    } in &averages
    {
        assert!(
            (mean - 1.0).abs() < f64::max(0.01, 4.0 * standard_error),
            "m = {m}: {mean:.4} ± {standard_error:.4} of the Allan variance"
        );
    }
    let found = averages.iter().filter(known).count();
    assert!(
        found >= octaves,
        "{found} octaves known to 0.3 %, not {octaves}"
    );
}

#[test]
fn quantization_has_its_allan_variance() {
    assert_averages(
        Coefficients {
            quantization: 2e-4,
            ..NONE
        },
        12_000,
        8,
    );
}

#[test]
fn angle_random_walk_has_its_allan_variance() {
    assert_averages(
        Coefficients {
            angle_random_walk: 5e-3,
            ..NONE
        },
        12_000,
        8,
    );
}

#[test]
fn bias_instability_has_its_allan_variance() {
    assert_averages(
        Coefficients {
            bias_instability: 4e-3,
            ..NONE
        },
        3_000,
        6,
    );
}

#[test]
fn rate_random_walk_has_its_allan_variance() {
    assert_averages(
        Coefficients {
            rate_random_walk: 3e-4,
            ..NONE
        },
        12_000,
        8,
    );
}

#[test]
fn rate_ramp_has_its_allan_variance() {
    assert_averages(
        Coefficients {
            rate_ramp: 1e-5,
            ..NONE
        },
        2,
        11,
    );
}

#[test]
fn the_variance_of_all_terms_is_the_sum_of_their_variances() {
    let all = Coefficients {
        rate_ramp: 2e-4,
        ..Preset::Mems.coefficients()
    };
    assert_averages(all, 2_000, 5);
}

#[test]
fn a_ramp_climbs_by_the_same_step_every_sample() {
    let ramp = Coefficients {
        rate_ramp: 0.5,
        ..NONE
    };
    let rates: Vec<f64> = Simulator::new(ramp, 10.0, 0).take(5).collect();
    for (i, rate) in rates.windows(2).enumerate() {
        assert!((rate[1] - rate[0] - 0.05).abs() < 1e-15, "step {i}");
    }
    assert_eq!(Simulator::new(NONE, 10.0, 0).take(3).sum::<f64>(), 0.0);
}

/// The first samples of a preset's record.
fn first(preset: Preset, seed: u64) -> [f64; 4] {
    let mut simulator = Simulator::new(preset.coefficients(), RATE_HZ, seed);
    std::array::from_fn(|_| simulator.next().expect("endless"))
}

#[test]
fn a_seed_always_gives_the_same_record() {
    for preset in Preset::TYPICAL.into_iter().chain(Preset::PAPER) {
        let bits = |seed| first(preset, seed).map(f64::to_bits);
        assert_eq!(bits(7), bits(7));
        assert_ne!(bits(7), bits(8));
    }
}

/// These sources use only arithmetic of the host, so they give the same bits everywhere.
#[test]
fn records_of_a_seed_have_not_changed() {
    let bits = |coefficients| -> Vec<u64> {
        let rates = Simulator::new(coefficients, 1.0, 1).take(3);
        rates.map(f64::to_bits).collect()
    };
    let quantization = Coefficients {
        quantization: 1.0,
        ..NONE
    };
    assert_eq!(
        bits(quantization),
        [
            0xbfc0_70a7_33f2_b7f0,
            0xc005_0d2c_4d69_4e48,
            0x4002_f26a_e07c_510e
        ]
    );
    let angle_random_walk = Coefficients {
        angle_random_walk: 1.0,
        ..NONE
    };
    assert_eq!(
        bits(angle_random_walk),
        [
            0x3feb_0209_616c_0cff,
            0x3fe6_e5df_946f_5f03,
            0xbffe_a768_d09a_ed0f
        ]
    );
    let rate_random_walk = Coefficients {
        rate_random_walk: 1.0,
        ..NONE
    };
    assert_eq!(
        bits(rate_random_walk),
        [
            0x3feb_0209_616c_0cff,
            0x3ff8_f3f4_7aed_b601,
            0xbfd6_cdd1_56b4_dc38
        ]
    );
}

/// Flicker noise uses exponentials of the host, which may differ in the last bit.
#[test]
fn records_of_the_presets_have_not_changed() {
    for (preset, expected) in [
        (
            Preset::Tactical,
            [-0.022_765_553_787_178_053, -0.012_509_007_647_572_555],
        ),
        (
            Preset::Fog,
            [-0.003_883_679_302_391_271_4, -0.002_277_124_879_055_117],
        ),
        (
            Preset::Mems,
            [-0.063_335_012_139_028_8, -0.033_862_081_197_821_77],
        ),
    ] {
        for (found, expected) in first(preset, 1).into_iter().zip(expected) {
            assert!(
                (found / expected - 1.0).abs() < 1e-12,
                "{preset:?}: {found}"
            );
        }
    }
}

/// Beyond some samples, flicker noise that ends at half the sample rate has the Allan variance of IEEE Std 952, eq. C.17.
#[test]
fn band_limited_flicker_noise_has_its_floor() {
    let variance = |seed: u64| {
        let mut random = Random::seed_from_u64(seed);
        let rates = band_limited_flicker(1.0, SAMPLES, &mut random);
        let means: Vec<f64> = rates
            .chunks_exact(32)
            .map(|chunk| chunk.iter().sum::<f64>() / 32.0)
            .collect();
        let differences = means.windows(2).map(|two| (two[1] - two[0]).powi(2));
        0.5 * differences.sum::<f64>() / (means.len() - 1) as f64
    };
    let mean = (0..100).map(variance).sum::<f64>() / 100.0;
    let floor = 2.0 * std::f64::consts::LN_2 / std::f64::consts::PI;
    assert!((mean / floor - 1.0).abs() < 0.03, "{mean}, not {floor}");
}
