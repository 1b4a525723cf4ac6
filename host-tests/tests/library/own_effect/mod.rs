//! A user's own effect takes one file and one line in a list. Simulation, diagnosis and storage
//! then work for it.

mod second_order;

use allanite::{
    Accumulator, Curve, Model, Scale,
    diagnosis::{Addition, Options, Step},
    effect::{CATALOGUE, Effect, Explain, FIRST_OWN_CODE, Flaw, SampledShape, check},
    storage::{AxisCertificate, Certificate, Conditions, EffectCode, RateUnit},
};
use allanite_host::{
    diagnosis::diagnose,
    simulate::{Coefficients, Hidden, Simulator},
};
use second_order::SecondOrderGaussMarkov;

/// The list of own effects, one per line.
const OWN: [&dyn Explain; 1] = [&SecondOrderGaussMarkov];

const RATE_HZ: f64 = 100.0;
const OCTAVES: usize = 16;

/// All effects that a diagnosis tries.
fn effects() -> Vec<&'static dyn Effect> {
    let own = OWN.into_iter().map(|effect| effect as &dyn Effect);
    CATALOGUE.into_iter().chain(own).collect()
}

/// Every own effect in each of its typical shapes.
fn hidden() -> impl Iterator<Item = Hidden> {
    OWN.into_iter().flat_map(|effect| {
        let shapes = effect.typical_shapes().iter();
        shapes.map(move |&parameters| Hidden {
            effect,
            parameters,
            coefficient: 0.01,
        })
    })
}

/// The curve of a simulated record.
fn curve(coefficients: Coefficients, hidden: Hidden, samples: usize, seed: u64) -> Curve<OCTAVES> {
    const QUANTUM: f64 = 1e-7;
    let simulator = Simulator::with_hidden(coefficients, &[hidden], RATE_HZ, seed);
    let mut accumulator = Accumulator::<OCTAVES>::new();
    for rate in simulator.take(samples) {
        accumulator.push((rate / QUANTUM).round() as i32);
    }
    accumulator.curve(Scale::new(QUANTUM, RATE_HZ).expect("possible"))
}

/// The diagnosis of a gyro with white noise, flicker noise and a hidden effect.
fn diagnosed(hidden: Hidden) -> (Curve<OCTAVES>, Vec<Step<OCTAVES>>) {
    let gyro = Coefficients {
        angle_random_walk: 2e-4,
        bias_instability: 3e-5,
        ..Coefficients::default()
    };
    let curve = curve(gyro, hidden, 1 << 17, 1);
    let mut steps = Vec::new();
    let model = Model::ieee_952();
    let (effects, options) = (effects(), Options::default());
    diagnose(&curve, &model, &effects, options, |step| {
        steps.push(step.clone());
    })
    .expect("a diagnosis");
    (curve, steps)
}

#[test]
fn own_effect_is_simulated_with_its_own_allan_variance() {
    for hidden in hidden() {
        let curve = curve(Coefficients::default(), hidden, 1 << 19, 7);
        let shape = SampledShape {
            interval_s: 1.0 / RATE_HZ,
            parameters: hidden.parameters,
        };
        for point in curve.points().iter().filter(|point| point.m <= 64) {
            let expected =
                hidden.coefficient.powi(2) * hidden.effect.variance(f64::from(point.m), &shape);
            let ratio = point.variance / expected;
            // A record of 2^19 samples contains 13 000 time constants.
            assert!((ratio - 1.0).abs() < 0.06, "m = {}: {ratio}", point.m);
        }
    }
}

#[test]
fn own_effect_is_found_and_explained() {
    for hidden in hidden() {
        let (_, steps) = diagnosed(hidden);
        let found: Vec<_> = steps
            .iter()
            .filter_map(|step| match step.added {
                Some(Addition::Effect(term)) => Some(term),
                _ => None,
            })
            .collect();
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].effect.name(), hidden.effect.name());
        let ratio = found[0].parameters[0] / hidden.parameters[0];
        assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
        let mut own = OWN.iter();
        let explained = own.find(|effect| effect.description().name == found[0].effect.name());
        let explanation = explained.expect("in the list").explanation();
        assert!(explanation.what.contains("smooth"));
    }
}

#[test]
fn own_effect_is_stored_and_read_back() {
    for hidden in hidden() {
        let (curve, steps) = diagnosed(hidden);
        let last = steps.last().expect("a step");
        let conditions = Conditions {
            temperature_c: None,
            duration_s: 1310.72,
            rate_hz: RATE_HZ,
            samples: 1 << 17,
            gaps: 0,
        };
        let unit = RateUnit::DegreesPerSecond;
        let mut record = Certificate::new(b"own", [1, 0, 0], conditions, unit).expect("short");
        let axis = AxisCertificate::new(&curve, &last.model, &last.fit).expect("a record");
        assert!(record.axes.push(axis).is_ok());
        let mut buffer = [0; Certificate::MAX_BYTES];
        let stored = record.encode(&mut buffer).expect("it fits");
        let read = Certificate::decode(stored).expect("intact");
        // The records are compared as bytes, because NaN marks unknown values.
        let mut again = [0; Certificate::MAX_BYTES];
        assert_eq!(read.encode(&mut again).expect("it fits"), stored);

        let term = read.axes[0].terms.last().expect("terms");
        assert_eq!(term.effect.number(), FIRST_OWN_CODE);
        // The effect is known only with a list that contains it.
        let known = term.effect.effect_of(&effects()).expect("in the list");
        assert_eq!(known.name(), hidden.effect.name());
        assert_eq!(term.effect.name(), "other");
        assert!(term.effect.effect().is_none());
        assert_eq!(term.shape.len(), known.parameters().len());
    }
}

/// An effect that claims a code of the catalogue.
struct Impostor;

impl Effect for Impostor {
    fn description(&self) -> &'static allanite::effect::Description {
        &allanite::effect::Description {
            name: "impostor",
            symbol: "s",
            coefficient: "rms",
            half_seconds: 0,
            reference_s: None,
            parameters: &[],
            code: 7,
            replaces: None,
            mirror: None,
            special_case: None,
            distribution: allanite::effect::Distribution::Gaussian,
        }
    }

    fn kernel(&self, lag: f64, _: &SampledShape) -> f64 {
        -lag
    }
}

#[test]
fn own_effects_are_checked() {
    for effect in OWN {
        assert_eq!(check(effect), Ok(()));
    }
    assert_eq!(check(&Impostor), Err(Flaw::Code(7)));
}

#[test]
fn own_effect_is_not_stored_under_a_code_of_the_catalogue() {
    assert_eq!(EffectCode::of(&Impostor), EffectCode::OTHER);
}
