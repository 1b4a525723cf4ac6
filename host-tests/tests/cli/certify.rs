//! Tests `certify`: the certificate of a record says what `diagnose` says of it, and `lot` takes either.

use program::{ADIS16405, json, number, output, refusal, rows, run};
use std::{fs, path::Path};
use tempfile::TempDir;

/// A log whose device has this name.
fn simulate(folder: &Path, name: &str, seed: u32, more: &[&str]) {
    let (seed, log) = (seed.to_string(), format!("{name}.csv"));
    let arguments = [
        "simulate",
        "mems",
        "--seed",
        &seed,
        "--duration",
        "200",
        "--output",
        &log,
    ];
    output(folder, &[&arguments[..], more].concat());
}

#[test]
fn a_certificate_says_what_the_diagnosis_says() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let line = [
        "--effect",
        "sinusoid:frequency_hz=7.7,amplitude=0.05",
        "--axes",
        "2",
    ];
    simulate(folder, "SN-1", 4, &line);
    let arguments = [
        "-q",
        "certify",
        "SN-1.csv",
        "--output",
        "SN-1.bin",
        "--firmware",
        "1.2.3",
        "--temperature",
        "22.5..24",
    ];
    let certified = json(folder, &arguments);
    // The file has what was printed.
    let decoded = json(folder, &["decode", "SN-1.bin"]);
    assert_eq!(
        certified["records"][0]["axes"],
        decoded["records"][0]["axes"]
    );
    let record = &decoded["records"][0];
    assert_eq!(
        (&record["device"], &record["firmware"]),
        (&"SN-1".into(), &"1.2.3".into())
    );
    assert_eq!(record["temperature_c"], serde_json::json!([22.5, 24.0]));
    assert_eq!(
        (number(&record["duration_s"]), number(&record["samples"])),
        (200.0, 20_000.0)
    );
    let diagnosis = json(folder, &["-q", "diagnose", "SN-1.csv"]);
    let axes = record["axes"].as_array().unwrap();
    assert_eq!(axes.len(), 2);
    for (axis, diagnosed) in axes.iter().zip(diagnosis["axes"].as_array().unwrap()) {
        assert_eq!(axis["verdict"], diagnosed["verdict"]);
        assert_eq!(axis["found"], serde_json::json!(["sinusoid"]));
        let last = diagnosed["steps"].as_array().unwrap().last().unwrap();
        assert!((number(&axis["chi2"]) / number(&last["chi2"]) - 1.0).abs() < 1e-9);
        let of_last = last["coefficients"].as_array().unwrap();
        let of_axis = axis["coefficients"].as_array().unwrap();
        assert_eq!(of_axis.len(), of_last.len());
        for (certified, fitted) in of_axis.iter().zip(of_last) {
            assert_eq!(certified["effect"], fitted["effect"]);
            // A certificate is in single precision.
            let (one, other) = (number(&certified["value"]), number(&fitted["value"]));
            assert!((one - other).abs() <= 1e-6 * other, "{certified} {fitted}");
        }
        assert!(!axis["detection_limits"].as_array().unwrap().is_empty());
        assert!(
            axis["stationary"] == true || !axis["events"].is_null(),
            "{axis}"
        );
    }
}

#[test]
fn many_records_are_certified_into_a_folder() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    simulate(folder, "SN-1", 1, &[]);
    simulate(folder, "SN-2", 2, &[]);
    output(folder, &["measure", "SN-2.csv", "--output", "SN-2.json"]);
    fs::create_dir(folder.join("certificates")).unwrap();
    let text = output(
        folder,
        &[
            "-q",
            "certify",
            "SN-1.csv",
            "SN-2.json",
            "--output",
            "certificates",
        ],
    );
    assert!(text.contains("SN-1") && text.contains("SN-2"), "{text}");
    let decoded = json(
        folder,
        &["decode", "certificates/SN-1.bin", "certificates/SN-2.bin"],
    );
    let devices = decoded["records"].as_array().unwrap().iter();
    let devices: Vec<&str> = devices.map(|one| one["device"].as_str().unwrap()).collect();
    assert_eq!(devices, ["SN-1", "SN-2"]);
    // A bad one does not hide the others.
    let run = run(
        folder,
        &[
            "-q",
            "certify",
            "SN-1.csv",
            "missing.csv",
            "--output",
            "certificates",
        ],
    );
    assert_eq!(run.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&run.stdout).contains("SN-1"));
}

#[test]
fn what_has_no_certificate_is_refused_in_a_line() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    simulate(folder, "SN-1", 1, &[]);
    let noise = |i: u32| (i * 7919) % 101;
    let four = (0..4000).map(|i| {
        let [a, b, c, d] = [0, 1, 2, 3].map(|axis| noise(4 * i + axis));
        format!("{a},{b},{c},{d}\n")
    });
    let many = "# rate_hz=100 unit=deg/s\na,b,c,d\n".to_owned() + &four.collect::<String>();
    fs::write(folder.join("many.csv"), many).unwrap();
    simulate(folder, "a-name-of-many-letters", 1, &[]);
    fs::write(
        folder.join("accelerometer.csv"),
        "# rate_hz=100 unit=m/s^2\nax\n".to_owned()
            + &(0..4000)
                .map(|i| format!("{}\n", (i * 7919) % 101))
                .collect::<String>(),
    )
    .unwrap();
    for (arguments, what) in rows! {
        &["SN-1.csv", "--output", "SN-1.json"][..], "a certificate must end in .bin";
        &["SN-1.csv", "many.csv", "--output", "x.bin"], "create the folder first";
        &["many.csv", "--output", "x.bin"], "up to 3 axes, and there are 4";
        &["a-name-of-many-letters.csv", "--output", "x.bin"], "give a shorter one with --device";
        &["accelerometer.csv", "--output", "x.bin"], "a certificate is that of a gyro";
        &["SN-1.csv", "--output", "x.bin", "--firmware", "1.2"], "--firmware";
        &["SN-1.csv", "--output", "x.bin", "--temperature", "24..22"], "--temperature";
        &["missing.csv", "--output", "x.bin"], "missing.csv";
    } {
        let refusal = refusal(folder, &[&["-q", "certify"], arguments].concat());
        assert!(refusal.contains(what), "{refusal}");
    }
    assert!(!folder.join("x.bin").exists());
}

/// A lot that is given as logs, as curve files and as certificates is the same lot.
#[test]
fn logs_curves_and_certificates_are_the_same_lot() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    for kind in ["logs", "curves", "certificates", "mixed"] {
        fs::create_dir(folder.join(kind)).unwrap();
    }
    for seed in 0..9 {
        let name = format!("SN-{seed}");
        simulate(folder, &format!("logs/{name}"), seed, &[]);
        let log = format!("logs/{name}.csv");
        output(folder, &["measure", &log, "--output", "curves"]);
        output(folder, &["-q", "certify", &log, "--output", "certificates"]);
        let (from, extension) =
            [("logs", "csv"), ("curves", "json"), ("certificates", "bin")][seed as usize % 3];
        let file = format!("{name}.{extension}");
        fs::copy(
            folder.join(from).join(&file),
            folder.join("mixed").join(&file),
        )
        .unwrap();
    }
    let lot = |kind: &str| {
        json(
            folder,
            &[
                "-q", "lot", "--limit", "N=0.005", "--limit", "B=20°/h", kind,
            ],
        )
    };
    let of_logs = lot("logs");
    assert_eq!(of_logs["devices"], 9);
    assert!(number(&of_logs["guarded"]) > 0.0, "{of_logs}");
    for kind in ["certificates", "mixed"] {
        assert_eq!(lot(kind), of_logs, "{kind}");
    }
    // A curve file has no kurtosis and no covariates of its log; the numbers of a quiet record are the same.
    assert_eq!(lot("curves")["limits"], of_logs["limits"]);
    // The real gyro of the repository is a device like any other.
    let with = json(
        folder,
        &["-q", "lot", "--limit", "N=0.1", "logs", ADIS16405],
    );
    assert_eq!(with["devices"], 10);
}
