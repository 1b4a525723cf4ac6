//! The image that measures the library on a Cortex-M4F in QEMU, where instructions can be counted
//! but not cycles: `cargo xtask bench`.
//!
//! With `-icount shift=0` an instruction takes 1 ns, so SysTick advances once in 40 at the 25 MHz of
//! the core, and once in 1000 at the 1 MHz of the reference.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod image {
    use allanite::demonstration::AMPLITUDES;
    use allanite::effect::{CATALOGUE, Effect as _, Setting, Sinusoid};
    use allanite::simulated::{Random, SimulatedGyro};
    use allanite::{Accumulator, Curve, Diagnosis, Evidence, Fit, Model, Settings, Verdict, fit};
    use core::hint::black_box;
    use cortex_m::peripheral::{SYST, syst::SystClkSource};
    use cortex_m_rt::entry;
    use defmt_semihosting as _;

    /// Instructions a tick of SysTick, which counts down 24 bits.
    const INSTRUCTIONS: u32 = 40;
    /// The same by the reference clock, for what takes long.
    const LONG: u32 = 1000;
    const MASK: u32 = (1 << 24) - 1;

    /// Repetitions of one sample: resolves a fraction of an instruction.
    const REPETITIONS: u32 = 200;

    #[entry]
    fn main() -> ! {
        let Some(mut core) = cortex_m::Peripherals::take() else {
            semihosting::process::exit(1);
        };
        core.SYST.set_clock_source(SystClkSource::Core);
        core.SYST.set_reload(MASK);
        core.SYST.clear_current();
        core.SYST.enable_counter();

        let (single, slice) = mean();
        defmt::info!("instructions_per_sample {=f64}", single);
        defmt::info!("instructions_per_sample_slice {=f64}", slice);
        for (octaves, worst) in [
            (12, worst::<12>()),
            (24, worst::<24>()),
            (30, worst::<30>()),
        ] {
            defmt::info!("instructions_worst_sample_{=u32} {=u32}", octaves, worst);
        }
        defmt::info!(
            "ram_bytes_per_axis_24 {=usize}",
            size_of::<Accumulator<24>>()
        );

        let (Some(curve), Some(hidden)) = (curve(0.0), curve(0.02)) else {
            semihosting::process::exit(1);
        };
        core.SYST.set_clock_source(SystClkSource::External);
        let start = SYST::get_current();
        let fitted = black_box(characterise(&curve)).is_ok();
        defmt::info!("instructions_fit_20 {=u32}", ticks_since(start) * LONG);
        let stack = crate::stack::used_by(|| characterise(black_box(&curve)).is_ok() == fitted);
        defmt::info!("stack_bytes_fit_20 {=usize}", stack);

        let start = SYST::get_current();
        let model = Model::ieee_952();
        let found = diagnose(black_box(&hidden), &model) == Ok(Verdict::Improved);
        defmt::info!(
            "instructions_diagnosis_20 {=u32}",
            ticks_since(start) * LONG
        );
        let stack = crate::stack::used_by(|| diagnose(black_box(&hidden), &model).is_ok() == found);
        defmt::info!("stack_bytes_diagnosis_20 {=usize}", stack);
        semihosting::process::exit(i32::from(!(fitted && found)))
    }

    fn ticks_since(start: u32) -> u32 {
        start.wrapping_sub(SYST::get_current()) & MASK
    }

    /// Instructions by the core's clock, up to 671 million.
    fn instructions(work: impl FnOnce()) -> u32 {
        let start = SYST::get_current();
        work();
        ticks_since(start) * INSTRUCTIONS
    }

    /// A push as a call of its own. What it costs beyond [`nothing`] is the push.
    #[inline(never)]
    fn push<const OCTAVES: usize>(accumulator: &mut Accumulator<OCTAVES>, count: i32) {
        accumulator.push(count);
    }

    #[inline(never)]
    fn nothing<const OCTAVES: usize>(accumulator: &mut Accumulator<OCTAVES>, count: i32) {
        black_box((accumulator, count));
    }

    /// Mean over a gyro at rest, by single counts and by slices.
    fn mean() -> (f64, f64) {
        const LENGTH: usize = 4096;
        const ROUNDS: u32 = 16;
        let mut gyro = SimulatedGyro::new(AMPLITUDES, 1);
        let counts: [i32; LENGTH] = core::array::from_fn(|_| gyro.next().unwrap_or(0));
        let mut accumulator = Accumulator::<24>::new();
        accumulator.push_slice(&counts);
        let mut total = |work: fn(&mut Accumulator<24>, i32)| {
            instructions(|| {
                for _ in 0..ROUNDS {
                    for &count in &counts {
                        work(&mut accumulator, count);
                    }
                }
            })
        };
        let single = total(push) - total(nothing);
        let slice = instructions(|| {
            for _ in 0..ROUNDS {
                accumulator.push_slice(black_box(&counts));
            }
        });
        let samples = f64::from(ROUNDS) * LENGTH as f64;
        (f64::from(single) / samples, f64::from(slice) / samples)
    }

    /// The most expensive sample of full-scale counts of random signs, where the schedule has every
    /// level due once up to the one of 2^19 samples.
    fn worst<const OCTAVES: usize>() -> u32 {
        const DEEPEST: u32 = 1 << 20;
        const AROUND: u32 = 256;
        let mut random = Random::new(1);
        let mut count = || {
            if random.bits() & 1 == 0 {
                i32::MIN
            } else {
                i32::MAX
            }
        };
        let mut before = Accumulator::<OCTAVES>::new();
        for _ in 0..DEEPEST - AROUND {
            before.push(count());
        }
        let mut worst = 0;
        let mut scratch = before.clone();
        for _ in 0..2 * AROUND {
            let count = count();
            let mut total = |work: fn(&mut Accumulator<OCTAVES>, i32)| {
                instructions(|| {
                    for _ in 0..REPETITIONS {
                        scratch.clone_from(black_box(&before));
                        work(&mut scratch, count);
                    }
                })
            };
            let difference = total(push) - total(nothing);
            worst = worst.max(difference.div_ceil(REPETITIONS));
            before.push(count);
        }
        worst
    }

    /// Twenty octaves of a gyro with all five terms, each off by a few per cent, and an oscillation at
    /// 7.7 Hz of some amplitude.
    fn curve(amplitude: f64) -> Option<Curve<20>> {
        let octaves = (0..20).map(|k| {
            let m = 1_u32 << k;
            let tau_s = f64::from(m) / 100.0;
            let smooth = 1.2e-7 / (tau_s * tau_s)
                + 2.5e-5 / tau_s
                + 7.1e-6
                + 3.0e-8 * tau_s
                + 1.3e-11 * tau_s * tau_s;
            let setting = Setting {
                parameters: [7.7, 0.0],
                ..Setting::new(0.01)
            };
            let wave = amplitude * amplitude * Sinusoid.variance(f64::from(m), &setting);
            let smooth = smooth + wave;
            let differences = (1_u64 << 21) / u64::from((m / 4).max(1)) - 7;
            let off = [0.3, -0.5, 0.9, -0.2, -0.7][k % 5] / (differences as f64 * 0.2 + 9.0);
            (m, differences, smooth * (1.0 + off))
        });
        Curve::new(100.0, octaves).ok()
    }

    #[inline(never)]
    fn characterise(curve: &Curve<20>) -> Result<Fit, allanite::Error> {
        fit(curve, &Model::ieee_952(), Settings::default())
    }

    #[inline(never)]
    fn diagnose(curve: &Curve<20>, model: &Model) -> Result<Verdict, allanite::Error> {
        let evidence = Evidence::NONE;
        Diagnosis::default().run(curve, &evidence, model, &CATALOGUE, |step| {
            black_box(step);
        })
    }

    #[panic_handler]
    fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
        defmt::error!("{}", defmt::Display2Format(info));
        semihosting::process::exit(101)
    }
}

/// Stack that a call uses, by painting it beforehand.
#[cfg(target_os = "none")]
#[allow(unsafe_code)]
mod stack {
    use core::ptr;
    use cortex_m::register::msp;

    /// Bytes painted, and the word that they are painted with.
    const PAINTED: usize = 256 * 1024;
    const PAINT: u32 = 0x5AFE_57AC;

    /// Bytes of stack below this function's own that `work` uses.
    #[inline(never)]
    pub(crate) fn used_by(work: impl FnOnce() -> bool) -> usize {
        let top = msp::read() as usize & !3;
        let bottom = top - PAINTED;
        for address in (bottom..top).step_by(4) {
            // SAFETY: the stack grows down in 4 MiB of RAM that hold little else. What lies below
            // the stack pointer is nobody's: there are no interrupts, and this loop calls nothing.
            unsafe { ptr::write_volatile(address as *mut u32, PAINT) };
        }
        assert!(work());
        let intact = (bottom..top)
            .step_by(4)
            // SAFETY: the words painted above.
            .take_while(|&address| unsafe { ptr::read_volatile(address as *const u32) } == PAINT)
            .count();
        PAINTED - 4 * intact
    }
}
