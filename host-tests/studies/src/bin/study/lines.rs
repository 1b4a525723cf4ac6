//! Lines of random frequency and amplitude.

use allanite_host::simulate::Preset;
use allanite_studies::lines;

pub(crate) fn print(records: u64) {
    println!(
        "{:<8} {:>7} {:>7} {:>7} | {:>7} {:>7} {:>9} | {:>8} {:>7} {:>11}",
        "gyro",
        "records",
        "aborted",
        "nothing",
        "line",
        "within",
        "ambiguous",
        "and more",
        "others",
        "unexplained"
    );
    println!(
        "{:<8} {:>7} {:>7} {:>7} | {:>7} {:>7}",
        "", "", "", "", "alone", "1 %"
    );
    for preset in Preset::TYPICAL {
        let t = lines::study(preset, records);
        println!(
            "{:<8} {:>7} {:>7} {:>7} | {:>7} {:>7} {:>9} | {:>8} {:>7} {:>11}",
            format!("{preset:?}").to_lowercase(),
            t.records,
            t.aborted,
            t.nothing,
            t.line,
            t.exact,
            t.ambiguous,
            t.more,
            t.others,
            t.unexplained
        );
        for (line, named) in t.wrong {
            let named: Vec<String> = named
                .iter()
                .map(|term| format!("{} {:.4?}", term.effect.name(), term.parameters))
                .collect();
            println!(
                "         {:.4} Hz, amplitude {:.4}: {}",
                line.frequency_hz,
                line.amplitude,
                named.join(", ")
            );
        }
    }
    println!(
        "lines at 0.97 to 0.9999 of half the rate, 0.3 to 2 times the white noise of a sample:"
    );
    for preset in Preset::TYPICAL {
        let t = lines::near_half(preset, records);
        println!(
            "{:<8} {} records, {} found, {} within the interval, mean error {:+.3} Hz",
            format!("{preset:?}").to_lowercase(),
            t.records,
            t.found,
            t.covered,
            t.error_hz / t.found.max(1) as f64
        );
    }
}
