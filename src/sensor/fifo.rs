use super::{PacketCount, PacketFormat, Signal, Writes};

/// The FIFO of a sensor: how it is set up, emptied and read, and what its time is.
///
/// A FIFO keeps every sample together with the sensor's own time, so that the number of lost samples follows
/// from the times of two neighbours. [`FifoImu`](super::FifoImu) reads it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fifo {
    /// The writes that set the FIFO up. They are sent before the last of the start-up writes.
    pub set_up: Writes<16>,
    /// The writes after the last of the start-up writes.
    pub turn_on: Writes<2>,
    /// The writes that empty the FIFO while it runs. Of their fields, only the registers and values are used.
    pub flush: Writes<2>,
    /// The register of the number of samples, and of the flags before it if the format has them.
    pub count: u8,
    /// The register through which the content is read.
    pub data: u8,
    /// What count and content look like.
    pub format: Format,
    /// The number of samples that the FIFO holds.
    pub capacity: u16,
    /// The number of bits of the sensor's time.
    pub time_bits: u8,
    /// The nominal duration of a tick of the sensor's time, in ps.
    pub tick_ps: u32,
    /// The nominal sample interval, in 1/256 ticks. Where rate and time come from one oscillator, the true
    /// interval has the same number of ticks, however wrong the oscillator is.
    pub interval: u32,
    /// How the interrupt pin announces that the FIFO has reached its watermark.
    pub signal: Signal,
}

/// The format of a FIFO's content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Format {
    /// Packets of 16 bytes with header, accelerometer, gyro, temperature and time, big endian; before the count
    /// of bytes, a status whose bit 1 says that the FIFO is full. So does the ICM-42688-P (data sheet
    /// DS-000347, section 6.1, "Packet 3").
    Icm426xx,
    /// The same packets in little endian; a count of packets. An erratum of the ICM-45686 (AN-000364, as quoted by
    /// TDK's driver and Zephyr's) demands that the count is read twice, and that the newest packet is left.
    Icm456xx,
    /// Words of 7 bytes, each with a tag of sensor, time slot and parity; a count of words with flags. So
    /// does the LSM6DSO (data sheet DS12140, section 6.5.7).
    Lsm6dso,
    /// The same words without parity. So does the LSM6DSV16X.
    Lsm6dsv,
    /// Packets of a sensor of your own.
    Packets(PacketFormat),
}

/// The bytes of an [`Icm426xx`](Format::Icm426xx) packet.
const PACKET: usize = 16;

/// The bytes of a tagged word.
const WORD: usize = 7;

/// What the registers of the count say.
pub(super) struct Level {
    /// The number of units that may be read.
    pub(super) units: usize,
    /// The number of samples in the FIFO, those that may not be read included.
    pub(super) samples: usize,
    /// Whether samples were lost, or will be.
    pub(super) full: bool,
}

impl Format {
    /// Whether there can be such a format.
    pub(super) const fn is_possible(&self) -> bool {
        match self {
            Self::Packets(own) => own.is_possible(),
            _ => true,
        }
    }

    /// The number of bytes that are read at once at least.
    pub(super) const fn unit(self) -> usize {
        match self {
            Self::Icm426xx | Self::Icm456xx => PACKET,
            Self::Lsm6dso | Self::Lsm6dsv => WORD,
            // A length of zero would never come to the end of a burst.
            Self::Packets(PacketFormat {
                packet_bytes: 0, ..
            }) => 1,
            Self::Packets(own) => own.packet_bytes as usize,
        }
    }

    /// The number of units of a sample.
    const fn units_per_sample(self) -> usize {
        match self {
            Self::Icm426xx | Self::Icm456xx | Self::Packets(_) => 1,
            // The gyro and the time.
            Self::Lsm6dso | Self::Lsm6dsv => 2,
        }
    }

    /// The number of bytes of count and flags.
    pub(super) const fn head(self) -> usize {
        match self {
            Self::Icm426xx => 3,
            Self::Packets(own) => own.count_bytes as usize,
            _ => 2,
        }
    }

    /// How often count and flags are read.
    pub(super) const fn count_reads(self) -> u8 {
        match self {
            Self::Icm456xx => 2,
            _ => 1,
        }
    }

    /// Whether a full FIFO is emptied instead of read, because a packet may be replaced while it is read.
    pub(super) const fn is_flushed_when_full(self) -> bool {
        match self {
            Self::Icm426xx | Self::Icm456xx => true,
            Self::Lsm6dso | Self::Lsm6dsv => false,
            Self::Packets(own) => own.is_flushed_when_full,
        }
    }

    /// What count and flags say.
    pub(super) fn level(self, [a, b, c]: [u8; 3], capacity: u16) -> Level {
        let (units, full) = match self {
            Self::Icm426xx => (
                usize::from(u16::from_be_bytes([b, c])) / PACKET,
                a & 0x02 != 0,
            ),
            Self::Icm456xx => (usize::from(u16::from_le_bytes([a, b])), false),
            // Bit 6 tells of an overrun now, and bit 3 of one since the flags were last read.
            Self::Lsm6dso => (
                usize::from(u16::from_le_bytes([a, b & 0x03])),
                b & 0x48 != 0,
            ),
            Self::Lsm6dsv => (
                usize::from(u16::from_le_bytes([a, b & 0x01])),
                b & 0x48 != 0,
            ),
            Self::Packets(own) => {
                let PacketCount { packets, is_full } = own.packets.count([a, b, c]);
                (packets, is_full)
            }
        };
        let samples = units / self.units_per_sample();
        Level {
            units: match self {
                Self::Icm456xx => units.saturating_sub(1),
                _ => units,
            },
            samples,
            full: full || samples >= usize::from(capacity),
        }
    }

    /// The number of samples in `units` units.
    pub(super) const fn samples(self, units: usize) -> usize {
        units / self.units_per_sample()
    }
}
