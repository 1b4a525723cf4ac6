//! The smallest image that takes counts, computes the curve fits the five terms of IEEE Std 952 to it, and compares
//! them with limits.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod image {
    use allanite::{
        Accumulator, Scale,
        ieee_952::{self, Limits},
    };
    use core::hint::black_box;

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        let mut accumulator = Accumulator::<14>::new();
        while let Some(count) = black_box(None) {
            accumulator.push(count);
        }
        let curve = Scale::new(1.0, 100.0)
            .ok()
            .and_then(|scale| accumulator.unbridged_curve(scale));
        let fit = curve.and_then(|curve| ieee_952::fit(&curve).ok());
        let limits = black_box(Limits {
            most: [1.0; ieee_952::TERMS],
        });
        black_box(fit.map(|fit| (limits.check(&fit), fit)));
        semihosting::process::exit(0)
    }
}

#[cfg(target_os = "none")]
mod panic;
