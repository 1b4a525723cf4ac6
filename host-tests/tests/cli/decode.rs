//! Tests `decode` on whole and broken certificates and snapshots, one file and many.

use crate::factory::{self, SINUSOID, axis, encoded, followed, record};
use allanite::{
    diagnosis::Verdict,
    effect::{CATALOGUE, Effect, GaussMarkov, LowPass},
    storage::{AxisCertificate, CertifiedBand, Doubt, EffectCode, RateUnit},
};
use allanite_host::verdict::ambiguous;
use program::{json, output, refusal, run};
use std::{fs, sync::LazyLock};
use tempfile::TempDir;

static AXES: LazyLock<[AxisCertificate; 2]> =
    LazyLock::new(|| [axis(None, 1), axis(Some(SINUSOID), 2)]);

/// A folder with the records of two devices, a snapshot, a broken record and a file of another
/// kind.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    let first = encoded(&record("SN-1", RateUnit::DegreesPerSecond, &AXES[..]));
    write("first.bin", &first);
    let second = record("\u{1}\u{2}", RateUnit::RadiansPerSecond, &AXES[..1]);
    write("second.bin", &encoded(&second));
    let mut buffer = vec![0; factory::Counts::SNAPSHOT_BYTES];
    let snapshot = factory::counts(None, 1);
    write("snapshot.bin", snapshot.snapshot(&mut buffer).unwrap());
    let mut broken = first.clone();
    broken[100] ^= 4;
    write("broken.bin", &broken);
    write("short.bin", &first[..first.len() - 1]);
    write("text.bin", b"rate,gx\n1,2\n");
    folder
}

#[test]
fn one_record_is_printed_in_full() {
    let folder = folder();
    let text = output(folder.path(), &["decode", "first.bin"]);
    for part in [
        "SN-1: firmware 1.2.300, 65536 samples at 100 Hz (10.9 min), no gap, 22.5 … 24.25 °C",
        "y: with sinusoid",
        "angle random walk",
        "deg/s/√Hz",
        "frequency 7.703 Hz (",
        "degrees of freedom, p ",
    ] {
        assert!(text.contains(part), "{part}:\n{text}");
    }
}

#[test]
fn several_records_make_one_table_in_customary_units() {
    let folder = folder();
    let text = output(folder.path(), &["decode", "first.bin", "second.bin"]);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 4, "{text}");
    assert!(
        lines[0].contains("N °/√h") && lines[0].contains("R °/h²"),
        "{text}"
    );
    assert!(
        lines[1].starts_with("SN-1") && lines[1].contains(" x "),
        "{text}"
    );
    assert!(lines[2].starts_with("SN-1") && lines[2].trim_end().ends_with("with sinusoid"));
    assert!(lines[3].starts_with("0102"), "{text}");
    // A number of rad/s is 180/π times as many deg/s.
    let white = |line: &str| -> f64 {
        let mut words = line.split("  ").filter(|word| !word.trim().is_empty());
        words.nth(5).unwrap().trim().parse().unwrap()
    };
    let ratio = white(lines[3]) / white(lines[1]);
    assert!((ratio / 57.295_78 - 1.0).abs() < 1e-3, "{ratio}\n{text}");
}

#[test]
fn json_has_every_number() {
    let folder = folder();
    let document = json(folder.path(), &["decode", "first.bin", "snapshot.bin"]);
    let device = &document["records"][0];
    assert_eq!(device["device"], "SN-1");
    assert_eq!(device["device_hex"], "534e2d31");
    assert_eq!(device["firmware"], "1.2.300");
    assert_eq!(device["unit"], "deg/s");
    assert_eq!(device["temperature_c"], serde_json::json!([22.5, 24.25]));
    let axis = &device["axes"][1];
    assert_eq!(axis["verdict"], Verdict::Improved.name());
    assert_eq!(axis["found"][0], "sinusoid");
    let terms = axis["coefficients"].as_array().unwrap();
    for (term, expected) in terms.iter().zip(&AXES[1].terms) {
        assert_eq!(term["effect"], expected.effect.name());
        assert_eq!(term["value"].as_f64().unwrap() as f32, expected.value);
    }
    let sinusoid = &terms[terms.len() - 1];
    assert!(sinusoid["shape"]["frequency_hz"]["lower"].is_number());
    assert_eq!(axis["covariance"].as_array().unwrap().len(), terms.len());
    assert!(axis["covariance"][1][1].is_number());
    let octaves = document["snapshots"][0]["octaves"].as_array().unwrap();
    assert_eq!(octaves.len(), 17);
    for (octave, expected) in octaves.iter().zip(factory::counts(None, 1).octaves()) {
        assert_eq!(octave["differences"], expected.differences);
        let sum = expected.sum.to_u128().unwrap();
        assert_eq!(octave["sum"].to_string(), sum.to_string());
    }
}

#[test]
fn all_that_a_diagnosis_found_is_printed() {
    let folder = TempDir::new().unwrap();
    let mut axis = followed();
    let effect = axis.found().next().unwrap().effect;
    for other in [GaussMarkov.description(), LowPass.description()] {
        let other = CATALOGUE.iter().find(|one| one.name() == other.name);
        let other = EffectCode::of(*other.unwrap());
        axis.findings.doubts.push(Doubt { effect, other }).unwrap();
    }
    let band = CertifiedBand {
        from_hz: 14.1,
        to_hz: 26.6,
        z: 12.2,
    };
    axis.findings.bands.push(band).unwrap();
    let certificate = record("SN-1", RateUnit::DegreesPerSecond, &[axis]);
    fs::write(folder.path().join("a.bin"), encoded(&certificate)).unwrap();
    let text = output(folder.path(), &["decode", "a.bin"]);
    for line in [
        "follows covariate 0 with 0.1521 ± 0.005248 deg/s per unit of it; the curve is that without it",
        &format!(
            "sinusoid: {}",
            ambiguous("Gauss–Markov noise or a low pass")
        ),
        "unexplained in the spectrum: 12 σ above the model at 14.10–26.60 Hz",
    ] {
        assert!(text.lines().any(|one| one == line), "{line}:\n{text}");
    }
    let axis = json(folder.path(), &["decode", "a.bin"])["records"][0]["axes"][0].clone();
    assert_eq!(axis["found"][0], "sinusoid");
    assert_eq!(axis["ambiguous"][1]["other"], "low_pass");
    let slope = axis["covariates"][0]["slope"].as_f64().unwrap();
    assert!((slope / (20.0 / 131.0) - 1.0).abs() < 0.1, "{axis}");
    assert!(axis["bands"][0]["z"].as_f64().unwrap() > 12.0);
    let events = axis["events"].as_array().unwrap();
    assert_eq!(axis["stationary"].as_bool().unwrap(), events.is_empty());
}

#[test]
fn snapshot_is_printed_with_one_line_per_octave() {
    let folder = folder();
    let text = output(folder.path(), &["decode", "snapshot.bin"]);
    assert!(text.starts_with("snapshot.bin: snapshot of 65536 samples, 1 gap, 17 octaves"));
    assert_eq!(text.lines().count(), 19, "{text}");
}

#[test]
fn broken_files_are_named_and_the_others_printed() {
    let folder = folder();
    let files = [
        "first.bin",
        "broken.bin",
        "second.bin",
        "absent.bin",
        "text.bin",
    ];
    let run = run(folder.path(), &[&["decode"], &files[..]].concat());
    assert_eq!(run.status.code(), Some(2));
    let whole = output(folder.path(), &["decode", "first.bin", "second.bin"]);
    assert_eq!(String::from_utf8(run.stdout).unwrap(), whole);
    let errors = String::from_utf8(run.stderr).unwrap();
    let expected = [
        "allanite: broken.bin: the checksum is wrong, because the bytes have changed since they were \
         stored; read them again or take an older copy",
        "allanite: absent.bin: no such file; check the path",
        "allanite: text.bin: the bytes are neither a snapshot nor a certificate of allanite; read \
         the place where it stored one",
    ];
    assert_eq!(errors.lines().collect::<Vec<_>>(), expected);
}

#[test]
fn broken_file_alone_is_refused() {
    let folder = folder();
    let line = refusal(folder.path(), &["decode", "short.bin"]);
    assert!(line.contains("were stored; read exactly these"), "{line}");
    refusal(folder.path(), &["decode", "broken.bin", "--json"]);
}
