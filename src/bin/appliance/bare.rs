//! The appliance as a main loop without an operating system: a timer interrupt hands the bursts of the sensor's
//! FIFO over, and the loop takes them, does a short piece of work and feeds the watchdog.
//!
//! The arguments are the seed of the power cuts, and `true` if the first diagnosis is done in one piece, which is
//! longer than the watchdog permits. On the host, the arguments are the seed and the cuts that an image logged, and
//! the program does the same without interrupts.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    use demonstration::appliance::{BUFFER, Cut, Gyro, replay};

    let mut arguments = std::env::args().skip(1);
    let seed = arguments.next().ok_or("no seed")?.parse()?;
    let cuts: Option<Vec<Cut>> = arguments.map(|cut| Cut::parse(&cut)).collect();
    let cuts = cuts.ok_or("a cut is not of the form made:taken:operations")?;
    let mut gyro = Box::new(Gyro::new());
    let mut buffer = vec![0; BUFFER];
    replay(seed, &cuts, &mut gyro, &mut buffer, |line| {
        println!("{line}");
    })
    .map_err(|failure| format!("{failure:?}"))?;
    Ok(())
}

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod board;
#[cfg(target_os = "none")]
mod panic;

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod image {
    use crate::board::{self, Fifo, Watchdog};
    use core::cell::RefCell;
    use cortex_m::Peripherals;
    use critical_section::Mutex;
    use demonstration::appliance::Progress;

    static FIFO: Mutex<RefCell<Option<Fifo>>> = Mutex::new(RefCell::new(None));

    #[cortex_m_rt::exception]
    fn SysTick() {
        critical_section::with(|section| {
            if let Some(fifo) = &mut *FIFO.borrow_ref_mut(section) {
                fifo.burst();
            }
        });
    }

    #[cortex_m_rt::entry]
    fn main() -> ! {
        let (mut product, fifo) = board::switch_on();
        let mut watchdog = Watchdog::start();
        critical_section::with(|section| FIFO.replace(section, Some(fifo)));
        if let Some(core) = Peripherals::take() {
            board::start_timer(core.SYST);
        }
        while product.pass() != Progress::Complete {
            watchdog.feed();
        }
        let records = product.records();
        let mut last = product.finish(&records);
        while last.pass(&mut watchdog) != Progress::Complete {
            watchdog.feed();
        }
        last.end(&watchdog)
    }
}
