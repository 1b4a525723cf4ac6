//! Instructions counted by a clock, calibrated against a known number of them.
//!
//! QEMU lets an instruction take 1 ns with `-icount shift=0`. How many fit into a tick depends on the
//! board's clock, so that one is found out and not assumed.

#![allow(unsafe_code)]

use core::arch::asm;

#[cfg(target_arch = "arm")]
use systick as counter;

/// Calls of either function that a calibration takes.
const CALLS: u32 = 1000;
/// Instructions that one does more than the other.
const DIFFERENCE: u32 = 2000;

/// A clock that runs.
pub(crate) struct Clock {
    instructions_per_tick: f64,
}

impl Clock {
    /// Starts and calibrates it; `None` if it does not count.
    pub(crate) fn start() -> Option<Self> {
        counter::start()?;
        let mut clock = Self {
            instructions_per_tick: 1.0,
        };
        let total = |work: fn()| {
            clock.ticks(|| {
                for _ in 0..CALLS {
                    core::hint::black_box(work)();
                }
            })
        };
        let ticks = total(many).checked_sub(total(few)).filter(|&n| n > 0)?;
        let instructions = f64::from(CALLS) * f64::from(DIFFERENCE);
        clock.instructions_per_tick = instructions / ticks as f64;
        defmt::debug!("{=f64} instructions a tick", clock.instructions_per_tick);
        Some(clock)
    }

    /// Ticks that work takes.
    pub(crate) fn ticks(&self, work: impl FnOnce()) -> u64 {
        let start = counter::now();
        work();
        counter::now() - start
    }

    /// Instructions in so many ticks.
    pub(crate) fn instructions_of(&self, ticks: u64) -> f64 {
        ticks as f64 * self.instructions_per_tick
    }

    /// Instructions that work takes, to a tick.
    pub(crate) fn instructions(&self, work: impl FnOnce()) -> f64 {
        self.instructions_of(self.ticks(work))
    }
}

#[inline(never)]
fn few() {
    // SAFETY: they do nothing.
    unsafe { asm!(".rept 500", "nop", ".endr", options(nomem, nostack)) };
}

#[inline(never)]
fn many() {
    // SAFETY: they do nothing.
    unsafe { asm!(".rept 2500", "nop", ".endr", options(nomem, nostack)) };
}

/// Arm: SysTick counts down 24 bits, and an exception counts how often.
#[cfg(target_arch = "arm")]
mod systick {
    use core::sync::atomic::{AtomicU32, Ordering};
    use cortex_m::peripheral::{SYST, syst::SystClkSource};

    const LAST: u32 = (1 << 24) - 1;

    static LAPS: AtomicU32 = AtomicU32::new(0);

    pub(super) fn start() -> Option<()> {
        let mut systick = cortex_m::Peripherals::take()?.SYST;
        systick.set_clock_source(SystClkSource::Core);
        systick.set_reload(LAST);
        systick.clear_current();
        systick.enable_interrupt();
        systick.enable_counter();
        Some(())
    }

    #[cortex_m_rt::exception]
    fn SysTick() {
        // A core without atomic additions: nobody else writes.
        LAPS.store(LAPS.load(Ordering::Relaxed) + 1, Ordering::Relaxed);
    }

    pub(super) fn now() -> u64 {
        loop {
            let laps = LAPS.load(Ordering::Relaxed);
            // Zero, where it starts too, begins a lap: the exception has counted it.
            let rest = SYST::get_current().wrapping_neg() & LAST;
            if laps == LAPS.load(Ordering::Relaxed) {
                return (u64::from(laps) << 24) + u64::from(rest);
            }
        }
    }
}

/// RISC-V counts instructions by itself.
#[cfg(target_arch = "riscv32")]
mod counter {
    pub(super) fn start() -> Option<()> {
        Some(())
    }

    pub(super) fn now() -> u64 {
        riscv::register::minstret::read64()
    }
}
