//! An image in which a microcontroller characterises a simulated gyro. Every figure is logged
//! with its bits, and the exit status tells whether the fit agrees with the simulated gyro. It runs on every
//! core in QEMU (see `cargo xtask test`), and on the host, where it prints the same lines.

#![cfg_attr(target_os = "none", no_std, no_main)]

/// The arguments are seeds of gyros, which replace the image's own seed.
#[cfg(not(target_os = "none"))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    use demonstration::{characterise, lines};

    let seeds = std::env::args().skip(1).map(|seed| seed.parse());
    let mut seeds = seeds.collect::<Result<Vec<u64>, _>>()?;
    if seeds.is_empty() {
        seeds.push(characterise::SEED);
    }
    for seed in seeds {
        let test = characterise::Characterised::run(seed)?;
        lines::characterised(&test, |line| println!("{line}"));
    }
    Ok(())
}

#[cfg(target_os = "none")]
mod image {
    use demonstration::{characterise, lines};
    // This crate provides critical sections for a single core.
    #[cfg(target_arch = "arm")]
    use cortex_m as _;
    use defmt_semihosting as _;
    #[cfg(target_arch = "riscv32")]
    use riscv as _;

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        let test = match characterise::Characterised::run(characterise::SEED) {
            Ok(test) => test,
            Err(error) => {
                defmt::error!("no fit: {}", error);
                semihosting::process::exit(1);
            }
        };
        lines::characterised(&test, |line| {
            defmt::info!("{}", defmt::Display2Format(&line));
        });
        if test.passed() {
            semihosting::process::exit(0)
        }
        defmt::error!("the coefficients are not those that were simulated");
        semihosting::process::exit(1)
    }

    #[panic_handler]
    fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
        defmt::error!("{}", defmt::Display2Format(info));
        semihosting::process::exit(101)
    }
}
