//! Sensors with a FIFO, simulated by their data sheets and independently of the library.

use allanite::sensor::{Description, ICM_42688_P, ICM_45686, LSM6DSO, LSM6DSR, LSM6DSV16X};
use std::collections::VecDeque;

/// A sensor whose FIFO is simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Icm42688P,
    Icm45686,
    Lsm6dso,
    Lsm6dsr,
    Lsm6dsv16x,
}

pub(crate) const KINDS: [Kind; 5] = [
    Kind::Icm42688P,
    Kind::Icm45686,
    Kind::Lsm6dso,
    Kind::Lsm6dsr,
    Kind::Lsm6dsv16x,
];

impl Kind {
    pub(crate) fn description(self) -> &'static Description {
        match self {
            Self::Icm42688P => &ICM_42688_P,
            Self::Icm45686 => &ICM_45686,
            Self::Lsm6dso => &LSM6DSO,
            Self::Lsm6dsr => &LSM6DSR,
            Self::Lsm6dsv16x => &LSM6DSV16X,
        }
    }

    pub(crate) fn is_icm(self) -> bool {
        matches!(self, Self::Icm42688P | Self::Icm45686)
    }

    /// The sample intervals per second of the sensor's own clock, and the sensor's ticks in an interval.
    pub(crate) fn rate_and_ticks(self) -> (f64, f64) {
        match self {
            Self::Icm42688P | Self::Icm45686 => (100.0, 10_000.0 / (16.0 * 32.0 / 30.0)),
            Self::Lsm6dso | Self::Lsm6dsr => (6667.0 / 64.0, 384.0),
            Self::Lsm6dsv16x => (120.0, 384.0),
        }
    }

    /// The number of samples that the FIFO holds.
    pub(crate) fn capacity(self) -> usize {
        match self {
            Self::Icm42688P | Self::Icm45686 | Self::Lsm6dsv16x => 128,
            Self::Lsm6dso | Self::Lsm6dsr => 256,
        }
    }

    fn identity(self) -> (u8, u8) {
        match self {
            Self::Icm42688P => (0x75, 0x47),
            Self::Icm45686 => (0x72, 0xE9),
            Self::Lsm6dso => (0x0F, 0x6C),
            Self::Lsm6dsr => (0x0F, 0x6B),
            Self::Lsm6dsv16x => (0x0F, 0x70),
        }
    }
}

/// The counts of sample `n`. No two of them are the same within 65 536 samples.
pub(crate) fn gyro(n: u64) -> [i32; 3] {
    let noise = n.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 48;
    [
        (n as u16).cast_signed(),
        (noise as u16).cast_signed() / 2,
        -7,
    ]
    .map(i32::from)
}

/// The number of the sample with these counts.
pub(crate) fn number([x, ..]: [i32; 3]) -> u16 {
    (x as i16).cast_unsigned()
}

/// A simulated sensor.
pub(crate) struct Chip {
    pub(crate) kind: Kind,
    registers: [u8; 256],
    /// The registers behind an indirect access.
    pages: Vec<u8>,
    /// Packets of 16 bytes, or words of 7.
    fifo: VecDeque<Vec<u8>>,
    /// The number of samples taken so far.
    pub(crate) taken: u64,
    /// What the last read of the count should have said, for an erratum.
    stale_count: u16,
    full: bool,
    overrun: bool,
    /// Time before the gyro in a slot, not after it.
    pub(crate) time_first: bool,
    /// Every write to a register.
    pub(crate) writes: Vec<(u8, u8)>,
    /// The sensor's ticks in a sample interval.
    pub(crate) ticks: f64,
    /// The shift of the sensor's ticks, so that they wrap early.
    pub(crate) epoch: f64,
}

impl Chip {
    pub(crate) fn new(kind: Kind) -> Self {
        let mut registers = [0; 256];
        let (register, identity) = kind.identity();
        registers[usize::from(register)] = identity;
        Self {
            kind,
            registers,
            pages: vec![0; 1 << 16],
            fifo: VecDeque::new(),
            taken: 0,
            stale_count: 0,
            full: false,
            overrun: false,
            time_first: kind == Kind::Lsm6dsv16x,
            writes: Vec::new(),
            ticks: kind.rate_and_ticks().1,
            epoch: 65_000.0,
        }
    }

    /// Sets a register, as the sensor itself does.
    pub(crate) fn set(&mut self, register: u8, value: u8) {
        self.registers[usize::from(register)] = value;
    }

    fn is_set(&self, register: u8, mask: u8, value: u8) -> bool {
        self.registers[usize::from(register)] & mask == value
    }

    /// Takes samples.
    pub(crate) fn take(&mut self, samples: u64) {
        for _ in 0..samples {
            let n = self.taken;
            self.taken += 1;
            self.store(gyro(n), (n as f64 * self.ticks + self.epoch) as u64);
        }
    }

    fn store(&mut self, gyro: [i32; 3], ticks: u64) {
        let [x, y, z] = gyro.map(|count| count as i16);
        match self.kind {
            Kind::Icm42688P => {
                let on = self.is_set(0x16, 0xC0, 0x40)
                    && self.is_set(0x5F, 0x03, 0x03)
                    && self.is_set(0x4E, 0x0F, 0x0F)
                    && self.is_set(0x54, 0x0D, 0x09)
                    && self.is_set(0x50, 0x0F, self.registers[0x4F] & 0x0F);
                if on {
                    let mut packet = vec![0x68, 1, 2, 3, 4, 5, 6];
                    packet.extend([x, y, z].into_iter().flat_map(i16::to_be_bytes));
                    packet.push(0xF6);
                    packet.extend((ticks as u16).to_be_bytes());
                    self.push(packet, 128);
                }
            }
            Kind::Icm45686 => {
                let on = self.is_set(0x1D, 0xC0, 0x40)
                    && self.is_set(0x21, 0x0F, 0x07)
                    && self.is_set(0x22, 0x06, 0x02)
                    && self.is_set(0x23, 0x60, 0x20)
                    && self.is_set(0x10, 0x0F, 0x0F)
                    && self.is_set(0x1B, 0x0F, self.registers[0x1C] & 0x0F)
                    && self.pages[0xA258] & 1 == 1;
                if on {
                    let mut packet = vec![0x68, 1, 2, 3, 4, 5, 6];
                    packet.extend([x, y, z].into_iter().flat_map(i16::to_le_bytes));
                    packet.push(0xF6);
                    packet.extend((ticks as u16).to_le_bytes());
                    self.push(packet, 128);
                }
            }
            Kind::Lsm6dso | Kind::Lsm6dsr | Kind::Lsm6dsv16x => {
                let time_on = match self.kind {
                    Kind::Lsm6dso | Kind::Lsm6dsr => self.is_set(0x19, 0x20, 0x20),
                    _ => self.is_set(0x50, 0x40, 0x40),
                };
                if !self.is_set(0x0A, 0x07, 0x06) || !time_on || !self.is_set(0x0A, 0xC0, 0x40) {
                    return;
                }
                let word = |kind: Kind, tag: u8, data: [u8; 6]| {
                    let tag = tag << 3 | ((self.taken & 3) as u8) << 1;
                    let parity = match kind {
                        Kind::Lsm6dso | Kind::Lsm6dsr => (tag.count_ones() % 2) as u8,
                        _ => 0,
                    };
                    [[tag | parity].as_slice(), &data].concat()
                };
                let mut counts = [0; 6];
                for (place, count) in counts.chunks_mut(2).zip([x, y, z]) {
                    place.copy_from_slice(&count.to_le_bytes());
                }
                let [a, b, c, d] = (ticks as u32).to_le_bytes();
                let gyro = word(self.kind, 0x01, counts);
                let time = word(self.kind, 0x04, [a, b, c, d, 0, 0]);
                let temperature = word(self.kind, 0x03, [0x80, 0xFD, 0, 0, 0, 0]);
                let [first, second] = match self.time_first {
                    true => [time, gyro],
                    false => [gyro, time],
                };
                let words = 2 * self.kind.capacity();
                self.push(first, words);
                self.push(second, words);
                if self.taken % 8 == 1 {
                    self.push(temperature, words);
                }
            }
        }
    }

    fn push(&mut self, unit: Vec<u8>, most: usize) {
        self.fifo.push_back(unit);
        if self.fifo.len() > most {
            self.fifo.pop_front();
            self.overrun = true;
        }
        self.full |= self.fifo.len() == most;
    }

    /// The indirect address.
    fn indirect(&self) -> usize {
        usize::from(u16::from_be_bytes([
            self.registers[0x7C],
            self.registers[0x7D],
        ]))
    }

    /// The value of the register of indirect values. The address moves on.
    fn move_on(&mut self) -> usize {
        let address = self.indirect();
        let next = (address as u16).wrapping_add(1).to_be_bytes();
        self.registers[0x7C..0x7E].copy_from_slice(&next);
        address
    }

    pub(crate) fn write(&mut self, register: u8, value: u8) {
        self.writes.push((register, value));
        if self.kind == Kind::Icm45686 && register == 0x7E {
            let address = self.move_on();
            self.pages[address] = value;
            return;
        }
        self.registers[usize::from(register)] = value;
        let flushed = match self.kind {
            Kind::Icm42688P => register == 0x4B && value & 0x02 != 0,
            Kind::Icm45686 => register == 0x20 && value & 0x80 != 0,
            Kind::Lsm6dso | Kind::Lsm6dsr | Kind::Lsm6dsv16x => {
                register == 0x0A && value & 0x07 == 0
            }
        };
        if flushed {
            self.fifo.clear();
            (self.full, self.overrun) = (false, false);
        }
    }

    pub(crate) fn read(&mut self, register: u8, bytes: &mut [u8]) {
        let units = self.fifo.len() as u16;
        match (self.kind, register) {
            (Kind::Icm42688P, 0x2D) => {
                let full = u8::from(std::mem::take(&mut self.full)) << 1;
                let status = self.registers[0x2D] | full;
                let [high, low] = (units * 16).to_be_bytes();
                fill(bytes, &[status, high, low]);
            }
            (Kind::Icm45686, 0x12) => {
                let count = std::mem::replace(&mut self.stale_count, units);
                fill(bytes, &count.to_le_bytes());
            }
            (Kind::Lsm6dso | Kind::Lsm6dsr, 0x3A) | (Kind::Lsm6dsv16x, 0x1B) => {
                let [low, high] = units.to_le_bytes();
                let flags = u8::from(std::mem::take(&mut self.overrun)) << 3;
                fill(bytes, &[low, high | flags]);
            }
            (Kind::Icm42688P, 0x30) | (Kind::Icm45686, 0x14) => self.drain(bytes, 16),
            (Kind::Lsm6dso | Kind::Lsm6dsr | Kind::Lsm6dsv16x, 0x78) => self.drain(bytes, 7),
            (Kind::Icm45686, 0x7E) => {
                let address = self.move_on();
                bytes[0] = self.pages[address];
            }
            _ => {
                let from = usize::from(register);
                fill(bytes, &self.registers[from..]);
            }
        }
    }

    fn drain(&mut self, bytes: &mut [u8], unit: usize) {
        for place in bytes.chunks_mut(unit) {
            // An empty FIFO answers with a header that says so.
            let content = self.fifo.pop_front().unwrap_or(vec![0x80; unit]);
            let length = place.len();
            place.copy_from_slice(&content[..length]);
        }
    }
}

fn fill(bytes: &mut [u8], from: &[u8]) {
    for (to, from) in bytes.iter_mut().zip(from) {
        *to = *from;
    }
}
