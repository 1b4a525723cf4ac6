//! The image that shows a microcontroller finding what a gyro lacks beyond the five terms, with no host:
//! every step of the diagnosis is logged, error before and after. What is hidden in the simulated gyro is
//! named by the first argument that the image is started with, and the diagnosis is not told. The host
//! prints the same lines.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "demonstration/mod.rs"]
// Every image uses some of it.
#[allow(dead_code, unreachable_pub)]
mod demonstration;

/// Behind the name there may be seeds to diagnose gyros with, instead of the image's.
#[cfg(not(target_os = "none"))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    use crate::demonstration::{diagnose, lines};

    let disturbance = diagnose::hidden(&std::env::args().nth(1).unwrap_or_default());
    let seeds = std::env::args().skip(2).map(|seed| seed.parse());
    let mut seeds = seeds.collect::<Result<Vec<u64>, _>>()?;
    if seeds.is_empty() {
        seeds.push(diagnose::SEED);
    }
    for seed in seeds {
        let step = |step: &_| lines::step(step, |line| println!("{line}"));
        let verdict = diagnose::diagnose(disturbance, seed, step)?;
        println!("verdict {verdict:?}");
    }
    Ok(())
}

#[cfg(target_os = "none")]
mod image {
    use crate::demonstration::{diagnose, lines};
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
        let name = (&arguments).nth(1).and_then(Result::ok).unwrap_or("");
        let step = |step: &_| {
            lines::step(step, |line| {
                defmt::info!("{}", defmt::Display2Format(&line));
            });
        };
        match diagnose::diagnose(diagnose::hidden(name), diagnose::SEED, step) {
            Ok(verdict) => {
                defmt::info!("verdict {}", defmt::Debug2Format(&verdict));
                semihosting::process::exit(0)
            }
            Err(error) => {
                defmt::error!("no diagnosis: {}", error);
                semihosting::process::exit(1)
            }
        }
    }

    #[panic_handler]
    fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
        defmt::error!("{}", defmt::Display2Format(info));
        semihosting::process::exit(101)
    }
}
