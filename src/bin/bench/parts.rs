//! The cost of each part of an axis, from which `cargo xtask cost` adds up that of a product.
//!
//! A part's instructions and bytes are a sum of what all axes share and of what every axis takes, and the bytes
//! grow in proportion to the octaves. So one and three axes, and 10 and 30 octaves, are enough.

use crate::{clock::Clock, work};
use allanite::{
    Axes,
    axis::{
        GatePart, Gated, MomentPart, Moments, Sample, Spectral, SpectrumPart, TrackPart, Tracked,
    },
    queue::{self, Queued},
};
use core::hint::black_box;
use heapless::spsc::Queue;

/// How often the counts in memory are repeated.
const ROUNDS: i32 = 16;

/// Measures axes with a single part each, and logs what they take.
#[inline(never)]
pub(crate) fn measure(clock: &Clock) {
    part::<0, (), (), (), ()>(clock, "bare");
    part::<0, Gated, (), (), ()>(clock, "gate");
    part::<0, (), Moments, (), ()>(clock, "moments");
    part::<0, (), (), (), Tracked>(clock, "course");
    part::<1, (), (), (), ()>(clock, "covariate");
    part::<0, (), (), Spectral<32>, ()>(clock, "spectrum_32");
    part::<0, (), (), Spectral<64>, ()>(clock, "spectrum_64");
    part::<0, (), (), Spectral<128>, ()>(clock, "spectrum_128");
    part::<0, (), (), Spectral<256>, ()>(clock, "spectrum_256");
    handing_over::<1>(clock);
    handing_over::<3>(clock);
}

/// Measures how samples of all axes and one covariate pass from an interrupt to the main loop.
fn handing_over<const AXES: usize>(clock: &Clock) {
    /// The number of samples that wait when the main loop comes.
    const LATE: i32 = 8;
    const TIMES: i32 = 1000;
    let mut queue = Queue::<Queued<Sample<AXES, 1>>, 16>::new();
    let (mut sender, mut receiver) = queue::split(&mut queue);
    let (mut interrupt, mut main_loop) = (0.0, 0.0);
    for _ in 0..TIMES {
        interrupt += clock.instructions(|| {
            for n in 0..LATE {
                sender.send(black_box(([n; AXES], [n])).into());
            }
        });
        main_loop += clock.instructions(|| {
            while let Some(queued) = receiver.receive() {
                black_box(&queued);
            }
        });
    }
    let samples = f64::from(TIMES) * f64::from(LATE);
    for (name, total) in [("send", interrupt), ("receive", main_loop)] {
        defmt::info!(
            "part_{=str}_instructions_{=usize} {=f64}",
            name,
            AXES,
            total / samples
        );
    }
    let bytes = size_of::<Queued<Sample<AXES, 1>>>();
    defmt::info!("part_slot_bytes_{=usize} {=usize}", AXES, bytes);
}

fn part<const COVARIATES: usize, G, M, S, T>(clock: &Clock, name: &str)
where
    G: GatePart,
    M: MomentPart,
    S: SpectrumPart,
    T: TrackPart,
{
    defmt::info!(
        "part_{=str}_instructions_1 {=f64}",
        name,
        work::mean_of_axes::<COVARIATES, G, M, 1, S, T>(clock, ROUNDS)
    );
    defmt::info!(
        "part_{=str}_instructions_3 {=f64}",
        name,
        work::mean_of_axes::<COVARIATES, G, M, 3, S, T>(clock, ROUNDS)
    );
    for (axes, octaves, bytes) in [
        (1, 10, size_of::<Axes<10, COVARIATES, G, M, 1, S, T>>()),
        (1, 30, size_of::<Axes<30, COVARIATES, G, M, 1, S, T>>()),
        (3, 10, size_of::<Axes<10, COVARIATES, G, M, 3, S, T>>()),
        (3, 30, size_of::<Axes<30, COVARIATES, G, M, 3, S, T>>()),
    ] {
        defmt::info!(
            "part_{=str}_bytes_{=u8}_{=u8} {=usize}",
            name,
            axes,
            octaves,
            bytes
        );
    }
}
