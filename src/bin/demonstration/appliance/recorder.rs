//! The product while it records: it takes samples, saves snapshots and tests itself.

use super::{
    EVERY, Failure, Gyro, GyroRecord, KELVIN, Progress, SAMPLES, flash::Flash, saver, saver::Saver,
    scale,
};
use crate::product::{OCTAVES, self_test};
use allanite::{
    Scale,
    axis::Sample,
    queue::Queued,
    self_test::{Look, SelfTest, Status},
};

/// The number of samples that a look of the self-test lasts.
const LOOK: u32 = 512;

/// A recording product. Its parts of many kilobytes lie where the caller puts them.
pub struct Recorder<'a> {
    gyro: &'a mut Gyro,
    /// A snapshot on its way to the flash. The record itself is not borrowed while flash erases.
    buffer: &'a mut [u8],
    saver: Saver,
    tests: [SelfTest<OCTAVES>; 1],
    /// The look in progress, whether it is complete, and the sample at which it ends.
    look: Option<(Look<OCTAVES>, bool, u32)>,
    scale: Scale,
    /// The number of the sample that comes next.
    taken: u32,
    counts: Counts,
}

/// What has happened since power was switched on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// The number of samples that the queue lost.
    pub lost: u32,
    /// The number of snapshots and looks that were not complete in time.
    pub late: u32,
    /// The number of samples that were taken while the flash erased.
    pub during_erase: u32,
    /// The number of samples that were taken during a look.
    pub during_look: u32,
}

/// What a product finds when it is switched on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Restart {
    /// The number of the snapshot that was restored; `None` if there was none.
    pub snapshot: Option<u32>,
    /// The number of samples that the restored record accounts for.
    pub accounted: u64,
    /// The number of samples since then, which are a gap.
    pub missing: u64,
    /// The status of the self-test.
    pub self_test: Status,
}

impl<'a> Recorder<'a> {
    /// Switches the product on. It restores the last complete snapshot. `made` is the sensor's count of its
    /// samples, which tells how many are missing.
    ///
    /// # Errors
    /// [`Failure`], if the plan of the self-test is not valid.
    pub fn switch_on(
        gyro: &'a mut Gyro,
        buffer: &'a mut [u8],
        flash: &Flash,
        made: u32,
    ) -> Result<(Self, Restart), Failure> {
        let scale = scale()?;
        let test = || Ok::<_, Failure>([self_test(scale).ok_or(Failure::Plan)?]);
        let mut tests = test()?;
        gyro.reset();
        let fresh = test()?;
        let snapshot = saver::load(flash, buffer, |bytes| {
            tests.clone_from(&fresh);
            gyro.restore(&mut tests, bytes).is_ok()
        });
        if snapshot.is_none() {
            tests = fresh;
        }
        let accounted = accounted(gyro);
        let taken = made.min(SAMPLES);
        let missing = u64::from(taken).saturating_sub(accounted);
        gyro.lost(missing);
        let restart = Restart {
            snapshot,
            accounted,
            missing,
            self_test: tests[0].status(gyro.samples()),
        };
        let recorder = Self {
            gyro,
            buffer,
            saver: Saver::new(snapshot.map_or(0, |number| number + 1)),
            tests,
            look: None,
            scale,
            taken,
            counts: Counts::default(),
        };
        Ok((recorder, restart))
    }

    /// The number of the sample that comes next.
    pub fn taken(&self) -> u32 {
        self.taken
    }

    /// Whether the record is complete.
    pub fn has_ended(&self) -> bool {
        self.taken >= SAMPLES
    }

    /// What has happened since power was switched on.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Takes a sample from the queue. A sample after the record is only counted if it was lost.
    ///
    /// # Errors
    /// [`Failure`], if a snapshot cannot be encoded.
    pub fn push(&mut self, queued: Queued<Sample<3, 1>>) -> Result<(), Failure> {
        self.counts.lost = self.counts.lost.saturating_add(queued.lost);
        if self.has_ended() {
            return Ok(());
        }
        self.gyro.lost(queued.lost.into());
        self.gyro.push(queued.sample);
        self.taken = (self.taken + queued.lost + 1).min(SAMPLES);
        self.counts.during_erase += u32::from(self.saver.is_erasing());
        self.counts.during_look += u32::from(self.look.is_some());
        if self.has_ended() {
            self.gyro.release();
        }
        self.look()?;
        if self.taken.is_multiple_of(EVERY) {
            self.snapshot()?;
        }
        Ok(())
    }

    /// Ends a look at its last sample, and begins one where it is due.
    fn look(&mut self) -> Result<(), Failure> {
        let taken = self.taken;
        let ends = |look: &mut (Look<OCTAVES>, bool, u32)| taken >= look.2 || taken == SAMPLES;
        if let Some((mut look, is_complete, _)) = self.look.take_if(ends) {
            // What a late look lacks is done by its conclusion.
            self.counts.late += u32::from(!is_complete);
            self.tests[0].conclude(&mut look)?;
        }
        if self.look.is_none() && !self.has_ended() && self.tests[0].is_due(self.gyro.samples()) {
            let x = self.record(0)?;
            let look = self.tests[0].begin_look(&x)?;
            self.look = Some((look, false, taken + LOOK));
        }
        Ok(())
    }

    /// Encodes a snapshot into the buffer, from where it goes to the flash.
    fn snapshot(&mut self) -> Result<(), Failure> {
        if self.saver.is_busy() {
            self.counts.late += 1;
            return Ok(());
        }
        while self.gyro.advance() {}
        let stored = self.gyro.snapshot(&self.tests, self.buffer)?;
        self.saver.begin(stored.len());
        Ok(())
    }

    /// Does one operation of the flash, and returns whether there is more to do.
    pub fn store(&mut self, flash: &mut Flash) -> bool {
        self.saver.advance(flash, self.buffer)
    }

    /// Does one piece of work that needs no flash. The record is complete when its last snapshot is stored.
    pub fn step(&mut self) -> Progress {
        if let Some((look, is_complete @ false, _)) = &mut self.look {
            *is_complete = look.advance();
            return Progress::Working;
        }
        if self.gyro.advance() {
            return Progress::Working;
        }
        if self.has_ended() && !self.saver.is_busy() {
            return Progress::Complete;
        }
        Progress::Idle
    }

    /// the record of an axis.
    ///
    /// # Errors
    /// [`Failure::Record`] if there is no such axis.
    pub fn record(&self, axis: usize) -> Result<GyroRecord, Failure> {
        Ok(self.gyro.record_so_far(axis, (self.scale, [KELVIN]))?)
    }

    /// The record.
    pub fn gyro(&self) -> &Gyro {
        self.gyro
    }

    /// The status of the self-test.
    pub fn self_test(&self) -> Status {
        self.tests[0].status(self.gyro.samples())
    }
}

/// The number of samples that a record accounts for: kept, left out by the gate, and missing.
pub(super) fn accounted(gyro: &Gyro) -> u64 {
    let [x, ..] = gyro.integrity();
    gyro.samples() + gyro.left_out() + x.tally().missing
}
