//! What is told about an effect: its names, its units and its explanation.

use super::shapes::{SPAN, assert_relative, for_every_shape};
use allanite::effect::{EXPLAINED, Effect, FIRST_OWN_CODE, MAX_PARAMETERS, SampledShape};

/// If the unit of time changes, a variance changes by a power of it. The unit of the coefficient
/// must contain that power. A reference time changes with the unit.
#[test]
fn units_are_those_of_the_variances() {
    const FACTOR: f64 = 4.0;
    for_every_shape(|effect, shape, name| {
        let mut slower = *shape;
        slower.interval_s *= FACTOR;
        for (parameter, value) in effect.parameters().iter().zip(&mut slower.parameters) {
            *value *= match parameter.unit {
                "s" => FACTOR,
                "Hz" => 1.0 / FACTOR,
                "" => 1.0,
                unit => panic!("{name}: {unit} is not a power of time"),
            };
        }
        let reference_s = effect.description().reference_s;
        let unit = |shape: &SampledShape, factor: f64| {
            let m = reference_s.map(|reference_s| factor * reference_s / shape.interval_s);
            m.map_or(1.0, |m| effect.variance(m, shape))
        };
        assert_relative(unit(shape, 1.0), 1.0, 1e-9, name);
        let fast = effect.variance(16.0, shape) / unit(shape, 1.0);
        let ratio = fast * unit(&slower, FACTOR) / effect.variance(16.0, &slower);
        let expected = FACTOR.powi(effect.half_seconds().into());
        assert_relative(ratio, expected, 1e-9, name);
    });
}

#[test]
fn descriptions_are_complete_and_distinct() {
    for (i, explained) in EXPLAINED.into_iter().enumerate() {
        let effect: &dyn Effect = explained;
        let description = effect.description();
        let name = description.name;
        let is_plain = |name: &str| {
            !name.is_empty() && name.chars().all(|c| c.is_ascii_lowercase() || c == '_')
        };
        assert!(is_plain(name), "{name}");
        assert!(is_plain(description.coefficient), "{name}");
        assert!((1..FIRST_OWN_CODE).contains(&description.code), "{name}");
        for other in &EXPLAINED[..i] {
            let other = other.description();
            assert!(
                other.name != name && other.code != description.code,
                "{name}"
            );
        }
        assert!(description.parameters.len() <= MAX_PARAMETERS, "{name}");
        for parameter in description.parameters {
            let unit = parameter.unit.to_lowercase();
            assert!(parameter.name.ends_with(&unit), "{name}: {parameter:?}");
        }
        if let Some(mirror) = description.mirror {
            assert_eq!(mirror.parameters().len(), description.parameters.len());
        }
        let explanation = explained.explanation();
        for text in [explanation.what, explanation.origin, explanation.check] {
            assert!(text.len() > 20, "{name}: {text}");
        }
        assert!(!explained.typical_shapes().is_empty(), "{name}");
        for shape in explained.typical_shapes() {
            for (i, value) in shape.iter().enumerate() {
                let range = effect.search_range(i, &SPAN);
                let within = range.map_or(*value == 0.0, |range| {
                    (range.low..=range.high).contains(value)
                });
                assert!(within, "{name}: {shape:?}");
            }
        }
    }
}
