//! A timer that interrupts when a sample is ready. The handler takes a fraction of the time between two
//! samples.

#[cfg(target_arch = "arm")]
pub(crate) use systick::start;

#[cfg(target_arch = "riscv32")]
pub(crate) use machine_timer::start;

#[cfg(target_arch = "arm")]
mod systick {
    use cortex_m::peripheral::{Peripherals, syst::SystClkSource};

    /// Starts the timer with so many ticks per sample. A tick is 25 to 75 instructions in QEMU.
    pub(crate) fn start(interval: u32) {
        let Some(core) = Peripherals::take() else {
            return;
        };
        let mut systick = core.SYST;
        systick.set_clock_source(SystClkSource::Core);
        systick.set_reload(interval);
        systick.clear_current();
        systick.enable_interrupt();
        systick.enable_counter();
    }

    #[cortex_m_rt::exception]
    fn SysTick() {
        crate::image::ready();
    }
}

#[cfg(target_arch = "riscv32")]
#[allow(unsafe_code)]
mod machine_timer {
    use core::ptr;
    use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
    use riscv::interrupt::{self, Interrupt};
    use riscv::register::mie;

    /// The address of `mtimecmp` of the first hart on QEMU's `virt`.
    const COMPARE: *mut u64 = 0x0200_4000 as *mut u64;
    /// The address of `mtime`.
    const TIME: *const u32 = 0x0200_BFF8 as *const u32;

    /// The ticks per sample.
    static INTERVAL: AtomicU32 = AtomicU32::new(0);

    /// Starts the timer with so many ticks per sample. It runs at 10 MHz, so that a tick is 100 instructions in QEMU.
    pub(crate) fn start(interval: u32) {
        INTERVAL.store(interval, Relaxed);
        next();
        // SAFETY: the handler exists, and it accesses shared data only in critical sections.
        unsafe {
            mie::set_mtimer();
            interrupt::enable();
        }
    }

    #[riscv_rt::core_interrupt(Interrupt::MachineTimer)]
    fn machine_timer() {
        next();
        crate::image::ready();
    }

    /// Sets the time of the next interrupt.
    fn next() {
        // SAFETY: every `virt` has these registers. A record lasts seconds, which do not fill 32 bits, so the
        // upper half of the time is zero.
        unsafe {
            let now = u64::from(ptr::read_volatile(TIME));
            ptr::write_volatile(COMPARE, now + u64::from(INTERVAL.load(Relaxed)));
        }
    }
}
