use super::{Clock, Description, Fifo, Format, Loss, Malformed, Reading, stamps::Stamps};

/// The tags of the words that are asked for, and that of a note about a changed configuration, which is left out.
const TAG_GYRO: u8 = 0x01;
const TAG_TEMPERATURE: u8 = 0x03;
const TAG_TIME: u8 = 0x04;
const TAG_CONFIGURATION: u8 = 0x05;

/// The header of a packet with accelerometer, gyro and time, apart from two bits.
const PACKET_HEADER: u8 = 0x68;
/// The bits of a packet's header that say that a rate differs from that of the packet before.
const RATE_CHANGED: u8 = 0x03;

/// A packet's temperature is one of 8 bits, and its steps are this many of those of the temperature registers.
const TEMPERATURE_STEPS: i16 = 64;

/// Turns the content of a FIFO into readings. It keeps what belongs together over the ends of bursts.
#[derive(Clone, Debug)]
pub(super) struct Decoder {
    pub(super) fifo: &'static Fifo,
    pub(super) stamps: Stamps,
    pub(super) clock: Clock,
    /// The FIFO has to be emptied, because it is not known where a unit begins.
    pub(super) must_flush: bool,
    /// The count was asked for, and did not arrive.
    pub(super) is_count_lost: bool,
    temperature: Option<i16>,
    slot: Slot,
}

/// The words of a time slot.
#[derive(Clone, Debug, Default)]
struct Slot {
    number: u8,
    gyro: Option<[i16; 3]>,
    time: Option<u32>,
}

/// What makes a reading.
struct Parts {
    gyro: [i32; 3],
    time: u32,
    rate_changed: bool,
}

impl Decoder {
    pub(super) fn new(description: &Description, fifo: &'static Fifo) -> Self {
        Self {
            fifo,
            stamps: Stamps::new(fifo),
            clock: Clock::new(description, fifo.tick_ps),
            must_flush: false,
            is_count_lost: false,
            temperature: None,
            slot: Slot::default(),
        }
    }

    /// Forgets the words of an incomplete time slot.
    pub(super) fn forget_slot(&mut self) {
        self.slot = Slot::default();
    }

    /// Decodes the next unit. It returns the reading that it completes.
    pub(super) fn decode(&mut self, unit: &[u8]) -> Result<Option<Reading>, Malformed> {
        let parts = match self.fifo.format {
            Format::Icm426xx => self.packet(unit, i16::from_be_bytes)?,
            Format::Icm456xx => self.packet(unit, i16::from_le_bytes)?,
            Format::Lsm6dso => self.word(unit, true)?,
            Format::Lsm6dsv => self.word(unit, false)?,
            Format::Packets(own) => own.packets.decode(unit)?.map(|packet| {
                self.temperature = packet.temperature.or(self.temperature);
                Parts {
                    gyro: packet.gyro,
                    time: packet.time,
                    rate_changed: packet.is_rate_changed,
                }
            }),
        };
        let Some(parts) = parts else {
            return Ok(None);
        };
        let found = parts.time;
        let (ticks, loss) = self.stamps.take(found).ok_or(Malformed::Time { found })?;
        Ok(Some(Reading {
            gyro: parts.gyro,
            temperature: self.temperature,
            loss: if parts.rate_changed {
                Loss::Unknown
            } else {
                loss
            },
            ticks: Some(ticks),
        }))
    }

    fn packet(
        &mut self,
        unit: &[u8],
        number: fn([u8; 2]) -> i16,
    ) -> Result<Option<Parts>, Malformed> {
        let &[
            header,
            _,
            _,
            _,
            _,
            _,
            _,
            x0,
            x1,
            y0,
            y1,
            z0,
            z1,
            temperature,
            t0,
            t1,
        ] = unit
        else {
            return Err(Malformed::Header { found: 0 });
        };
        if header & !RATE_CHANGED != PACKET_HEADER {
            return Err(Malformed::Header { found: header });
        }
        let gyro = [number([x0, x1]), number([y0, y1]), number([z0, z1])];
        let temperature = i16::from(temperature.cast_signed());
        if temperature != i16::from(i8::MIN) {
            self.temperature = Some(temperature * TEMPERATURE_STEPS);
        }
        // The mark of a packet without a sample. The time of the next one tells that one is missing.
        if gyro == [i16::MIN; 3] {
            return Ok(None);
        }
        Ok(Some(Parts {
            gyro: gyro.map(i32::from),
            time: u32::from(number([t0, t1]).cast_unsigned()),
            rate_changed: header & RATE_CHANGED != 0,
        }))
    }

    fn word(&mut self, unit: &[u8], has_parity: bool) -> Result<Option<Parts>, Malformed> {
        let &[found, a, b, c, d, e, f] = unit else {
            return Err(Malformed::Header { found: 0 });
        };
        if has_parity && found.count_ones() % 2 != 0 {
            return Err(Malformed::Parity { found });
        }
        let number = found >> 1 & 0x03;
        if number != self.slot.number {
            self.slot = Slot {
                number,
                ..Slot::default()
            };
        }
        let slot = &mut self.slot;
        match found >> 3 {
            TAG_GYRO => slot.gyro = Some([[a, b], [c, d], [e, f]].map(i16::from_le_bytes)),
            TAG_TIME => slot.time = Some(u32::from_le_bytes([a, b, c, d])),
            TAG_TEMPERATURE => self.temperature = Some(i16::from_le_bytes([a, b])),
            TAG_CONFIGURATION => {}
            _ => return Err(Malformed::Header { found }),
        }
        let (Some(gyro), Some(time)) = (slot.gyro, slot.time) else {
            return Ok(None);
        };
        (slot.gyro, slot.time) = (None, None);
        Ok(Some(Parts {
            gyro: gyro.map(i32::from),
            time,
            rate_changed: false,
        }))
    }
}
