//! Curves and models that do not determine their coefficients.

use super::{ALL, METHODS, OCTAVES, RATE_HZ, assert_relative, changed, exact, settings};
use allanite::{
    Curve, Error, Model,
    effect::{AngleRandomWalk, Effect, RateRamp},
    fit::{Method, Options, State, fit},
};

#[test]
fn too_few_octaves_are_refused_by_number() {
    let curve = exact(ALL, 40, RATE_HZ);
    let found = curve.points().len();
    assert_eq!(found, 4);
    for method in METHODS {
        let found = fit(&curve, &Model::ieee_952(), settings(method)).map(|fit| fit.method);
        let refused = Err(Error::TooFewOctaves {
            found: 4,
            needed: 5,
        });
        assert_eq!(
            found,
            if method == Method::Covariance {
                Ok(method)
            } else {
                refused
            }
        );
    }
    // Of the six octaves of 120 samples, four have nine clusters or more.
    let curve = exact(ALL, 120, RATE_HZ);
    assert_eq!(curve.points().len(), 6);
    let refusal = |method| fit(&curve, &Model::ieee_952(), settings(method)).err();
    assert_eq!(refusal(Method::Ordinary), None);
    let too_few = Error::TooFewOctaves {
        found: 4,
        needed: 5,
    };
    assert_eq!(refusal(Method::AccuratePart), Some(too_few));
    let octave = Curve::<OCTAVES>::new(1.0, [(1, 100, 1.0)]).expect("possible");
    let found = fit(&octave, &Model::ieee_952(), Options::default());
    assert_eq!(
        found,
        Err(Error::TooFewOctaves {
            found: 1,
            needed: 2
        })
    );
    let empty = Curve::<OCTAVES>::new(1.0, []).expect("possible");
    for method in METHODS {
        let found = fit(&empty, &Model::ieee_952(), settings(method));
        assert!(
            matches!(found, Err(Error::TooFewOctaves { found: 0, .. })),
            "{found:?}"
        );
    }
}

#[test]
fn a_curve_without_noise_is_refused_by_its_octave() {
    let flat = changed(&exact(ALL, 1 << 12, RATE_HZ), |k| {
        if k >= 3 { 0.0 } else { 1.0 }
    });
    for method in METHODS {
        let found = fit(&flat, &Model::ieee_952(), settings(method));
        assert_eq!(found, Err(Error::NoNoise { m: 8 }));
    }
}

#[test]
fn effects_that_cannot_be_distinguished_are_refused_or_not_observable() {
    let curve = exact(ALL, 1 << 14, RATE_HZ);
    let twice: [&'static dyn Effect; 3] = [&AngleRandomWalk, &RateRamp, &AngleRandomWalk];
    let model = Model::new(&twice).expect("three effects");
    for method in METHODS {
        if method != Method::Covariance {
            assert_eq!(fit(&curve, &model, settings(method)), Err(Error::Singular));
        }
    }
    let found = fit(&curve, &model, Options::default()).expect("one of the two");
    let states: Vec<State> = [0, 2].map(|i| found.coefficients[i].state).to_vec();
    let not_observable = |state: &State| matches!(state, State::NotObservable { .. });
    assert!(states.iter().any(not_observable), "{states:?}");
    // An empty model has no coefficients to fit.
    assert_eq!(
        fit(&curve, &Model::default(), Options::default()),
        Err(Error::Singular)
    );
}

#[test]
fn variances_of_any_size_are_fitted_or_refused() {
    let curve = exact(ALL, 1 << 14, RATE_HZ);
    for exponent in (-150..=150).step_by(10) {
        let scaled = changed(&curve, |_| 10_f64.powi(exponent));
        for method in METHODS {
            match fit(&scaled, &Model::ieee_952(), settings(method)) {
                Ok(fit) => {
                    let expected = ALL[1] * 10_f64.powi(exponent).sqrt();
                    let what = format!("{method:?} at 10^{exponent}");
                    assert_relative(fit.coefficients[1].value, expected, 1e-3, &what);
                }
                Err(error) => {
                    assert_eq!(error, Error::Singular);
                    assert!(exponent.abs() >= 130, "{method:?} at 10^{exponent}");
                }
            }
        }
    }
}

#[test]
fn a_model_has_room_for_eight_effects() {
    let nine: [&'static dyn Effect; 9] = [&AngleRandomWalk; 9];
    assert!(Model::new(&nine[..8]).is_ok_and(|model| model.terms().len() == 8));
    let refused = Model::new(&nine).map(|model| model.terms().len());
    assert_eq!(refused, Err(Error::TooManyEffects { capacity: 8 }));
}
