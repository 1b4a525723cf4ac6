//! An image in which a microcontroller finds, without a host, an effect of a gyro that the five terms do not
//! describe. Every step of the diagnosis is logged, with the errors before and after it. The first argument
//! of the image names the effect that is hidden in the simulated gyro. The diagnosis does not see it. The
//! host prints the same lines.

#![cfg_attr(target_os = "none", no_std, no_main)]

/// The seeds of gyros may follow the name, and replace the image's own seed.
#[cfg(not(target_os = "none"))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    use demonstration::{diagnose, lines};

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
    use demonstration::{diagnose, lines};
    // This crate provides critical sections for a single core.
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
        // The first argument is the name of the image.
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
