//! A station for one axis of an LSM6DSO: it measures the noise of a gyro at rest, holds it to limits, and shows on two pins
//! whether the gyro passes.

#![no_std]
#![no_main]

mod board;
mod clock;
mod judge;

use allanite::{
    Accumulator,
    integrity::Screen,
    sensor::{Imu, LSM6DSO},
};
use board::{Board, Bus, Display};
use clock::{Clock, rate_hz, ticks};
use embassy_stm32::gpio::Input;
use embedded_hal::delay::DelayNs as _;
use panic_halt as _;
use static_cell::ConstStaticCell;

/// The octaves of averaging time: from one sample to 2^13 samples, which are 79 seconds.
const OCTAVES: usize = 14;

/// The axis that is measured: 0 is x, 1 is y, and 2 is z.
const AXIS: usize = 2;

/// The number of samples after which the gyro is judged first: ten minutes.
const FIRST: u64 = 1 << 16;

/// A record that leaves it open goes on to twice its length, up to this number of samples: 84 minutes.
const LAST: u64 = 1 << 19;

/// The ticks of the clock from one sample to the next.
const INTERVAL: u32 = ticks(1_000_000 / 104);

/// The ticks that are counted as one, so that all of a record fit into 32 bits, and that the rate is right to a thousandth.
const FRACTION: u32 = 32;

/// The time in µs from the supply to the first access to the sensor.
const SUPPLY_US: u32 = 100_000;

/// An empty record is all zero, so that it takes no flash.
static GYRO: ConstStaticCell<Accumulator<OCTAVES>> = ConstStaticCell::new(Accumulator::new());

/// What the station found.
enum Verdict {
    Pass,
    /// This coefficient exceeds its limit.
    Fail(&'static str),
    /// The limit of this coefficient lies within its interval.
    Undecided(&'static str),
    /// The record is not one of a gyro at rest, and why: `moved`, `stuck`, `repeated`, `spiked` or `coarse`.
    Invalid(&'static str),
    /// The five terms do not explain the record.
    Misfit,
    /// The record cannot be fitted.
    NoFit,
    /// No LSM6DSO answers.
    NoSensor,
    /// No sample comes.
    Silent,
    /// The samples do not come at the rate of the description.
    WrongRate,
}

#[cortex_m_rt::entry]
fn main() -> ! {
    // Both are there once after a reset, and this is the only place that takes them.
    if let (Some(board), Some(gyro)) = (&mut Board::start(), GYRO.try_take()) {
        let verdict = match start(&mut board.bus, &mut board.clock) {
            Some(mut imu) => station(&mut imu, &board.ready, &mut board.clock, gyro),
            None => Verdict::NoSensor,
        };
        show(&verdict, &mut board.display);
        // Here, where the drivers of the pins still exist: dropped, they would let go of the levels.
        stop();
    }
    stop()
}

/// Waits for the next reset.
fn stop() -> ! {
    loop {
        cortex_m::asm::wfi();
    }
}

/// Records until the limits can be judged.
fn station(
    imu: &mut Imu<&mut Bus>,
    ready: &Input<'_>,
    clock: &mut Clock,
    gyro: &mut Accumulator<OCTAVES>,
) -> Verdict {
    let mut samples = FIRST;
    let mut screen = Screen::new();
    loop {
        let rate_hz = match record(imu, ready, clock, (gyro, &mut screen), samples) {
            Ok(rate_hz) => rate_hz,
            Err(verdict) => return verdict,
        };
        let verdict = judge::judge(gyro, &screen, rate_hz);
        if samples >= LAST || !matches!(verdict, Verdict::Undecided(_)) {
            return verdict;
        }
        samples *= 2;
    }
}

/// Starts the sensor; `None` if it does not answer as an LSM6DSO.
#[inline(never)]
fn start<'b>(bus: &'b mut Bus, clock: &mut Clock) -> Option<Imu<&'b mut Bus>> {
    // The sensor wakes up for some time after its supply came.
    clock.delay_us(SUPPLY_US);
    Imu::start(bus, &LSM6DSO, clock).ok()
}

/// Records until there are so many samples, and returns the sensor's rate in samples per second of the board's clock.
#[inline(never)]
fn record(
    imu: &mut Imu<&mut Bus>,
    ready: &Input<'_>,
    clock: &mut Clock,
    (gyro, screen): (&mut Accumulator<OCTAVES>, &mut Screen),
    until: u64,
) -> Result<f32, Verdict> {
    // Samples were lost while the record was judged.
    gyro.gap();
    screen.gap();
    let (mut elapsed, mut intervals) = (0_u32, 0_u32);
    clock.restart();
    while gyro.samples() < until {
        if clock.ticks() > 8 * INTERVAL {
            return Err(Verdict::Silent);
        }
        if ready.is_low() {
            continue;
        }
        // The pin stays high until a sample was read. So this tries again after an error of the bus, until the time is up.
        let Ok(Some(reading)) = imu.read() else {
            continue;
        };
        let since = clock.restart();
        if since > INTERVAL + INTERVAL / 2 {
            gyro.gap();
            screen.gap();
        } else {
            elapsed += since / FRACTION;
            intervals += 1;
        }
        gyro.push(reading.gyro[AXIS]);
        screen.push(reading.gyro[AXIS]);
    }
    // Another rate than the true one would shift the curve along τ. The sensor's oscillator may be off by some per cent.
    let rate_hz = rate_hz(FRACTION) * intervals as f32 / elapsed as f32;
    if !(0.95 * LSM6DSO.rate_hz..1.05 * LSM6DSO.rate_hz).contains(&rate_hz) {
        return Err(Verdict::WrongRate);
    }
    Ok(rate_hz)
}

/// Shows the verdict. Both pins stay low if there is none.
fn show(verdict: &Verdict, display: &mut Display) {
    let (words, name) = match verdict {
        Verdict::Pass => ("pass", ""),
        Verdict::Fail(name) => ("fail: ", *name),
        Verdict::Undecided(name) => ("undecided: ", *name),
        Verdict::Invalid(name) => ("no record of a gyro at rest: ", *name),
        Verdict::Misfit => ("the five terms do not explain the record", ""),
        Verdict::NoFit => ("the record cannot be fitted", ""),
        Verdict::NoSensor => ("no LSM6DSO answers", ""),
        Verdict::Silent => ("no sample comes", ""),
        Verdict::WrongRate => ("wrong sample rate", ""),
    };
    match verdict {
        Verdict::Pass => display.pass.set_high(),
        Verdict::Fail(_) => display.fail.set_high(),
        _ => {}
    }
    display.say([words, name, "\r\n"]);
}
