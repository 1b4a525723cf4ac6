//! An image that measures the cost of each part of an axis, from which `cargo xtask cost` adds up that of a product.
//!
//! A part's instructions and bytes are a sum of what all axes share and of what every axis takes, and the bytes
//! grow in proportion to the octaves. So one and three axes, and 10 and 30 octaves, are enough. With the argument `full`,
//! the image also measures the stack of a diagnosis of 30 octaves.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod clock;
#[cfg(target_os = "none")]
mod stack;
// This image does only a part of it.
#[cfg(target_os = "none")]
#[allow(dead_code)]
mod work;

#[cfg(target_os = "none")]
mod image {
    use crate::{clock::Clock, stack, work};
    use allanite::{
        Axes, Model,
        axis::{
            CoursePart, Courses, GatePart, Gated, MomentPart, Moments, Sample, Spectral,
            SpectrumPart,
        },
        queue::{self, Queued},
    };
    use core::hint::black_box;
    #[cfg(target_arch = "arm")]
    use cortex_m as _;
    use defmt_semihosting as _;
    use heapless::spsc::Queue;

    /// How often the counts in memory are repeated.
    const ROUNDS: i32 = 16;

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        let Some(clock) = Clock::start() else {
            defmt::error!(
                "the core's clock does not count: run the image in QEMU with -icount shift=0"
            );
            semihosting::process::exit(1);
        };
        measure(&clock);
        let arguments = semihosting::experimental::env::args::<64>();
        let mut words = arguments.iter().flatten();
        let is_full = words.nth(1).and_then(Result::ok) == Some("full");
        let done = !is_full || deep_diagnosis();
        semihosting::process::exit(i32::from(!done))
    }

    /// Measures axes with a single part each, and logs what they take.
    #[inline(never)]
    fn measure(clock: &Clock) {
        part::<0, (), (), (), ()>(clock, "bare");
        part::<0, Gated, (), (), ()>(clock, "gate");
        part::<0, (), Moments, (), ()>(clock, "moments");
        part::<0, (), (), (), Courses>(clock, "course");
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
                "{=str}_instructions_{=usize} {=f64}",
                name,
                AXES,
                total / samples
            );
        }
        let bytes = size_of::<Queued<Sample<AXES, 1>>>();
        defmt::info!("slot_bytes_{=usize} {=usize}", AXES, bytes);
    }

    fn part<const COVARIATES: usize, G, M, S, T>(clock: &Clock, name: &str)
    where
        G: GatePart,
        M: MomentPart,
        S: SpectrumPart,
        T: CoursePart,
    {
        defmt::info!(
            "{=str}_instructions_1 {=f64}",
            name,
            work::mean_of_axes::<COVARIATES, G, M, 1, S, T>(clock, ROUNDS)
        );
        defmt::info!(
            "{=str}_instructions_3 {=f64}",
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
                "{=str}_bytes_{=u8}_{=u8} {=usize}",
                name,
                axes,
                octaves,
                bytes
            );
        }
    }

    /// Measures the stack of a diagnosis of the largest number of octaves.
    #[inline(never)]
    fn deep_diagnosis() -> bool {
        let model = Model::ieee_952();
        let Some(curve) = work::curve::<30>(&[work::SINUSOID]) else {
            return false;
        };
        let stack = stack::used_by(|| {
            black_box(work::diagnose(black_box(&curve), &model));
        });
        defmt::info!("stack_of_diagnosis_30 {=usize}", stack);
        true
    }

    #[panic_handler]
    fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
        defmt::error!("{}", defmt::Display2Format(info));
        semihosting::process::exit(101)
    }
}
