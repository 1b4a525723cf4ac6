//! The image of the five terms with a screen of the record: whether values stick or repeat, are too coarse, move or spike.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod image {
    use allanite::{
        Accumulator, Scale,
        ieee_952::{self, Limits},
        integrity::Screen,
    };
    use core::hint::black_box;

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        let mut accumulator = Accumulator::<14>::new();
        let mut screen = Screen::new();
        while let Some(count) = black_box(None) {
            accumulator.push(count);
            screen.push(count);
        }
        let scale = Scale::new(1.0, 100.0).ok();
        let curve = scale.and_then(|scale| Some((scale, accumulator.unbridged_curve(scale)?)));
        let valid = curve.filter(|(scale, curve)| screen.verdict(curve, *scale).is_none());
        let fit = valid.and_then(|(_, curve)| ieee_952::fit(&curve).ok());
        let limits = black_box(Limits {
            most: [1.0; ieee_952::TERMS],
        });
        black_box(fit.map(|fit| (limits.check(&fit), fit)));
        semihosting::process::exit(0)
    }
}

#[cfg(target_os = "none")]
mod panic;
