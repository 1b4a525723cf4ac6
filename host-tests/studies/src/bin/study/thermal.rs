//! Temperatures that the rate depends on.

use allanite_host::simulate::Preset;
use allanite_studies::{
    lag::{self, Course, Dependence, Tally},
    thermal,
};

fn print_heading(first: &str) {
    println!(
        "{first:<7} {:<10} {:<9} {:>6} {:>7} {:>7} {:>7} {:>13} {:>11} {:>13} {:>8} {:>6}",
        "course",
        "follows",
        "found",
        "lagged",
        "rate",
        "square",
        "slope inside",
        "lag inside",
        "wrong effect",
        "bounded",
        "holds"
    );
}

fn print_line(first: &str, course: Course, dependence: Dependence, tally: &Tally) {
    println!(
        "{first:<7} {:<10} {:<9} {:>6} {:>7} {:>7} {:>7} {:>13} {:>11} {:>13} {:>8} {:>6}",
        format!("{course:?}"),
        format!("{dependence:?}"),
        tally.found,
        tally.lagged,
        tally.rate_of_change,
        tally.square,
        tally.slope_inside,
        tally.lag_inside,
        tally.wrong,
        tally.bounded,
        tally.bound_holds
    );
}

/// Temperatures whose course, noise and lag are drawn at random, with seeds from 0 on.
pub(crate) fn print_drawn(records: u64) {
    println!(
        "20 Hz, {records} records of 2^16 samples a line; lag 10 … 120 s, thermometer noise 0 … 0.2 K, steps of 0.1 K in half of them"
    );
    print_heading("preset");
    for preset in [Preset::Mems, Preset::Fog] {
        for dependence in [
            Dependence::Lagged,
            Dependence::AtOnce,
            Dependence::Square,
            Dependence::None,
        ] {
            for course in Course::ALL {
                let tally = lag::study(preset, course, dependence, None, records);
                print_line(&format!("{preset:?}"), course, dependence, &tally);
            }
        }
    }
}

/// Thermometers with coarse steps, with seeds from 0 on.
pub(crate) fn print_steps(records: u64) {
    println!(
        "mems at 20 Hz, {records} records of 2^16 samples a line; lag 10 … 120 s, thermometer noise 0.02 K"
    );
    print_heading("step, K");
    let courses = [Course::WarmUp, Course::SlowCycle, Course::Ramp];
    for dependence in [
        Dependence::AtOnce,
        Dependence::Lagged,
        Dependence::Weak,
        Dependence::None,
    ] {
        for step in [0.01, 0.1, 0.5, 1.0] {
            for course in courses {
                let tally = lag::study(Preset::Mems, course, dependence, Some(step), records);
                print_line(&step.to_string(), course, dependence, &tally);
            }
        }
    }
}

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
