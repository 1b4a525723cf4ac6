//! Lines of random frequency and amplitude.

use host_tests::{simulate::Preset, study::lines};

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
}
