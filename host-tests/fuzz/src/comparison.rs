//! Fit and comparison of any curve and spectrum with any model: they end after a bounded number of steps, with finite
//! numbers or an error.

use crate::diagnosis::{BINS, OCTAVES, measured};
use allanite::{
    Comparison, Model, Record, Term,
    effect::{CATALOGUE, MAX_PARAMETERS},
    fit::{Fit, Fitting, Method, Options},
};

/// The most pieces of work. A fit takes less than a hundred.
const MOST_STEPS: u32 = 10_000;

const METHODS: [Method; 6] = [
    Method::Ordinary,
    Method::AccuratePart,
    Method::RelativeAccuracy,
    Method::ClusterCount,
    Method::Covariance,
    Method::Covariance,
];

/// Fits the model that the first bytes encode to what the others encode.
pub fn check(bytes: &[u8]) {
    let Some((&[options, terms], rest)) = bytes.split_first_chunk() else {
        return;
    };
    let (terms, rest) = rest.split_at(rest.len().min(3 * usize::from(terms % 9)));
    let mut model = Model::default();
    for three in terms.chunks_exact(3) {
        let effect = CATALOGUE[usize::from(three[0]) % CATALOGUE.len()];
        let parameters: [f64; MAX_PARAMETERS] = std::array::from_fn(|j| match effect.is_whole(j) {
            true => f64::from(three[2] % 7),
            false => 10_f64.powf(f64::from(three[1 + j % 2] as i8) / 16.0),
        });
        // A model has room for eight.
        model.add(Term::known(effect, parameters)).unwrap();
    }
    if options >= 128 {
        model = Model::ieee_952();
    }
    let Some((curve, spectrum)) = measured(rest) else {
        return;
    };
    let options = Options {
        method: METHODS[usize::from(options) % METHODS.len()],
        tolerance: [0.0, 0.01, 1.0, 100.0][usize::from(options >> 3) % 4],
    };
    let observed = Record::new(&curve, &spectrum);
    let mut fitting = Fitting::new(observed, model.clone(), options);
    for _ in 0..MOST_STEPS {
        match fitting.advance() {
            Ok(None) => {}
            Ok(Some(fit)) => {
                judge(observed, &model, fit);
                return;
            }
            Err(error) => {
                assert!(!error.to_string().is_empty());
                return;
            }
        }
    }
    panic!("not finished after {MOST_STEPS} pieces of work");
}

/// Every number of a fit and of its comparisons is finite.
fn judge(observed: Record<'_, OCTAVES, BINS>, model: &Model, fit: &Fit) {
    assert_eq!(fit.coefficients.len(), model.terms().len());
    for coefficient in &fit.coefficients {
        let numbers = [coefficient.value, coefficient.lower, coefficient.square];
        assert!(numbers.iter().all(|x| x.is_finite()), "{coefficient:?}");
        // The upper end is infinite if the effect cannot be told from others.
        let rounded = 1.0 + 1e-9;
        assert!(
            coefficient.lower <= coefficient.value * rounded
                && coefficient.value <= coefficient.upper * rounded,
            "{coefficient:?}"
        );
    }
    let is_probability = |p: f64| p.is_nan() || (0.0..=1.0).contains(&p);
    assert!(is_probability(fit.p_value), "p {}", fit.p_value);
    let own = Comparison::new(observed, model, fit);
    let held_out = Comparison::held_out(observed, model, fit, 0.01);
    for comparison in [own, held_out].into_iter().flatten() {
        assert_eq!(comparison.octaves.len(), observed.curve.points().len());
        for octave in &comparison.octaves {
            assert!(octave.model.is_finite(), "{octave:?}");
            // Other methods let squares be negative.
            if fit.method == Method::Covariance {
                let is_share = |share: &f32| (-0.01..1.01).contains(share);
                assert!(octave.model >= 0.0, "{octave:?}");
                assert!(octave.shares.iter().all(is_share), "{octave:?}");
            }
        }
        assert!(comparison.chi_squared.is_nan() || comparison.chi_squared >= 0.0);
        assert!(is_probability(comparison.p_value));
        for band in comparison.bands() {
            assert!(band.from_hz <= band.to_hz && band.z.is_finite(), "{band:?}");
        }
        assert!(!comparison.to_string().is_empty());
    }
}
