//! Times the accumulator per sample on this host. `cargo xtask bench` reads the output.

use allanite::Accumulator;
use demonstration::{AMPLITUDES, simulated::SimulatedGyro};
use std::{hint::black_box, time::Instant};

const SAMPLES: usize = 1 << 22;
const RUNS: usize = 15;

type Axis = Accumulator<24>;

fn main() {
    let counts: Vec<i32> = SimulatedGyro::new(AMPLITUDES, 1).take(SAMPLES).collect();
    let slice = median(&counts, |axis, counts| axis.push_slice(counts));
    println!("ns_per_sample_slice {slice:.3}");
    let single = median(&counts, |axis, counts| {
        for &count in counts {
            axis.push(count);
        }
    });
    println!("ns_per_sample {single:.3}");
}

/// The median of several runs, in ns per sample.
fn median(counts: &[i32], work: impl Fn(&mut Axis, &[i32])) -> f64 {
    let mut times = [(); RUNS].map(|()| {
        let mut axis = Axis::new();
        let start = Instant::now();
        work(&mut axis, black_box(counts));
        let elapsed = start.elapsed();
        black_box(&axis);
        elapsed
    });
    times.sort_unstable();
    times[RUNS / 2].as_secs_f64() * 1e9 / counts.len() as f64
}
