//! What people and scripts see of the program: results, statuses, and one line for what is wrong.

use host_tests::program::{command, output, refusal};
use serde::Deserialize;
use std::{fs, path::Path, process::Stdio};
use tempfile::TempDir;

/// A folder with a simulated log of 20 000 samples, three axes and their curves.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    let simulate = [
        "simulate",
        "mems",
        "--duration",
        "200s",
        "--axes",
        "3",
        "--output",
        "log.csv",
    ];
    assert_eq!(output(folder.path(), &simulate), "");
    output(
        folder.path(),
        &["measure", "log.csv", "--output", "curve.json"],
    );
    folder
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    axes: Vec<Axis>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Axis {
    axis: String,
    rate_hz: f64,
    unit: String,
    octaves: Vec<Octave>,
    method: String,
    coefficients: Vec<Coefficient>,
    chi2: Option<f64>,
    dof: Option<u32>,
    p_value: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Octave {
    m: u32,
    tau_s: f64,
    differences: u64,
    variance: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Coefficient {
    effect: String,
    symbol: String,
    value: Option<f64>,
    lower: Option<f64>,
    upper: Option<f64>,
    state: String,
    unit: String,
}

fn fit(folder: &Path, arguments: &[&str]) -> Document {
    let arguments = [&["fit", "--json"], arguments].concat();
    serde_json::from_str(&output(folder, &arguments)).unwrap()
}

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
        let scale: &[&str] = if more.is_empty() { &[] } else { more };
        let array = [&["a.npy", "--rate", "100", "--unit", "deg/s"], scale].concat();
        let [text, packed, array] = [&["a.csv"][..], &["a.csv.gz"], &array]
            .map(|arguments| output(folder.path(), &[&["fit", "--json"], arguments].concat()));
        assert_eq!(text, packed);
        assert_eq!(text, array);
    }
}

#[test]
fn every_method_has_its_name_and_says_what_it_can() {
    let folder = folder();
    for (method, judges) in [
        ("ordinary", false),
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
        }
        output(folder.path(), &["fit", "curve.json", "--method", method]);
    }
}

#[test]
fn radians_in_are_the_same_degrees_out() {
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
            .nth(2)
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
fn simulation_depends_on_the_seed_and_nothing_else() {
    let folder = TempDir::new().unwrap();
    let simulate = |more: &[&str]| {
        output(
            folder.path(),
            &[&["simulate", "mems", "--duration", "1"], more].concat(),
        )
    };
    let one = simulate(&[]);
    assert_eq!(one, simulate(&["--seed", "1"]));
    assert_ne!(one, simulate(&["--seed", "2"]));
    assert_eq!(one.lines().count(), 102);
    assert!(one.starts_with("# rate_hz=100 unit=deg/s seed=1 "), "{one}");
    let axes = simulate(&["--axes", "3"]);
    let first = |text: &str| {
        let rows = text.lines().skip(2);
        rows.map(|row| row.split(',').next().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!(
        first(&one),
        first(&axes),
        "the first axis is that of a single one"
    );
    let named = output(
        folder.path(),
        &["simulate", "--preset", "mems", "--duration", "1s"],
    );
    assert_eq!(one, named);
    let own = [
        "simulate",
        "fog",
        "--angle-random-walk",
        "0",
        "--bias-instability",
        "0.5",
    ];
    let comment = output(folder.path(), &[&own[..], &["--duration", "1"]].concat());
    let comment = comment.lines().next().unwrap();
    for word in [
        "quantization=0.00002",
        "angle_random_walk=0 ",
        "bias_instability=0.5",
    ] {
        assert!(comment.contains(word), "{comment}");
    }
}

#[test]
fn bad_input_ends_with_one_line_and_no_output_file() {
    let folder = folder();
    let path = folder.path();
    let good = fs::read_to_string(path.join("log.csv")).unwrap();
    let curve = fs::read_to_string(path.join("curve.json")).unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(path.join(name), bytes).unwrap();
    write("ragged.csv", format!("{good}1,2\n").as_bytes());
    write("text.csv", format!("{good}1,2,many\n").as_bytes());
    write("nan.csv", format!("{good}nan,2,3\n").as_bytes());
    write("empty.csv", b"");
    write("bare.csv", b"# rate_hz=100\ngx\n");
    write("short.csv", b"# rate_hz=100\ngx\n1\n2\n4\n");
    write(
        "stuck.csv",
        ["# rate_hz=100\ngx\n", &"7\n".repeat(99)]
            .concat()
            .as_bytes(),
    );
    write("rate.csv", b"# rate_hz=0\ngx\n1\n2\n4\n");
    write("silent.csv", b"gx\n1\n2\n4\n");
    write("log.txt", good.as_bytes());
    write(
        "old.json",
        curve.replace("\"version\": 1", "\"version\": 0").as_bytes(),
    );
    write(
        "odd.json",
        curve.replacen("\"m\": 2", "\"m\": 3", 1).as_bytes(),
    );
    for (input, more, expected) in [
        (
            "ragged.csv",
            &[][..],
            "ragged.csv:20003: 2 values where the first row has 3; ",
        ),
        (
            "text.csv",
            &[],
            "text.csv:20003: axis gz: \"many\" is not a number; ",
        ),
        (
            "nan.csv",
            &[],
            "nan.csv:20003: axis gx: \"nan\" is not a finite number; ",
        ),
        ("empty.csv", &[], "empty.csv: the file is empty; "),
        ("bare.csv", &[], "bare.csv: no rows; "),
        (
            "short.csv",
            &[],
            "short.csv: 3 samples, and two octaves need 9; record longer",
        ),
        (
            "stuck.csv",
            &[],
            "stuck.csv: axis gx never changes its value; ",
        ),
        (
            "rate.csv",
            &[],
            "rate.csv:1: rate_hz=\"0\" is not a positive, finite number; ",
        ),
        (
            "silent.csv",
            &[],
            "silent.csv: the sampling rate is not known; \
             give it with --rate HZ, or name a column of time stamps with --time",
        ),
        (
            "log.txt",
            &[],
            "log.txt: the extension names no kind of log; ",
        ),
        ("none.csv", &[], "none.csv: no such file; check the path"),
        (".", &[], "the extension names no kind of log; "),
        ("log.csv", &["--rate", "0"], "--rate 0 is impossible; "),
        ("log.csv", &["--rate", "-5"], "--rate -5 is impossible; "),
        ("log.csv", &["--rate", "nan"], "--rate NaN is impossible; "),
        ("log.csv", &["--scale", "-1"], "--scale -1 is impossible; "),
        (
            "log.csv",
            &["--columns", "gx,gw"],
            "log.csv: there is no column \"gw\"; ",
        ),
    ] {
        for command in [&["fit"][..], &["measure", "--output", "new.json"]] {
            let line = refusal(path, &[command, &[input], more].concat());
            assert!(line.contains(expected), "{line}\nis not\n{expected}");
        }
        assert!(!path.join("new.json").exists(), "{input}");
    }
    for (input, expected) in [
        (
            "old.json",
            "old.json: version 0 of the format, and this program reads 1; ",
        ),
        ("odd.json", "odd.json: axis \"gx\": octave m = 3: "),
        ("none.json", "none.json: no such file; "),
    ] {
        let line = refusal(path, &["fit", input]);
        assert!(line.starts_with(expected), "{line}");
    }
    let line = refusal(path, &["fit", "curve.json", "--rate", "100"]);
    assert!(
        line.starts_with("curve.json: a curve knows its rate"),
        "{line}"
    );
}

#[test]
fn failure_leaves_an_earlier_output_as_it_was() {
    let folder = folder();
    let path = folder.path();
    let before = fs::read(path.join("curve.json")).unwrap();
    fs::write(path.join("bad.csv"), "# rate_hz=1\ngx\n1\n2\nx\n").unwrap();
    refusal(path, &["measure", "bad.csv", "--output", "curve.json"]);
    assert_eq!(before, fs::read(path.join("curve.json")).unwrap());
    assert_eq!(
        fs::read_dir(path).unwrap().count(),
        3,
        "no temporary file stays behind"
    );
    let line = refusal(path, &["measure", "log.csv", "--output", "log.csv"]);
    assert_eq!(
        line,
        "log.csv: a curve file's extension is .json; name the output so"
    );
    let line = refusal(path, &["measure", "log.csv", "--output", "none/curve.json"]);
    assert_eq!(
        line,
        "none/curve.json: its folder does not exist; make the folder first"
    );
}

#[test]
fn source_and_licence_are_kept_and_axes_renamed() {
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
fn accelerometers_are_spoken_of_in_their_own_words_and_units() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    // 100 µg/√Hz, and a drift that the record shows.
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
        "curves keep the unit"
    );
    let line = refusal(path, &["simulate", "mems", "--unit", "g"]);
    assert!(
        line.starts_with("presets are gyros, and --unit g is not; "),
        "{line}"
    );
}

#[test]
fn logs_of_other_programs_fit_without_an_option() {
    let folder = TempDir::new().unwrap();
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    for name in ["euroc.csv", "imu-zstd.mcap", "ros1.mcap", "gyro.ulg"] {
        let path = fixtures.join(name);
        let path = path.to_str().unwrap();
        let gyro = output(folder.path(), &["fit", path]);
        assert!(
            gyro.contains("angle random walk") && gyro.contains("at 200 Hz"),
            "{gyro}"
        );
        let acceleration = output(folder.path(), &["fit", path, "--sensor", "accel"]);
        assert!(
            acceleration.contains("velocity random walk"),
            "{acceleration}"
        );
    }
}

#[test]
fn impossible_simulations_are_refused() {
    let folder = TempDir::new().unwrap();
    for (arguments, expected) in [
        (&[][..], "nothing to simulate; "),
        (&["mems", "--rate", "0"], "--rate 0 is impossible; "),
        (&["mems", "--rate", "nan"], "--rate NaN is impossible; "),
        (
            &["mems", "--duration", "0"],
            "--duration 0 at 100 Hz is impossible; ",
        ),
        (
            &["mems", "--duration", "-3"],
            "--duration -3 at 100 Hz is impossible; ",
        ),
        (
            &["mems", "--duration", "inf"],
            "--duration inf at 100 Hz is impossible; ",
        ),
        (
            &["mems", "--duration", "long"],
            "--duration \"long\" is not a length of time; ",
        ),
        (&["mems", "--axes", "0"], "--axes 0 is impossible; "),
        (&["mems", "--axes", "4"], "--axes 4 is impossible; "),
        (&["mems", "--scale", "0"], "--scale 0 is impossible; "),
        (
            &["mems", "--rate-ramp", "-1"],
            "--rate-ramp -1 is impossible; ",
        ),
        (
            &["mems", "--output", "a.txt"],
            "a.txt: the extension names no kind of log; ",
        ),
        (
            &["mems", "--output", "a.csv", "--scale", "1e-300"],
            "a rate of ",
        ),
    ] {
        let line = refusal(folder.path(), &[&["simulate"], arguments].concat());
        assert!(line.starts_with(expected), "{line}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn reader_that_leaves_early_is_no_failure() {
    let mut child = command(Path::new("."), &["simulate", "mems", "--duration", "1d"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}
