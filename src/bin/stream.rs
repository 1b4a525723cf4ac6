//! An image that sends the counts of a simulated gyro for as long as a host reads them. Each count is a line
//! of text, as a firmware would send it through a serial port: `cargo xtask watch --rate 100`.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod image {
    use core::fmt::Write as _;
    use demonstration::{AMPLITUDES, simulated::SimulatedGyro, stream::SEED};
    use heapless::String;
    use semihosting::io::{self, Write as _};

    /// The number of bytes of the longest count, with its sign and the end of its line.
    const LINE: usize = 12;

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        let Ok(mut output) = io::stdout() else {
            semihosting::process::exit(1);
        };
        for count in SimulatedGyro::new(AMPLITUDES, SEED) {
            let mut line = String::<LINE>::new();
            if writeln!(line, "{count}").is_err() || output.write_all(line.as_bytes()).is_err() {
                semihosting::process::exit(1);
            }
        }
        semihosting::process::exit(0)
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
        semihosting::process::exit(101)
    }
}
