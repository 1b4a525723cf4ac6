//! Counts instructions with a clock, which is calibrated against a known number of instructions.
//!
//! With `-icount shift=0`, QEMU lets an instruction take 1 ns. The number of instructions per tick depends on
//! the clock of the board, so it is measured and not assumed.

#![allow(unsafe_code)]

use core::arch::asm;

#[cfg(target_arch = "arm")]
use systick as counter;

/// The number of calls of each function in a calibration.
const CALLS: u32 = 1000;
/// The number of instructions that [`many`] executes more than [`few`].
const DIFFERENCE: u32 = 2000;

/// A running clock.
pub(crate) struct Clock {
    instructions_per_tick: f64,
}

impl Clock {
    /// Starts and calibrates the clock; `None` if it does not count.
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

    /// The number of ticks since an arbitrary time.
    pub(crate) fn now(&self) -> u64 {
        counter::now()
    }

    /// The number of ticks that `work` takes.
    pub(crate) fn ticks(&self, work: impl FnOnce()) -> u64 {
        let start = self.now();
        work();
        self.now() - start
    }

    /// The number of instructions in this many ticks.
    pub(crate) fn instructions_of(&self, ticks: u64) -> f64 {
        ticks as f64 * self.instructions_per_tick
    }

    /// The number of instructions that `work` takes, with the resolution of a tick.
    pub(crate) fn instructions(&self, work: impl FnOnce()) -> f64 {
        self.instructions_of(self.ticks(work))
    }
}

#[inline(never)]
fn few() {
    // SAFETY: the instructions do nothing.
    unsafe { asm!(".rept 500", "nop", ".endr", options(nomem, nostack)) };
}

#[inline(never)]
fn many() {
    // SAFETY: the instructions do nothing.
    unsafe { asm!(".rept 2500", "nop", ".endr", options(nomem, nostack)) };
}

/// The counter of Arm. SysTick counts down 24 bits, and an exception counts its laps.
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
        // The core may lack atomic additions, and nothing else writes here.
        LAPS.store(LAPS.load(Ordering::Relaxed) + 1, Ordering::Relaxed);
    }

    pub(super) fn now() -> u64 {
        loop {
            let laps = LAPS.load(Ordering::Relaxed);
            // The counter starts a lap at zero, which the exception has then counted.
            let rest = SYST::get_current().wrapping_neg() & LAST;
            if laps == LAPS.load(Ordering::Relaxed) {
                return (u64::from(laps) << 24) + u64::from(rest);
            }
        }
    }
}

/// The counter of RISC-V, which counts instructions itself.
#[cfg(target_arch = "riscv32")]
mod counter {
    pub(super) fn start() -> Option<()> {
        Some(())
    }

    pub(super) fn now() -> u64 {
        riscv::register::minstret::read64()
    }
}
