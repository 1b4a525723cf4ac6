//! Temperatures that the rate depends on.

use host_tests::study::thermal;

pub(crate) fn print(records: u64) {
    println!("mems at 20 Hz, {records} records of 2^16 samples, 0.01 deg/s per kelvin");
    println!(
        "{:<20} {:>6} {:>12} {:>9} {:>9} {:>11} {:>17} {:>13}",
        "course",
        "found",
        "mean slope",
        "coverage",
        "scatter",
        "error",
        "over the bound",
        "wrongly blamed"
    );
    for (name, course, kelvin, bound) in thermal::CASES {
        let t = thermal::study(course, kelvin, records);
        println!(
            "{name:<20} {:>4.1} % {:>10.3}   {:>7.1} % {:>9.5} {:>11.5} {:>17.2} {:>11.2} %",
            100.0 * t.found,
            t.mean,
            100.0 * t.coverage,
            t.deviation,
            t.error,
            t.error / bound,
            100.0 * t.blamed
        );
    }
    println!(
        "\nwith strong Gauss–Markov noise (T_c 1 s) and ten times the slope; share with both found:"
    );
    for (name, course, kelvin, _) in thermal::CASES {
        let share = thermal::with_gauss_markov(course, kelvin, records.min(200));
        println!("{name:<20} {:.1} %", 100.0 * share);
    }
}
