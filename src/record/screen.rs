//! A small screen of the samples of one axis, in integers.

/// What a core with little flash keeps to see whether a record is one of a gyro at rest: 24 bytes, and a dozen instructions a sample.
///
/// It takes the place of [`Integrity`](crate::integrity::Integrity), which sees more and needs 10 KB of flash. With the curve of the same
/// samples, its [verdict](Self::verdict) recognises values that stick or repeat, noise below half a count, motion that goes
/// on, and spikes. It does not see when something happened, a change of range, reads without an answer, or clipping.
///
/// ```
/// use allanite::{Accumulator, Scale, integrity::Screen};
///
/// let (mut accumulator, mut screen) = (Accumulator::<14>::new(), Screen::new());
/// let mut random = 1_u32;
/// for n in 0..20_000_u32 {
///     random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
///     let count = (random >> 26) as i32 + if n % 4000 == 77 { 900 } else { 0 };
///     accumulator.push(count);
///     screen.push(count);
/// }
/// let scale = Scale::new(0.01, 100.0)?;
/// let reason = screen.verdict(&accumulator.curve(scale), scale);
/// assert_eq!(reason.map(|reason| reason.name()), Some("spiked"));
/// # Ok::<(), allanite::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Screen {
    last: i32,
    /// The samples since the last one that differed from the one before it, and the most that there were; 0 behind a gap.
    run: u32,
    longest: u32,
    /// Samples that equal the one before, and those that do not.
    repeats: u32,
    changes: u32,
    /// The largest difference of neighbours.
    largest: u32,
}

impl Screen {
    /// No samples yet.
    pub const fn new() -> Self {
        Self {
            last: 0,
            run: 0,
            longest: 0,
            repeats: 0,
            changes: 0,
            largest: 0,
        }
    }

    /// Adds the count that the accumulator takes.
    #[inline]
    pub fn push(&mut self, count: i32) {
        let difference = count.abs_diff(self.last);
        self.last = count;
        if self.run == 0 || difference > 0 {
            if self.run > 0 {
                self.changes = self.changes.saturating_add(1);
                self.largest = self.largest.max(difference);
            }
            self.run = 1;
            return;
        }
        self.repeats = self.repeats.saturating_add(1);
        self.run = self.run.saturating_add(1);
        self.longest = self.longest.max(self.run);
    }

    /// Marks a place where the next sample does not adjoin the one before.
    pub fn gap(&mut self) {
        self.run = 0;
    }

    /// Repeats, changes, the longest run of equal values, and the largest difference of neighbours.
    pub(crate) const fn seen(&self) -> (u32, u32, u32, u32) {
        (self.repeats, self.changes, self.longest, self.largest)
    }
}
