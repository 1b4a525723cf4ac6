//! Tests `report`: the page contains the results of `diagnose`, is accessible, and can be stepped
//! through.

use crate::{
    browser::Browser,
    page::{embedded, opened, reported, simulate, steps},
};
use program::{ADIS16405, measure_without_spectrum, number, output, refusal, rows};
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

/// The text of the page about the error of a fit.
fn error(fit: &Value) -> String {
    let (chi2, dof) = (number(&fit["chi2"]), &fit["dof"]);
    format!("χ² {chi2:.1} for {dof} degrees of freedom")
}

/// The error that the page shows for an axis.
fn shown_error(browser: &mut Browser, axis: usize) -> String {
    browser.text(&format!("#axis-{axis} .error .figures:nth-child(1)"))
}

/// The contrast of two colours like `rgb(1, 2, 3)`, as in WCAG 2.
const CONTRAST: &str = "((a, b) => {
    const light = (colour) => {
        const [r, g, b] = colour.match(/[0-9.]+/g).slice(0, 3).map((part) => part / 255)
            .map((part) => part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4);
        return 0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05;
    };
    const [x, y] = [light(a), light(b)];
    return Math.max(x, y) / Math.min(x, y);
})";

#[test]
fn the_page_contains_the_printed_diagnosis_and_loads_nothing_external() {
    let folder = TempDir::new().unwrap();
    let diagnosis = reported(folder.path(), &[ADIS16405]);
    let page = fs::read_to_string(folder.path().join("report.html")).unwrap();
    assert!(page.len() < 1 << 20, "{} bytes", page.len());
    assert_eq!(embedded(&page)["diagnosis"], diagnosis);
    for word in ["src=", "url(", "@import", "fetch(", "href=\"http"] {
        assert!(!page.contains(word), "{word}");
    }
    let text = output(folder.path(), &["diagnose", ADIS16405]);
    let html = |line: &str| {
        line.replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('>', "&gt;")
    };
    // Without a script, the page shows all results.
    let (_, plain) = page.split_once("<noscript>").unwrap();
    assert!(text.lines().all(|line| plain.contains(&html(line))));
}

#[test]
fn each_axis_begins_with_where_it_fails_the_missing_effect_and_the_decrease_of_the_error() {
    let folder = TempDir::new().unwrap();
    let diagnosis = reported(folder.path(), &[ADIS16405]);
    let mut browser = opened(folder.path());
    for (number_of_axis, axis) in diagnosis["axes"].as_array().unwrap().iter().enumerate() {
        let lead = browser.text(&format!(".summary li:nth-child({}) p", number_of_axis + 1));
        let (first, last) = (&steps(axis)[0], &steps(axis)[steps(axis).len() - 1]);
        let worst = &first["worst"];
        let parts = [
            format!("{:.0} % ", number(&worst["percent"]).abs()),
            format!("τ = {:.1} ms", 1e3 * number(&worst["tau_s"])),
            format!("({:.0} standard errors)", number(&worst["z"]).abs()),
            format!(
                "χ² {:.1} → {:.1}",
                number(&first["error"]),
                number(&last["error"])
            ),
            axis["missing"][0].as_str().unwrap().replace('_', " "),
        ];
        for part in parts {
            assert!(lead.contains(&part), "{part}: {lead}");
        }
        // The worst octave is marked and named in both panels.
        let figure = format!("#axis-{number_of_axis} .figure.deviation");
        let rings = browser.value(&format!(
            "document.querySelectorAll('{figure} .worst').length"
        ));
        assert_eq!(rings, 2);
        let label = browser.value(&format!(
            "document.querySelector('{figure} .worst-label').textContent"
        ));
        let size = format!("{:.0} std. errors", number(&worst["z"]).abs());
        assert!(label.as_str().unwrap().contains(&size), "{label}");
        // The cursor is on the worst octave at first, and tells its numbers.
        let readout = browser.text(&format!(
            "#axis-{number_of_axis} .place:nth-child(1) .readout"
        ));
        let z = number(&worst["z"]);
        let sign = if z < 0.0 { '−' } else { '+' };
        let parts = [
            format!("averaging time τ {:.5} s", number(&worst["tau_s"])),
            format!("residual {sign}{:.1} std. errors", z.abs()),
        ];
        assert!(
            parts.iter().all(|part| readout.contains(part)),
            "{parts:?}: {readout}"
        );
    }
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn steps_are_selected_by_mouse_and_keyboard_and_show_their_own_error() {
    let folder = TempDir::new().unwrap();
    let diagnosis = reported(folder.path(), &[ADIS16405]);
    let mut browser = opened(folder.path());
    let steps = steps(&diagnosis["axes"][2]);
    let last = steps.len() - 1;
    assert!(last >= 2, "{last}");
    let expect = |browser: &mut Browser, step: usize| {
        assert_eq!(shown_error(browser, 2), error(&steps[step]));
        let tab = browser.text("#axis-2 [role=tab][aria-selected=true] .chi2");
        assert_eq!(tab, format!("χ² {:.1}", number(&steps[step]["chi2"])));
    };
    expect(&mut browser, 0);
    let [previous, next] =
        ["Previous", "Next"].map(|way| format!("#axis-2 [aria-label='{way} step']"));
    for step in 1..=last {
        browser.click(&next);
        expect(&mut browser, step);
    }
    // There is no step after the last one.
    browser.click(&next);
    expect(&mut browser, last);
    browser.click(&previous);
    expect(&mut browser, last - 1);
    browser.click("#axis-2 [role=tab]:first-child");
    expect(&mut browser, 0);
    let right = (2..=last).map(|step| ("ArrowRight", step));
    let keys = std::iter::once(("ArrowDown", 1)).chain(right).chain([
        ("ArrowRight", last),
        ("ArrowUp", last - 1),
        ("ArrowLeft", last - 2),
    ]);
    for (key, step) in keys {
        browser.press(key);
        expect(&mut browser, step);
        assert_eq!(
            browser.value("document.activeElement.getAttribute('aria-selected')"),
            "true"
        );
        // With the keyboard, the focus is visible.
        let outline = browser.value("getComputedStyle(document.activeElement).outlineStyle");
        assert_eq!(outline, "solid");
    }
    // The bars become shorter as the error falls.
    let widths = browser
        .value("[...document.querySelectorAll('#axis-2 .fill')].map((fill) => fill.getBoundingClientRect().width)");
    let widths: Vec<f64> = widths.as_array().unwrap().iter().map(number).collect();
    assert!(
        widths.is_sorted_by(|before, after| before > after),
        "{widths:?}"
    );
    assert!(
        widths[0] > 1.15 * widths[1] && widths[1] > 1.2 * widths[last],
        "{widths:?}"
    );
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn every_candidate_shows_its_own_fit() {
    let folder = TempDir::new().unwrap();
    // In the octaves alone, other effects look like the two.
    let hidden = [
        "sinusoid:frequency_hz=7.7,amplitude=0.0267",
        "decimation_filter:width_s=0.0235,stages=2",
    ];
    simulate(folder.path(), &hidden);
    // The spectrum would show both effects at once, so it is left out.
    measure_without_spectrum(folder.path(), "log.csv");
    let diagnosis = reported(folder.path(), &["curve.json"]);
    let steps = steps(&diagnosis["axes"][0]);
    let several = |step: &Value| step["candidates"].as_array().unwrap().len() > 1;
    assert!(steps.iter().any(several), "{steps:?}");
    let mut browser = opened(folder.path());
    for (at, step) in steps.iter().enumerate() {
        browser.click(&format!("#axis-0-step-{at}"));
        let candidates = step["candidates"].as_array().unwrap();
        for (place, candidate) in candidates.iter().enumerate() {
            browser.click(&format!("#axis-0-candidate-{place}"));
            let heading = browser.text("#axis-0 .model");
            let shown = shown_error(&mut browser, 0);
            if place == 0 && !step["added"].is_null() {
                assert_eq!(shown, error(&steps[at + 1]));
                continue;
            }
            let name = match candidate["effect"].as_str().unwrap() {
                "gauss_markov" => "Gauss–Markov".to_owned(),
                name => name.replace('_', " "),
            };
            assert!(
                heading.starts_with("With this candidate") && heading.contains(&name),
                "{heading}"
            );
            // The shape in the list is that of another model of the whole record, and here it is fitted anew.
            let chi2: f64 = shown.split(' ').nth(1).unwrap().parse().unwrap();
            assert!(
                chi2 > 0.0 && number(&candidate["chi2"]) > 0.0,
                "{name}: {chi2}"
            );
            assert_ne!(shown, error(step));
        }
        if !candidates.is_empty() {
            // The keys move from the first candidate to the step's own model.
            browser.click("#axis-0-candidate-0");
            browser.press("ArrowUp");
            assert_eq!(shown_error(&mut browser, 0), error(step));
        }
    }
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn units_change_coefficients_and_the_axis_of_the_plot() {
    let folder = TempDir::new().unwrap();
    let diagnosis = reported(folder.path(), &[ADIS16405]);
    let mut browser = opened(folder.path());
    let coefficients = diagnosis["axes"][0]["steps"][0]["coefficients"]
        .as_array()
        .unwrap();
    let random_walk = &coefficients[1];
    assert_eq!(random_walk["effect"], "angle_random_walk");
    let row = "#axis-0 .coefficients tbody tr:nth-child(2)";
    let title = "document.querySelector('#axis-0 .figure').textContent";
    for (unit, factor, name, rate) in [(0, 1.0, "deg/s/√Hz", "deg/s"), (1, 60.0, "°/√h", "°/h")]
    {
        browser.click(&format!("#units [value='{unit}']"));
        assert_eq!(browser.text(&format!("{row} .unit")), name);
        let shown =
            [format!("{row} .best"), format!("{row} .interval")].map(|cell| browser.text(&cell));
        let shown = shown.join(" … ");
        let shown: Vec<f64> = shown
            .split(" … ")
            .map(|part| part.parse().unwrap())
            .collect();
        for (shown, key) in shown.iter().zip(["value", "lower", "upper"]) {
            let expected = factor * number(&random_walk[key]);
            assert!(
                (shown / expected - 1.0).abs() < 5e-4,
                "{key}: {shown}, {expected}"
            );
        }
        let words = browser.value(title);
        let words = words.as_str().unwrap();
        assert!(
            words.contains(&format!("Allan deviation σ, {rate}")),
            "{words}"
        );
    }
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn the_page_fits_a_phone_is_readable_in_the_dark_and_can_be_printed() {
    let folder = TempDir::new().unwrap();
    reported(folder.path(), &[ADIS16405]);
    let mut browser = opened(folder.path());
    for (medium, scheme, width) in [
        ("screen", "light", 390),
        ("screen", "dark", 390),
        ("screen", "dark", 1280),
        ("print", "dark", 700),
    ] {
        browser.emulate(medium, scheme);
        browser.resize(width, 844);
        for step in 0..3 {
            browser.value(&format!("walks.forEach((walk) => walk.show({step}))"));
            let wide = browser.value("document.documentElement.scrollWidth");
            assert!(
                number(&wide) <= f64::from(width),
                "{wide} pixels of {width}"
            );
            // There is no clipped text inside an element either.
            let clipped = browser.value(
                "[...document.querySelectorAll('p, td, th, dd, li, h2, h3, button')]\
                 .filter((one) => one.scrollWidth > one.clientWidth + 1 && one.clientWidth > 0)\
                 .map((one) => one.textContent)",
            );
            assert_eq!(clipped, Value::Array(Vec::new()), "{width}");
            // Ticks and titles of the figure lie inside it.
            let outside = browser.value(
                "[...document.querySelectorAll('.figure text')].filter((text) => {\
                 const [box, paper] = [text, text.closest('svg')].map((one) => one.getBoundingClientRect());\
                 return box.left < paper.left - 1 || box.right > paper.right + 1;\
                 }).map((text) => text.textContent)",
            );
            assert_eq!(outside, Value::Array(Vec::new()), "{width}");
        }
        for (selector, property) in [
            ("body", "color"),
            (".words", "color"),
            (".figure text", "fill"),
            (".figure .pale", "fill"),
            (".badge", "color"),
            ("a", "color"),
        ] {
            let contrast = browser.value(&format!(
                "{CONTRAST}(getComputedStyle(document.querySelector('{selector}'))['{property}'], \
                 getComputedStyle(document.body).backgroundColor)"
            ));
            assert!(
                number(&contrast) >= 4.5,
                "{medium}, {scheme}: {selector}: {contrast}"
            );
        }
        let paper = browser.value("getComputedStyle(document.body).backgroundColor");
        assert_eq!(
            paper == "rgb(255, 255, 255)",
            medium == "print" || scheme == "light",
            "{paper}"
        );
    }
    let buttons = browser.value("document.querySelector('.turn').offsetHeight");
    assert_eq!(buttons, 0, "on paper nothing is pressed");
    let pdf = browser.call("Page.printToPDF", serde_json::json!({}));
    // This is `%PDF` in base 64.
    assert!(pdf["data"].as_str().unwrap().starts_with("JVBERi"));
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn names_are_shown_as_text_and_never_run_as_markup() {
    let folder = TempDir::new().unwrap();
    let hostile =
        "</script><script>window.taken=1</script><img src=x onerror='window.taken=1'>&amp;\"";
    let mut curves: Value = serde_json::from_str(&fs::read_to_string(ADIS16405).unwrap()).unwrap();
    let axis = &mut curves["axes"][0];
    axis["axis"] = hostile.into();
    axis["source"] = hostile.into();
    let file = "<img src=x onerror=\"window.taken=1\">'.json";
    fs::write(folder.path().join(file), curves.to_string()).unwrap();
    let diagnosis = reported(folder.path(), &[file]);
    let page = fs::read_to_string(folder.path().join("report.html")).unwrap();
    assert_eq!(embedded(&page)["diagnosis"], diagnosis);
    let mut browser = opened(folder.path());
    assert_eq!(browser.value("typeof window.taken"), "undefined");
    assert_eq!(browser.value("document.scripts.length"), 16);
    assert_eq!(browser.value("document.images.length"), 0);
    assert_eq!(
        browser.value("document.querySelector('.axis h2').textContent"),
        hostile
    );
    assert_eq!(
        browser.value("document.querySelector('h1 .name').textContent"),
        file
    );
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn a_covariate_is_a_step_and_the_settings_reproduce_the_page() {
    let folder = TempDir::new().unwrap();
    let thermal = "thermal:slope=0.03,kelvin=10,period_s=300";
    simulate(folder.path(), &[thermal]);
    let diagnosis = reported(folder.path(), &["log.csv", "--covariates", "temp_C"]);
    let steps = steps(&diagnosis["axes"][0]);
    let mut browser = opened(folder.path());
    browser.click("#axis-0 [aria-label='Next step']");
    assert_eq!(shown_error(&mut browser, 0), error(&steps[1]));
    let finding = browser.text("#axis-0 .finding");
    assert!(
        finding.contains("What was missing: covariate temp_C") && finding.contains("slope 0.0"),
        "{finding}"
    );
    let settings = browser.text(".settings");
    let command = "allanite report log.csv --covariates temp_C --plain --output report.html";
    for part in [command, env!("CARGO_PKG_VERSION"), "1 %", "p = 0.01"] {
        assert!(settings.contains(part), "{part}: {settings}");
    }
    assert!(browser.complaints.is_empty(), "{:?}", browser.complaints);
}

#[test]
fn pages_that_cannot_be_written_are_refused_before_anything_is_read() {
    let folder = TempDir::new().unwrap();
    for (input, page, message) in rows! {
        ADIS16405, "report.pdf", "report.pdf: a page must end in .html; rename the output";
        ADIS16405, "absent/report.html", "its folder does not exist; create the folder first";
        "absent.json", "report.html", "absent.json: no such file; check the path";
    } {
        let refused = refusal(folder.path(), &["report", input, "--output", page]);
        assert!(refused.contains(message), "{refused}");
    }
    fs::create_dir(folder.path().join("folder.html")).unwrap();
    let refused = refusal(
        folder.path(),
        &["report", ADIS16405, "--output", "folder.html"],
    );
    assert!(refused.contains("is a directory"), "{refused}");
    // No partial file remains.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
