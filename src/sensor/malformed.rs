use core::fmt;

/// Why the content of a FIFO makes no sense. What was read after it is lost, the FIFO is emptied by the next
/// read, and the sample after that says how many samples are missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Malformed {
    /// A header or tag that was not asked for.
    Header {
        /// The byte found.
        found: u8,
    },
    /// A tag of wrong parity.
    Parity {
        /// The byte found.
        found: u8,
    },
    /// A time that is not later than that of the sample before.
    Time {
        /// The stamp found, in ticks.
        found: u32,
    },
}

impl fmt::Display for Malformed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Header { found } => write!(f, "the FIFO holds the unknown header {found:#04x}")?,
            Self::Parity { found } => write!(f, "the FIFO's tag {found:#04x} has wrong parity")?,
            Self::Time { found } => write!(f, "the FIFO's time {found} is not after the last")?,
        }
        f.write_str(": check clock and wiring of the bus; the FIFO is emptied")
    }
}

impl core::error::Error for Malformed {}
