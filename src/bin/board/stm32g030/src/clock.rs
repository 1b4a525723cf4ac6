//! The time, by the timer that every Cortex-M has. It needs no interrupt.

use cortex_m::peripheral::{SYST, syst::SystClkSource};
use embedded_hal::delay::DelayNs;

/// The core's clock after a reset: the chip's own oscillator of 16 MHz, which is right to about 1 %.
const TICKS_PER_US: u32 = 16;

/// The counter has 24 bits, so that it comes round once a second.
const MASK: u32 = 0x00FF_FFFF;

/// Measures times of less than a second.
pub struct Clock {
    since: u32,
}

impl Clock {
    /// Starts the timer.
    pub fn start(mut timer: SYST) -> Self {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(MASK);
        timer.clear_current();
        timer.enable_counter();
        let since = SYST::get_current();
        Self { since }
    }

    /// The ticks since the last [`restart`](Self::restart).
    pub fn ticks(&self) -> u32 {
        // The counter counts down.
        self.since.wrapping_sub(SYST::get_current()) & MASK
    }

    /// Returns the ticks since the last restart, and counts from now on. No tick is lost in between.
    pub fn restart(&mut self) -> u32 {
        let ticks = self.ticks();
        self.since = self.since.wrapping_sub(ticks) & MASK;
        ticks
    }
}

/// The number of ticks in so many µs.
pub const fn ticks(us: u32) -> u32 {
    us * TICKS_PER_US
}

/// The rate in Hz of what comes after so many ticks each time.
pub fn rate_hz(ticks: u32) -> f32 {
    (1_000_000 * TICKS_PER_US) as f32 / ticks as f32
}

impl DelayNs for Clock {
    fn delay_ns(&mut self, ns: u32) {
        self.delay_us(ns.div_ceil(1000));
    }

    fn delay_us(&mut self, us: u32) {
        let mut left = us.saturating_mul(TICKS_PER_US);
        self.restart();
        while left > 0 {
            left = left.saturating_sub(self.restart());
        }
    }
}
