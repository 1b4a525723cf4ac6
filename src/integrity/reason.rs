//! The reasons why a record is invalid, with a sentence for each.

/// Why the Allan curve of a record is not valid. `Display` writes the finding, its numbers and a remedy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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
    /// Too many values are extreme values of the converter: the rate left the sensor's range, or the
    /// sensor marks bad data with such a value.
    Railed {
        /// Samples at either end of the scale.
        hits: u64,
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
        /// Number of stretches of motion.
        motions: u64,
        /// Samples in each of the clusters whose means showed the motion.
        cluster: u16,
        /// Share of ΣD² of these clusters that the motion contributes, in percent.
        percent: u8,
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

impl core::fmt::Display for Reason {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Stuck {
                longest_run,
                changes,
                samples,
            } => write!(
                f,
                "the values are stuck: up to {longest_run} equal values in a row, {changes} changes \
                 in {samples} samples; check that the sensor is read at its own rate, or use a finer \
                 range"
            ),
            Self::Railed { hits, samples } => write!(
                f,
                "{hits} of {samples} samples are at the end of the scale; record at rest, use a \
                 wider range, or check the bus"
            ),
            Self::Spiked { spikes, percent } => write!(
                f,
                "the record has spikes: single samples far beyond the noise ({spikes}) explain \
                 {percent} % of the variance of one sample; check the supply and the bus, or leave \
                 the spikes out as gaps"
            ),
            Self::Moved {
                motions,
                cluster,
                percent,
            } => write!(
                f,
                "the gyro was moved: {motions} jumps explain {percent} % of the variance of means of \
                 {cluster} samples; record again at rest, untouched"
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
