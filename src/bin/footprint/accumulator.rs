//! The accumulator alone, as in an interrupt: counts and gaps come in, and no result is read.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod image {
    use allanite::Accumulator;
    use core::hint::black_box;

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        let mut accumulator = Accumulator::<20>::new();
        while let Some(count) = black_box(None) {
            accumulator.push(count);
            if black_box(false) {
                accumulator.gap();
            }
        }
        black_box(&accumulator);
        semihosting::process::exit(0)
    }
}

#[cfg(target_os = "none")]
mod panic;
