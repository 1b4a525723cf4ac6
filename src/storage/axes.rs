//! Snapshots of everything that is kept of a record, including the self-tests: version 4 of the format, or version 5
//! for a record with gaps that were filled.
//!
//! This table describes the payload of the [`envelope`]. The payload is in
//! postcard's encoding: numbers longer than one byte are varints of seven bits per byte, lowest bits first,
//! and signed numbers are zigzag-encoded.
//!
//! | content | type |
//! |---|---|
//! | number of octaves, axes, covariates, self-tests | 4 × u8 |
//! | parts: 1 for a gate, plus 2 for fourth moments, plus 4 for the course, plus 8 for the reads, plus 16 for the sums, plus 32 for neighbours | u8 |
//! | spectrum: number of blocks of a segment, number of levels; zeros without one | u16, u8 |
//! | samples; gaps, including one at the end of the snapshot | 2 × u64 |
//! | for each octave `m = 1, 2, 4, …`: number of differences, the same for all axes and covariates | u64 |
//! | in version 5: gaps that were filled and samples lost in them, of each class of [`Bridged`] | 7 × u32, 7 × u32 |
//! | for each axis, then for each covariate: Σ D² of each octave in counts², lowest limb first | 3 × u64 |
//! | for each axis: its integrity, as the structure `integrity::State` has it | |
//! | and with fourth moments: Σ D⁴ of each octave, lowest limb first | 3 × u64 |
//! | and for each covariate, each octave: Σ D_g D_x as `low + 2^64 · upper` | i64, i128 |
//! | and with a spectrum: samples that found no room | u64 |
//! | and for each level, shortest blocks first: number of segments | u32 |
//! | and for each bin, if there are segments: Σ P and Σ P² over the segments | 2 × f32 |
//! | and with the course: its blocks, as `course::stored` says | |
//! | with reads, which earlier snapshots lack: the structure `reads::stored::Stored` | |
//! | with sums, which earlier snapshots lack: the sum of all counts and filled values of each axis, then of each covariate; −2^63 if it is not known | i64 |
//! | with neighbours, of two covariates or more: for each covariate but the first, each octave: Σ D D' with the one before | i64, i128 |
//! | losses | u64 |
//! | with a gate: samples left out, then for each axis the integrity of all samples | u64, … |
//! | for each self-test: plan, next look, limits kept, verdict | |

use super::{
    Error,
    envelope::{self, Kind, OVERHEAD, Writer, take},
    snapshot::{self, LONGEST, LONGEST_BRIDGED, has_possible_gaps, is_possible, take_bridged},
};
use crate::{
    record::{
        axis::{
            Axes, CoursePart, GatePart, MomentPart, SpectrumPart, courses::CourseSums,
            gate::Passing, kept::AxisSums, moments::MomentSums, spectra::SpectrumSums,
        },
        course::Course,
        cross_sums::ProductSum,
        octave::{Accumulator, Bridged, OctaveSum, UNKNOWN},
        reads::Reads,
        square_sum::SquareSum,
    },
    self_test::{self, SelfTest},
};
use serde::{Deserialize, Serialize, de::DeserializeOwned};

const VERSION: u8 = 4;

/// The version for a record with gaps that were filled.
const BRIDGED_VERSION: u8 = 5;

/// The bit of the parts that says that the reads follow.
const WITH_READS: u8 = 8;

/// The bit of the parts that says that the sums of the counts follow.
const WITH_SUMS: u8 = 16;

/// The bit of the parts that says that the products of neighbouring covariates follow.
const WITH_NEIGHBOURS: u8 = 32;

/// The largest number of bytes that the integrity of an axis takes.
const INTEGRITY: usize = 520;

/// The number of bytes of the longest varint of 128 bits.
const LONGEST_128: usize = 19;

#[derive(PartialEq, Eq, Serialize, Deserialize)]
struct Parts {
    octaves: u8,
    axes: u8,
    covariates: u8,
    self_tests: u8,
    kept: u8,
}

#[derive(Serialize, Deserialize)]
struct Counts {
    samples: u64,
    gaps: u64,
}

/// The bytes that have not been read yet.
struct Reader<'b>(&'b [u8]);

impl Reader<'_> {
    fn take<T: DeserializeOwned>(&mut self) -> Result<T, Error> {
        take(&mut self.0).ok_or(Error::Impossible)
    }
}

impl<const OCTAVES: usize, const COVARIATES: usize, G, M, const AXES: usize, S, T>
    Axes<OCTAVES, COVARIATES, G, M, AXES, S, T>
where
    G: GatePart,
    M: MomentPart,
    S: SpectrumPart,
    T: CoursePart,
{
    const HAS_GATE: bool = <G::State<AXES, COVARIATES> as Passing<AXES, COVARIATES>>::EXISTS;
    const HAS_MOMENTS: bool = <M::Sums<OCTAVES> as MomentSums<OCTAVES>>::EXIST;
    const HAS_COURSE: bool = <T::Sums<COVARIATES> as CourseSums<COVARIATES>>::EXISTS;

    /// The size in bytes of a buffer that holds a snapshot of any record with this number of self-tests.
    /// The snapshot of a gyro at rest takes about a third of it.
    pub const fn snapshot_bytes(self_tests: usize) -> usize {
        let sums = OCTAVES * 3 * LONGEST;
        let moments = if Self::HAS_MOMENTS { sums } else { 0 };
        let product = OCTAVES * (LONGEST + LONGEST_128);
        let products = COVARIATES * product;
        let neighbours = COVARIATES.saturating_sub(1) * product;
        let seen = if Self::HAS_GATE { INTEGRITY } else { 0 };
        let spectrum = <S::Sums as SpectrumSums>::LONGEST;
        let course = if Self::HAS_COURSE {
            Course::<COVARIATES>::LONGEST_STORED
        } else {
            0
        };
        let axis = sums + INTEGRITY + moments + products + seen + spectrum + course;
        let head =
            Reads::<AXES>::LONGEST_STORED + 5 + 4 + (4 + OCTAVES) * LONGEST + LONGEST_BRIDGED;
        let counts = (AXES + COVARIATES) * LONGEST;
        let covariates = COVARIATES * sums + neighbours;
        head + counts + AXES * axis + covariates + self_tests * self_test::LONGEST + OVERHEAD
    }

    fn parts(self_tests: usize) -> Parts {
        Parts {
            octaves: OCTAVES as u8,
            axes: AXES as u8,
            covariates: COVARIATES as u8,
            self_tests: self_tests as u8,
            kept: u8::from(Self::HAS_GATE)
                + 2 * u8::from(Self::HAS_MOMENTS)
                + 4 * u8::from(Self::HAS_COURSE)
                + WITH_READS
                + WITH_SUMS
                + WITH_NEIGHBOURS * u8::from(COVARIATES > 1),
        }
    }

    /// Writes the record and the state of the self-tests that judge these axes to a buffer, and returns the
    /// part of the buffer that was used.
    ///
    /// The record does not change. The snapshot does not contain the samples that the gate holds back. After
    /// a restore they are lost, like the samples that came after the snapshot.
    ///
    /// # Errors
    /// [`Error::BufferTooSmall`], which never occurs with [`snapshot_bytes`](Self::snapshot_bytes).
    ///
    /// # Example
    ///
    /// ```
    /// use allanite::Axes;
    ///
    /// type Gyro = Axes<10, 1, ()>;
    ///
    /// let mut gyro = Gyro::new();
    /// for n in 0..100 {
    ///     gyro.push(([n * n % 7, n * n % 11, n * n % 13], [n]));
    /// }
    /// let mut buffer = [0; Gyro::snapshot_bytes(0)];
    /// let stored = gyro.snapshot(&[], &mut buffer)?;
    ///
    /// // After a restart, the restored record equals one that had a gap at this moment.
    /// let mut restored = Gyro::new();
    /// restored.restore(&mut [], stored)?;
    /// gyro.gap();
    /// assert_eq!(restored.accumulators(), gyro.accumulators());
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn snapshot<'b>(
        &self,
        self_tests: &[SelfTest<OCTAVES>],
        buffer: &'b mut [u8],
    ) -> Result<&'b [u8], Error> {
        let most = Self::snapshot_bytes(self_tests.len()) - OVERHEAD;
        let is_bridged = |axis: &AxisSums<_, _, _, _, _>| !axis.accumulator.bridged().is_empty();
        let version = match self.kept.axes.first().is_some_and(is_bridged) {
            true => BRIDGED_VERSION,
            false => VERSION,
        };
        let mut writer = Writer::new(buffer, Kind::Snapshot, version, most)?;
        writer.push(&Self::parts(self_tests.len()))?;
        writer.push(&<S::Sums as SpectrumSums>::SIZE)?;
        self.write_sums(&mut writer)?;
        for axis in &self.kept.axes {
            writer.push(&axis.integrity.stored())?;
            if let Some(moments) = axis.moments.moments() {
                for octave in 0..OCTAVES {
                    writer.push(&moments.read(octave, &axis.accumulator))?;
                }
            }
            for (products, covariate) in axis.cross.iter().zip(&self.kept.covariates) {
                for octave in 0..OCTAVES {
                    let sum = products.read(octave, &axis.accumulator, covariate);
                    writer.push(&sum.parts())?;
                }
            }
            writer.push_with(|rest| axis.spectrum.write(rest))?;
            if let Some(course) = axis.course.course() {
                writer.push_with(|rest| course.write(rest))?;
            }
        }
        writer.push(&self.kept.reads.stored())?;
        for accumulator in self.kept.accumulators() {
            writer.push(&accumulator.total())?;
        }
        let neighbours = self.kept.covariates.windows(2);
        for (pair, between) in neighbours.zip(self.kept.between.iter().skip(1)) {
            let [one, other] = pair else { continue };
            for octave in 0..OCTAVES {
                writer.push(&between.read(octave, one, other).parts())?;
            }
        }
        writer.push(&self.losses)?;
        if let Some(gate) = self.gate.gate() {
            writer.push(&gate.left_out())?;
            for seen in gate.integrity() {
                writer.push(&seen.stored())?;
            }
        }
        for test in self_tests {
            writer.push(&test.stored())?;
        }
        writer.finish()
    }

    fn write_sums(&self, writer: &mut Writer<'_>) -> Result<(), Error> {
        let accumulators = || self.kept.accumulators();
        let Some(first) = accumulators().next() else {
            return Ok(());
        };
        writer.push(&Counts {
            samples: first.samples(),
            gaps: first.ended_gaps(),
        })?;
        for octave in first.octaves() {
            writer.push(&octave.differences)?;
        }
        if !first.bridged().is_empty() {
            writer.push(first.bridged())?;
        }
        for accumulator in accumulators() {
            for octave in accumulator.octaves() {
                writer.push(&octave.sum.limbs())?;
            }
        }
        Ok(())
    }

    /// Restores the record that a [snapshot](Self::snapshot) holds, as it is after a [`gap`](Self::gap),
    /// and the state of the self-tests, which must have been made with the same plans. The snapshot does not
    /// contain the limits of integrity, so the present limits stay. A snapshot of an [`Accumulator`] alone
    /// can be restored into one axis without moments and covariates; its integrity is then empty.
    ///
    /// # Errors
    /// [`Error::UnknownMagic`], [`Error::WrongLength`], [`Error::Corrupt`], [`Error::WrongKind`],
    /// [`Error::UnknownVersion`], [`Error::WrongOctaves`], [`Error::OtherParts`], [`Error::OtherPlan`];
    /// [`Error::Impossible`] if no record can have such contents. After any error the record is empty, and
    /// the self-tests must be made anew.
    pub fn restore(
        &mut self,
        self_tests: &mut [SelfTest<OCTAVES>],
        bytes: &[u8],
    ) -> Result<(), Error> {
        self.reset();
        let restored = self.read(self_tests, bytes);
        if restored.is_err() {
            self.reset();
        }
        restored
    }

    fn read(&mut self, self_tests: &mut [SelfTest<OCTAVES>], bytes: &[u8]) -> Result<(), Error> {
        let (version, payload) = envelope::open_any(bytes, Kind::Snapshot)?;
        match version {
            VERSION | BRIDGED_VERSION => {}
            snapshot::VERSION | snapshot::BRIDGED_VERSION => {
                return self.read_accumulator(self_tests, bytes);
            }
            found if snapshot::EARLIER.contains(&found) => {
                return self.read_accumulator(self_tests, bytes);
            }
            found => {
                return Err(Error::UnknownVersion {
                    found,
                    known: VERSION,
                });
            }
        }
        let mut reader = Reader(payload);
        let mut parts: Parts = reader.take()?;
        if usize::from(parts.octaves) != OCTAVES {
            return Err(Error::WrongOctaves {
                found: parts.octaves.into(),
                wanted: OCTAVES,
            });
        }
        let [has_reads, has_sums] = [WITH_READS, WITH_SUMS].map(|bit| parts.kept & bit > 0);
        parts.kept |= WITH_READS | WITH_SUMS;
        if parts != Self::parts(self_tests.len()) {
            return Err(Error::OtherParts);
        }
        let size: (u16, u8) = reader.take()?;
        if size != <S::Sums as SpectrumSums>::SIZE {
            return Err(Error::OtherParts);
        }
        self.read_sums(&mut reader, version == BRIDGED_VERSION)?;
        for axis in &mut self.kept.axes {
            let rest = axis.integrity.restore(reader.0);
            reader.0 = rest.ok_or(Error::Impossible)?;
            if let Some(moments) = axis.moments.moments_mut() {
                for sum in moments.sums_mut() {
                    *sum = reader.take()?;
                }
            }
            for sum in axis.cross.iter_mut().flat_map(|cross| cross.sums_mut()) {
                let (low, upper) = reader.take()?;
                *sum = ProductSum::from_parts(low, upper);
            }
            reader.0 = axis.spectrum.read(reader.0).ok_or(Error::Impossible)?;
            if let Some(course) = axis.course.course_mut() {
                reader.0 = course.read(reader.0).ok_or(Error::Impossible)?;
            }
        }
        if has_reads {
            let rest = self.kept.reads.restore(reader.0);
            reader.0 = rest.ok_or(Error::Impossible)?;
        }
        if has_sums {
            for accumulator in self.kept.accumulators_mut() {
                accumulator.set_total(reader.take()?);
            }
        }
        let neighbours = self.kept.between.iter_mut().skip(1);
        for sum in neighbours.flat_map(|between| between.sums_mut()) {
            let (low, upper) = reader.take()?;
            *sum = ProductSum::from_parts(low, upper);
        }
        self.losses = reader.take()?;
        if let Some(gate) = self.gate.gate_mut() {
            let (seen, left_out) = gate.state_mut();
            *left_out = reader.take()?;
            for seen in seen {
                reader.0 = seen.restore(reader.0).ok_or(Error::Impossible)?;
            }
        }
        for test in self_tests {
            reader.0 = test.restore(reader.0)?;
        }
        reader.0.is_empty().then_some(()).ok_or(Error::Impossible)
    }

    fn read_sums(&mut self, reader: &mut Reader<'_>, is_bridged: bool) -> Result<(), Error> {
        let Counts { samples, gaps } = reader.take()?;
        if !has_possible_gaps(samples, gaps) {
            return Err(Error::Impossible);
        }
        let mut octaves = [OctaveSum {
            m: 0,
            differences: 0,
            sum: SquareSum::ZERO,
        }; OCTAVES];
        for (octave, k) in octaves.iter_mut().zip(0_u32..) {
            octave.m = 1_u32.wrapping_shl(k);
            octave.differences = reader.take()?;
        }
        let bridged = match is_bridged {
            true => take_bridged(&mut reader.0).ok_or(Error::Impossible)?,
            false => Bridged::NONE,
        };
        for accumulator in self.kept.accumulators_mut() {
            for (octave, k) in octaves.iter_mut().zip(0..) {
                let sum = SquareSum::from_limbs(reader.take()?);
                octave.sum = sum.ok_or(Error::Impossible)?;
                if !is_possible((samples, gaps), &bridged, k, octave) {
                    return Err(Error::Impossible);
                }
            }
            *accumulator =
                Accumulator::ended((samples, UNKNOWN), gaps, octaves).with_bridged(bridged);
        }
        Ok(())
    }

    /// Restores a snapshot of an accumulator.
    fn read_accumulator(
        &mut self,
        self_tests: &[SelfTest<OCTAVES>],
        bytes: &[u8],
    ) -> Result<(), Error> {
        let [axis] = &mut self.kept.axes[..] else {
            return Err(Error::OtherParts);
        };
        let has_spectrum = <S::Sums as SpectrumSums>::SIZE != (0, 0);
        let has_more = Self::HAS_MOMENTS || Self::HAS_COURSE || has_spectrum;
        if COVARIATES > 0 || has_more || !self_tests.is_empty() {
            return Err(Error::OtherParts);
        }
        axis.accumulator = Accumulator::restore(bytes)?;
        Ok(())
    }
}
