use super::Malformed;
use core::{fmt, ptr};

/// The FIFO of a sensor of your own: packets of one length, each of which holds a sample of the gyro with the sensor's time.
///
/// ```
/// use allanite::sensor::{Malformed, Packet, PacketCount, PacketFormat, Packets};
///
/// /// Eight bytes: x, y, z, and a time of 16 bits, each with the low byte first; before the count, a byte of flags.
/// struct Mine;
///
/// impl Packets for Mine {
///     fn count(&self, [flags, low, high]: [u8; 3]) -> PacketCount {
///         let packets = u16::from_le_bytes([low, high]).into();
///         PacketCount { packets, is_full: flags & 0x80 != 0 }
///     }
///
///     fn decode(&self, packet: &[u8]) -> Result<Option<Packet>, Malformed> {
///         let &[x0, x1, y0, y1, z0, z1, t0, t1] = packet else {
///             return Err(Malformed::Header { found: 0 });
///         };
///         let axis = |bytes| i16::from_le_bytes(bytes).into();
///         Ok(Some(Packet {
///             gyro: [axis([x0, x1]), axis([y0, y1]), axis([z0, z1])],
///             time: u16::from_le_bytes([t0, t1]).into(),
///             temperature: None,
///             is_rate_changed: false,
///         }))
///     }
/// }
///
/// const FORMAT: PacketFormat = PacketFormat {
///     packet_bytes: 8,
///     count_bytes: 3,
///     is_flushed_when_full: false,
///     packets: &Mine,
/// };
/// # let _ = FORMAT;
/// ```
pub trait Packets: Sync {
    /// What the bytes of the count say. Those that are not read are zero.
    fn count(&self, bytes: [u8; 3]) -> PacketCount;

    /// The sample in a packet; `None` if it holds none.
    ///
    /// # Errors
    /// [`Malformed`] if it makes no sense. The rest of the FIFO is then left out, and what was lost follows from the time of
    /// the next sample.
    fn decode(&self, packet: &[u8]) -> Result<Option<Packet>, Malformed>;
}

/// What a sensor says of its FIFO.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PacketCount {
    /// The number of packets that may be read.
    pub packets: usize,
    /// Whether samples were lost, or will be, because the FIFO is full.
    pub is_full: bool,
}

/// A sample with its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Packet {
    /// The counts of the three axes.
    pub gyro: [i32; 3],
    /// The sensor's time, in ticks of [`Fifo::tick_ps`](super::Fifo::tick_ps), of [`Fifo::time_bits`](super::Fifo::time_bits)
    /// bits.
    pub time: u32,
    /// The counts of the temperature, in steps of the sensor's [`Temperature`](super::Temperature), if there is a new one.
    pub temperature: Option<i16>,
    /// Whether the rate differs from that of the sample before, so that the number of lost samples is not known.
    pub is_rate_changed: bool,
}

/// How the packets of a FIFO are read.
#[derive(Clone, Copy)]
pub struct PacketFormat {
    /// The bytes of a packet; at least 1.
    pub packet_bytes: u8,
    /// The bytes of count and flags, which are read from [`Fifo::count`](super::Fifo::count): 1 to 3.
    pub count_bytes: u8,
    /// Whether a full FIFO is emptied instead of read, because a packet may be replaced while it is read.
    pub is_flushed_when_full: bool,
    /// What the bytes mean.
    pub packets: &'static dyn Packets,
}

impl PacketFormat {
    pub(super) const fn is_possible(&self) -> bool {
        self.packet_bytes > 0 && matches!(self.count_bytes, 1..=3)
    }
}

/// Equal if the same value decodes the packets.
impl PartialEq for PacketFormat {
    fn eq(&self, other: &Self) -> bool {
        self.packet_bytes == other.packet_bytes
            && self.count_bytes == other.count_bytes
            && self.is_flushed_when_full == other.is_flushed_when_full
            && ptr::addr_eq(self.packets, other.packets)
    }
}

impl Eq for PacketFormat {}

impl fmt::Debug for PacketFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PacketFormat")
            .field("packet_bytes", &self.packet_bytes)
            .field("count_bytes", &self.count_bytes)
            .field("is_flushed_when_full", &self.is_flushed_when_full)
            .finish_non_exhaustive()
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for PacketFormat {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "packets of {=u8} bytes", self.packet_bytes);
    }
}
