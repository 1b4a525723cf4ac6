//! An image that does everything a product does, with every part of the library. Its results are
//! logged with their bits, and the host prints the same lines.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    use demonstration::product::{Gyro, run};

    let mut gyro = Box::new(Gyro::new());
    let mut flash = vec![0; Gyro::snapshot_bytes(1)];
    run(&mut gyro, &mut flash, |line| println!("{line}"))
        .map_err(|failure| format!("{failure:?}"))?;
    Ok(())
}

#[cfg(target_os = "none")]
mod image {
    use core::cell::RefCell;
    use demonstration::product::{Gyro, run};
    // This crate provides critical sections for a single core.
    #[cfg(target_arch = "arm")]
    use cortex_m as _;
    use critical_section::Mutex;
    use defmt_semihosting as _;
    #[cfg(target_arch = "riscv32")]
    use riscv as _;

    /// An empty gyro is all zero, so that it takes no flash for an initial value.
    static GYRO: Mutex<RefCell<Gyro>> = Mutex::new(RefCell::new(Gyro::new()));
    /// A buffer in RAM that takes the place of flash.
    static FLASH: Mutex<RefCell<[u8; Gyro::snapshot_bytes(1)]>> =
        Mutex::new(RefCell::new([0; Gyro::snapshot_bytes(1)]));

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        let result = critical_section::with(|section| {
            let mut gyro = GYRO.borrow_ref_mut(section);
            let mut flash = FLASH.borrow_ref_mut(section);
            run(&mut gyro, &mut flash[..], |line| {
                defmt::info!("{}", defmt::Display2Format(&line));
            })
        });
        if let Err(error) = result {
            defmt::error!("no diagnosis: {}", defmt::Debug2Format(&error));
            semihosting::process::exit(1);
        }
        semihosting::process::exit(0)
    }

    #[panic_handler]
    fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
        defmt::error!("{}", defmt::Display2Format(info));
        semihosting::process::exit(101)
    }
}
