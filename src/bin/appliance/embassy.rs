//! The appliance with Embassy: the timer's interrupt says that the sensor's FIFO is full, and a task of high
//! priority, which awaits that, hands the burst over. The samples, the flash and the diagnosis are the work of a task
//! of low priority.
//!
//! The arguments are those of `appliance_loop`.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod board;
#[cfg(target_os = "none")]
mod panic;

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod image {
    use crate::board::{self, Fifo, Product, Watchdog};
    use cortex_m::{Peripherals, interrupt::InterruptNumber, singleton};
    use demonstration::appliance::Progress;
    use embassy_executor::{Executor, InterruptExecutor};
    use embassy_sync::{blocking_mutex::raw::CriticalSectionRawMutex, signal::Signal};

    /// An interrupt that no device of the board uses. It runs the tasks of high priority.
    #[derive(Clone, Copy)]
    struct Tasks;

    // SAFETY: this core has 240 vectors, of which the crate cortex-m-rt fills all.
    #[allow(unsafe_code)]
    unsafe impl InterruptNumber for Tasks {
        fn number(self) -> u16 {
            31
        }
    }

    static HIGH: InterruptExecutor = InterruptExecutor::new();
    static FULL: Signal<CriticalSectionRawMutex, ()> = Signal::new();

    #[cortex_m_rt::exception]
    fn SysTick() {
        FULL.signal(());
    }

    /// Handles the interrupts, which have no names without a description of the device.
    #[allow(unsafe_code)]
    #[cortex_m_rt::exception]
    unsafe fn DefaultHandler(interrupt: i16) {
        if interrupt == Tasks.number() as i16 {
            // SAFETY: the interrupt is enabled by the start of this executor, and it has no other handler.
            unsafe { HIGH.on_interrupt() }
        } else {
            // The watchdog resets the board.
            loop {
                cortex_m::asm::nop();
            }
        }
    }

    /// Hands the bursts over.
    #[embassy_executor::task]
    async fn bursts(mut fifo: Fifo) {
        loop {
            FULL.wait().await;
            fifo.burst();
        }
    }

    /// Does all other work.
    #[embassy_executor::task]
    async fn work(mut product: Product) {
        let mut watchdog = Watchdog::start();
        while product.pass() != Progress::Complete {
            watchdog.feed();
            embassy_futures::yield_now().await;
        }
        let records = product.records();
        let mut last = product.finish(&records);
        while last.pass(&mut watchdog) != Progress::Complete {
            watchdog.feed();
            embassy_futures::yield_now().await;
        }
        last.end(&watchdog)
    }

    #[cortex_m_rt::entry]
    fn main() -> ! {
        let (product, fifo) = board::switch_on();
        let high = HIGH.start(Tasks);
        if let Ok(task) = bursts(fifo) {
            high.spawn(task);
        }
        if let Some(core) = Peripherals::take() {
            board::start_timer(core.SYST);
        }
        let Some(low) = singleton!(: Executor = Executor::new()) else {
            semihosting::process::exit(2);
        };
        low.run(|spawner| {
            if let Ok(task) = work(product) {
                spawner.spawn(task);
            }
        })
    }
}
