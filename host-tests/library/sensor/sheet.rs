//! The contents of data sheets, stated independently as transfers on mocked buses.

use allanite::sensor::{
    BMI160,
    Bus::{self, Any, I2c, Spi},
    Description, I2cBus, ICM_20602, ICM_20948, ICM_42688_P, ICM_45686, Imu, L3GD20, LSM6DSO,
    LSM6DSR, LSM6DSV16X, LSM9DS1, Loss, MPU_6050, MPU_6500, Reading,
};
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::i2c::{Mock as I2cMock, Transaction as I2cTurn};
use embedded_hal_mock::eh1::spi::Transaction as SpiTurn;

/// The contents of a data sheet, stated independently of the library.
pub(crate) struct Sheet {
    pub(crate) description: &'static Description,
    /// The I²C address, and the bits that mark a read over SPI and over I²C.
    pub(crate) bus: (u8, u8, u8),
    /// The identity register and its value.
    pub(crate) identity: (u8, u8),
    /// The register, the value, and the buses over which it is written.
    pub(crate) writes: &'static [(u8, u8, Bus)],
    /// Registers that are read before the write of this index, and what they hold.
    pub(crate) reads: &'static [(usize, u8, u8)],
    pub(crate) status: u8,
    /// The first register and the number of bytes that are read at once, and the offsets of gyro
    /// and temperature in them.
    pub(crate) block: (u8, usize, usize, Option<usize>),
    pub(crate) big_endian: bool,
    pub(crate) ready: u8,
}

const MPU_WRITES: &[(u8, u8, Bus)] = &[
    (0x6B, 0x80, Any),
    (0x68, 0x07, Spi),
    (0x6A, 0x10, Spi),
    (0x6B, 0x01, Any),
    (0x1A, 0x04, Any),
    (0x19, 0x04, Any),
    (0x1B, 0x00, Any),
    (0x37, 0x10, Any),
    (0x38, 0x01, Any),
];

const LSM6DSO_WRITES: &[(u8, u8, Bus)] = &[
    (0x12, 0x01, Any),
    (0x18, 0xE2, Any),
    (0x13, 0x04, Spi),
    (0x12, 0x44, Any),
    (0x0D, 0x02, Any),
    (0x11, 0x40, Any),
];

pub(crate) const SHEETS: [Sheet; 12] = [
    Sheet {
        description: &BMI160,
        bus: (0x68, 0x80, 0),
        identity: (0x00, 0xD1),
        writes: &[(0x7E, 0x15, Any), (0x43, 0x03, Any), (0x42, 0x09, Any)],
        reads: &[],
        status: 0x1B,
        block: (0x0C, 22, 0, Some(20)),
        big_endian: false,
        ready: 0x40,
    },
    Sheet {
        description: &ICM_20602,
        bus: (0x68, 0x80, 0),
        identity: (0x75, 0x12),
        writes: &[
            (0x6B, 0x80, Any),
            (0x70, 0x40, Spi),
            (0x6B, 0x01, Any),
            (0x1A, 0x04, Any),
            (0x19, 0x04, Any),
            (0x1B, 0x00, Any),
            (0x37, 0x10, Any),
            (0x38, 0x01, Any),
        ],
        reads: &[],
        status: 0x3A,
        block: (0x41, 8, 2, Some(0)),
        big_endian: true,
        ready: 0x01,
    },
    Sheet {
        description: &ICM_20948,
        bus: (0x68, 0x80, 0),
        identity: (0x00, 0xEA),
        writes: &[
            (0x06, 0x80, Any),
            (0x03, 0x10, Spi),
            (0x06, 0x01, Any),
            (0x7F, 0x20, Any),
            (0x00, 0x04, Any),
            (0x01, 0x21, Any),
            (0x7F, 0x00, Any),
            (0x0F, 0x10, Any),
            (0x11, 0x01, Any),
        ],
        reads: &[],
        status: 0x1A,
        block: (0x33, 8, 0, Some(6)),
        big_endian: true,
        ready: 0x01,
    },
    Sheet {
        description: &ICM_42688_P,
        bus: (0x68, 0x80, 0),
        identity: (0x75, 0x47),
        writes: &[
            (0x11, 0x01, Any),
            (0x4C, 0x33, Spi),
            (0x13, 0x09, I2c),
            (0x76, 0x01, I2c),
            (0x7C, 0x5C, I2c),
            (0x76, 0x00, I2c),
            (0x4D, 0x51, Any),
            (0x4F, 0x68, Any),
            (0x51, 0x1A, Any),
            (0x52, 0x13, Any),
            (0x62, 0x00, Any),
            (0x64, 0x00, Any),
            (0x65, 0x08, Any),
            (0x4E, 0x0C, Any),
        ],
        reads: &[],
        status: 0x2D,
        block: (0x1D, 14, 8, Some(0)),
        big_endian: true,
        ready: 0x08,
    },
    Sheet {
        description: &ICM_45686,
        bus: (0x68, 0x80, 0),
        identity: (0x72, 0xE9),
        writes: &[
            (0x7F, 0x02, Any),
            (0x18, 0x01, Any),
            (0x16, 0x04, Any),
            // Two indirect registers, whose other bits stay.
            (0x7C, 0xA4, Any),
            (0x7D, 0xA6, Any),
            (0x7C, 0xA4, Any),
            (0x7D, 0xA6, Any),
            (0x7E, 0xD9, Any),
            (0x7C, 0xA4, Any),
            (0x7D, 0xAC, Any),
            (0x7C, 0xA4, Any),
            (0x7D, 0xAC, Any),
            (0x7E, 0x83, Any),
            (0x1C, 0x49, Any),
            (0x10, 0x0C, Any),
        ],
        reads: &[(5, 0x7E, 0xB9), (10, 0x7E, 0x85)],
        status: 0x19,
        block: (0x06, 8, 0, Some(6)),
        big_endian: false,
        ready: 0x04,
    },
    Sheet {
        description: &L3GD20,
        bus: (0x6A, 0xC0, 0x80),
        identity: (0x0F, 0xD4),
        writes: &[
            (0x21, 0x00, Any),
            (0x24, 0x02, Any),
            (0x2E, 0x00, Any),
            (0x23, 0x80, Any),
            (0x20, 0x1F, Any),
        ],
        reads: &[],
        status: 0x27,
        block: (0x28, 6, 0, None),
        big_endian: false,
        ready: 0x08,
    },
    Sheet {
        description: &LSM6DSO,
        bus: (0x6A, 0x80, 0),
        identity: (0x0F, 0x6C),
        writes: LSM6DSO_WRITES,
        reads: &[],
        status: 0x1E,
        block: (0x20, 8, 2, Some(0)),
        big_endian: false,
        ready: 0x02,
    },
    Sheet {
        description: &LSM6DSR,
        bus: (0x6A, 0x80, 0),
        identity: (0x0F, 0x6B),
        writes: LSM6DSO_WRITES,
        reads: &[],
        status: 0x1E,
        block: (0x20, 8, 2, Some(0)),
        big_endian: false,
        ready: 0x02,
    },
    Sheet {
        description: &LSM6DSV16X,
        bus: (0x6A, 0x80, 0),
        identity: (0x0F, 0x70),
        writes: &[
            (0x12, 0x01, Any),
            (0x03, 0x01, Spi),
            (0x12, 0x44, Any),
            (0x15, 0x01, Any),
            (0x0D, 0x02, Any),
            (0x11, 0x06, Any),
        ],
        reads: &[],
        status: 0x1E,
        block: (0x20, 8, 2, Some(0)),
        big_endian: false,
        ready: 0x02,
    },
    Sheet {
        description: &LSM9DS1,
        bus: (0x6A, 0x80, 0),
        identity: (0x0F, 0x68),
        writes: &[
            (0x22, 0x05, Any),
            (0x23, 0x04, Spi),
            (0x22, 0x44, Any),
            (0x11, 0x02, Any),
            (0x12, 0x00, Any),
            (0x0C, 0x02, Any),
            (0x10, 0x61, Any),
        ],
        reads: &[],
        status: 0x17,
        block: (0x15, 9, 3, Some(0)),
        big_endian: false,
        ready: 0x02,
    },
    Sheet {
        description: &MPU_6050,
        bus: (0x68, 0x80, 0),
        identity: (0x75, 0x68),
        writes: MPU_WRITES,
        reads: &[],
        status: 0x3A,
        block: (0x41, 8, 2, Some(0)),
        big_endian: true,
        ready: 0x01,
    },
    Sheet {
        description: &MPU_6500,
        bus: (0x68, 0x80, 0),
        identity: (0x75, 0x70),
        writes: MPU_WRITES,
        reads: &[],
        status: 0x3A,
        block: (0x41, 8, 2, Some(0)),
        big_endian: true,
        ready: 0x01,
    },
];

/// The temperature of every sample here, in counts.
const TEMPERATURE: i16 = -258;

impl Sheet {
    pub(crate) fn of(description: &Description) -> &'static Self {
        SHEETS
            .iter()
            .find(|sheet| sheet.description.name == description.name)
            .unwrap()
    }

    pub(crate) fn block(&self, gyro: [i16; 3]) -> Vec<u8> {
        let (_, length, gyro_at, temperature_at) = self.block;
        // The bytes between are nonsense, so that taking them for counts would be noticed.
        let mut block = vec![0xA5; length];
        let mut put = |at: usize, count: i16| {
            let bytes = match self.big_endian {
                true => count.to_be_bytes(),
                false => count.to_le_bytes(),
            };
            block[at..at + 2].copy_from_slice(&bytes);
        };
        for (k, count) in gyro.into_iter().enumerate() {
            put(gyro_at + 2 * k, count);
        }
        if let Some(at) = temperature_at {
            put(at, TEMPERATURE);
        }
        block
    }

    pub(crate) fn i2c_read(&self, register: u8, answer: Vec<u8>) -> I2cTurn {
        let (address, _, read) = self.bus;
        I2cTurn::write_read(address, vec![register | read], answer)
    }

    pub(crate) fn i2c_sample(&self, flags: u8, gyro: [i16; 3]) -> [I2cTurn; 2] {
        [
            self.i2c_read(self.status, vec![flags]),
            self.i2c_read(self.block.0, self.block(gyro)),
        ]
    }

    pub(crate) fn i2c_start(&self) -> Vec<I2cTurn> {
        let mut turns = vec![self.i2c_read(self.identity.0, vec![self.identity.1])];
        for (index, &(register, value, bus)) in self.writes.iter().enumerate() {
            for &(_, register, value) in self.reads.iter().filter(|read| read.0 == index) {
                turns.push(self.i2c_read(register, vec![value]));
            }
            if bus != Spi {
                turns.push(I2cTurn::write(self.bus.0, vec![register, value]));
            }
        }
        turns.extend(self.i2c_sample(0, [1, 1, 1]));
        turns
    }

    pub(crate) fn spi_read(&self, register: u8, answer: Vec<u8>) -> [SpiTurn<u8>; 4] {
        [
            SpiTurn::transaction_start(),
            SpiTurn::write_vec(vec![register | self.bus.1]),
            SpiTurn::read_vec(answer),
            SpiTurn::transaction_end(),
        ]
    }

    pub(crate) fn spi_sample(&self, flags: u8, gyro: [i16; 3]) -> Vec<SpiTurn<u8>> {
        let mut turns = self.spi_read(self.status, vec![flags]).to_vec();
        turns.extend(self.spi_read(self.block.0, self.block(gyro)));
        turns
    }

    pub(crate) fn spi_start(&self) -> Vec<SpiTurn<u8>> {
        let mut turns = Vec::new();
        if self.description.name == "BMI160" {
            turns.extend(self.spi_read(0x7F, vec![0]));
        }
        turns.extend(self.spi_read(self.identity.0, vec![self.identity.1]));
        for (index, &(register, value, bus)) in self.writes.iter().enumerate() {
            for &(_, register, value) in self.reads.iter().filter(|read| read.0 == index) {
                turns.extend(self.spi_read(register, vec![value]));
            }
            if bus == I2c {
                continue;
            }
            turns.extend([
                SpiTurn::transaction_start(),
                SpiTurn::write_vec(vec![register, value]),
                SpiTurn::transaction_end(),
            ]);
        }
        turns.extend(self.spi_sample(0, [1, 1, 1]));
        turns
    }

    pub(crate) fn reading(&self, gyro: [i16; 3], overrun: bool) -> Reading {
        Reading {
            gyro: gyro.map(i32::from),
            temperature: self.block.3.map(|_| TEMPERATURE),
            loss: if overrun {
                Loss::Unknown
            } else {
                Loss::Nothing
            },
            ticks: None,
        }
    }
}

/// Starts a sensor over I²C and then expects `turns`.
pub(crate) fn start(
    sheet: &Sheet,
    turns: impl IntoIterator<Item = I2cTurn>,
) -> (Imu<I2cBus<I2cMock>>, I2cMock) {
    let mut all = sheet.i2c_start();
    all.extend(turns);
    let mock = I2cMock::new(&all);
    let imu = Imu::start(I2cBus::new(mock.clone()), sheet.description, &mut NoopDelay).unwrap();
    (imu, mock)
}
