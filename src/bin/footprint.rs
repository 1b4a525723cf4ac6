//! The smallest image that takes counts, makes the curve and fits it: what the library costs in
//! flash, start-up code included. `cargo xtask bench` sums its sections.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod image {
    use allanite::{Accumulator, Model, Scale, Settings, fit};
    use core::hint::black_box;
    use cortex_m_rt::entry;

    #[entry]
    fn main() -> ! {
        let mut accumulator = Accumulator::<20>::new();
        while let Some(count) = black_box(None) {
            accumulator.push(count);
        }
        let fit = Scale::new(1.0, 100.0)
            .map(|scale| accumulator.curve(scale))
            .and_then(|curve| fit(&curve, &Model::ieee_952(), Settings::default()));
        black_box(&fit);
        semihosting::process::exit(0)
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
        semihosting::process::exit(101)
    }
}
