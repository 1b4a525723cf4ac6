//! Whether p-values are uniform and intervals contain the truth.

use crate::origin::{Origin, print_json};
use allanite::diagnosis::Options;
use allanite_host::simulate::Preset;
use allanite_studies::calibration::{Case, LEVELS, Row, SAMPLES, TERMS, study};
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
    let rows = presets.flat_map(|preset| Case::all().map(move |case| (preset, case)));
    let rows = rows.map(|(preset, case)| study(preset, case, records, options));
    if json {
        let rows: Vec<_> = rows.collect();
        return print_json(Origin::new("calibration", [0, records - 1], begun), &rows);
    }
    println!(
        "{records} records of {SAMPLES} samples at 100 Hz, short ones of 4096; shares in % of those named right, with standard errors √(p (1 − p)/n)"
    );
    let [half, most, full] = LEVELS.map(|(level, _)| 100.0 * level);
    println!(
        "intervals of {half:.0}, {most:.0} and {full:.0} %, those of effects of {full:.0} %; truths not above the upper end (of which bounds)"
    );
    println!(
        "{:<8} {:<18} {:>10} {:>7} | {:>6} {:>6} {:>6} | {} | {:>7} {:>7} {:>7} | {} | z of octaves, of bins: mean, σ, range of σ",
        "preset",
        "hidden",
        "shape",
        "records",
        "p < 5",
        "p < 1",
        "KS",
        TERMS.map(|symbol| format!("{symbol:>14}")).join(" "),
        "coeff.",
        "shape",
        "shape",
        TERMS.map(|symbol| format!("{symbol} ≤ end")).join(" "),
    );
    for row in rows {
        print_row(&row);
    }
    println!("\n{}", Origin::new("calibration", [0, records - 1], begun));
    Ok(())
}

fn print_row(row: &Row) {
    let percent = |share: f64| match share.is_nan() {
        true => "–".into(),
        false => format!("{:.1}", 100.0 * share),
    };
    let shape = match row.effect {
        None => String::new(),
        Some(_) => format!("{} {}", row.shape[0], row.shape[1]),
    };
    let name = match row.case {
        Case::Nothing => "nothing",
        Case::Short => "nothing, short",
        Case::Gaps => "nothing, gaps",
        Case::Faint => "nothing, faint K",
        Case::BandLimited => "band-limited",
        Case::Hidden(_) => row.effect.unwrap_or_default(),
    };
    let covered = row.covered.map(|levels| {
        let levels = levels.map(|share| format!("{:>4}", percent(share)));
        levels.join(" ")
    });
    let bounds: Vec<String> = (0..TERMS.len())
        .map(|i| {
            format!(
                "{:>5} ({})",
                percent(row.bounded[i]),
                percent(row.bounds[i])
            )
        })
        .collect();
    let scatter = |[mean, deviation]: [f64; 2], [least, most]: [f64; 2]| {
        format!("{mean:>5.2} {deviation:.2} {least:.2}–{most:.2}")
    };
    println!(
        "{:<8} {:<18} {:>10} {:>7} | {:>6} {:>6} {:>6.3} | {} | {} | {} | {}, {}",
        row.preset,
        name,
        shape,
        row.records,
        percent(row.p_below[0]),
        percent(row.p_below[1]),
        row.distance,
        covered.join(" "),
        row.covered_effect
            .map(|share| format!("{:>7}", percent(share)))
            .join(" "),
        bounds.join(" "),
        scatter(row.octaves, row.octave_range),
        scatter(row.bins, row.bin_range),
    );
}
