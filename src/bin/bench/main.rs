//! An image that measures the library in QEMU, which counts instructions but not cycles:
//! `cargo xtask bench`. Its first argument says how much to measure, `full` is everything. On a core of ARMv6-M
//! it measures what fits into 16 KiB of RAM.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod clock;
#[cfg(target_os = "none")]
mod stack;
#[cfg(target_os = "none")]
mod varied;
#[cfg(target_os = "none")]
mod work;

#[cfg(target_os = "none")]
mod image {
    use crate::clock::Clock;
    use crate::{stack, varied, work};
    use allanite::{
        Accumulator, Axes, Curve, Model, Real,
        axis::{Courses, Gated, Moments, Spectral},
        course::Course,
        ieee_952,
        self_test::Status,
        spectrum::{Spectrum, SpectrumAccumulator},
    };
    use core::hint::black_box;
    #[cfg(target_arch = "arm")]
    use cortex_m as _;
    use defmt_semihosting as _;

    /// The number of octaves of an axis whose fit still fits into 16 KiB.
    const SMALL: usize = 14;
    const USUAL: usize = 20;
    /// A core without atomic exchanges, whose board has no room for a diagnosis: ARMv6-M.
    const IS_SMALL: bool = cfg!(all(target_arch = "arm", not(target_has_atomic = "32")));
    /// Four levels of spectrum.
    const BINS: usize = 112;

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        let Some(clock) = Clock::start() else {
            defmt::error!(
                "the core's clock does not count: run the image in QEMU with -icount shift=0"
            );
            semihosting::process::exit(1);
        };
        let done = with_extent(|extent| match extent {
            "worst" if IS_SMALL => worst_of_all::<SMALL>(&clock),
            "worst" => worst_of_all::<USUAL>(&clock),
            _ if IS_SMALL => {
                samples(&clock);
                worst::<24>(&clock, SOON);
                fit::<SMALL>(&clock)
            }
            "full" => {
                samples(&clock);
                slices(&clock);
                axes(&clock);
                spectrum(&clock);
                worst::<12>(&clock, LATE);
                worst::<24>(&clock, LATE);
                worst::<30>(&clock, LATE);
                fit::<USUAL>(&clock)
                    && diagnosis(&clock)
                    && diagnosis_with_spectrum(&clock)
                    && stretches(&clock)
            }
            _ => {
                samples(&clock);
                worst::<24>(&clock, SOON);
                fit::<USUAL>(&clock) && diagnosis(&clock)
            }
        });
        semihosting::process::exit(i32::from(!done))
    }

    /// Calls `measure` with the first argument. The name of the image precedes it.
    fn with_extent(measure: impl FnOnce(&str) -> bool) -> bool {
        let arguments = semihosting::experimental::env::args::<64>();
        let mut words = arguments.iter().flatten();
        measure(words.nth(1).and_then(Result::ok).unwrap_or(""))
    }

    #[inline(never)]
    fn samples(clock: &Clock) {
        let mean = work::mean(clock, work::push) - work::mean(clock, work::nothing);
        defmt::info!("instructions_per_sample {=f64}", mean);
        defmt::info!(
            "ram_bytes_per_axis_24 {=usize}",
            size_of::<Accumulator<24>>()
        );
    }

    /// Measures three axes with every part of the library and one covariate.
    #[inline(never)]
    fn axes(clock: &Clock) {
        let mean = work::mean_of_axes::<1, Gated, Moments, 3, (), ()>(clock, work::ROUNDS);
        defmt::info!("instructions_per_sample_three_axes {=f64}", mean);
        let axis = size_of::<Axes<USUAL, 1>>() / 3;
        defmt::info!("ram_bytes_per_axis_20_with_all_parts {=usize}", axis);
        let with_spectrum =
            work::mean_of_axes::<1, Gated, Moments, 3, Spectral, ()>(clock, work::ROUNDS);
        defmt::info!(
            "instructions_per_sample_three_axes_with_spectrum {=f64}",
            with_spectrum
        );
        let with_course =
            work::mean_of_axes::<1, Gated, Moments, 3, Spectral, Courses>(clock, work::ROUNDS);
        defmt::info!(
            "instructions_per_sample_three_axes_with_spectrum_and_course {=f64}",
            with_course
        );
        defmt::info!(
            "ram_bytes_per_axis_of_course {=usize}",
            size_of::<Course<1>>()
        );
        defmt::info!(
            "ram_bytes_per_axis_of_spectrum {=usize}",
            size_of::<SpectrumAccumulator<64, 7>>()
        );
    }

    /// Measures the two halves of a spectrum's work for one axis.
    #[inline(never)]
    fn spectrum(clock: &Clock) {
        let [interrupt, main_loop] = work::mean_of_spectrum(clock);
        defmt::info!(
            "instructions_per_sample_spectrum_interrupt {=f64}",
            interrupt
        );
        defmt::info!(
            "instructions_per_sample_spectrum_main_loop {=f64}",
            main_loop
        );
    }

    /// Measures a diagnosis of a record of 2^21 samples that has a spectrum.
    #[inline(never)]
    fn diagnosis_with_spectrum(clock: &Clock) -> bool {
        let model = Model::ieee_952();
        let Some(curve) = work::curve::<USUAL>(&[work::SINUSOID]) else {
            return false;
        };
        let Some(spectrum) = work::spectrum::<BINS>(&[work::SINUSOID]) else {
            return false;
        };
        let mut found = false;
        let instructions = clock.instructions(|| {
            found = work::diagnose_both(black_box(&curve), black_box(&spectrum), &model);
        });
        let stack = stack::used_by(|| {
            black_box(work::diagnose_both(black_box(&curve), &spectrum, &model));
        });
        defmt::info!(
            "instructions_of_diagnosis_with_spectrum {=f64}",
            instructions
        );
        defmt::info!("stack_of_diagnosis_with_spectrum {=usize}", stack);
        found
    }

    #[inline(never)]
    fn slices(clock: &Clock) {
        let mean = work::mean_of_slices(clock);
        defmt::info!("instructions_per_sample_slice {=f64}", mean);
    }

    /// The numbers of samples near which the worst sample is sought. By then, the schedule has served every
    /// level up to half as many samples at least once.
    const SOON: u32 = 1 << 16;
    const LATE: u32 = 1 << 20;

    #[inline(never)]
    fn worst<const OCTAVES: usize>(clock: &Clock, deepest: u32) {
        let worst = work::worst::<OCTAVES>(clock, deepest);
        defmt::info!("instructions_worst_sample_{=usize} {=u64}", OCTAVES, worst);
    }

    #[inline(never)]
    fn fit<const OCTAVES: usize>(clock: &Clock) -> bool {
        let Some(curve) = work::curve::<OCTAVES>(&[]) else {
            return false;
        };
        let mut fitted = false;
        let fit = || fitted = work::characterise(black_box(&curve)).is_ok();
        let instructions = clock.instructions(fit);
        let stack = stack::used_by(|| {
            black_box(work::characterise(black_box(&curve)).is_ok());
        });
        let axis = size_of::<Accumulator<OCTAVES>>() + size_of::<Curve<OCTAVES>>();
        defmt::info!("octaves {=usize}", OCTAVES);
        defmt::info!("ram_bytes_axis_and_curve {=usize}", axis);
        defmt::info!("instructions_fit_{=usize} {=f64}", OCTAVES, instructions);
        defmt::info!("stack_bytes_fit_{=usize} {=usize}", OCTAVES, stack);
        fitted && five_terms(clock, &curve) && self_test::<OCTAVES>(clock)
    }

    /// Measures the small fit of the five terms.
    #[inline(never)]
    fn five_terms<const OCTAVES: usize>(clock: &Clock, curve: &Curve<OCTAVES>) -> bool {
        let mut fitted = false;
        let instructions = clock.instructions(|| fitted = ieee_952::fit(black_box(curve)).is_ok());
        let stack = stack::used_by(|| {
            black_box(ieee_952::fit(black_box(curve)).is_ok());
        });
        defmt::info!(
            "instructions_five_terms_{=usize} {=f64}",
            OCTAVES,
            instructions
        );
        defmt::info!("stack_of_five_terms_{=usize} {=usize}", OCTAVES, stack);
        let [costliest, _] = varied::costliest(OCTAVES);
        let Some(worst) = varied::five_terms::<OCTAVES>(clock, costliest) else {
            return false;
        };
        defmt::info!("instructions_worst_five_terms {=f64}", worst);
        fitted
    }

    /// Measures the fits of a thousand curves and the looks at a thousand records.
    #[inline(never)]
    fn worst_of_all<const OCTAVES: usize>(clock: &Clock) -> bool {
        let fits = varied::Costs::of(|number| varied::five_terms::<OCTAVES>(clock, number));
        let looks = varied::Costs::of(|number| varied::of_look::<OCTAVES>(clock, number));
        for (of, costs) in [("fit", fits), ("look", looks)] {
            defmt::info!("{=str}_mean {=f64}", of, costs.mean);
            defmt::info!("{=str}_worst {=f64}", of, costs.most);
            defmt::info!("{=str}_costliest {=u32}", of, costs.costliest);
        }
        true
    }

    /// Measures a look of a self-test with a limit.
    #[inline(never)]
    fn self_test<const OCTAVES: usize>(clock: &Clock) -> bool {
        let mut accumulator = Accumulator::<OCTAVES>::new();
        let mut random = 1_u32;
        for _ in 0..4096 {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            accumulator.push((random >> 28) as i32);
        }
        let mut status = None;
        let instructions = clock.instructions(|| status = work::look(black_box(&accumulator)));
        let stack = stack::used_by(|| {
            black_box(work::look(black_box(&accumulator)));
        });
        defmt::info!(
            "instructions_of_look_{=usize} {=f64}",
            OCTAVES,
            instructions
        );
        defmt::info!("stack_of_look_{=usize} {=usize}", OCTAVES, stack);
        let [_, costliest] = varied::costliest(OCTAVES);
        let Some(worst) = varied::of_look::<OCTAVES>(clock, costliest) else {
            return false;
        };
        defmt::info!("instructions_worst_look {=f64}", worst);
        status == Some(Status::Passed)
    }

    #[inline(never)]
    fn diagnosis(clock: &Clock) -> bool {
        let model = Model::ieee_952();
        let Some(curve) = work::curve::<USUAL>(&[work::SINUSOID]) else {
            return false;
        };
        let mut found = false;
        let diagnose = || found = work::diagnose(black_box(&curve), &model);
        let instructions = clock.instructions(diagnose);
        let stack = stack::used_by(|| {
            black_box(work::diagnose(black_box(&curve), &model));
        });
        // The size of the curve is not added, because the diagnosis contains the curve.
        let ram = size_of::<Accumulator<USUAL>>() * 3 + stack;
        defmt::info!(
            "instructions_diagnosis_{=usize} {=f64}",
            USUAL,
            instructions
        );
        defmt::info!("stack_bytes_diagnosis_{=usize} {=usize}", USUAL, stack);
        defmt::info!("ram_bytes_three_axes_20_with_diagnosis {=usize}", ram);
        found
    }

    /// Measures how long a main loop waits for a fit to return or a diagnosis to pause, for each hidden effect.
    #[inline(never)]
    fn stretches(clock: &Clock) -> bool {
        let model = Model::ieee_952();
        let (mut of_fit, mut of_diagnosis, mut of_both) = (0.0_f64, 0.0_f64, 0.0_f64);
        for (name, hidden) in work::HIDDEN {
            let Some(curve) = work::curve::<USUAL>(hidden) else {
                return false;
            };
            let Some(fit) = work::longest_stretch_of_fit(clock, &curve, &model) else {
                return false;
            };
            let Some(diagnosis) =
                work::longest_stretch_of_diagnosis(clock, &curve, &Spectrum::<0>::EMPTY, &model)
            else {
                return false;
            };
            defmt::info!("instructions_stretch_{=str} {=f64}", name, diagnosis);
            of_fit = of_fit.max(fit);
            of_diagnosis = of_diagnosis.max(diagnosis);
            // In double precision, emulated on this core, each case takes QEMU half a minute.
            if size_of::<Real>() > 4 && name != work::HARDEST {
                continue;
            }
            let Some(spectrum) = work::spectrum::<BINS>(hidden) else {
                return false;
            };
            let Some(both) = work::longest_stretch_of_diagnosis(clock, &curve, &spectrum, &model)
            else {
                return false;
            };
            defmt::info!(
                "instructions_stretch_with_spectrum_{=str} {=f64}",
                name,
                both
            );
            of_both = of_both.max(both);
        }
        defmt::info!("instructions_stretch_fit_20 {=f64}", of_fit);
        defmt::info!("instructions_stretch_diagnosis_20 {=f64}", of_diagnosis);
        defmt::info!(
            "instructions_stretch_diagnosis_with_spectrum {=f64}",
            of_both
        );
        true
    }

    #[panic_handler]
    fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
        defmt::error!("{}", defmt::Display2Format(info));
        semihosting::process::exit(101)
    }
}
