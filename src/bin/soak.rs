//! A long record with faults at random, whose sums are compared with their definition: on the host
//! `cargo xtask soak`, and on a core with the arguments `SAMPLES SEED FIRST`.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    use demonstration::soak::{Plan, run};
    use std::time::Instant;

    let mut arguments = std::env::args().skip(1).map(|argument| argument.parse());
    let mut number = || arguments.next().ok_or("usage: soak SAMPLES SEED FIRST");
    let plan = Plan {
        samples: number()??,
        seed: number()??,
        first: number()??,
    };
    let begun = Instant::now();
    let mut next = plan.samples / 20;
    let progress = |samples| {
        if samples >= next {
            eprintln!("{samples} samples after {} s", begun.elapsed().as_secs());
            next = samples + plan.samples / 20;
        }
    };
    let tally = run(plan, progress).map_err(|failure| format!("seed {}: {failure}", plan.seed))?;
    println!("{tally}");
    let seconds = begun.elapsed().as_secs_f64();
    let each = seconds * 1e9 / tally.samples as f64;
    println!("exact: {seconds:.0} s, {each:.1} ns a sample with the oracle");
    Ok(())
}

#[cfg(target_os = "none")]
mod image {
    // This crate provides critical sections for a single core.
    #[cfg(target_arch = "arm")]
    use cortex_m as _;
    use defmt_semihosting as _;
    use demonstration::soak::{Plan, run};
    #[cfg(target_arch = "riscv32")]
    use riscv as _;

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        let Some(plan) = plan() else {
            defmt::error!("the arguments are SAMPLES SEED FIRST");
            semihosting::process::exit(2);
        };
        match run(plan, |_| ()) {
            Ok(tally) => defmt::info!("{}", defmt::Display2Format(&tally)),
            Err(failure) => {
                defmt::error!("{}", defmt::Display2Format(&failure));
                semihosting::process::exit(1);
            }
        }
        semihosting::process::exit(0)
    }

    fn plan() -> Option<Plan> {
        let arguments = semihosting::experimental::env::args::<128>();
        let mut words = arguments.iter().flatten().skip(1);
        let mut number = || words.next()?.ok()?.parse().ok();
        Some(Plan {
            samples: number()?,
            seed: number()?,
            first: number()?,
        })
    }

    #[panic_handler]
    fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
        defmt::error!("{}", defmt::Display2Format(info));
        semihosting::process::exit(101)
    }
}
