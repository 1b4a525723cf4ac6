//! The reasons why a record is invalid, with a sentence for each.

/// Why the Allan curve of a record is not valid. `Display` writes the finding, its numbers and a remedy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "storage", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "storage", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Reason {
    /// The values change too seldom: the sensor or its reader hung, or the quanta are too coarse for the
    /// noise.
    Stuck {
        /// Samples in the longest run of equal values.
        longest_run: u32,
        /// Number of samples that differ from the one before.
        changes: u64,
        /// Samples of the record.
        samples: u64,
    },
    /// Samples are there several times: the sensor's rate is a fraction of what was given.
    Repeated {
        /// How often each sample is there, 2 to 4. 1: some are there once more than others, at equal distances, as by a
        /// reader that is faster than the sensor. 0: at any distances.
        times: u8,
        /// Number of samples that differ from the one before, and of those that equal it by chance where that is known.
        changes: u64,
        /// Samples of the record.
        samples: u64,
    },
    /// Samples have one number on all axes, more often than chance explains, as a bus on which no sensor answers gives them.
    Unanswered {
        /// Samples with one number on all axes.
        reads: u64,
        /// Samples of the record.
        samples: u64,
    },
    /// Blocks of samples are there a second time, as a buffer that was not refilled leaves them.
    Stale {
        /// Samples that were there before; at least.
        stale: u64,
        /// The number of samples from one to the same one, up to 128.
        distance: u16,
        /// Samples of the record.
        samples: u64,
    },
    /// The noise is below half a count, so that rounding is no noise that adds. The variance of short
    /// averaging times then follows from where between two counts the constant offset lies.
    Coarse {
        /// The mean square of the differences of neighbouring samples, in thousandths of a squared count.
        per_mille: u16,
    },
    /// The counts jump between the ends of a range of whole bits: they were read without their sign, or with their bytes in
    /// the wrong order.
    Misread {
        /// The bits of the range.
        bits: u8,
    },
    /// Too many values are extreme values of the converter, or of the record: the rate left the sensor's range, or the
    /// sensor marks bad data with such a value.
    Railed {
        /// Samples at the end of the scale that is clipped, or at both.
        hits: u64,
        /// Samples of the record.
        samples: u64,
    },
    /// Too many values are zero, as behind a dead band: the noise is larger than the record shows.
    DeadBand {
        /// Samples that are zero.
        zeros: u64,
        /// Samples of the record.
        samples: u64,
    },
    /// Single samples far beyond the noise contribute a large share of the variance.
    Spiked {
        /// Number of spikes.
        spikes: u64,
        /// Share of ΣD² at averaging factor `m = 1` that the spikes contribute, in percent.
        percent: u8,
    },
    /// The gyro was not at rest.
    Moved {
        /// Number of stretches of motion. 0: the motion never stopped.
        motions: u64,
        /// Samples in each of the clusters whose means showed the motion.
        cluster: u16,
        /// Share of ΣD² of these clusters that the motion contributes, in percent; at least, where it never stopped.
        percent: u8,
    },
    /// The noise of a sample is another one from a place of the record on, by a factor that no gyro at rest reaches.
    Changed {
        /// Samples before the change, to one block of the [`Course`](crate::course::Course).
        after: u64,
        /// The noise behind the change, in percent of that before it; at most 65 535.
        percent: u16,
    },
    /// Too many samples were lost.
    Missing {
        /// Number of samples lost.
        missing: u64,
        /// Number of samples that the sensor must have sent.
        sent: u64,
    },
    /// A gate left out too many samples because of what it saw in them.
    LeftOut {
        /// Number of samples left out.
        left_out: u64,
        /// Samples of the record, including those that were left out.
        samples: u64,
    },
}

impl Reason {
    /// The words of all reasons, as [`Reason::name`] gives them.
    pub const NAMES: [&'static str; 13] = [
        "stuck",
        "repeated",
        "unanswered",
        "stale",
        "coarse",
        "misread",
        "railed",
        "dead_band",
        "spiked",
        "moved",
        "changed",
        "missing",
        "left_out",
    ];

    /// The reason as a word for files, such as `dead_band`: the name of the variant.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Stuck { .. } => "stuck",
            Self::Repeated { .. } => "repeated",
            Self::Unanswered { .. } => "unanswered",
            Self::Stale { .. } => "stale",
            Self::Coarse { .. } => "coarse",
            Self::Misread { .. } => "misread",
            Self::Railed { .. } => "railed",
            Self::DeadBand { .. } => "dead_band",
            Self::Spiked { .. } => "spiked",
            Self::Moved { .. } => "moved",
            Self::Changed { .. } => "changed",
            Self::Missing { .. } => "missing",
            Self::LeftOut { .. } => "left_out",
        }
    }
}

impl core::fmt::Display for Reason {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Stuck {
                longest_run,
                changes,
                samples,
            } => write!(
                f,
                "stuck values: up to {longest_run} equal values in a row, {changes} changes \
                 in {samples} samples; check that the sensor is read at its own rate, or use a finer \
                 range"
            ),
            Self::Repeated {
                times,
                changes,
                samples,
            } if *times < 2
                || changes.saturating_mul(98).saturating_mul((*times).into())
                    > samples.saturating_mul(100) =>
            {
                let per_mille =
                    |part: u64| (u128::from(part) * 1000 / u128::from(*samples.max(&1))) as u16;
                let (repeats, own) = (
                    per_mille(samples.saturating_sub(*changes)),
                    per_mille(*changes),
                );
                write!(
                    f,
                    "{}.{} % of the samples repeat the one before: the sensor's rate is {}.{:03} of what \
                     was given; read the sensor at its own rate, or give that rate and leave the repeated \
                     samples out",
                    repeats / 10,
                    repeats % 10,
                    own / 1000,
                    own % 1000
                )
            }
            Self::Repeated {
                times,
                changes,
                samples,
            } => {
                let (every, rate) = match times {
                    2 => ("twice", "half"),
                    3 => ("three times", "a third"),
                    _ => ("four times", "a quarter"),
                };
                write!(
                    f,
                    "every sample is there {every}, {changes} changes in {samples} samples: the \
                     sensor's rate is {rate} of what was given; read the sensor at its own rate, or \
                     give that rate and leave the repeated samples out"
                )
            }
            Self::Unanswered { reads, samples } => write!(
                f,
                "{reads} of {samples} samples have one number on all axes, as a bus without an answer gives them; check \
                 the bus and the status of each read, and leave such samples out as gaps"
            ),
            Self::Stale {
                stale,
                distance,
                samples,
            } => write!(
                f,
                "at least {stale} of {samples} samples are there a second time, {distance} samples after the first, as a \
                 buffer that was not refilled leaves them; read each half of the buffer once, when it is full"
            ),
            Self::Coarse { per_mille } => write!(
                f,
                "the noise is below half a count: the mean square of the differences of neighbouring \
                 samples is {}.{:03} squared counts, and the result would follow from the constant \
                 offset; use a finer range",
                per_mille / 1000,
                per_mille % 1000
            ),
            Self::Misread { bits } => write!(
                f,
                "the counts jump between the ends of a range of {bits} bits: they were read without \
                 their sign, or with their bytes in the wrong order; read them in two's complement"
            ),
            Self::Railed { hits, samples } => write!(
                f,
                "{hits} of {samples} samples are at the end of the scale; record at rest, use a \
                 wider range, or check the bus"
            ),
            Self::DeadBand { zeros, samples } => write!(
                f,
                "{zeros} of {samples} values are exactly zero, as a dead band leaves them, so that the \
                 coefficients are lower bounds; switch the dead band off in the sensor or its driver"
            ),
            Self::Spiked { spikes, percent } => write!(
                f,
                "the record has spikes: single samples far beyond the noise ({spikes}) explain \
                 {percent} % of the variance of one sample; check the supply and the bus, or leave \
                 the spikes out as gaps"
            ),
            Self::Moved {
                motions: 0,
                cluster,
                percent,
            } => write!(
                f,
                "the gyro was not at rest: motion explains at least {percent} % of the variance of \
                 means of {cluster} samples; record again at rest, untouched"
            ),
            Self::Moved {
                motions,
                cluster,
                percent,
            } => {
                let (jumps, explain) = match motions {
                    1 => ("jump", "explains"),
                    _ => ("jumps", "explain"),
                };
                write!(
                    f,
                    "the gyro was moved: {motions} {jumps} {explain} {percent} % of the variance of \
                     means of {cluster} samples; record again at rest, untouched"
                )
            }
            Self::Changed { after, percent } => write!(
                f,
                "the noise changed to {percent} % of what it was after {after} samples, as another range, rate or \
                 filter of the sensor makes it; keep the settings of the sensor, and record again"
            ),
            Self::Missing { missing, sent } => write!(
                f,
                "{missing} of {sent} samples are missing; read faster or record at a lower rate"
            ),
            Self::LeftOut { left_out, samples } => write!(
                f,
                "the gate left out {left_out} of {samples} samples (motion, stuck values, end of the \
                 scale or spikes); record again at rest, untouched"
            ),
        }
    }
}
