//! Reads every export format back as its consumer does.

use program::{ADIS16405, json, output, refusal};
use saphyr::{LoadableYamlNode, Yaml};
use serde_json::Value;
use std::{collections::HashMap, fs, path::Path, process::Command};
use tempfile::TempDir;

const TOLERANCE: f64 = 1e-12;

fn close(value: f64, expected: f64) -> bool {
    (value / expected - 1.0).abs() <= TOLERANCE
}

/// Options that leave a simulated gyro no change of its bias.
const WHITE: [&str; 4] = ["--bias-instability", "0", "--rate-random-walk", "0"];

/// Writes the log of a simulated gyro of this many axes, and of this seed.
fn simulated(folder: &Path, duration: &str, axes: u8, options: &[&str], name: &str) {
    let axes = axes.to_string();
    let simulate = ["simulate", "mems", "--duration", duration, "--axes", &axes];
    let written = ["--output", name];
    output(folder, &[&simulate[..], options, &written].concat());
}

/// A folder with the curves of a real gyro and of a simulated one. An axis of the real gyro has a
/// name with characters that are special in every format. The simulated one in `short.json` has no
/// bias that changes, and a random walk that is not observable.
fn folder() -> (TempDir, String) {
    let hostile = "g\"x*/ // #: ,\\\n'{%} é".to_owned();
    let folder = TempDir::new().unwrap();
    let mut curve: Value = serde_json::from_str(&fs::read_to_string(ADIS16405).unwrap()).unwrap();
    curve["axes"][0]["axis"] = hostile.clone().into();
    fs::write(folder.path().join("curve.json"), curve.to_string()).unwrap();
    simulated(folder.path(), "200s", 1, &WHITE, "log.csv");
    let measure = ["measure", "log.csv", "--output", "short.json"];
    output(folder.path(), &measure);
    (folder, hostile)
}

/// Exports the five terms, which `fit` has too.
fn export(folder: &Path, input: &str, arguments: &[&str]) -> String {
    let model = ["export", input, "--model", "five-terms", "--format"];
    output(folder, &[&model[..], arguments].concat())
}

/// The coefficient of each axis that a filter may use, in radians: the value, or else the upper
/// bound.
fn expected(folder: &Path, input: &str, symbol: &str) -> Vec<Option<f64>> {
    let fit = json(folder, &["fit", input]);
    let radians = std::f64::consts::PI / 180.0;
    let of_axis = |axis: &Value| {
        assert_eq!(axis["unit"], "deg/s");
        let coefficients = axis["coefficients"].as_array().unwrap();
        let one = coefficients.iter().find(|one| one["symbol"] == symbol);
        let one = one.unwrap();
        match one["state"].as_str().unwrap() {
            "measured" => Some(radians * one["value"].as_f64().unwrap()),
            "upper_bound" => Some(radians * one["upper"].as_f64().unwrap()),
            _ => None,
        }
    };
    fit["axes"]
        .as_array()
        .unwrap()
        .iter()
        .map(of_axis)
        .collect()
}

/// The random walk of each axis for a filter without another state for the bias: K, and twice the walk that is as large as
/// white noise where flicker noise is.
fn walks(folder: &Path, input: &str) -> Vec<Option<f64>> {
    let of = |symbol: &str| expected(folder, input, symbol);
    let axes = of("N").into_iter().zip(of("B")).zip(of("K"));
    let walk = |((n, b), k): ((Option<f64>, Option<f64>), Option<f64>)| {
        let flicker = n.zip(b).map(|(n, b)| 2.0 * b * b / n);
        match (k, flicker) {
            (Some(k), Some(flicker)) => Some(k.hypot(flicker)),
            (k, flicker) => k.or(flicker),
        }
    };
    axes.map(walk).collect()
}

fn largest(values: &[Option<f64>]) -> f64 {
    values.iter().flatten().copied().fold(0.0, f64::max)
}

fn yaml(text: &str) -> Yaml<'_> {
    Yaml::load_from_str(text).unwrap().remove(0)
}

/// The number that a comment gives for a key.
fn commented(text: &str, key: &str) -> f64 {
    let line = text
        .lines()
        .find_map(|line| line.trim_start().strip_prefix(&format!("# {key}: ")));
    line.unwrap()
        .split_whitespace()
        .next()
        .unwrap()
        .parse()
        .unwrap()
}

/// Whether the resolver of YAML 1.1, which Kalibr's parser uses, takes the text for a float.
fn is_yaml_1_1_float(text: &str) -> bool {
    let (digits, exponent) = text
        .split_once('e')
        .map_or((text, None), |(d, e)| (d, Some(e)));
    let signed = exponent.is_none_or(|exponent| exponent.starts_with(['+', '-']));
    digits.contains('.') && signed && text.parse::<f64>().is_ok()
}

#[test]
fn kalibr_reads_the_densities_of_the_fit_and_of_the_overbound() {
    let (folder, _) = folder();
    let text = export(
        folder.path(),
        "curve.json",
        &["kalibr", "--rostopic", "/a: \"b\" #c"],
    );
    let file = yaml(&text);
    let number = |key: &str| file[key].as_floating_point().unwrap();
    let densities = expected(folder.path(), "curve.json", "N");
    for (key, wanted) in [
        ("gyroscope_noise_density", densities),
        ("gyroscope_random_walk", walks(folder.path(), "curve.json")),
    ] {
        assert!(close(number(key), largest(&wanted)), "{key}");
        let line = text.lines().find(|line| line.starts_with(key)).unwrap();
        assert!(
            is_yaml_1_1_float(line.split_whitespace().nth(1).unwrap()),
            "{line}"
        );
    }
    assert_eq!(number("update_rate"), 100.0);
    assert_eq!(file["rostopic"].as_str(), Some("/a: \"b\" #c"));
    // The record of a gyro does not contain an accelerometer, so Kalibr will ask for its values.
    assert!(file.as_mapping_get("accelerometer_noise_density").is_none());

    let above = export(folder.path(), "curve.json", &["kalibr", "--overbound"]);
    for key in ["gyroscope_noise_density", "gyroscope_random_walk"] {
        let overbound = yaml(&above)[key].as_floating_point().unwrap();
        assert_eq!(commented(&text, key), overbound);
        assert_eq!(commented(&above, key), number(key));
    }
}

#[test]
fn openvins_finds_the_same_under_imu0_and_the_accelerometer_as_given() {
    let (folder, _) = folder();
    let accelerometer = [
        "vins",
        "--accelerometer-noise-density",
        "2e-3",
        "--accelerometer-random-walk",
        "0.00003",
    ];
    let text = export(folder.path(), "curve.json", &accelerometer);
    // The first line that OpenCV writes is not valid YAML.
    let rest = text.strip_prefix("%YAML:1.0\n").unwrap();
    let file = yaml(rest);
    let imu = &file["imu0"];
    let number = |key: &str| imu[key].as_floating_point().unwrap();
    assert_eq!(number("accelerometer_noise_density"), 2e-3);
    assert_eq!(number("accelerometer_random_walk"), 3e-5);
    let densities = expected(folder.path(), "curve.json", "N");
    for (key, wanted) in [
        ("gyroscope_noise_density", densities),
        ("gyroscope_random_walk", walks(folder.path(), "curve.json")),
    ] {
        assert!(close(number(key), largest(&wanted)), "{key}");
    }
    assert_eq!(imu["rostopic"].as_str(), Some("/imu0"));
    assert_eq!(imu["T_i_b"][3][3].as_floating_point(), Some(1.0));
}

/// The names and values in a parameter file, without comments.
fn parameters(text: &str, value: impl Fn(&str) -> (String, f64)) -> HashMap<String, f64> {
    let lines = text
        .lines()
        .filter(|line| !line.starts_with('#') && !line.is_empty());
    lines.map(value).collect()
}

#[test]
fn autopilots_read_discrete_noise_per_prediction() {
    let (folder, _) = folder();
    let density = largest(&expected(folder.path(), "curve.json", "N"));
    let walk = largest(&walks(folder.path(), "curve.json"));

    let text = export(folder.path(), "curve.json", &["px4"]);
    let px4 = parameters(&text, |line| {
        let fields: Vec<&str> = line.split('\t').collect();
        assert_eq!(
            (fields.len(), fields[0], fields[1], fields[4]),
            (5, "1", "1", "9")
        );
        (fields[2].into(), fields[3].parse().unwrap())
    });
    assert_eq!(px4.len(), 2);
    assert!(close(px4["EKF2_GYR_NOISE"], density / 0.01_f64.sqrt()));
    assert!(close(px4["EKF2_GYR_B_NOISE"], walk / 0.01_f64.sqrt()));

    let slower = ["ardupilot", "--prediction-interval", "0.02"];
    for (arguments, interval_s) in [(&slower[..1], 0.012_f64), (&slower[..], 0.02)] {
        let text = export(folder.path(), "curve.json", arguments);
        let ardupilot = parameters(&text, |line| {
            let (name, value) = line.split_once(',').unwrap();
            (name.into(), value.parse().unwrap())
        });
        assert_eq!(ardupilot.len(), 2);
        assert!(close(
            ardupilot["EK3_GYRO_P_NSE"],
            density / interval_s.sqrt()
        ));
        assert!(close(
            ardupilot["EK3_GBIAS_P_NSE"],
            walk / interval_s.sqrt()
        ));
    }
}

#[test]
fn matlab_gets_three_values_if_all_axes_are_known_and_one_otherwise() {
    let (folder, _) = folder();
    let name = "part \"one\"\n";
    let text = export(folder.path(), "curve.json", &["matlab", "--name", name]);
    let file: Value = serde_json::from_str(&text).unwrap();
    let gyro = &file[name]["Gyroscope"];
    let row = |key: &str| -> Vec<f64> {
        let row = gyro[key].as_array().unwrap();
        row.iter().map(|value| value.as_f64().unwrap()).collect()
    };
    for (key, symbol) in [("NoiseDensity", "N"), ("BiasInstability", "B")] {
        let wanted = expected(folder.path(), "curve.json", symbol);
        assert_eq!(wanted.len(), 3);
        for (value, wanted) in row(key).into_iter().zip(wanted) {
            assert!(close(value, wanted.unwrap()), "{key}");
        }
    }
    // The bias instability stands beside it.
    let wanted = largest(&expected(folder.path(), "curve.json", "K"));
    assert!(close(gyro["RandomWalk"].as_f64().unwrap(), wanted));
    let above = &file[format!("{name}_overbound")]["Gyroscope"];
    assert_eq!(above["NoiseDensity"].as_array().unwrap().len(), 3);
    assert_eq!(above["RandomWalk"].as_array().unwrap().len(), 3);
}

/// Compiles a header by itself and prints its macros.
fn compiled(folder: &Path, header: &str, macros: &[String]) -> Vec<f64> {
    fs::write(folder.join("noise.h"), header).unwrap();
    let prints = macros
        .iter()
        .map(|name| format!("printf(\"%.17g\\n\", {name});"));
    let program = format!(
        "#include \"noise.h\"\n#include \"noise.h\"\n#include <stdio.h>\nint main(void) {{ {} return 0; }}\n",
        prints.collect::<String>()
    );
    fs::write(folder.join("main.c"), program).unwrap();
    let strict = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror"];
    let compiler = Command::new("cc")
        .current_dir(folder)
        .args(strict)
        .args(["-o", "print", "main.c"])
        .output()
        .unwrap();
    assert!(
        compiler.status.success(),
        "{}",
        String::from_utf8_lossy(&compiler.stderr)
    );
    let printed = Command::new(folder.join("print")).output().unwrap();
    let text = String::from_utf8(printed.stdout).unwrap();
    text.lines().map(|line| line.parse().unwrap()).collect()
}

#[test]
fn c_compiler_takes_the_header_and_prints_the_same_numbers() {
    let (folder, _) = folder();
    let header = export(folder.path(), "curve.json", &["c", "--name", "3 axis-gyro"]);
    let macros = ["NOISE_DENSITY", "NOISE_SIGMA", "OVERBOUND_RANDOM_WALK"];
    let all = macros.map(|name| format!("N3_AXIS_GYRO_ALL_{name}"));
    let quantization = "N3_AXIS_GYRO_AXIS_GZ_QUANTIZATION".to_owned();
    let macros = [&all[..], &[quantization]].concat();
    let printed = compiled(folder.path(), &header, &macros);
    let density = largest(&expected(folder.path(), "curve.json", "N"));
    assert!(close(printed[0], density));
    assert!(close(printed[1], density * 10.0));
    let above = export(folder.path(), "curve.json", &["kalibr", "--overbound"]);
    let walk = yaml(&above)["gyroscope_random_walk"]
        .as_floating_point()
        .unwrap();
    assert!(close(printed[2], walk));
    let quantization = expected(folder.path(), "curve.json", "Q")[2].unwrap();
    assert!(close(printed[3], quantization));
}

#[test]
fn csv_has_the_curve_its_limits_and_models() {
    let (folder, hostile) = folder();
    let text = export(folder.path(), "curve.json", &["csv"]);
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let names = "axis tau_s m differences deviation lower upper model overbound";
    let header: Vec<String> = reader
        .headers()
        .unwrap()
        .iter()
        .map(str::to_owned)
        .collect();
    assert_eq!(header, names.split(' ').collect::<Vec<_>>());
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let compared = json(folder.path(), &["compare", "curve.json"]);
    let octaves = compared["axes"]
        .as_array()
        .unwrap()
        .iter()
        .flat_map(|axis| {
            let octaves = axis["octaves"].as_array().unwrap();
            octaves.iter().map(move |octave| (&axis["axis"], octave))
        });
    let octaves: Vec<_> = octaves.collect();
    assert_eq!(rows.len(), octaves.len());
    assert_eq!(rows[0][0], hostile.replace(char::is_control, " "));
    let radians = std::f64::consts::PI / 180.0;
    for (row, (axis, octave)) in rows.iter().zip(octaves) {
        let number = |i: usize| row[i].parse::<f64>().unwrap();
        assert_eq!(Some(&row[0]), axis.as_str());
        assert!(close(number(1), octave["tau_s"].as_f64().unwrap()));
        assert_eq!(row[2].parse().ok(), octave["m"].as_u64());
        assert!(close(
            number(4),
            radians * octave["measured"].as_f64().unwrap()
        ));
        // The comparison keeps these columns in single precision.
        assert!((number(7) / (radians * octave["model"].as_f64().unwrap()) - 1.0).abs() < 1e-6);
        assert!(number(5) < number(4) && number(4) < number(6));
        assert!(number(8) >= number(6) * (1.0 - 1e-15), "{row:?}");
    }
}

#[test]
fn log_in_radians_is_exported_without_conversion() {
    let (folder, _) = folder();
    let text = export(folder.path(), "log.csv", &["kalibr", "--unit", "rad/s"]);
    let density = yaml(&text)["gyroscope_noise_density"]
        .as_floating_point()
        .unwrap();
    let fit = json(folder.path(), &["fit", "log.csv", "--unit", "rad/s"]);
    let walk = &fit["axes"][0]["coefficients"][1];
    assert_eq!(walk["unit"], "rad/s/√Hz");
    assert_eq!(Some(density), walk["value"].as_f64());
}

#[test]
fn coefficient_that_is_not_observable_is_bounded_or_left_out_with_the_reason() {
    let (folder, _) = folder();
    assert_eq!(expected(folder.path(), "short.json", "K"), [None]);
    let reason = "not observable in this record; a record of ";
    // A filter gets the least random walk above the curve, which the bias may have.
    let text = export(folder.path(), "short.json", &["kalibr"]);
    let walk = yaml(&text)["gyroscope_random_walk"].as_floating_point();
    let above = export(folder.path(), "short.json", &["kalibr", "--overbound"]);
    assert_eq!(
        walk,
        yaml(&above)["gyroscope_random_walk"].as_floating_point()
    );
    assert!(walk.unwrap() > 0.0);
    let said =
        format!("the least random walk above the limits of the curve, because K is {reason}");
    assert!(text.contains(&said), "{text}");
    // K itself, and the walk of a simulator, have no number.
    let text = export(folder.path(), "short.json", &["c"]);
    assert!(text.contains(&format!(
        "// GYRO_AXIS_GX_RANDOM_WALK is not defined: {reason}"
    )));
    compiled(folder.path(), &text, &["GYRO_ALL_NOISE_DENSITY".into()]);
    let text = export(folder.path(), "short.json", &["matlab"]);
    let file: Value = serde_json::from_str(&text).unwrap();
    assert!(file["gyro"]["Gyroscope"].get("RandomWalk").is_none());
    let notes = file["gyro_notes"].as_array().unwrap();
    let said = |note: &Value| {
        note.as_str()
            .unwrap()
            .starts_with("RandomWalk left out: not obs")
    };
    assert!(notes.iter().any(said));
}

/// Writes a log of a gyro and an accelerometer, in which the third axis of the gyro has white noise alone.
fn imu(folder: &Path) {
    simulated(folder, "600s", 3, &[], "three.csv");
    simulated(folder, "600s", 3, &["--seed", "11"], "others.csv");
    simulated(folder, "600s", 1, &WHITE, "white.csv");
    let rows = |name: &str| -> Vec<String> {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
        rows.map(str::to_owned).collect()
    };
    let mut log = "gx (deg/s),gy (deg/s),gz (deg/s),ax (m/s^2),ay (m/s^2),az (m/s^2)\n".to_owned();
    let gyro = rows("three.csv").into_iter().zip(rows("white.csv"));
    for ((three, white), others) in gyro.zip(rows("others.csv")) {
        let (two, _) = three.rsplit_once(',').unwrap();
        log += &format!("{two},{white},{others}\n");
    }
    fs::write(folder.join("imu.csv"), log).unwrap();
}

#[test]
fn one_log_gives_the_numbers_of_both_sensors() {
    let folder = TempDir::new().unwrap();
    imu(folder.path());
    let both = |format: &str| {
        export(
            folder.path(),
            "imu.csv",
            &[format, "--rate", "100", "--accelerometer"],
        )
    };
    let fit = [
        "fit",
        "imu.csv",
        "--rate",
        "100",
        "--sensor",
        "accelerometer",
    ];
    let fit = json(folder.path(), &fit);
    let of_axis = |axis: &Value| axis["coefficients"][1]["value"].as_f64().unwrap();
    let density = fit["axes"]
        .as_array()
        .unwrap()
        .iter()
        .map(of_axis)
        .fold(0.0, f64::max);
    let text = both("kalibr");
    let file = yaml(&text);
    let number = |key: &str| file[key].as_floating_point().unwrap();
    assert!(close(number("accelerometer_noise_density"), density));
    assert!(number("accelerometer_random_walk") > 0.0);
    assert!(
        text.contains("# Accelerometer, in m/s^2 and seconds:"),
        "{text}"
    );
    let text = both("fast-lio");
    let file = yaml(&text);
    let covariance = file["mapping"]["acc_cov"].as_floating_point().unwrap();
    assert!(close(covariance, density * density * 100.0));
    // A number that an option gives is that of the option.
    let given = [
        "orb-slam3",
        "--rate",
        "100",
        "--accelerometer",
        "--accelerometer-noise-density",
        "0.25",
    ];
    let text = export(folder.path(), "imu.csv", &given);
    let rest = text.strip_prefix("%YAML:1.0\n").unwrap();
    assert_eq!(yaml(rest)["IMU.NoiseAcc"].as_floating_point(), Some(0.25));
    let scaled = [
        "export",
        "imu.csv",
        "--quiet",
        "--format",
        "kalibr",
        "--accelerometer",
        "--rate",
        "100",
        "--scale",
        "2",
    ];
    assert_eq!(
        refusal(folder.path(), &scaled),
        "--scale describes one sensor, and the log is read for two; name columns and units in the log's header instead"
    );
}

#[test]
fn an_axis_without_a_random_walk_leaves_no_default_in_the_other_program() {
    let folder = TempDir::new().unwrap();
    imu(folder.path());
    let written = |format: &str| export(folder.path(), "imu.csv", &[format, "--rate", "100"]);
    let model: Value = serde_json::from_str(&written("json")).unwrap();
    let axis = |place: usize| &model["axes"][place];
    assert_eq!(axis(2)["random_walk"], Value::Null);
    let walk = |place: usize| axis(place)["random_walk_alone"].as_f64().unwrap();
    assert_eq!(Some(walk(2)), axis(2)["overbound"]["random_walk"].as_f64());
    let text = written("gtsam");
    let start = "    params.setBiasOmegaCovariance(np.diag([";
    let call = text
        .lines()
        .find_map(|line| line.strip_prefix(start))
        .unwrap();
    let (row, _) = call.split_once("])").unwrap();
    let text = written("kf-gins");
    let file = yaml(&text);
    for (place, square) in row.split(", ").enumerate() {
        assert!(close(square.parse().unwrap(), walk(place).powi(2)));
        let sigma = file["imunoise"]["gbstd"][place]
            .as_floating_point()
            .unwrap();
        let degrees = 3600.0 * 180.0 / std::f64::consts::PI;
        assert!(
            close(sigma, walk(place) * 300_f64.sqrt() * degrees),
            "{text}"
        );
    }
}

#[test]
fn a_key_that_is_left_out_says_what_the_other_program_then_does() {
    let folder = TempDir::new().unwrap();
    simulated(folder.path(), "60s", 1, &WHITE, "white.csv");
    let written = |format: &str| export(folder.path(), "white.csv", &[format]);
    let text = written("gtsam");
    assert!(text.contains("def set_gyro_noise(params):"), "{text}");
    // Python asks for what gtsam would take for 1.
    assert!(text.contains("def set_accelerometer_noise(params, noise_density, random_walk):"));
    for (format, said) in [
        ("kalibr", "Kalibr then stops"),
        ("openvins", "OpenVINS then stops"),
        ("vins-fusion", "VINS-Fusion then takes 0"),
        ("orb-slam3", "ORB-SLAM3 then stops"),
        ("lio-sam", "LIO-SAM then takes 2e-4"),
        ("fast-lio", "FAST-LIO then takes 1e-4"),
        ("kf-gins", "KF-GINS then stops"),
        ("px4", "its default is 0.003"),
        ("ardupilot", "its default is 0.02"),
        ("sdf", "Gazebo then takes 0"),
    ] {
        let text = written(format);
        assert!(text.contains(said), "{format}: {text}");
    }
}

#[test]
fn output_file_is_written_completely_and_bad_options_are_refused() {
    let (folder, _) = folder();
    let arguments = [
        "export",
        "curve.json",
        "--model",
        "five-terms",
        "--format",
        "kalibr",
        "--output",
        "imu.yaml",
    ];
    assert_eq!(output(folder.path(), &arguments), "");
    let text = fs::read_to_string(folder.path().join("imu.yaml")).unwrap();
    assert_eq!(text, export(folder.path(), "curve.json", &["kalibr"]));
    let interval = [
        "export",
        "curve.json",
        "--format",
        "px4",
        "--prediction-interval",
        "0",
    ];
    assert_eq!(
        refusal(folder.path(), &interval),
        "--prediction-interval is impossible; give a positive, finite number"
    );
}
