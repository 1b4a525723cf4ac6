//! Models are compared with plain lists of names.

use super::*;
use crate::{
    numerics::real::{by_precision, double},
    theory::effect::{
        AngleRandomWalk, DecimationFilter, GaussMarkov, LowPass, Quantization, RateRamp, Resonance,
        Sinusoid,
    },
};

/// The five terms of IEEE Std 952, in its order.
const FIVE: [&str; 5] = [
    "quantization",
    "angle_random_walk",
    "bias_instability",
    "rate_random_walk",
    "rate_ramp",
];

fn assert_names(model: &Model, expected: &[&str]) {
    let names = model.terms().iter().map(|term| term.effect.name());
    assert!(names.eq(expected.iter().copied()), "{model:?}");
    for (place, name) in expected.iter().enumerate() {
        assert_eq!(model.position(name), Some(place));
    }
}

#[test]
fn a_model_keeps_the_order_of_its_effects() {
    assert_names(&Model::ieee_952(), &FIVE);
    let model = Model::new(&[&Sinusoid, &Quantization]).expect("room");
    assert_names(&model, &["sinusoid", "quantization"]);
    assert_names(&Model::default(), &[]);
    assert_eq!(model.position("rate_ramp"), None);
}

#[test]
fn a_full_model_refuses_another_effect() {
    let mut effects: [&'static dyn Effect; MAX_EFFECTS + 1] = [&RateRamp; MAX_EFFECTS + 1];
    let refused = Error::TooManyEffects {
        capacity: MAX_EFFECTS,
    };
    assert_eq!(Model::new(&effects).err(), Some(refused));
    effects[0] = &Quantization;
    let mut full = Model::new(&effects[..MAX_EFFECTS]).expect("room");
    assert_eq!(full.terms().len(), MAX_EFFECTS);
    assert_eq!(full.add(Term::new(&RateRamp)), Err(refused));
    assert_eq!(full.restore(&AngleRandomWalk), Err(refused));
    assert_eq!(full.terms().len(), MAX_EFFECTS);
}

#[test]
fn removing_an_effect_keeps_the_order_of_the_others() {
    for (place, name) in FIVE.into_iter().enumerate() {
        let without = Model::ieee_952().without(name);
        let mut removed = Model::ieee_952();
        assert_eq!(removed.remove(name), Some(place));
        assert_eq!(removed.remove(name), None);
        let mut rest = [""; 4];
        let others = FIVE.iter().filter(|other| **other != name);
        for (slot, other) in rest.iter_mut().zip(others) {
            *slot = other;
        }
        assert_names(&without, &rest);
        assert_names(&removed, &rest);
        // The effect comes back to its old place.
        let effect = IEEE_952[place];
        assert_eq!(removed.restore(effect), Ok(place));
        assert_names(&removed, &FIVE);
    }
    assert_names(&Model::ieee_952().without("sinusoid"), &FIVE);
}

#[test]
fn removing_a_name_that_occurs_twice_removes_the_later_effect() {
    let mut model = Model::ieee_952();
    for quality in [1.0, 2.0] {
        let mut term = Term::new(&Sinusoid);
        term.set_parameter(0, quality);
        assert_eq!(model.add(term), Ok(()));
    }
    assert_eq!(model.remove("sinusoid"), Some(6));
    assert_eq!(model.terms()[5].parameter(0), 1.0);
}

#[test]
fn given_shapes_and_whole_numbers_are_not_fitted() {
    assert_eq!(Term::new(&Resonance).fitted_parameters().count(), 0);
    assert!(Term::fitted(&Resonance).fitted_parameters().eq([0, 1]));
    assert!(Term::fitted(&GaussMarkov).fitted_parameters().eq([0]));
    assert!(!Term::fitted(&RateRamp).fitted);
    // The width of a decimation filter is fitted. The number of its stages is a whole number and is
    // not.
    assert!(Term::fitted(&DecimationFilter).fitted_parameters().eq([0]));
}

#[test]
fn parameters_beyond_the_last_are_zero_and_cannot_be_set() {
    let mut term = Term::new(&Resonance);
    term.set_parameter(1, 3.0);
    term.scale_parameter(1, 4.0);
    term.set_parameter(MAX_PARAMETERS, 5.0);
    assert_eq!(
        [0, 1, MAX_PARAMETERS].map(|j| term.parameter(j)),
        [0.0, 12.0, 0.0]
    );
    assert_eq!(term.parameter_name(MAX_PARAMETERS), "");
    assert_eq!(term.sampled_shape(0.5).parameters, term.parameters);
}

#[test]
fn the_variance_of_a_model_is_the_sum_over_its_effects() {
    // The formulas of IEEE Std 952 at τ = 0.64 s are 3 Q²/τ², N²/τ, (2 ln 2/π) B², K²τ/3 and R²τ²/2.
    let (interval_s, m) = (0.01, 64);
    let tau: f64 = 0.64;
    let squares = [1e-4, 2e-3, 3e-3, 4e-3, 5e-3];
    let shape = [
        3.0 / (tau * tau),
        1.0 / tau,
        2.0 * core::f64::consts::LN_2 / core::f64::consts::PI,
        // The walk is sampled, so that its factor is (2m² + 1)/6m of the interval.
        interval_s * f64::from(2 * m * m + 1) / f64::from(6 * m),
        0.5 * tau * tau,
    ];
    let expected: f64 = squares.iter().zip(shape).map(|(x, y)| x * y).sum();
    let given = squares.map(real);
    let found = Model::ieee_952().variance(&given, m, real(interval_s));
    let off = double(found) / expected - 1.0;
    assert!(off.abs() < double(by_precision(1e-12, 1e-5)), "{off:e}");
}

#[test]
fn a_known_filter_takes_the_place_of_the_white_noise() {
    let mut model = Model::ieee_952();
    let filter = Term::known(&LowPass, [0.004, 2.0]);
    assert_eq!(model.put(filter), Ok(()));
    let expected = [FIVE[0], "low_pass", FIVE[2], FIVE[3], FIVE[4]];
    assert_names(&model, &expected);
    let known = model.terms()[1];
    assert_eq!(
        (known.parameters, known.fitted, known.pinned),
        ([0.004, 2.0, 0.0], false, false)
    );
    // A second filter has nothing to replace.
    assert_eq!(
        model.put(Term::known(&DecimationFilter, [0.02, 1.0])),
        Ok(())
    );
    assert_eq!(model.position("decimation_filter"), Some(5));
    assert_eq!(model.terms().len(), 6);
}
