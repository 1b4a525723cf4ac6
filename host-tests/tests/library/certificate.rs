//! Factory certificates keep what a fit and a diagnosis reported, and are refused if anything has
//! changed.

use crate::{
    factory::{self, SINUSOID, axis, encoded, followed, record},
    sealed::sealed,
};
use allanite::{
    Curve, Model,
    course::What,
    diagnosis::Verdict,
    effect::{AngleRandomWalk, BiasInstability, CATALOGUE, DecimationFilter, RateRandomWalk},
    fit::{Options, State, curve_covariance, fit},
    integrity::Reason,
    storage::{
        Certificate, CertifiedBand, CertifiedEvent, CertifiedLimit, CertifiedSlope, CertifiedState,
        CertifiedWhat, Doubt, EffectCode, Error, Findings, RateUnit,
    },
};

fn three_axes() -> Certificate {
    let axes = [axis(None, 1), axis(Some(SINUSOID), 2), axis(None, 3)];
    record("SN-0042", RateUnit::DegreesPerSecond, &axes)
}

#[test]
fn record_keeps_the_results_of_fit_and_diagnosis() {
    let written = three_axes();
    let bytes = encoded(&written);
    let read = Certificate::decode(&bytes).unwrap();
    assert_eq!(encoded(&read), bytes);
    assert_eq!((bytes.len(), Certificate::MAX_BYTES), (610, 3568));
    assert_eq!(read.device, b"SN-0042");
    assert_eq!(read.firmware, [1, 2, 300]);
    assert_eq!(read.conditions, written.conditions);
    let verdicts: Vec<_> = read.axes.iter().map(|axis| axis.verdict.unwrap()).collect();
    assert_eq!(verdicts[1], Verdict::Improved);
    assert!(read.axes[0].found().next().is_none());
    let found: Vec<_> = read.axes[1].found().collect();
    assert_eq!(found[0].effect.name(), "sinusoid");
    let frequency = found[0].shape[0];
    assert!(frequency.lower < frequency.value && frequency.value < frequency.upper);
    assert!((frequency.value / 7.7 - 1.0).abs() < 0.03, "{frequency:?}");
}

#[test]
fn numbers_of_a_fit_are_kept_in_single_precision() {
    let curve = factory::counts(None, 1).curve(allanite::Scale::new(0.01, 100.0).unwrap());
    let model = Model::ieee_952();
    let fit = fit(&curve, &model, Options::default()).unwrap();
    let axis = allanite::storage::AxisCertificate::new(&curve, &model, &fit).unwrap();
    assert_eq!(axis.chi_squared, fit.chi_squared);
    assert_eq!(axis.p_value, fit.p_value);
    assert_eq!(usize::from(axis.degrees_of_freedom), fit.degrees_of_freedom);
    for (term, coefficient) in axis.terms.iter().zip(&fit.coefficients) {
        assert_eq!(term.effect.name(), coefficient.name);
        assert_eq!(term.value, coefficient.value as f32);
        assert_eq!(term.upper, coefficient.upper as f32);
        assert_eq!(term.square_error, coefficient.square_error as f32);
        let same = match (term.state, coefficient.state) {
            (CertifiedState::Measured, State::Measured) => true,
            (CertifiedState::UpperBound, State::UpperBound) => true,
            (CertifiedState::NotObservable { after_s: a }, State::NotObservable { after_s: b }) => {
                a == b.map(|b| b as f32)
            }
            _ => false,
        };
        assert!(same, "{term:?} {coefficient:?}");
    }
}

/// The curve has no noise, so that the derivatives of a fit with respect to the octaves show how
/// errors propagate.
#[test]
fn covariance_agrees_with_errors_propagated_through_the_fit() {
    let squares = [0.04_f64, 0.004, 0.0009].map(|x| x * x);
    let model = Model::new(&[&AngleRandomWalk, &BiasInstability, &RateRandomWalk]).unwrap();
    let octaves = |changed: usize, step: f64| {
        let (model, squares) = (&model, &squares);
        (0..15).map(move |k| {
            let variance = model.variance(squares, 1 << k, 0.01);
            let factor = if k == changed { 1.0 + step } else { 1.0 };
            (
                1 << k,
                ((1_u64 << 18) >> k.saturating_sub(2)) - 7,
                variance * factor,
            )
        })
    };
    let curve = |changed, step| Curve::<15>::new(100.0, octaves(changed, step)).unwrap();
    let fitted = |curve: &Curve<15>| fit(curve, &model, Options::default()).unwrap();
    let exact = curve(99, 0.0);
    let (best, scatter) = (fitted(&exact), curve_covariance(&exact, &model, &squares));
    let correlations = best.correlations(&exact, &model).unwrap();

    const STEP: f64 = 1e-3;
    let mut derivatives = [[0.0; 15]; 3];
    for k in 0..15 {
        let (up, down) = (fitted(&curve(k, STEP)), fitted(&curve(k, -STEP)));
        for (i, row) in derivatives.iter_mut().enumerate() {
            let change = up.coefficients[i].square - down.coefficients[i].square;
            row[k] = change / (2.0 * STEP * exact.points()[k].variance);
        }
    }
    let covariance = |i: usize, j: usize| {
        let mut sum = 0.0;
        for k in 0..15 {
            for l in 0..15 {
                sum += derivatives[i][k] * scatter[(k, l)] * derivatives[j][l];
            }
        }
        sum
    };
    for i in 0..3 {
        let error = best.coefficients[i].square_error;
        assert!((covariance(i, i).sqrt() / error - 1.0).abs() < 0.02);
        for j in 0..i {
            let expected = covariance(i, j) / (covariance(i, i) * covariance(j, j)).sqrt();
            let found = correlations.get(i, j);
            assert!(
                (found - expected).abs() < 0.01,
                "{i}, {j}: {found} {expected}"
            );
            assert_eq!(found, correlations.get(j, i));
        }
        assert_eq!(correlations.get(i, i), 1.0);
    }
    assert!(correlations.get(0, 1).abs() > 0.05, "{correlations:?}");
}

#[test]
fn every_change_of_one_byte_is_refused() {
    let bytes = encoded(&three_axes());
    let mut changed = bytes.clone();
    for i in 0..bytes.len() {
        for difference in 1..=u8::MAX {
            changed[i] = bytes[i] ^ difference;
            assert!(
                Certificate::decode(&changed).is_err(),
                "byte {i} ^ {difference}"
            );
        }
        changed[i] = bytes[i];
    }
    for length in 0..bytes.len() {
        assert!(
            Certificate::decode(&bytes[..length]).is_err(),
            "{length} bytes"
        );
    }
}

#[test]
fn arbitrary_contents_are_refused_or_give_a_valid_record() {
    let bytes = encoded(&three_axes());
    let payload = &bytes[8..bytes.len() - 4];
    let mut accepted = 0;
    for i in 0..payload.len() {
        for value in 0..=u8::MAX {
            let mut payload = payload.to_vec();
            payload[i] = value;
            match Certificate::decode(&sealed(2, 1, &payload)) {
                Ok(record) => {
                    let again = encoded(&record);
                    assert_eq!(encoded(&Certificate::decode(&again).unwrap()), again);
                    accepted += 1;
                }
                Err(error) => assert_eq!(error, Error::Impossible, "byte {i} = {value}"),
            }
        }
    }
    assert!(accepted > payload.len());
    for length in 0..payload.len() {
        let short = Certificate::decode(&sealed(2, 1, &payload[..length]));
        assert_eq!(short, Err(Error::Impossible), "{length} bytes");
    }
}

/// A change that makes a certificate impossible, with its name.
type Spoil = (&'static str, fn(&mut Certificate));

#[test]
fn impossible_contents_are_refused_behind_a_right_checksum() {
    let measured = |record: &mut Certificate| {
        for term in record.axes.iter_mut().flat_map(|axis| &mut axis.terms) {
            term.state = CertifiedState::Measured;
            (term.lower, term.upper) = (0.5 * term.value, 2.0 * term.value + 1.0);
            term.square_error = 1.0;
        }
    };
    let conditions: &[Spoil] = &[
        ("no samples", |record| record.conditions.samples = 0),
        ("more gaps than samples", |record| {
            record.conditions.gaps = u64::MAX;
        }),
        ("more samples than time", |record| {
            record.conditions.samples <<= 1;
        }),
        ("no time", |record| record.conditions.duration_s = 0.0),
        ("endless time", |record| {
            record.conditions.duration_s = 1e300;
        }),
        ("a rate beyond all", |record| {
            record.conditions.rate_hz = 1e300;
        }),
        ("below absolute zero", |record| {
            record.conditions.temperature_c = Some((-300.0, 20.0));
        }),
    ];
    for (what, spoil) in conditions {
        let mut record = three_axes();
        spoil(&mut record);
        let mut buffer = vec![0; Certificate::MAX_BYTES];
        assert_eq!(record.encode(&mut buffer), Err(Error::Impossible), "{what}");
    }
    let contents: &[Spoil] = &[
        ("negative bound", |record| {
            record.axes[0].terms[0].upper = -5.0;
        }),
        ("unknown bound", |record| {
            record.axes[0].terms[0].upper = f32::NAN;
        }),
        ("negative lower end", |record| {
            record.axes[0].terms[0].lower = -1.0;
        }),
        ("endless measured interval", |record| {
            record.axes[0].terms[1].upper = f32::INFINITY;
        }),
        ("unknown error", |record| {
            record.axes[0].terms[1].square_error = f32::NAN;
        }),
        ("no time to wait", |record| {
            let term = &mut record.axes[0].terms[1];
            term.lower = 0.0;
            term.state = CertifiedState::NotObservable {
                after_s: Some(-1.0),
            };
        }),
        ("a lower end that was not measured", |record| {
            record.axes[0].terms[1].state = CertifiedState::UpperBound;
        }),
        ("one term eight times", |record| {
            let terms = &mut record.axes[0].terms;
            while terms.push(terms[1].clone()).is_ok() {}
        }),
        ("a shape that the effect does not have", |record| {
            let shape = record.axes[1].terms.last().unwrap().shape[0];
            record.axes[0].terms[1].shape.push(shape).unwrap();
        }),
        ("no shape", |record| {
            record.axes[1].terms.last_mut().unwrap().shape.clear();
        }),
        ("shape outside its interval", |record| {
            let shape = &mut record.axes[1].terms.last_mut().unwrap().shape[0];
            shape.value = shape.upper + 1.0;
        }),
        ("negative shape", |record| {
            let shape = &mut record.axes[1].terms.last_mut().unwrap().shape[0];
            (shape.value, shape.lower) = (-1.0, -2.0);
        }),
        ("99.5 stages", |record| stages(record, 99.5)),
        ("99 stages", |record| stages(record, 99.0)),
        ("χ² unknown and p known", |record| {
            record.axes[0].chi_squared = f64::NAN;
        }),
        ("negative χ²", |record| record.axes[0].chi_squared = -1.0),
        ("p above one", |record| record.axes[0].p_value = 1.5),
        ("unknown tolerance", |record| {
            record.axes[0].tolerance = f32::NAN;
        }),
        ("120 per cent", |record| {
            let (spikes, percent) = (3, 120);
            let reason = Reason::Spiked { spikes, percent };
            record.axes[0].verdict = Some(Verdict::Invalid(reason));
        }),
        ("more hits than samples", |record| {
            let (hits, samples) = (30, 20);
            let reason = Reason::Railed { hits, samples };
            record.axes[0].verdict = Some(Verdict::Invalid(reason));
        }),
    ];
    let mut good = three_axes();
    measured(&mut good);
    assert!(Certificate::decode(&encoded(&good)).is_ok());
    stages(&mut good, 2.0);
    assert!(Certificate::decode(&encoded(&good)).is_ok());
    for (what, spoil) in contents {
        let mut record = three_axes();
        measured(&mut record);
        spoil(&mut record);
        let decoded = Certificate::decode(&encoded(&record));
        assert_eq!(decoded, Err(Error::Impossible), "{what}");
    }
    // The last numbers of the payload are correlations of measured coefficients.
    let mut record = three_axes();
    measured(&mut record);
    let bytes = encoded(&record);
    let mut payload = bytes[8..bytes.len() - 4].to_vec();
    let last = payload.len() - 4;
    for wrong in [f32::NAN, 1.5, f32::INFINITY] {
        payload[last..].copy_from_slice(&wrong.to_le_bytes());
        let decoded = Certificate::decode(&sealed(2, 1, &payload));
        assert_eq!(decoded, Err(Error::Impossible), "a correlation of {wrong}");
    }
}

/// Turns the sinusoid into a decimation filter of this many stages.
fn stages(record: &mut Certificate, stages: f32) {
    let term = record.axes[1].terms.last_mut().unwrap();
    term.effect = EffectCode::of(&DecimationFilter);
    let mut shape = term.shape[0];
    (shape.value, shape.lower, shape.upper) = (stages, f32::NAN, f32::NAN);
    term.shape.truncate(1);
    term.shape.push(shape).unwrap();
}

#[test]
fn every_effect_of_the_catalogue_has_a_permanent_code() {
    let codes = CATALOGUE.map(|effect| EffectCode::of(effect).number());
    // Numbers never change, and new ones follow.
    assert!(codes.into_iter().eq(1..=21));
    for effect in CATALOGUE {
        let code = EffectCode::of(effect);
        assert_eq!(code.name(), effect.name());
        assert_eq!(code.effect().unwrap().name(), effect.name());
    }
    assert_eq!(EffectCode::OTHER.name(), "other");
    assert!(EffectCode::OTHER.effect().is_none());
}

#[test]
fn limits_of_detection_are_kept_and_a_record_without_them_has_the_first_version() {
    let version = |bytes: &[u8]| bytes[5];
    let mut record = three_axes();
    assert_eq!(version(&encoded(&record)), 1);
    let sinusoid = allanite::detection::Range {
        effect: &allanite::effect::Sinusoid,
        ends: (0.1, 10.0),
        size: 0.004,
        is_of_shape: false,
    };
    let filter = allanite::detection::Range {
        effect: &allanite::effect::LowPass,
        ends: (0.0, 0.0),
        size: 0.007,
        is_of_shape: true,
    };
    for range in [sinusoid, filter] {
        let limit = CertifiedLimit::of(&range);
        record.axes[1].limits.push(limit).unwrap();
    }
    let bytes = encoded(&record);
    assert_eq!(version(&bytes), 2);
    let read = Certificate::decode(&bytes).unwrap();
    assert!(read.axes[0].limits.is_empty());
    assert_eq!(read.axes[1].limits, record.axes[1].limits);
    let range = read.axes[1].limits[0].range().unwrap();
    assert_eq!(range.effect.name(), "sinusoid");
    assert!((range.size / 0.004 - 1.0).abs() < 1e-6 && !range.is_of_shape);
    assert!(read.axes[1].limits[1].range().unwrap().is_of_shape);
    for broken in [f32::NAN, -1.0, 0.0, f32::INFINITY] {
        record.axes[1].limits[0].size = broken;
        let bytes = encoded(&record);
        assert_eq!(Certificate::decode(&bytes), Err(Error::Impossible));
    }
}

#[test]
fn a_gyro_that_follows_its_temperature_and_has_a_line_says_both_after_reading_back() {
    let mut written = record("SN-1", RateUnit::DegreesPerSecond, &[followed()]);
    let bytes = encoded(&written);
    assert_eq!(bytes[5], 3, "the version with findings");
    let read = Certificate::decode(&bytes).unwrap();
    // NaN is not equal to itself, and stands for correlations that are not known.
    assert_eq!(encoded(&read), bytes);
    let axis = &read.axes[0];
    assert_eq!(axis.findings, written.axes[0].findings);
    let [slope] = axis.findings.covariates[..] else {
        panic!("{:?}", axis.findings)
    };
    // 20 counts of 1/131 deg/s.
    let off = f64::from(slope.value) - 20.0 / 131.0;
    assert!(off.abs() < 4.0 * f64::from(slope.error), "{slope:?}");
    assert!(
        f64::from(slope.error) < 0.05 * f64::from(slope.value),
        "{slope:?}"
    );
    let found: Vec<_> = axis.found().map(|term| term.effect.name()).collect();
    assert_eq!(found, ["sinusoid"]);
    assert_eq!(axis.verdict, Some(Verdict::Improved));

    for (what, spoil) in FINDINGS {
        let good = written.axes[0].findings.clone();
        spoil(&mut written.axes[0].findings);
        let decoded = Certificate::decode(&encoded(&written));
        assert_eq!(decoded, Err(Error::Impossible), "{what}");
        written.axes[0].findings = good;
    }
}

/// A change that makes findings impossible, with its name.
type SpoilFindings = (&'static str, fn(&mut Findings));

const FINDINGS: &[SpoilFindings] = &[
    ("a slope without an error", |found| {
        found.covariates[0].error = 0.0;
    }),
    ("an endless slope", |found| {
        found.covariates[0].value = f32::INFINITY;
    }),
    ("one covariate twice", |found| {
        found.covariates.push(found.covariates[0]).unwrap();
    }),
    (
        "a doubt about an effect that is not in the model",
        |found| {
            let effect = EffectCode::of(&DecimationFilter);
            found
                .doubts
                .push(Doubt {
                    effect,
                    other: effect,
                })
                .unwrap();
        },
    ),
    ("a band that ends before it begins", |found| {
        let band = CertifiedBand {
            from_hz: 2.0,
            to_hz: 1.0,
            z: 6.0,
        };
        found.bands.clear();
        found.bands.push(band).unwrap();
    }),
    ("a band above half of the sample rate", |found| {
        let band = CertifiedBand {
            from_hz: 40.0,
            to_hz: 60.0,
            z: 6.0,
        };
        found.bands.clear();
        found.bands.push(band).unwrap();
    }),
    ("an event after the record", |found| {
        found.events = Some(
            [CertifiedEvent {
                at_s: 800.0,
                ..STEP
            }]
            .into_iter()
            .collect(),
        );
    }),
    ("an event at no time", |found| {
        found.events = Some(
            [CertifiedEvent {
                at_s: f32::NAN,
                ..STEP
            }]
            .into_iter()
            .collect(),
        );
    }),
    ("an event outside its interval", |found| {
        found.events = Some([CertifiedEvent { size: 0.4, ..STEP }].into_iter().collect());
    }),
    ("bursts in more parts than there are", |found| {
        let what = CertifiedWhat::Bursts { blocks: 65 };
        found.events = Some([CertifiedEvent { what, ..STEP }].into_iter().collect());
    }),
    ("a warm-up without a time constant", |found| {
        let what = CertifiedWhat::WarmUp {
            time_constant_s: 0.0,
        };
        found.events = Some([CertifiedEvent { what, ..STEP }].into_iter().collect());
    }),
];

const STEP: CertifiedEvent = CertifiedEvent {
    what: CertifiedWhat::Step,
    at_s: 60.0,
    size: 0.1,
    lower: 0.08,
    upper: 0.12,
    z: 9.0,
};

#[test]
fn events_and_doubts_are_kept_and_a_stationary_record_says_so() {
    let mut record = three_axes();
    let sinusoid = record.axes[1].terms.last().unwrap().effect;
    let kinds = [
        CertifiedWhat::NoiseChange,
        CertifiedWhat::Bursts { blocks: 8 },
        CertifiedWhat::Step,
        CertifiedWhat::WarmUp {
            time_constant_s: 60.0,
        },
    ];
    let events = kinds.map(|what| CertifiedEvent { what, ..STEP });
    let found = &mut record.axes[1].findings;
    found.events = Some(events.into_iter().collect());
    let doubt = Doubt {
        effect: sinusoid,
        other: EffectCode::of(&DecimationFilter),
    };
    found.doubts.push(doubt).unwrap();
    record.axes[2].findings.events = Some(Default::default());
    let read = Certificate::decode(&encoded(&record)).unwrap();
    for (read, written) in read.axes.iter().zip(&record.axes) {
        assert_eq!(read.findings, written.findings);
    }
    let stationary = [0, 1, 2].map(|i: usize| read.axes[i].findings.is_stationary());
    assert_eq!(stationary, [None, Some(false), Some(true)]);
    let event = read.axes[1].findings.events.as_ref().unwrap()[3].event();
    assert!(matches!(event.what, What::WarmUp { time_constant_s } if time_constant_s == 60.0));
}

#[test]
fn largest_record_fits_and_a_larger_one_is_refused() {
    let mut largest = three_axes();
    let axes = largest.axes;
    largest = Certificate::new(&[0xFF; 16], [0; 3], largest.conditions, largest.unit).unwrap();
    largest.axes = axes;
    largest.conditions.samples = 1 << 63;
    largest.conditions.gaps = 1 << 63;
    largest.conditions.duration_s = 1e12;
    largest.conditions.rate_hz = 1e9;
    largest.firmware = [u16::MAX; 3];
    for axis in &mut largest.axes {
        while axis.terms.push(axis.terms[0].clone()).is_ok() {}
        for term in &mut axis.terms {
            // Only effects without a code can be there more than once.
            term.effect = EffectCode::OTHER;
            term.state = CertifiedState::NotObservable { after_s: Some(1.0) };
            term.lower = 0.0;
            let one = allanite::storage::CertifiedShape {
                value: 1.0,
                lower: 0.5,
                upper: 2.0,
            };
            while term.shape.push(one).is_ok() {}
        }
        let limit = CertifiedLimit {
            effect: EffectCode::OTHER,
            size: 1.0,
            low: 0.5,
            high: 2.0,
        };
        while axis.limits.push(limit).is_ok() {}
        let found = &mut axis.findings;
        for covariate in [0, 1] {
            let slope = CertifiedSlope {
                covariate,
                value: 1.0,
                error: 0.1,
            };
            found.covariates.push(slope).unwrap();
        }
        let doubt = Doubt {
            effect: EffectCode::OTHER,
            other: EffectCode::OTHER,
        };
        while found.doubts.push(doubt).is_ok() {}
        let band = CertifiedBand {
            from_hz: 1.0,
            to_hz: 2.0,
            z: 6.0,
        };
        while found.bands.push(band).is_ok() {}
        let what = CertifiedWhat::WarmUp {
            time_constant_s: 60.0,
        };
        let events = std::iter::repeat_n(CertifiedEvent { what, ..STEP }, 8);
        found.events = Some(events.collect());
        axis.degrees_of_freedom = u16::MAX;
        axis.verdict = Some(Verdict::Invalid(Reason::Stuck {
            longest_run: u32::MAX,
            changes: u64::MAX,
            samples: u64::MAX,
        }));
    }
    let bytes = encoded(&largest);
    assert!(bytes.len() <= Certificate::MAX_BYTES && bytes.len() + 8 > Certificate::MAX_BYTES);
    assert_eq!(encoded(&Certificate::decode(&bytes).unwrap()), bytes);
    let mut buffer = vec![0; bytes.len() - 1];
    let needed = Certificate::MAX_BYTES;
    assert_eq!(
        largest.encode(&mut buffer),
        Err(Error::BufferTooSmall { needed })
    );

    let long = Certificate::new(
        &[0; 17],
        [0; 3],
        largest.conditions,
        RateUnit::RadiansPerSecond,
    );
    assert_eq!(
        long,
        Err(Error::DeviceTooLong {
            length: 17,
            capacity: 16
        })
    );
    largest.conditions.rate_hz = 0.0;
    let mut buffer = vec![0; needed];
    assert_eq!(largest.encode(&mut buffer), Err(Error::Impossible));
}

#[test]
fn format_has_not_changed_since_it_was_frozen() {
    let bytes: Vec<u8> = (0..FROZEN.len())
        .step_by(2)
        .map(|i| u8::from_str_radix(&FROZEN[i..i + 2], 16).unwrap())
        .collect();
    let record = Certificate::decode(&bytes).unwrap();
    assert_eq!(encoded(&record), bytes);
    assert_eq!(record.device, b"SN-1");
    assert_eq!(record.firmware, [1, 2, 300]);
    let conditions = record.conditions;
    assert_eq!(conditions.temperature_c, Some((22.5, 24.25)));
    assert_eq!((conditions.duration_s, conditions.rate_hz), (655.36, 100.0));
    assert_eq!((conditions.samples, conditions.gaps), (65_536, 3));
    assert_eq!(record.unit, RateUnit::RadiansPerSecond);
    let [axis] = &record.axes[..] else {
        panic!("{record:?}")
    };
    assert_eq!(
        (axis.chi_squared, axis.p_value, axis.tolerance),
        (12.5, 0.25, 0.5)
    );
    assert_eq!(axis.degrees_of_freedom, 11);
    let reason = Reason::Moved {
        motions: 5,
        cluster: 300,
        percent: 40,
    };
    assert_eq!(axis.verdict, Some(Verdict::Invalid(reason)));
    let [white, sinusoid] = &axis.terms[..] else {
        panic!("{axis:?}")
    };
    assert_eq!(white.effect.name(), "angle_random_walk");
    assert_eq!((white.value, white.lower, white.upper), (0.5, 0.25, 0.75));
    assert_eq!(
        (white.state, white.square_error),
        (CertifiedState::Measured, 0.125)
    );
    assert_eq!(sinusoid.effect.name(), "sinusoid");
    assert_eq!(
        sinusoid.state,
        CertifiedState::NotObservable { after_s: Some(8.0) }
    );
    let shape = sinusoid.shape[0];
    assert_eq!((shape.value, shape.lower, shape.upper), (8.0, 7.0, 9.0));
    assert_eq!(axis.correlations.get(1, 0), -0.5);
    assert_eq!(axis.covariance(1, 0), -0.5 * 0.125 * 0.5);
}

/// A record of one axis with two terms in version 1 of the format, packed by hand from the table in
/// `src/storage/certificate/mod.rs`.
const FROZEN: &str = "414c4e5402017f0004534e2d310102ac02010000b4410000c2417b14ae47e17a844000000000000059408080\
    040301010000000000002940000000000000d03f0b0000003f040305ac022802020000003f0000803e000040\
    3f0000003e0000070000004000000000000080400000003f02010000004101000000410000e0400000104100\
    0000bf3f6debd2";

/// The limit of detection and the findings that version 3 has behind the correlations of an axis, packed by hand from
/// the same table: no limits; 0.5 ± 0.25 for covariate 1; the sinusoid or effect 6; 1 … 2 Hz at 6 σ; a step.
const FROZEN_FINDINGS: &str = "00\
    01010000003f0000803e\
    010706\
    010000803f000000400000c040\
    01010200007042000080be000000bf000000000000c0c0";

/// A limit of detection as version 2 has it: a sinusoid of 0.5 from 1 Hz to 2 Hz.
const FROZEN_LIMIT: &str = "01070000003f0000803f00000040";

#[test]
fn later_versions_have_not_changed_since_they_were_frozen() {
    let bytes = |hex: &str| -> Vec<u8> {
        let at = (0..hex.len()).step_by(2);
        at.map(|i| u8::from_str_radix(&hex[i..i + 2], 16).unwrap())
            .collect()
    };
    let first = bytes(FROZEN);
    let payload = |more: &str| [&first[8..first.len() - 4], &bytes(more)].concat();

    let second = sealed(2, 2, &payload(FROZEN_LIMIT));
    let record = Certificate::decode(&second).unwrap();
    let [limit] = record.axes[0].limits[..] else {
        panic!("{record:?}")
    };
    assert_eq!(limit.effect.name(), "sinusoid");
    assert_eq!((limit.size, limit.low, limit.high), (0.5, 1.0, 2.0));
    assert!(record.axes[0].findings.is_empty());
    assert_eq!(encoded(&record), second);

    let third = sealed(2, 3, &payload(FROZEN_FINDINGS));
    let record = Certificate::decode(&third).unwrap();
    let found = &record.axes[0].findings;
    let slope = CertifiedSlope {
        covariate: 1,
        value: 0.5,
        error: 0.25,
    };
    assert_eq!(found.covariates[..], [slope]);
    let [doubt] = found.doubts[..] else {
        panic!("{found:?}")
    };
    assert_eq!((doubt.effect.number(), doubt.other.number()), (7, 6));
    let band = CertifiedBand {
        from_hz: 1.0,
        to_hz: 2.0,
        z: 6.0,
    };
    assert_eq!(found.bands[..], [band]);
    let step = CertifiedEvent {
        what: CertifiedWhat::Step,
        at_s: 60.0,
        size: -0.25,
        lower: -0.5,
        upper: 0.0,
        z: -6.0,
    };
    assert_eq!(found.events.as_ref().unwrap()[..], [step]);
    assert_eq!(encoded(&record), third);
    // A version to come is refused and not misread.
    let unknown = Error::UnknownVersion { found: 4, known: 3 };
    let later = Certificate::decode(&sealed(2, 4, &payload(FROZEN_FINDINGS)));
    assert_eq!(later, Err(unknown));
}
