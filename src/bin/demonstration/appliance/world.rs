//! What a power cut leaves as it is.

use super::{BURST, Counts, Flash, SAMPLES};
use crate::{product::Sensor, simulated::Random};
use allanite::axis::Sample;
use core::fmt::{self, Display, Formatter};

/// The number of power cuts.
pub const CUTS: usize = 10;

/// The number of samples after the record within which the last cut happens, while the diagnosis is in progress.
/// A whole diagnosis was seen to last 648 samples on the board that QEMU models.
const DIAGNOSIS: u32 = 512;

/// The sensor with its FIFO, and the supply of power.
pub struct Source {
    sensor: Sensor,
    /// The numbers of samples after which power is cut, in increasing order.
    cuts: [u32; CUTS],
    /// The number of cuts so far.
    done: usize,
}

/// What happens after a sample has been made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plan {
    /// Nothing.
    GoOn,
    /// The power is cut at once.
    Cut,
}

impl Source {
    fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let mut below = |end: u32| ((u64::from(random.bits()) * u64::from(end)) >> 32) as u32;
        let mut cuts = [0; CUTS].map(|_: u32| 1 + below(SAMPLES - 1));
        cuts[CUTS - 1] = SAMPLES + BURST + below(DIAGNOSIS);
        cuts.sort_unstable();
        Self {
            sensor: Sensor::new(0),
            cuts,
            done: 0,
        }
    }

    /// The number of samples that were made.
    pub fn made(&self) -> u32 {
        self.sensor.made()
    }

    /// Makes the next sample, and tells whether power is cut after it.
    pub fn sample(&mut self) -> (Sample<3, 1>, Plan) {
        let sample = self.sensor.sample();
        match self.cuts.get(self.done) {
            Some(&cut) if self.made() >= cut => {
                self.done += 1;
                (sample, Plan::Cut)
            }
            _ => (sample, Plan::GoOn),
        }
    }
}

/// The flash, and notes about the product that belong to no product. The notes are kept so that the host can
/// repeat a cut.
pub struct Stored {
    /// The flash.
    pub flash: Flash,
    /// The number of times that power was switched on.
    pub starts: u32,
    /// The number of the sample that comes next, as of the last cut.
    pub taken: u32,
    /// What had happened between the last start and the last cut.
    pub counts: Counts,
    /// Whether the next diagnosis is done in one piece, which is longer than the watchdog permits.
    pub undivided: bool,
}

/// The gyros, the supply of power and the flash.
pub struct World {
    /// The part that the interrupt uses.
    pub source: Source,
    /// The part that the main loop uses.
    pub stored: Stored,
}

impl World {
    /// A world with the cuts of a seed.
    pub fn new(seed: u64) -> Self {
        Self {
            source: Source::new(seed),
            stored: Stored {
                flash: Flash::ERASED,
                starts: 0,
                taken: 0,
                counts: Counts::default(),
                undivided: false,
            },
        }
    }

    /// The moment of the last power cut.
    pub fn cut(&self) -> Cut {
        Cut {
            made: self.source.made(),
            taken: self.stored.taken,
            operations: self.stored.flash.operations(),
        }
    }

    /// Switches power on.
    pub fn switch_on(&mut self) {
        self.stored.flash.switch_on();
        self.stored.starts += 1;
        self.stored.taken = 0;
        self.stored.counts = Counts::default();
    }
}

/// The moment of a power cut: all that the host needs to repeat it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cut {
    /// The number of samples that were made.
    pub made: u32,
    /// The number of samples that the product had taken, or that were lost before.
    pub taken: u32,
    /// The number of operations of the flash since power was switched on.
    pub operations: u32,
}

impl Cut {
    /// Reads what [`Display`] wrote.
    pub fn parse(text: &str) -> Option<Self> {
        let mut numbers = text.split(':').map(|number| number.parse().ok());
        let cut = Self {
            made: numbers.next()??,
            taken: numbers.next()??,
            operations: numbers.next()??,
        };
        numbers.next().is_none().then_some(cut)
    }
}

impl Display for Cut {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.made, self.taken, self.operations)
    }
}
