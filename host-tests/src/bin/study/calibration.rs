//! Whether p-values are uniform and intervals contain the truth.

use crate::origin::{Origin, print_json};
use allanite::diagnosis::Options;
use host_tests::{
    simulate::Preset,
    study::calibration::{ALL, SAMPLES, TERMS, study},
};
use std::time::Instant;

pub(crate) fn print(
    records: u64,
    only: Option<Preset>,
    tolerance: Option<f64>,
    json: bool,
) -> anyhow::Result<()> {
    let begun = Instant::now();
    let mut options = Options::default();
    options.tolerance = tolerance.unwrap_or(options.tolerance);
    let presets = Preset::TYPICAL.into_iter();
    let presets = presets.filter(|&preset| only.is_none_or(|only| only == preset));
    let rows = presets.flat_map(|preset| (0..ALL).map(move |case| (preset, case)));
    let rows = rows.map(|(preset, case)| study(preset, case, records, options));
    if json {
        let rows: Vec<_> = rows.collect();
        return print_json(Origin::new("calibration", [0, records - 1], begun), &rows);
    }
    println!(
        "{records} records of {SAMPLES} samples at 100 Hz; shares in % of those named right, with standard errors √(p (1 − p)/n)"
    );
    println!(
        "{:<8} {:<18} {:>10} {:>7} | {:>6} {:>6} {:>6} | {} | {:>7} {:>7} {:>7}",
        "preset",
        "hidden",
        "shape",
        "records",
        "p < 5",
        "p < 1",
        "KS",
        TERMS.map(|symbol| format!("{symbol:>5}")).join(" "),
        "coeff.",
        "shape",
        "shape",
    );
    for row in rows {
        let percent = |share: f64| match share.is_nan() {
            true => String::new(),
            false => format!("{:.1}", 100.0 * share),
        };
        let shape = match row.effect {
            None => String::new(),
            Some(_) => format!("{} {}", row.shape[0], row.shape[1]),
        };
        println!(
            "{:<8} {:<18} {:>10} {:>7} | {:>6} {:>6} {:>6.3} | {} | {}",
            row.preset,
            row.effect
                .unwrap_or(if row.gaps { "nothing, gaps" } else { "nothing" }),
            shape,
            row.records,
            percent(row.p_below[0]),
            percent(row.p_below[1]),
            row.distance,
            row.covered
                .map(|share| format!("{:>5}", percent(share)))
                .join(" "),
            row.covered_effect
                .map(|share| format!("{:>7}", percent(share)))
                .join(" "),
        );
    }
    println!("\n{}", Origin::new("calibration", [0, records - 1], begun));
    Ok(())
}
