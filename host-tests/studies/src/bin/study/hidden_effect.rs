//! How often a hidden effect is found.

use allanite_host::simulate::Preset;
use allanite_studies::hidden_effect::{Strength, both_found, cases, false_alarms, hide, study};

pub(crate) fn print(records: u64, clean: u64, only: Option<Preset>, effect: Option<&str>) {
    let presets = || {
        Preset::TYPICAL
            .into_iter()
            .filter(|&preset| only.is_none_or(|only| only == preset))
    };
    println!("records of 2^16 samples at 100 Hz; errors in %, coverage of 95 % intervals in %");
    println!(
        "{:<8} {:<18} {:<12} {:<8} {:>6} {:>8} | {:>5} {:>5} {:>5} {:>5} | {:>6} {:>5} {:>6} {:>5} {:>6} {:>5} | {:>13} {:>13} {:>5}",
        "preset",
        "effect",
        "shape",
        "strength",
        "χ²",
        "p",
        "right",
        "amb.",
        "wrong",
        "miss",
        "par.",
        "cov.",
        "par.",
        "cov.",
        "coeff.",
        "cov.",
        "rms",
        "held out",
        "falls"
    );
    for preset in presets() {
        for (name, parameters) in cases().filter(|(name, _)| effect.is_none_or(|e| e == *name)) {
            for strength in Strength::ALL {
                let Some(hidden) = hide(name, parameters, preset, strength) else {
                    continue;
                };
                let t = study(preset, &hidden, records);
                let percent = |count: usize| 100.0 * count as f64 / t.records as f64;
                print!(
                    "{:<8} {:<18} {:<12} {:<8} {:>6.0} {:>8.0e} | {:>5.0} {:>5.0} {:>5.0} {:>5.0} |",
                    format!("{preset:?}").to_lowercase(),
                    name,
                    format!("{:.4} {}", hidden.parameters[0], hidden.parameters[1]),
                    format!("{strength:?}").to_lowercase(),
                    t.median.0,
                    t.median.1,
                    percent(t.right),
                    percent(t.ambiguous),
                    percent(t.wrong),
                    percent(t.missed)
                );
                for j in 0..2 {
                    match (t.parameter_error.get(j), t.parameter_coverage.get(j)) {
                        (Some(error), Some(coverage)) if !error.is_nan() => {
                            print!(" {:>6.1} {:>5.0}", 100.0 * error, 100.0 * coverage);
                        }
                        _ => print!(" {:>6} {:>5}", "", ""),
                    }
                }
                println!(
                    " {:>6.1} {:>5.0} | {:>5.1} → {:>5.1} {:>5.1} → {:>5.1} {:>5.0}",
                    100.0 * t.coefficient_error,
                    100.0 * t.coefficient_coverage,
                    t.rms[0].0,
                    t.rms[0].1,
                    t.rms[1].0,
                    t.rms[1].1,
                    100.0 * t.held_out_falls
                );
            }
        }
    }
    if effect.is_none() {
        println!(
            "\ntwo strong effects at once, a sinusoid and a filter of two stages; share with both found:"
        );
        for preset in presets() {
            if let Some(share) = both_found(preset, records) {
                println!(
                    "{:<8} {:.0} %",
                    format!("{preset:?}").to_lowercase(),
                    100.0 * share
                );
            }
        }
    }
    println!("\nnothing hidden, {clean} records per preset; share with an effect claimed:");
    for preset in presets() {
        let (share, names) = false_alarms(preset, clean);
        println!(
            "{:<8} {:.1} % {names:?}",
            format!("{preset:?}").to_lowercase(),
            100.0 * share
        );
    }
}
