//! Tests `simulate --chain`: white noise behind filters that run at a multiple of the rate of the log.

use program::{json, number, output, refusal};
use tempfile::TempDir;

#[test]
fn noise_goes_through_the_filters_of_a_sensor_and_its_driver() {
    let folder = TempDir::new().unwrap();
    let chain = "butterworth:poles=2,cutoff_hz=12 | every:samples=8";
    let gyro = ["--angle-random-walk", "0.005", "--rate", "100"];
    let record = ["--duration", "20min", "--output", "log.npy"];
    let simulate = [&["simulate"], &gyro[..], &["--chain", chain], &record].concat();
    output(folder.path(), &simulate);
    let comment = std::fs::read_to_string(folder.path().join("log.npy.txt")).unwrap();
    assert!(comment.contains(chain), "{comment}");
    let filter = ["--filter", "low_pass:cutoff_hz=12,poles=2"];
    let fit = json(folder.path(), &[&["fit", "log.npy"], &filter[..]].concat());
    let terms = fit["axes"][0]["coefficients"].as_array().unwrap().clone();
    let white = terms.iter().find(|term| term["symbol"] == "N").unwrap();
    let share = number(&white["value"]) / 0.005;
    assert!((share - 1.0).abs() < 0.02, "{share}");
}

/// The catalogue has one filter at a time, and takes the rest of two for another effect, which takes N with it.
#[test]
fn two_filters_in_series_are_one_low_pass_of_another_form() {
    let folder = TempDir::new().unwrap();
    let chain = "butterworth:poles=2,cutoff_hz=12 | every:samples=8 | ema:share=0.4";
    let gyro = ["--angle-random-walk", "0.005", "--rate", "100"];
    let record = ["--duration", "3h", "--output", "log.npy", "--seed", "3"];
    let simulate = [&["simulate"], &gyro[..], &["--chain", chain], &record].concat();
    output(folder.path(), &simulate);
    let text = output(folder.path(), &["diagnose", "log.npy"]);
    let start = "a low pass of another form explains the record without ";
    let found = text.split_once(start).map(|(_, rest)| rest);
    let found = found.unwrap_or_else(|| panic!("{text}"));
    // N is what the chain leaves of it at frequency zero, which is all of it.
    let (_, white) = found.split_once(", N ").unwrap();
    let numbers: Vec<f64> = (white.split([' ', '(', ')', '…']))
        .filter_map(|word| word.parse().ok())
        .take(3)
        .collect();
    assert!((numbers[0] / 0.005 - 1.0).abs() < 0.05, "{found}");
    assert!(numbers[1] < 0.005 && 0.005 < numbers[2], "{found}");
    // A filter that the catalogue has needs no other form.
    let chain = "butterworth:poles=2,cutoff_hz=12 | every:samples=64";
    let simulate = [&["simulate"], &gyro[..], &["--chain", chain], &record].concat();
    std::fs::remove_file(folder.path().join("log.npy")).unwrap();
    output(folder.path(), &simulate);
    let text = output(folder.path(), &["diagnose", "log.npy"]);
    assert!(!text.contains("another form"), "{text}");
}

#[test]
fn a_chain_that_is_not_understood_is_refused() {
    let folder = TempDir::new().unwrap();
    let both = [
        "--chain",
        "ema:share=0.4",
        "--effect",
        "low_pass:cutoff_hz=5,poles=1",
    ];
    let told = refusal(folder.path(), &[&["simulate", "mems"], &both[..]].concat());
    assert!(
        told.contains("replace the same white noise; drop one of them"),
        "{told}"
    );
    let told = refusal(
        folder.path(),
        &["simulate", "mems", "--chain", "bessel:poles=2"],
    );
    assert!(
        told.contains("bessel: no such stage; choose from"),
        "{told}"
    );
}
