//! The appliance with RTIC: the timer's interrupt is a task of high priority that hands the bursts of the sensor's
//! FIFO over, and all other work is done when no task runs.
//!
//! The arguments are those of `appliance_loop`.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod board;
#[cfg(target_os = "none")]
mod panic;

/// What RTIC needs to know about the board: the bits of a priority. The timer is a part of the core, so that the
/// board's own interrupts need no names.
#[cfg(all(target_os = "none", target_arch = "arm"))]
mod device {
    pub(crate) const NVIC_PRIO_BITS: u8 = 3;
}

// RTIC's macro expands to its own unsafe code.
#[cfg(all(target_os = "none", target_arch = "arm"))]
#[allow(unsafe_code, missing_docs)]
#[rtic::app(device = crate::device, peripherals = false)]
mod image {
    use crate::board::{self, Fifo, Product, Watchdog};
    // This crate provides the vector table.
    use cortex_m_rt as _;
    use demonstration::appliance::Progress;

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        fifo: Fifo,
        product: Product,
        watchdog: Watchdog,
    }

    #[init]
    fn init(context: init::Context) -> (Shared, Local) {
        let (product, fifo) = board::switch_on();
        let watchdog = Watchdog::start();
        board::start_timer(context.core.SYST);
        let local = Local {
            fifo,
            product,
            watchdog,
        };
        (Shared {}, local)
    }

    /// Hands a burst over.
    #[task(binds = SysTick, priority = 2, local = [fifo])]
    fn burst(context: burst::Context) {
        context.local.fifo.burst();
    }

    #[idle(local = [product, watchdog])]
    fn idle(context: idle::Context) -> ! {
        let idle::LocalResources {
            product, watchdog, ..
        } = context.local;
        while product.pass() != Progress::Complete {
            watchdog.feed();
        }
        let records = product.records();
        let mut last = product.finish(&records);
        while last.pass(watchdog) != Progress::Complete {
            watchdog.feed();
        }
        last.end(watchdog)
    }
}
