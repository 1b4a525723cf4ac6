//! Slow Gauss–Markov noise.

use allanite_studies::slow::{BENCHMARK, Limited, benchmark, limited};

/// The probability of the ideal test from which on noise is told surely.
const SURE: f64 = 0.99;

pub(crate) fn print(records: u64, limits: u64, factor: f64) {
    let t = benchmark(records);
    let [n, rms, time] = t.covered;
    println!(
        "published benchmark, {} s at {} Hz, correlation time {} s: {} records",
        BENCHMARK.samples as f64 / BENCHMARK.rate_hz,
        BENCHMARK.rate_hz,
        BENCHMARK.correlation_time_s,
        t.records
    );
    println!(
        "named Gauss–Markov alone {}, or among alternatives {}",
        t.named, t.among
    );
    println!("B or K called measured {}", t.measured);
    println!("covered: N {n}, rms {rms}, correlation time {time}");
    for said in &t.others {
        println!("  said: {said}");
    }
    let all = limited(factor, limits);
    let told = all.iter().filter(|one| one.told).count();
    println!(
        "\n{factor} times the ideal limit, correlation time 3 s to a tenth of the record: told in {told} of {} records",
        all.len()
    );
    let ideal: f64 = all.iter().map(Limited::ideal).sum();
    println!("the ideal test, which knows the correlation time, would tell {ideal:.1}");
    let clear: Vec<&Limited> = all.iter().filter(|one| one.ideal() > SURE).collect();
    let told = clear.iter().filter(|one| one.told).count();
    println!(
        "where it would tell more than {:.0} %: told in {told} of {}",
        100.0 * SURE,
        clear.len()
    );
    for one in all.iter().filter(|one| !one.told) {
        println!(
            "  {:?}, {} samples, {:.3} s, rms {:.4}, an expected fall of {:.1}: {}",
            one.preset, one.samples, one.correlation_time_s, one.rms, one.fall, one.said
        );
    }
}
