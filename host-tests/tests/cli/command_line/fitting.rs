//! Fits logs and curves to coefficients on the command line.

use super::{Document, fit, folder};
use allanite::diagnosis::Verdict;
use program::{output, refusal};
use std::fs;
use tempfile::TempDir;

#[test]
fn fit_prints_the_documented_json() {
    let folder = folder();
    let document = fit(folder.path(), &["curve.json"]);
    let names: Vec<_> = document
        .axes
        .iter()
        .map(|axis| axis.axis.as_str())
        .collect();
    assert_eq!(names, ["gx", "gy", "gz"]);
    for axis in &document.axes {
        assert_eq!((axis.rate_hz, axis.unit.as_str()), (100.0, "deg/s"));
        assert_eq!(axis.method, "covariance");
        assert_eq!(axis.adequate, axis.p_value.map(|p| p >= 0.01));
        assert!(axis.adequate.is_some());
        let is_adequate = axis.verdict.as_deref() == Some(Verdict::Adequate.name());
        assert_eq!(axis.adequate, Some(is_adequate));
        assert!(axis.missing.is_empty());
        assert!(axis.birge_ratio >= 1.0 && axis.notes.is_empty());
        assert!(axis.invalid.is_none() && axis.reason.is_none() && axis.covariates.is_empty());
        assert_eq!(axis.octaves[0].differences, 19_999);
        for (k, octave) in axis.octaves.iter().enumerate() {
            assert_eq!(
                (octave.m, octave.tau_s),
                (1 << k, f64::from(1 << k) / 100.0)
            );
            assert!(octave.variance > 0.0);
        }
        let terms: Vec<_> = axis
            .coefficients
            .iter()
            .map(|c| (c.effect.as_str(), c.symbol.as_str(), c.unit.as_str()))
            .collect();
        assert_eq!(
            terms,
            [
                ("quantization", "Q", "deg"),
                ("angle_random_walk", "N", "deg/s/√Hz"),
                ("bias_instability", "B", "deg/s"),
                ("rate_random_walk", "K", "deg/s/√s"),
                ("rate_ramp", "R", "deg/s²"),
            ]
        );
        for coefficient in &axis.coefficients {
            let states = ["measured", "upper_bound", "not_observable"];
            assert!(states.contains(&coefficient.state.as_str()));
            if coefficient.state == "measured" {
                let [lower, value, upper] =
                    [coefficient.lower, coefficient.value, coefficient.upper].map(Option::unwrap);
                assert!(0.0 < lower && lower < value && value < upper);
            }
        }
        let white = &axis.coefficients[1];
        assert!(
            (white.value.unwrap() / 5e-3 - 1.0).abs() < 0.05,
            "{:?}",
            white.value
        );
        assert!(axis.dof.unwrap() > 5 && axis.chi2.unwrap() > 0.0);
        assert!((0.0..=1.0).contains(&axis.p_value.unwrap()));
        // The gyro has no offset. The deviance of a model that explains the record is near its χ².
        assert!(axis.mean_rate.unwrap().abs() < 0.1, "{:?}", axis.mean_rate);
        let ratio = axis.deviance.unwrap() / axis.chi2.unwrap();
        assert!((0.7..1.4).contains(&ratio), "{ratio}");
    }
}

#[test]
fn log_and_its_curve_give_the_same_fit() {
    let folder = folder();
    let from_log = output(folder.path(), &["fit", "log.csv"]);
    assert_eq!(from_log, output(folder.path(), &["fit", "curve.json"]));
    let json = output(folder.path(), &["fit", "--json", "log.csv"]);
    assert_eq!(
        json,
        output(folder.path(), &["fit", "--json", "curve.json"])
    );
    for word in [
        "°/√h",
        "°/h",
        "arcsec",
        "95 % interval",
        "degrees of freedom",
        "five-term model",
    ] {
        assert!(from_log.contains(word), "{word}");
    }
}

#[test]
fn all_formats_of_a_simulated_log_give_the_same_fit() {
    let folder = folder();
    let simulate = |name: &str, more: &[&str]| {
        let duration = [
            "simulate",
            "tactical",
            "--duration",
            "100",
            "--axes",
            "2",
            "--output",
            name,
        ];
        output(folder.path(), &[&duration, more].concat());
    };
    for more in [&[][..], &["--scale", "0.001"]] {
        for name in ["a.csv", "a.csv.gz", "a.npy"] {
            simulate(name, more);
        }
        // A file beside the array tells its rate, unit and scale.
        let [text, packed, array] = [&["a.csv"][..], &["a.csv.gz"], &["a.npy"]]
            .map(|arguments| output(folder.path(), &[&["fit", "--json"], arguments].concat()));
        assert_eq!(text, packed);
        assert_eq!(text, array);
    }
}

#[test]
fn every_method_is_named_and_reports_its_statistics() {
    let folder = folder();
    for (method, judges) in [
        ("ordinary", false),
        ("accurate-part", false),
        ("relative-accuracy", true),
        ("cluster-count", false),
        ("covariance", true),
    ] {
        let document = fit(folder.path(), &["curve.json", "--method", method]);
        for axis in &document.axes {
            assert_eq!(axis.method, method);
            let judged = [
                axis.chi2.is_some(),
                axis.dof.is_some(),
                axis.p_value.is_some(),
            ];
            assert_eq!(judged, [judges; 3], "{method}");
            assert_eq!(axis.adequate.is_some(), method == "covariance");
        }
        output(folder.path(), &["fit", "curve.json", "--method", method]);
    }
}

#[test]
fn logs_in_radians_and_in_degrees_give_the_same_coefficients() {
    let folder = folder();
    let preset = ["simulate", "fog", "--duration", "100"];
    output(
        folder.path(),
        &[&preset[..], &["--output", "deg.csv"]].concat(),
    );
    output(
        folder.path(),
        &[&preset[..], &["--unit", "rad/s", "--output", "rad.csv"]].concat(),
    );
    let [degrees, radians] = ["deg.csv", "rad.csv"].map(|name| fit(folder.path(), &[name]));
    let n = |document: &Document| document.axes[0].coefficients[1].value.unwrap();
    assert!((n(&degrees) / n(&radians).to_degrees() - 1.0).abs() < 1e-4);
    assert_eq!(radians.axes[0].coefficients[1].unit, "rad/s/√Hz");
    let customary = |name| output(folder.path(), &["fit", name]);
    let line = |text: &str| {
        let line = text
            .lines()
            .find(|line| line.starts_with("angle random walk"))
            .unwrap();
        line.split_whitespace()
            .rev()
            .nth(1)
            .unwrap()
            .parse::<f64>()
            .unwrap()
    };
    let [degrees, radians] = [line(&customary("deg.csv")), line(&customary("rad.csv"))];
    assert!(
        (degrees / radians - 1.0).abs() < 1e-3,
        "{degrees} {radians}"
    );
}

#[test]
fn source_and_licence_are_kept_and_axes_can_be_renamed() {
    let folder = folder();
    let path = folder.path();
    let measure = [
        "measure",
        "log.csv",
        "--output",
        "named.json",
        "--columns",
        "roll=gx,pitch=gy",
    ];
    let about = ["--source", "my bench", "--licence", "CC0-1.0"];
    let summary = output(path, &[&measure[..], &about].concat());
    assert!(
        summary.starts_with("roll: 20000 samples at 100 Hz, 13 octaves; deviation "),
        "{summary}"
    );
    let text = fs::read_to_string(path.join("named.json")).unwrap();
    assert!(text.contains("\"source\": \"my bench\"") && text.contains("\"licence\": \"CC0-1.0\""));
    let names: Vec<_> = fit(path, &["named.json"])
        .axes
        .into_iter()
        .map(|axis| axis.axis)
        .collect();
    assert_eq!(names, ["roll", "pitch"]);
}

#[test]
fn accelerometers_have_their_own_words_and_units() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    // The simulated accelerometer has 100 µg/√Hz and a drift that shows in the record.
    let simulate = [
        "simulate",
        "--unit",
        "m/s^2",
        "--angle-random-walk",
        "980.665e-6",
    ];
    let more = [
        "--rate-random-walk",
        "1e-3",
        "--duration",
        "300",
        "--output",
        "a.csv",
    ];
    output(path, &[&simulate[..], &more].concat());
    let text = output(path, &["fit", "a.csv"]);
    let line = |start: &str| text.lines().find(|line| line.starts_with(start)).unwrap();
    let white: Vec<_> = line("velocity random walk").split_whitespace().collect();
    let customary = white.iter().position(|&word| word == "µg/√Hz").unwrap();
    let value: f64 = white[customary - 1].parse().unwrap();
    assert!((value / 100.0 - 1.0).abs() < 0.05, "{text}");
    assert!(white.contains(&"m/s²/√Hz"), "{text}");
    assert!(
        line("acceleration random walk").contains("m/s²/√s"),
        "{text}"
    );
    let document = fit(path, &["a.csv"]);
    assert_eq!(document.axes[0].unit, "m/s^2");
    assert_eq!(document.axes[0].coefficients[1].effect, "angle_random_walk");
    output(path, &["measure", "a.csv", "--output", "a.json"]);
    assert_eq!(
        text,
        output(path, &["fit", "a.json"]),
        "the curve file keeps the unit"
    );
    let line = refusal(path, &["simulate", "mems", "--unit", "g"]);
    assert!(
        line.starts_with("presets describe gyros, but --unit g is for accelerometers; "),
        "{line}"
    );
}

/// Nobody sees in a record what flicker noise is below the sample interval. Where it is as strong as the white noise of a
/// sample, the angle random walk depends on it.
#[test]
fn flicker_noise_below_the_sample_interval_is_told_where_it_matters() {
    let folder = TempDir::new().expect("a temporary folder");
    let simulated = |coefficients: &[&str]| {
        let record = ["simulate", "mems", "--duration", "20min", "--seed", "3"];
        let to_file = ["--output", "log.csv"];
        output(folder.path(), &[&record, coefficients, &to_file].concat());
        output(folder.path(), &["fit", "log.csv"])
    };
    let words = "If the flicker noise ends at half the sample rate, the angle random walk is";
    let strong = ["--angle-random-walk", "0.002", "--bias-instability", "0.02"];
    let printed = simulated(&strong);
    let line = printed.lines().find(|line| line.starts_with(words));
    // 0.09 B²τ₀/2N² with B√τ₀ = N.
    let share = line.and_then(|line| line[words.len()..].split(' ').nth(1));
    let share: f64 = share.expect(&printed).parse().expect("a number");
    assert!((4.0..5.5).contains(&share), "{share} %");
    assert!(!simulated(&[]).contains(words));
}
