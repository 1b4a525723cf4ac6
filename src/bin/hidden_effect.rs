//! The image that shows a microcontroller finding what a gyro lacks beyond the five terms, with no host:
//! every step of the diagnosis is logged, error before and after. What is hidden in the simulated gyro is
//! named by the first argument that the image is started with, and the diagnosis is not told.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod image {
    use allanite::demonstration::diagnose::{HIDDEN, OCTAVES, diagnose};
    use allanite::{Addition, Step, Verdict};
    // Critical sections of a single core.
    #[cfg(target_arch = "arm")]
    use cortex_m as _;
    use defmt_semihosting as _;
    #[cfg(target_arch = "riscv32")]
    use riscv as _;

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        let Ok(arguments) = semihosting::experimental::env::args::<128>() else {
            defmt::error!("no arguments: start the image with what to hide");
            semihosting::process::exit(2);
        };
        // The first is the image's own name.
        let name = (&arguments)
            .nth(1)
            .and_then(Result::ok)
            .unwrap_or("nothing");
        let disturbance = HIDDEN.iter().find(|(hidden, _)| *hidden == name);
        match diagnose(disturbance.map(|&(_, disturbance)| disturbance), log) {
            Ok(verdict) => {
                defmt::info!("verdict {}", verdict);
                semihosting::process::exit(i32::from(matches!(verdict, Verdict::Invalid(_))))
            }
            Err(error) => {
                defmt::error!("no diagnosis: {}", error);
                semihosting::process::exit(1)
            }
        }
    }

    fn log(step: &Step<OCTAVES>) {
        for octave in &step.comparison.octaves {
            defmt::info!(
                "octave m {=u32} measured {=f64} model {=f64} z {=f64} {=u64:x}",
                octave.m,
                octave.measured,
                octave.model,
                octave.z,
                octave.z.to_bits()
            );
        }
        defmt::info!("comparison {}", defmt::Display2Format(&step.comparison));
        defmt::info!(
            "fit degrees_of_freedom {=usize} chi_squared {=f64} {=u64:x} p_value {=f64} {=u64:x} rms_percent {=f64} {=u64:x}",
            step.fit.degrees_of_freedom,
            step.fit.chi_squared,
            step.fit.chi_squared.to_bits(),
            step.fit.p_value,
            step.fit.p_value.to_bits(),
            step.comparison.rms_percent,
            step.comparison.rms_percent.to_bits()
        );
        for coefficient in &step.fit.coefficients {
            defmt::info!(
                "coefficient {=str} value {=f64} {=u64:x}",
                coefficient.name,
                coefficient.value,
                coefficient.value.to_bits()
            );
        }
        for candidate in &step.candidates {
            defmt::info!(
                "candidate {=str} improvement {=f64} {=u64:x}",
                candidate.term.effect.name(),
                candidate.improvement,
                candidate.improvement.to_bits()
            );
        }
        if let Some(swap) = step.swap() {
            let [taken, dropped] = [swap.taken, swap.dropped].map(|effect| effect.name());
            defmt::info!("{=str} instead of {=str}", taken, dropped);
        }
        for name in &step.ambiguous {
            defmt::info!("ambiguous {=str}", name);
        }
        if let Some(Addition::Effect(term)) = &step.added {
            defmt::info!(
                "added {=str} first {=f64} {=u64:x}",
                term.effect.name(),
                term.parameters[0],
                term.parameters[0].to_bits()
            );
        }
    }

    #[panic_handler]
    fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
        defmt::error!("{}", defmt::Display2Format(info));
        semihosting::process::exit(101)
    }
}
