//! An image that does nothing. Its size is the flash that start-up and exit take, and it is subtracted from
//! the sizes of the other images.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod image {
    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        semihosting::process::exit(0)
    }
}

#[cfg(target_os = "none")]
mod panic;
