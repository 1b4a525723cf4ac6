//! Every command says the same of a record: a gyro beside a fan, whose bias follows the temperature.

use crate::{
    browser::Browser,
    page::embedded,
    whole_page::{explored, settle},
};
use allanite::diagnosis::Verdict;
use allanite_host::verdict::{
    NOT_STATIONARY_IN_WORDS, concluded, of_five_terms, on_badge, sentence,
};
use program::{ADIS16405, json, number, output, refusal};
use serde_json::Value;
use std::{fs, path::Path};
use tempfile::TempDir;

/// Writes a log of three axes with a fan and a temperature.
fn record(folder: &Path) {
    let simulate = [
        "simulate",
        "mems",
        "--duration",
        "1800",
        "--axes",
        "3",
        "--seed",
        "5",
        "--effect",
        "sinusoid:frequency_hz=47,amplitude=0.03",
        "--effect",
        "thermal:slope=0.02,kelvin=5,period_s=400",
        "--output",
        "log.csv",
    ];
    output(folder, &simulate);
}

/// The lines of a conclusion, without what to do next.
fn conclusion(text: &str) -> Vec<&str> {
    let is_conclusion = |line: &&str| !line.starts_with("next: ") && !line.starts_with("wrote ");
    text.lines().take_while(is_conclusion).collect()
}

/// The error of each step of each axis of a diagnosis.
fn errors(diagnosis: &Value) -> Vec<Vec<f64>> {
    let steps = |axis: &Value| {
        let steps = axis["steps"].as_array().unwrap();
        steps.iter().map(|step| number(&step["error"])).collect()
    };
    diagnosis["axes"]
        .as_array()
        .unwrap()
        .iter()
        .map(steps)
        .collect()
}

#[test]
fn five_lines_say_what_how_sure_and_what_to_do() {
    let folder = TempDir::new().unwrap();
    record(folder.path());
    let text = output(folder.path(), &["diagnose", "log.csv"]);
    let lines = conclusion(&text);
    assert!(lines.len() < 5, "{text}");
    assert!(text.lines().nth(lines.len()).unwrap().contains("`report`"));
    let first = lines[0];
    assert!(first.starts_with("gx, gy and gz: "), "{first}");
    let explained = concluded(Verdict::Improved, "five terms", false);
    assert!(first.contains(&format!("{explained} (p = ")), "{first}");
    let fan = lines
        .iter()
        .find(|line| line.contains(" Hz on all three axes: sinusoid, amplitude 0.0"));
    let fan = fan.unwrap_or_else(|| panic!("{text}"));
    let frequency_hz: f64 = fan.split(' ').next().unwrap().parse().unwrap();
    assert!((frequency_hz - 47.0).abs() < 0.05, "{fan}");
    let words = ["explains ", " of χ²", "a fan", "switch off motors"];
    assert!(words.iter().all(|words| fan.contains(words)), "{fan}");
    let heat = lines.iter().find(|line| line.contains("follows temp_C"));
    let heat = heat.unwrap_or_else(|| panic!("{text}"));
    assert!(
        heat.starts_with("all three axes: the rate follows temp_C, slope 0.0"),
        "{heat}"
    );
    assert!(heat.contains(" deg/s per K;"), "{heat}");
    // What the temperature explains is no disturbance.
    for words in [NOT_STATIONARY_IN_WORDS, "leave out", "misfit", "per unit"] {
        assert!(!text.contains(words), "{words}: {text}");
    }
    assert_eq!(
        text.matches("missing effects: covariate temp_C and sinusoid (4")
            .count(),
        3
    );
}

#[test]
fn one_number_falls_and_every_view_says_the_same() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    record(folder);
    let diagnosis = json(folder, &["diagnose", "log.csv"]);
    let text = output(folder, &["diagnose", "log.csv"]);
    for axis in errors(&diagnosis) {
        assert!(axis.windows(2).all(|pair| pair[1] < pair[0]), "{axis:?}");
        for pair in axis.windows(2) {
            let step = format!(": χ² {:.1} → {:.1}, p ", pair[0], pair[1]);
            assert!(text.contains(&step), "{step}{text}");
        }
        let found = format!("; χ² {:.1} → {:.1}", axis[0], axis[axis.len() - 1]);
        let whole = sentence::improved(&found, "");
        let whole = whole.split(" (p").next().unwrap();
        assert!(text.contains(whole), "{whole}");
    }
    let axes = diagnosis["axes"].as_array().unwrap();
    let verdicts: Vec<&Value> = axes.iter().map(|axis| &axis["verdict"]).collect();
    assert_eq!(verdicts, [Verdict::Improved.name(); 3]);

    let fitted = output(folder, &["fit", "log.csv"]);
    // Each of the three axes has its own effects.
    let said = of_five_terms("", Some(false), "|");
    let said = said.split('|').next().unwrap();
    assert_eq!(fitted.matches(said).count(), 3, "{fitted}");
    assert!(!fitted.contains("tried temp_C: no dependence"), "{fitted}");
    let compared = json(folder, &["compare", "log.csv"]);
    let report = output(folder, &["report", "log.csv", "--output", "report.html"]);
    let page = fs::read_to_string(folder.join("report.html")).unwrap();
    assert_eq!(embedded(&page)["diagnosis"], diagnosis);
    assert_eq!(conclusion(&report), conclusion(&text));
    assert!(report.contains("wrote report.html: "), "{report}");
    for line in conclusion(&text) {
        let html = line
            .replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('>', "&gt;");
        assert!(page.contains(&html), "{line}");
    }
    let picture = output(folder, &["plot", "log.csv", "--output", "log.svg"]);
    assert_eq!(conclusion(&picture), conclusion(&text));
    let exported = output(folder, &["export", "log.csv", "--format", "json"]);
    let exported: Value = serde_json::from_str(&exported).unwrap();
    let log = folder.join("log.csv");
    let mut browser = explored(folder, &[log.to_str().unwrap()]).map(|url| {
        let mut browser = Browser::start();
        browser.open(&url);
        browser
    });
    for (at, axis) in axes.iter().enumerate() {
        let five = format!("{:.1}", number(&axis["steps"][0]["chi2"]));
        assert_eq!(
            format!("{:.1}", number(&compared["axes"][at]["chi2"])),
            five
        );
        assert!(fitted.contains(&format!("χ² {five}, ")), "{five}: {fitted}");
        assert!(text.contains(&format!(": {five}, ")), "{five}");
        let model = &exported["axes"][at];
        assert_eq!(model["adequate"], true);
        assert_eq!(model["notches"].as_array().unwrap().len(), 1);
        assert_eq!(model["subtract"].as_array().unwrap().len(), 1);
        if let Some(browser) = &mut browser {
            browser.click(&format!(
                "#records tbody tr:nth-child({}) input[type=radio]",
                at + 1
            ));
            settle(browser);
            assert_eq!(browser.text("#error .chi2 strong"), five);
        }
    }
}

#[test]
fn what_stays_unexplained_is_so_in_every_view() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let text = output(folder, &["diagnose", ADIS16405]);
    let diagnosis = json(folder, &["diagnose", ADIS16405]);
    let axes = diagnosis["axes"].as_array().unwrap();
    let open = axes
        .iter()
        .find(|axis| axis["verdict"] == Verdict::Incomplete.name());
    let name = open.unwrap()["axis"].as_str().unwrap();
    let lines = conclusion(&text);
    let said = concluded(Verdict::Incomplete, "five terms", false);
    let line = lines.iter().find(|line| line.contains(&said));
    assert!(line.unwrap().contains(name), "{text}");
    let report = output(folder, &["report", ADIS16405, "--output", "report.html"]);
    assert_eq!(conclusion(&report), lines);
    let page = fs::read_to_string(folder.join("report.html")).unwrap();
    assert!(page.contains(on_badge(Verdict::Incomplete)));
    let refused = refusal(folder, &["export", ADIS16405, "--format", "kalibr"]);
    assert!(
        refused.contains(&format!(
            "axis {name}: the diagnosis leaves something unexplained"
        )),
        "{refused}"
    );
}
