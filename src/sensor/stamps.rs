use super::{Fifo, Loss};
use core::num::NonZeroU64;

/// The number of intervals over which the number of ticks of an interval is learned.
const WINDOW: u16 = 256;

/// The fixed point of an interval: 1/256 tick. It equals the window, so that the ticks of a window are the
/// interval.
const FRACTION: u64 = WINDOW as u64;

const PS_PER_US: u64 = 1_000_000;

/// The largest disagreement of the clocks of sensor and host that is expected, as the exponent of a fraction 1/2ⁿ: 3 %
/// for a time of less than 32 bits, whose rounds have to be distinguished, and else 12 %.
const fn disagreement(bits: u32) -> u32 {
    if bits < 32 { 5 } else { 3 }
}

/// By how many intervals a time may differ from what is expected, besides that.
const SLACK: u64 = 4;

/// The largest number of intervals between neighbours in a burst. Only packets without a sample can be between them.
const NEIGHBOURS: u64 = 8;

/// After so many implausible times in a row, the next one is believed.
const REFUSALS: u8 = 2;

/// Turns a sensor's wrapping stamps into its time, and into the number of lost samples.
///
/// The stamps alone tell how many samples were lost, up to whole rounds of the counter. The host's time is used
/// only to count those rounds.
#[derive(Clone, Debug)]
pub(super) struct Stamps {
    /// The number of bits of a stamp, at most 32.
    bits: u32,
    tick_ps: NonZeroU64,
    nominal: NonZeroU64,
    /// The learned interval, in 1/256 ticks.
    interval: NonZeroU64,
    /// The ticks and intervals of the window, without losses.
    window: (u64, u16),
    /// The time of the sample before.
    last: Option<u64>,
    /// A time of the host in µs, and the sensor's time then.
    host: Option<(u32, u64)>,
    /// Whether the next stamp is the first of a burst.
    is_first: bool,
    /// About the time of that stamp, and the uncertainty of this.
    expected: Option<(u64, u64)>,
    /// The number of implausible times in a row.
    refused: u8,
}

impl Stamps {
    pub(super) fn new(fifo: &Fifo) -> Self {
        let bits = u32::from(fifo.time_bits).clamp(8, 32);
        let positive =
            |number: u32| NonZeroU64::MIN.saturating_add(u64::from(number).saturating_sub(1));
        let nominal = positive(fifo.interval);
        Self {
            bits,
            tick_ps: positive(fifo.tick_ps),
            nominal,
            interval: nominal,
            window: (0, 0),
            last: None,
            host: None,
            is_first: true,
            expected: None,
            refused: 0,
        }
    }

    /// The sample interval in 1/256 ticks: the nominal one, or what the last window says.
    pub(super) const fn interval(&self) -> u64 {
        self.interval.get()
    }

    /// The ticks of a number of intervals.
    const fn ticks(&self, intervals: u64) -> u64 {
        intervals.saturating_mul(self.interval.get()) / FRACTION
    }

    /// Tells the host's time when the FIFO held `samples` samples, of which the next stamp is the oldest.
    pub(super) fn expect(&mut self, now_us: u32, samples: usize) {
        self.is_first = true;
        self.expected = self.host.map(|(then_us, ticks)| {
            let elapsed = u64::from(now_us.wrapping_sub(then_us));
            let elapsed = elapsed * PS_PER_US / self.tick_ps;
            let age = self.ticks(samples as u64);
            let disagreement = elapsed >> disagreement(self.bits);
            let uncertainty = disagreement.saturating_add(self.ticks(SLACK));
            (
                ticks.saturating_add(elapsed).saturating_sub(age),
                uncertainty,
            )
        });
    }

    /// Takes the stamp of the next sample. It returns its time, and what was lost before it; `None` if the stamp
    /// cannot be that of a later sample.
    ///
    /// A damaged stamp must not be believed, because all later samples would seem to come before it. So a time is
    /// refused if it is not near that of its neighbour or, at the beginning of a burst, near the host's.
    pub(super) fn take(&mut self, stamp: u32) -> Option<(u64, Loss)> {
        let is_first = core::mem::take(&mut self.is_first);
        let expected = self.expected.take();
        let Some(last) = self.last else {
            let ticks = u64::from(stamp);
            self.last = Some(ticks);
            return Some((ticks, Loss::Nothing));
        };
        let round = 1_u64.wrapping_shl(self.bits);
        let forward = u64::from(stamp).wrapping_sub(last) & round.wrapping_sub(1);
        let mut ticks = last.saturating_add(forward);
        let (mut certain, plausible);
        if let Some((expected, uncertainty)) = expected {
            let rounds = (expected.saturating_add(round / 2))
                .saturating_sub(ticks)
                .wrapping_shr(self.bits);
            ticks = ticks.saturating_add(rounds.saturating_mul(round));
            certain = uncertainty < round / 4;
            plausible = !certain || ticks.abs_diff(expected) <= uncertainty;
        } else if is_first {
            (certain, plausible) = (true, forward <= round / 2);
        } else {
            (certain, plausible) = (true, forward <= self.ticks(NEIGHBOURS));
        }
        if !plausible && self.refused >= REFUSALS {
            certain = false;
        } else if !plausible {
            self.refused = self.refused.saturating_add(1);
            return None;
        }
        let loss = self.loss(ticks.saturating_sub(last), certain)?;
        self.refused = 0;
        self.last = Some(ticks);
        Some((ticks, loss))
    }

    /// What was lost if `ticks` ticks have passed since the sample before; `None` if this is no interval.
    fn loss(&mut self, ticks: u64, certain: bool) -> Option<Loss> {
        let scaled = ticks.saturating_mul(FRACTION);
        let interval = self.interval.get();
        let intervals = scaled.saturating_add(interval / 2) / self.interval;
        if intervals == 0 {
            return None;
        }
        let off = scaled.abs_diff(intervals.saturating_mul(interval));
        if !certain || off > interval / 4 {
            self.window = (0, 0);
            return Some(Loss::Unknown);
        }
        if intervals > 1 {
            self.window = (0, 0);
            return Some(Loss::Samples(
                u32::try_from(intervals - 1).unwrap_or(u32::MAX),
            ));
        }
        let (sum, number) = &mut self.window;
        *sum = sum.saturating_add(ticks);
        *number = number.saturating_add(1);
        if *number == WINDOW {
            let nominal = self.nominal.get();
            let learned = NonZeroU64::new(*sum).filter(|_| sum.abs_diff(nominal) <= nominal / 8);
            self.interval = learned.unwrap_or(self.interval);
            self.window = (0, 0);
        }
        Some(Loss::Nothing)
    }

    /// Tells the host's time when the sample of the last stamp was followed by `remaining` further ones. It
    /// returns the sensor's time then.
    pub(super) fn settle(&mut self, now_us: u32, remaining: usize) -> Option<u64> {
        let younger = self.ticks(remaining as u64);
        let ticks = self.last?.saturating_add(younger);
        self.host = Some((now_us, ticks));
        Some(ticks)
    }
}
