//! The image that shows a microcontroller characterising a simulated gyro: every figure is logged
//! with its bits, and the exit status tells whether the gyro came out as simulated. It runs on a
//! Cortex-M4F in QEMU; see `cargo xtask test`.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod image {
    use allanite::demonstration::characterise::Characterised;
    // Critical sections of a single core.
    #[cfg(target_arch = "arm")]
    use cortex_m as _;
    use defmt_semihosting as _;
    #[cfg(target_arch = "riscv32")]
    use riscv as _;

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        let test = match Characterised::run() {
            Ok(test) => test,
            Err(error) => {
                defmt::error!("no fit: {}", error);
                semihosting::process::exit(1);
            }
        };
        for point in test.curve.points() {
            defmt::info!(
                "octave m {=u32} differences {=u64} variance {=f64} {=u64:x}",
                point.m,
                point.differences,
                point.variance,
                point.variance.to_bits()
            );
        }
        for (coefficient, truth) in test.fit.coefficients.iter().zip(test.truth) {
            defmt::info!(
                "coefficient {=str} value {=f64} {=u64:x} lower {=f64} {=u64:x} upper {=f64} {=u64:x} truth {=f64} {}",
                coefficient.name,
                coefficient.value,
                coefficient.value.to_bits(),
                coefficient.lower,
                coefficient.lower.to_bits(),
                coefficient.upper,
                coefficient.upper.to_bits(),
                truth,
                coefficient.state
            );
        }
        defmt::info!(
            "fit degrees_of_freedom {=usize} chi_squared {=f64} {=u64:x} p_value {=f64} {=u64:x}",
            test.fit.degrees_of_freedom,
            test.fit.chi_squared,
            test.fit.chi_squared.to_bits(),
            test.fit.p_value,
            test.fit.p_value.to_bits()
        );
        if test.passed() {
            defmt::info!("passed");
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
