//! An image that does nothing: what start-up and end cost in flash. The other images here are weighed
//! against it.

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
