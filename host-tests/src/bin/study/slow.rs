//! Slow Gauss–Markov noise.

use host_tests::study::slow::{BENCHMARK, benchmark, limited};

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
    for one in all.iter().filter(|one| !one.told) {
        println!(
            "  {:?}, {} samples, {:.3} s, rms {:.4}: {}",
            one.preset, one.samples, one.correlation_time_s, one.rms, one.said
        );
    }
}
