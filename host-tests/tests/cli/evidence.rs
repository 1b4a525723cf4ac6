//! Tests `diagnose` with the evidence beside the curve: whether the record is valid, and whether it
//! depends on a covariate.

use crate::{INVALID, record_over_time::change};
use allanite::diagnosis::Verdict;
use allanite_host::verdict::{ADEQUATE, NOT_STATIONARY, brief, sentence};
use program::{json, measure_without_spectrum, output, refusal, run};
use serde_json::Value;
use std::{fs, path::Path};
use tempfile::TempDir;

/// Writes the log of a consumer gyro, 2^16 samples at 100 Hz, with hidden effects.
fn simulate(folder: &Path, effects: &[&str]) {
    let simulate = ["simulate", "mems", "--duration", "655.36", "--seed", "5"];
    let mut arguments = [&simulate[..], &["--output", "log.csv"]].concat();
    for effect in effects {
        arguments.extend(["--effect", effect]);
    }
    output(folder, &arguments);
}

/// Returns the rate that replaces the given one: `change(index, rate)`.
type Change<'a> = &'a mut dyn FnMut(usize, f64) -> f64;

fn list(value: &Value) -> Vec<&str> {
    let list = value.as_array().unwrap();
    list.iter().map(|text| text.as_str().unwrap()).collect()
}

#[test]
fn a_disturbed_record_is_invalid_and_blames_no_effect() {
    let folder = TempDir::new().unwrap();
    let mut held = 0.0;
    let cases: [(&str, &str, Change<'_>); 3] = [
        ("moved", "moved", &mut |i, rate| {
            let turned = (30_000..30_400).contains(&i);
            rate + if turned { 20.0 } else { 0.0 }
        }),
        ("stuck", "equal values", &mut |i, rate| {
            if !(40_000..60_000).contains(&i) {
                held = rate;
            }
            held
        }),
        ("spike", "spike", &mut |i, rate| {
            if i == 12_345 { 500.0 } else { rate }
        }),
    ];
    for (name, word, disturb) in cases {
        simulate(folder.path(), &[]);
        change(folder.path(), disturb);
        let document = json(folder.path(), &["diagnose", "log.csv"]);
        let axis = &document["axes"][0];
        assert_eq!(axis["verdict"], INVALID.name(), "{name}");
        assert!(list(&axis["missing"]).is_empty() && list(&axis["ambiguous"]).is_empty());
        let steps = axis["steps"].as_array().unwrap();
        assert_eq!(steps.len(), 1);
        assert!(
            steps[0]["added"].is_null() && steps[0]["candidates"].as_array().unwrap().is_empty()
        );
        let notes = list(&axis["notes"]);
        assert!(
            notes.iter().any(|note| note.contains(word)),
            "{name}: {notes:?}"
        );
        let text = output(folder.path(), &["diagnose", "log.csv"]);
        let said = sentence::invalid("");
        assert!(text.contains(said.trim_end_matches('.')), "{text}");
        assert!(notes.iter().all(|note| text.contains(note)), "{text}");
    }
}

#[test]
fn the_share_of_rounding_is_told() {
    let folder = TempDir::new().unwrap();
    simulate(folder.path(), &[]);
    // The noise is about 0.8 counts, to which rounding adds some 8 %.
    change(folder.path(), |_, rate: f64| (rate / 0.07).round());
    let document = json(folder.path(), &["fit", "log.csv", "--scale", "0.07"]);
    let fitted = list(&document["axes"][0]["notes"]);
    let [note] = fitted[..] else {
        panic!("{fitted:?}")
    };
    let percent = note.strip_prefix("rounding of the values raises angle random walk by ");
    let percent = percent.and_then(|rest| rest.split(' ').next()?.parse::<f64>().ok());
    assert!(
        percent.is_some_and(|percent| (6.0..11.0).contains(&percent)),
        "{note}"
    );
    let value = note.split("without it, it is ").nth(1).unwrap();
    let value: f64 = value.split(' ').next().unwrap().parse().unwrap();
    // The gyro has 0.005 deg/√s, which is 0.3 °/√h.
    assert!((value / 0.3 - 1.0).abs() < 0.03, "{note}");
    let text = output(folder.path(), &["fit", "log.csv", "--scale", "0.07"]);
    assert!(text.contains(note), "{text}");
    let diagnosed = json(folder.path(), &["diagnose", "log.csv", "--scale", "0.07"]);
    assert!(list(&diagnosed["axes"][0]["notes"]).contains(&note));
}

#[test]
fn noise_below_half_a_count_is_invalid() {
    let folder = TempDir::new().unwrap();
    simulate(folder.path(), &[]);
    change(folder.path(), |_, rate: f64| (rate / 0.2).round());
    let document = json(folder.path(), &["fit", "log.csv", "--scale", "0.2"]);
    let fitted = list(&document["axes"][0]["notes"]);
    assert!(
        fitted[0].starts_with("the noise is below half a count"),
        "{fitted:?}"
    );
    let text = output(folder.path(), &["fit", "log.csv", "--scale", "0.2"]);
    assert!(text.contains("The curve is not valid: the noise is below half a count"));
    assert!(!text.contains(ADEQUATE), "{text}");
    let diagnosed = json(folder.path(), &["diagnose", "log.csv", "--scale", "0.2"]);
    let axis = &diagnosed["axes"][0];
    assert_eq!(axis["verdict"], INVALID.name());
    let notes = list(&axis["notes"]);
    assert!(notes[0].contains("below half a count"), "{notes:?}");
}

#[test]
fn floats_that_were_rounded_more_coarsely_than_their_noise_are_invalid() {
    let folder = TempDir::new().unwrap();
    simulate(folder.path(), &[]);
    // Steps of 0.15 °/s, three times the white noise of a sample, and an offset between two of them.
    change(folder.path(), |_, rate: f64| {
        ((rate + 0.04) / 0.15).round() * 0.15
    });
    let diagnosed = json(folder.path(), &["diagnose", "log.csv"]);
    let axis = &diagnosed["axes"][0];
    assert_eq!(axis["verdict"], INVALID.name());
    let notes = list(&axis["notes"]);
    assert!(notes[0].contains("below half a count"), "{notes:?}");
    let fitted = output(folder.path(), &["fit", "log.csv"]);
    assert!(
        fitted.contains("The curve is not valid: the noise is below half a count"),
        "{fitted}"
    );
}

#[test]
fn a_temperature_is_found_and_printed_with_its_slope() {
    let folder = TempDir::new().unwrap();
    simulate(
        folder.path(),
        &["thermal:slope=0.03,kelvin=10,period_s=300"],
    );
    let diagnose = ["diagnose", "log.csv", "--covariates", "temp_C"];
    let document = json(folder.path(), &diagnose);
    let axis = &document["axes"][0];
    assert_eq!(list(&axis["missing"]), ["covariate"]);
    assert_eq!(axis["steps"][0]["added"], "covariate");
    let effect = &axis["steps"][1]["effects"][0];
    assert_eq!(
        (&effect["name"], &effect["channel"]),
        (&"covariate".into(), &"temp_C".into())
    );
    let parameter = |name: &str| effect["parameters"][name].as_f64().unwrap();
    let slope = parameter("slope");
    assert!((slope / 0.03 - 1.0).abs() < 0.1, "{slope}");
    assert!(parameter("slope_lower") < 0.03 && 0.03 < parameter("slope_upper"));
    // Without the column of the temperature, the slow part of the curve gets another name or none.
    let blind = json(folder.path(), &["diagnose", "log.csv", "--no-covariates"]);
    assert!(!list(&blind["axes"][0]["missing"]).contains(&"covariate"));
    let text = output(folder.path(), &diagnose);
    assert!(text.contains("1. + covariate temp_C: "), "{text}");
    assert!(text.contains("missing effect: covariate temp_C"), "{text}");
}

/// Rewrites the rates of a log with a temperature: `change(rate, temperature, change of temperature per second)`.
fn change_with_temperature(folder: &Path, change: impl Fn(f64, f64, f64) -> f64) {
    let path = folder.join("log.csv");
    let text = fs::read_to_string(&path).unwrap();
    let mut before = None;
    let lines = text.lines().map(|line| {
        let numbers = line
            .split_once(',')
            .map(|(rate, celsius)| (rate.parse(), celsius.parse()));
        let Some((Ok(rate), Ok(celsius))) = numbers else {
            return line.to_owned();
        };
        let per_second = 100.0 * (celsius - before.replace(celsius).unwrap_or(celsius));
        format!("{},{celsius}", change(rate, celsius, per_second))
    });
    let changed = lines.collect::<Vec<_>>().join("\n");
    fs::write(path, changed + "\n").unwrap();
}

#[test]
fn a_temperature_and_its_rate_are_tried_without_being_asked_for() {
    let folder = TempDir::new().unwrap();
    let thermal = "thermal:slope=0.03,kelvin=10,period_s=300";
    let channels = |document: &Value| {
        let all = document["axes"][0]["covariates"]
            .as_array()
            .unwrap()
            .clone();
        let one = |tried: &Value| {
            (
                tried["channel"].as_str().unwrap().to_owned(),
                tried["acts"] == true,
            )
        };
        all.iter().map(one).collect::<Vec<_>>()
    };
    let both = |temperature, rate| {
        let named = [("temp_C", temperature), ("rate(temp_C)", rate)];
        named.map(|(name, acts)| (name.to_owned(), acts)).to_vec()
    };
    // Either acts alone, both, or none.
    for (slope, rate_slope) in [(0.03, 0.0), (0.0, 1.0), (0.03, 1.0), (0.0, 0.0)] {
        simulate(folder.path(), &[thermal]);
        change_with_temperature(folder.path(), |rate, celsius, per_second| {
            rate + (slope - 0.03) * (celsius - 25.0) + rate_slope * per_second
        });
        let expected = both(slope != 0.0, rate_slope != 0.0);
        for command in ["fit", "diagnose"] {
            let document = json(folder.path(), &[command, "log.csv"]);
            assert_eq!(
                channels(&document),
                expected,
                "{command}: {slope}, {rate_slope}"
            );
            let text = output(folder.path(), &[command, "log.csv"]);
            let of_temperature = match slope {
                0.0 => "tried temp_C: no dependence above 0.0",
                _ => "tried temp_C: the rate follows it with 0.0",
            };
            assert!(
                text.contains(of_temperature) && text.contains(" deg/s per K"),
                "{text}"
            );
            assert!(
                text.contains("tried rate(temp_C): ") && text.contains(" deg/s per K/s"),
                "{text}"
            );
        }
        let document = json(folder.path(), &["diagnose", "log.csv"]);
        let axis = &document["axes"][0];
        let acts = expected.iter().filter(|(_, acts)| *acts).count();
        let effects = axis["steps"].as_array().unwrap().last().unwrap()["effects"]
            .as_array()
            .unwrap()
            .clone();
        let followed = effects
            .iter()
            .filter(|effect| effect["name"] == "covariate");
        assert_eq!(followed.count(), acts, "{slope}, {rate_slope}");
        assert_eq!(
            list(&axis["missing"]).len(),
            acts.min(1),
            "{}",
            axis["missing"]
        );
        for (tried, truth) in axis["covariates"]
            .as_array()
            .unwrap()
            .iter()
            .zip([slope, rate_slope])
        {
            let ends = ["slope_lower", "slope_upper"].map(|end| tried[end].as_f64().unwrap());
            let spare = ends[1] - ends[0];
            assert!(
                ends[0] - spare < truth && truth < ends[1] + spare,
                "{tried}: {truth}"
            );
        }
        let without = json(folder.path(), &["fit", "log.csv", "--no-covariates"]);
        assert!(channels(&without).is_empty());
    }
}

#[test]
fn a_temperature_that_is_no_number_is_left_out_with_a_note() {
    let folder = TempDir::new().unwrap();
    simulate(
        folder.path(),
        &["thermal:slope=0.03,kelvin=10,period_s=300"],
    );
    let path = folder.path().join("log.csv");
    let text = fs::read_to_string(&path).unwrap();
    let line = text.lines().nth(500).unwrap().to_owned();
    let rate = line.split(',').next().unwrap();
    fs::write(&path, text.replacen(&line, &format!("{rate},nan"), 1)).unwrap();
    let document = json(folder.path(), &["diagnose", "log.csv"]);
    assert!(
        document["axes"][0]["covariates"]
            .as_array()
            .unwrap()
            .is_empty()
    );
    // A column that is asked for stays, and the sample is lost.
    let run = run(folder.path(), &["fit", "log.csv", "--covariates", "temp_C"]);
    let notes = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(
        notes.contains("1 sample lost in row 501: axis temp_C"),
        "{notes}"
    );
}

#[test]
fn motion_about_one_axis_is_told_of_all_axes_and_export_refuses_it() {
    let folder = TempDir::new().unwrap();
    let simulate = [
        "simulate",
        "mems",
        "--duration",
        "655.36",
        "--seed",
        "5",
        "--axes",
        "3",
    ];
    output(
        folder.path(),
        &[&simulate[..], &["--output", "log.csv"]].concat(),
    );
    let path = folder.path().join("log.csv");
    let text = fs::read_to_string(&path).unwrap();
    let mut row = 0;
    let lines = text.lines().map(|line| {
        let values: Option<Vec<f64>> = line.split(',').map(|value| value.parse().ok()).collect();
        let Some(mut values) = values else {
            return line.to_owned();
        };
        row += 1;
        values[1] += if (30_000..30_400).contains(&row) {
            20.0
        } else {
            0.0
        };
        let values: Vec<String> = values.iter().map(f64::to_string).collect();
        values.join(",")
    });
    let moved = lines.collect::<Vec<_>>().join("\n") + "\n";
    fs::write(&path, moved).unwrap();
    let diagnosed = json(folder.path(), &["diagnose", "log.csv"]);
    let fitted = json(folder.path(), &["fit", "log.csv"]);
    for at in 0..3 {
        let axis = &diagnosed["axes"][at];
        assert_eq!(axis["verdict"], INVALID.name());
        let event = &axis["events"][0];
        assert_eq!(event["what"], "motion");
        let at_s = event["at_s"].as_f64().unwrap();
        assert!((at_s - 300.0).abs() < 2.0, "{at_s}");
        let invalid = fitted["axes"][at]["invalid"].as_str().unwrap();
        assert!(invalid.contains("the gyro was moved"), "{invalid}");
        assert_eq!(invalid.contains("seen in axis gy"), at != 1, "{invalid}");
        assert!(list(&axis["notes"]).contains(&invalid), "{}", axis["notes"]);
    }
    let text = output(folder.path(), &["fit", "log.csv"]);
    assert_eq!(
        text.matches("The curve is not valid: the gyro was moved")
            .count(),
        3,
        "{text}"
    );
    assert!(!text.contains(ADEQUATE), "{text}");
    let export = ["export", "log.csv", "--format", "kalibr"];
    let refused = refusal(folder.path(), &export);
    assert!(
        refused.contains("was moved") && refused.contains("--despite-invalid"),
        "{refused}"
    );
    let told = [&export[..], &["--despite-invalid"]].concat();
    assert!(output(folder.path(), &told).contains("gyroscope_noise_density"));
}

#[test]
fn a_rate_of_change_is_a_covariate_and_an_unrelated_column_is_not_blamed() {
    let folder = TempDir::new().unwrap();
    simulate(
        folder.path(),
        &["thermal:slope=0.03,kelvin=10,period_s=300"],
    );
    let both = "temp_C,rate(temp_C)";
    let document = json(
        folder.path(),
        &["diagnose", "log.csv", "--covariates", both],
    );
    let effect = &document["axes"][0]["steps"][1]["effects"][0];
    assert_eq!(effect["channel"], "temp_C");
    // This is an unrelated temperature, as if it were of another day.
    let other = fs::read_to_string(folder.path().join("log.csv")).unwrap();
    simulate(folder.path(), &[]);
    let own = fs::read_to_string(folder.path().join("log.csv")).unwrap();
    let temperature = |line: &str| line.split(',').nth(1).unwrap_or_default().to_owned();
    let joined = own.lines().zip(other.lines()).skip(1);
    let joined = joined.map(|(own, other)| format!("{own},{}\n", temperature(other)));
    let log = "# rate_hz=100 unit=deg/s\n".to_owned() + &joined.collect::<String>();
    fs::write(folder.path().join("log.csv"), log).unwrap();
    let document = json(
        folder.path(),
        &["diagnose", "log.csv", "--covariates", "temp_C"],
    );
    assert_eq!(document["axes"][0]["verdict"], Verdict::Adequate.name());
}

#[test]
fn two_effects_that_resemble_a_third_are_distinguished_from_it() {
    let folder = TempDir::new().unwrap();
    let hidden = [
        "sinusoid:frequency_hz=7.7,amplitude=0.0267",
        "decimation_filter:width_s=0.0235,stages=2",
    ];
    simulate(folder.path(), &hidden);
    // The spectrum shows both at once.
    let document = json(folder.path(), &["diagnose", "log.csv"]);
    let axis = &document["axes"][0];
    let mut missing = list(&axis["missing"]);
    missing.sort_unstable();
    assert_eq!(missing, ["decimation_filter", "sinusoid"]);
    // In the octaves, they resemble a resonance.
    measure_without_spectrum(folder.path(), "log.csv");
    let document = json(folder.path(), &["diagnose", "curve.json"]);
    let axis = &document["axes"][0];
    let named = [list(&axis["missing"]), list(&axis["ambiguous"])].concat();
    assert!(
        named.contains(&"sinusoid")
            && (named.contains(&"decimation_filter") || named.contains(&"low_pass")),
        "{named:?}"
    );
    assert!(!list(&axis["missing"]).contains(&"resonance"));
}

#[test]
fn impossible_covariates_are_refused() {
    let folder = TempDir::new().unwrap();
    simulate(
        folder.path(),
        &["thermal:slope=0.03,kelvin=10,period_s=300"],
    );
    let refused = |covariates: &str| {
        refusal(
            folder.path(),
            &["diagnose", "log.csv", "--covariates", covariates],
        )
    };
    assert!(refused("temp").contains("there is no column \"temp\""));
    assert!(refused("gx").contains("\"gx\" is an axis"));
    output(
        folder.path(),
        &["measure", "log.csv", "--output", "curve.json"],
    );
    let of_a_curve = ["diagnose", "curve.json", "--covariates", "temp_C"];
    assert!(refusal(folder.path(), &of_a_curve).contains("a curve file has no covariates"));
}

#[test]
fn a_record_in_which_something_happened_is_not_called_adequate() {
    let folder = TempDir::new().unwrap();
    simulate(folder.path(), &[]);
    let steady = json(folder.path(), &["diagnose", "log.csv"]);
    assert_eq!(steady["axes"][0]["verdict"], Verdict::Adequate.name());
    assert_eq!(steady["axes"][0]["events"].as_array().unwrap().len(), 0);

    // The rate steps by 0.3 °/s at 300 s. A step of this size hardly moves χ², because the walk and the ramp take it up.
    change(folder.path(), |n, rate| {
        rate + if n < 30_000 { 0.0 } else { 0.3 }
    });
    let document = json(folder.path(), &["diagnose", "log.csv"]);
    let axis = &document["axes"][0];
    assert_eq!(axis["verdict"], NOT_STATIONARY);
    let event = &axis["events"][0];
    assert_eq!(event["what"], "step");
    let [at_s, size] = ["at_s", "size"].map(|key| event[key].as_f64().unwrap());
    // A block lasts 10.24 s.
    assert!((at_s - 300.0).abs() < 10.24, "{at_s}");
    assert!((size - 0.3).abs() < 0.02, "{size}");
    let notes = list(&axis["notes"]);
    let without = notes
        .iter()
        .find(|note| note.starts_with("without the change of the rate"));
    assert!(without.is_some(), "{notes:?}");
    let blamed = notes
        .iter()
        .find(|note| note.starts_with("because of it, "));
    assert!(
        blamed.is_some_and(|note| note.contains("rate random walk")),
        "{notes:?}"
    );
    let text = output(folder.path(), &["diagnose", "log.csv"]);
    let said = sentence::not_stationary("the rate stepped by 0.29", "");
    let said = said.trim_end_matches("; ");
    assert!(text.contains(&format!("gx: {said}")), "{text}");
    assert!(!text.contains(&brief(Verdict::Adequate, "")), "{text}");
}
