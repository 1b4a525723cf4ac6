//! Conversations with the FIFO of each sensor, byte by byte as the data sheet has them, replayed over mocked buses.

use super::sheet::Sheet;
use super::wire::NoDelay;
use allanite::sensor::{
    Description, FifoImu, I2cBus, ICM_42688_P, ICM_45686, LSM6DSO, LSM6DSV16X, Loss, Malformed,
    Reading, SpiBus,
};
use embedded_hal::i2c::ErrorKind;
use embedded_hal_mock::eh1::i2c::{Mock as I2cMock, Transaction as I2cTurn};
use embedded_hal_mock::eh1::spi::{Mock as SpiMock, Transaction as SpiTurn};

/// A transfer of a log.
#[derive(Clone, Copy)]
enum Turn {
    Write(u8, u8),
    Read(u8, &'static [u8]),
}
use Turn::{Read, Write};

struct Log {
    description: &'static Description,
    /// The transfers of the start between the start-up writes but the last one and that one.
    set_up: &'static [Turn],
    /// The transfers after the last start-up write.
    turn_on: &'static [Turn],
    bursts: &'static [Burst],
}

/// The host's time, the transfers, and the readings.
type Burst = (u32, &'static [Turn], &'static [Result<Reading, Malformed>]);

const fn reading(
    gyro: [i32; 3],
    temperature: Option<i16>,
    loss: Loss,
    ticks: u64,
) -> Result<Reading, Malformed> {
    Ok(Reading {
        gyro,
        temperature,
        loss,
        ticks: Some(ticks),
    })
}

const LOGS: [Log; 4] = [
    Log {
        description: &ICM_42688_P,
        set_up: &[
            Write(0x54, 0x29),
            Write(0x5F, 0x27),
            // 8 packets of 16 bytes.
            Write(0x60, 128),
            Write(0x61, 0),
            Write(0x50, 0x08),
            Write(0x65, 0x04),
            Write(0x16, 0x40),
        ],
        turn_on: &[Write(0x4E, 0x0F), Write(0x4B, 0x02)],
        bursts: &[
            // Nothing yet.
            (1_000, &[Read(0x2D, &[0x00, 0, 0])], &[]),
            (
                11_000,
                &[
                    Read(0x2D, &[0x04, 0, 32]),
                    Read(
                        0x30,
                        &[
                            0x68, 0, 1, 0, 2, 8, 0, 0xFF, 0xFE, 0x12, 0x34, 0x80, 0x00, 0x02, 0xFE,
                            0x00, //
                            0x68, 0, 1, 0, 2, 8, 0, 0x00, 0x05, 0xFF, 0xFF, 0x00, 0x00, 0xFE, 0x00,
                            0x4A,
                        ],
                    ),
                ],
                &[
                    reading([-2, 0x1234, -32768], Some(128), Loss::Nothing, 65024),
                    // The 16 bits have wrapped: 586 ticks later.
                    reading([5, -1, 0], Some(-128), Loss::Nothing, 65610),
                ],
            ),
            // The FIFO is full, so that it is emptied.
            (
                1_400_000,
                &[Read(0x2D, &[0x02, 0x08, 0x00]), Write(0x4B, 0x02)],
                &[],
            ),
            // 141 intervals of 585.94 ticks after the last one: 82 617, which is 17 081 beyond one round.
            (
                1_421_000,
                &[
                    Read(0x2D, &[0x00, 0, 16]),
                    Read(
                        0x30,
                        &[0x68, 0, 1, 0, 2, 8, 0, 0, 1, 0, 2, 0, 3, 0x80, 0x43, 0x03],
                    ),
                ],
                &[reading([1, 2, 3], Some(-128), Loss::Samples(140), 148_227)],
            ),
            // Extended data that were not asked for.
            (
                1_431_000,
                &[
                    Read(0x2D, &[0x00, 0, 16]),
                    Read(
                        0x30,
                        &[0x78, 0, 1, 0, 2, 8, 0, 0, 1, 0, 2, 0, 3, 0, 0x45, 0x4D],
                    ),
                ],
                &[Err(Malformed::Header { found: 0x78 })],
            ),
            (1_441_000, &[Write(0x4B, 0x02)], &[]),
        ],
    },
    Log {
        description: &ICM_45686,
        set_up: &[
            Write(0x1D, 0x07),
            Write(0x1E, 9),
            Write(0x1F, 0),
            Write(0x20, 0x08),
            Write(0x22, 0x02),
            Read(0x23, &[0x40 | 0x0F]),
            Write(0x23, 0x20 | 0x0F),
            Write(0x7C, 0xA2),
            Write(0x7D, 0x58),
            Read(0x7E, &[0x60]),
            Write(0x7C, 0xA2),
            Write(0x7D, 0x58),
            Write(0x7E, 0x61),
            Write(0x1B, 0x19),
            Write(0x16, 0x02),
            Write(0x21, 0x06),
            Write(0x1D, 0x47),
            Write(0x21, 0x07),
        ],
        turn_on: &[Write(0x10, 0x0F), Write(0x20, 0x88)],
        bursts: &[
            (
                0,
                &[
                    // The second count holds, and the newest packet stays.
                    Read(0x12, &[0, 0]),
                    Read(0x12, &[2, 0]),
                    Read(
                        0x14,
                        &[
                            0x6B, 0, 1, 0, 2, 8, 0, 0xFE, 0xFF, 0x34, 0x12, 0x00, 0x80, 0x0A, 0x10,
                            0x00,
                        ],
                    ),
                ],
                // The rates differ from those of the packet before.
                &[reading([-2, 0x1234, -32768], Some(640), Loss::Unknown, 16)],
            ),
            (
                10_000,
                &[
                    Read(0x12, &[2, 0]),
                    Read(0x12, &[2, 0]),
                    // A packet without a sample.
                    Read(
                        0x14,
                        &[
                            0x68, 0, 1, 0, 2, 8, 0, 0x00, 0x80, 0x00, 0x80, 0x00, 0x80, 0x80, 0x5A,
                            0x02,
                        ],
                    ),
                ],
                &[],
            ),
            (
                20_000,
                &[
                    Read(0x12, &[2, 0]),
                    Read(0x12, &[2, 0]),
                    Read(
                        0x14,
                        &[0x68, 0, 1, 0, 2, 8, 0, 1, 0, 2, 0, 3, 0, 0x0A, 0xA4, 0x04],
                    ),
                ],
                // 16 + 1172 ticks.
                &[reading([1, 2, 3], Some(640), Loss::Samples(1), 1188)],
            ),
        ],
    },
    Log {
        description: &LSM6DSO,
        set_up: &[
            Write(0x19, 0x20),
            Write(0x07, 16),
            Write(0x08, 0),
            Write(0x09, 0x40),
            Write(0x0D, 0x08),
        ],
        turn_on: &[Write(0x0A, 0x60), Write(0x0A, 0x66)],
        bursts: &[
            (
                0,
                &[
                    Read(0x3A, &[5, 0x00]),
                    Read(
                        0x78,
                        &[
                            // Time slot 1: gyro, time, temperature; slot 2: gyro and time.
                            0x0A, 0xFE, 0xFF, 0x34, 0x12, 0x00, 0x80, //
                            0x22, 0x00, 0xFF, 0xFF, 0xFF, 0x00, 0x00, //
                            0x1B, 0x00, 0xFB, 0x00, 0x00, 0x00, 0x00, //
                            0x0C, 0x01, 0x00, 0x02, 0x00, 0x03, 0x00, //
                            0x24, 0x80, 0x00, 0x00, 0x00, 0x00, 0x00, //
                        ],
                    ),
                ],
                &[
                    reading([-2, 0x1234, -32768], None, Loss::Nothing, 0xFFFF_FF00),
                    // 384 ticks later, beyond 32 bits.
                    reading([1, 2, 3], Some(-1280), Loss::Nothing, 0x1_0000_0080),
                ],
            ),
            // Words of the slot before were overwritten. The time without its gyro is left out.
            (
                48_000,
                &[
                    Read(0x3A, &[3, 0x08]),
                    Read(
                        0x78,
                        &[
                            0x22, 0x80, 0x06, 0x00, 0x00, 0x00, 0x00, //
                            0x0C, 0x04, 0x00, 0x05, 0x00, 0x06, 0x00, //
                            0x24, 0x00, 0x08, 0x00, 0x00, 0x00, 0x00, //
                        ],
                    ),
                ],
                &[reading(
                    [4, 5, 6],
                    Some(-1280),
                    Loss::Samples(4),
                    0x1_0000_0800,
                )],
            ),
            // A tag of wrong parity.
            (
                58_000,
                &[
                    Read(0x3A, &[1, 0x00]),
                    Read(0x78, &[0x0B, 0x04, 0x00, 0x05, 0x00, 0x06, 0x00]),
                ],
                &[Err(Malformed::Parity { found: 0x0B })],
            ),
            (68_000, &[Write(0x0A, 0x60), Write(0x0A, 0x66)], &[]),
        ],
    },
    Log {
        description: &LSM6DSV16X,
        set_up: &[
            Write(0x50, 0x40),
            Write(0x07, 16),
            Write(0x08, 0),
            Write(0x09, 0x60),
            Write(0x0D, 0x08),
        ],
        turn_on: &[Write(0x0A, 0x60), Write(0x0A, 0x66)],
        bursts: &[
            // The burst ends within a time slot, which the next one completes.
            (
                0,
                &[
                    Read(0x1B, &[3, 0x00]),
                    Read(
                        0x78,
                        &[
                            0x22, 0x10, 0x00, 0x00, 0x00, 0x00, 0x00, //
                            0x0A, 0xFE, 0xFF, 0x34, 0x12, 0x00, 0x80, //
                            0x24, 0x90, 0x01, 0x00, 0x00, 0x00, 0x00, //
                        ],
                    ),
                ],
                &[reading([-2, 0x1234, -32768], None, Loss::Nothing, 0x10)],
            ),
            (
                8_333,
                &[
                    Read(0x1B, &[1, 0x00]),
                    Read(0x78, &[0x0C, 0x01, 0x00, 0x02, 0x00, 0x03, 0x00]),
                ],
                &[reading([1, 2, 3], None, Loss::Nothing, 0x190)],
            ),
            // A word of the accelerometer, which was not asked for.
            (
                16_667,
                &[
                    Read(0x1B, &[1, 0x00]),
                    Read(0x78, &[0x16, 0x01, 0x00, 0x02, 0x00, 0x03, 0x00]),
                ],
                &[Err(Malformed::Header { found: 0x16 })],
            ),
            (25_000, &[Write(0x0A, 0x60), Write(0x0A, 0x66)], &[]),
        ],
    },
];

impl Log {
    /// The transfers of the start, over SPI or I²C, without those that wake the sensor.
    fn start(&self, over_spi: bool) -> Vec<Turn> {
        use allanite::sensor::Bus;
        let sheet = Sheet::of(self.description);
        let mut turns = vec![Read(
            sheet.identity.0,
            std::slice::from_ref(&sheet.identity.1),
        )];
        for (index, (register, value, bus)) in sheet.writes.iter().enumerate() {
            for (_, register, value) in sheet.reads.iter().filter(|read| read.0 == index) {
                turns.push(Read(*register, std::slice::from_ref(value)));
            }
            if index + 1 == sheet.writes.len() {
                turns.extend(self.set_up);
            }
            if *bus != if over_spi { Bus::I2c } else { Bus::Spi } {
                turns.push(Write(*register, *value));
            }
        }
        turns.extend(self.turn_on);
        turns
    }

    fn turns(&self, over_spi: bool) -> Vec<Turn> {
        let bursts = self.bursts.iter().flat_map(|(_, turns, _)| turns.iter());
        self.start(over_spi)
            .into_iter()
            .chain(bursts.copied())
            .collect()
    }
}

macro_rules! replay {
    ($log: expr, $bus: expr) => {{
        let mut imu = FifoImu::start($bus, $log.description, &mut NoDelay).unwrap();
        let mut buffer = [0; 64];
        for (now_us, _, expected) in $log.bursts {
            let burst = imu.read(*now_us, &mut buffer).unwrap();
            let readings: Vec<_> = burst.collect();
            assert_eq!(readings, *expected, "{} {now_us}", $log.description.name);
        }
    }};
}

#[test]
fn conversations_are_those_of_the_data_sheets_over_i2c() {
    for log in &LOGS {
        let address = Sheet::of(log.description).bus.0;
        let turns: Vec<_> = log
            .turns(false)
            .into_iter()
            .map(|turn| match turn {
                Write(register, value) => I2cTurn::write(address, vec![register, value]),
                Read(register, bytes) => {
                    I2cTurn::write_read(address, vec![register], bytes.to_vec())
                }
            })
            .collect();
        let mut mock = I2cMock::new(&turns);
        replay!(log, I2cBus::new(mock.clone()));
        mock.done();
    }
}

#[test]
fn conversations_are_those_of_the_data_sheets_over_spi() {
    for log in &LOGS {
        let mut turns = Vec::new();
        for turn in log.turns(true) {
            turns.push(SpiTurn::transaction_start());
            match turn {
                Write(register, value) => turns.push(SpiTurn::write_vec(vec![register, value])),
                Read(register, bytes) => turns.extend([
                    SpiTurn::write_vec(vec![register | 0x80]),
                    SpiTurn::read_vec(bytes.to_vec()),
                ]),
            }
            turns.push(SpiTurn::transaction_end());
        }
        let mut mock = SpiMock::new(&turns);
        replay!(log, SpiBus::new(&mut mock));
        mock.done();
    }
}

/// The gyro of one time slot, and the time of another one with the same number, four slots later. Between them,
/// words were overwritten. The flag of this may be lost with a failed transfer.
#[test]
fn a_time_slot_is_not_completed_by_the_words_of_another_one() {
    const GYRO: &[u8] = &[0x0C, 9, 0, 9, 0, 9, 0];
    const REST: &[u8] = &[
        0x24, 0x80, 0x0C, 0x00, 0x00, 0x00, 0x00, //
        0x0F, 0x01, 0x00, 0x02, 0x00, 0x03, 0x00, //
        0x27, 0x00, 0x0E, 0x00, 0x00, 0x00, 0x00, //
    ];
    let log = &LOGS[2];
    let address = Sheet::of(log.description).bus.0;
    let read =
        |register, bytes: &[u8]| I2cTurn::write_read(address, vec![register], bytes.to_vec());
    for flag_is_lost in [false, true] {
        let mut turns = vec![];
        for turn in log.start(false) {
            turns.push(match turn {
                Write(register, value) => I2cTurn::write(address, vec![register, value]),
                Read(register, bytes) => read(register, bytes),
            });
        }
        turns.extend([read(0x3A, &[1, 0]), read(0x78, GYRO)]);
        if flag_is_lost {
            turns.push(read(0x3A, &[0, 0x08]).with_error(ErrorKind::Bus));
            turns.push(read(0x3A, &[3, 0x00]));
        } else {
            turns.push(read(0x3A, &[3, 0x08]));
        }
        turns.push(read(0x78, REST));
        let mut mock = I2cMock::new(&turns);
        let bus = I2cBus::new(mock.clone());
        let mut imu = FifoImu::start(bus, log.description, &mut NoDelay).unwrap();
        let mut buffer = [0; 64];
        assert_eq!(imu.read(0, &mut buffer).unwrap().count(), 0);
        if flag_is_lost {
            assert!(imu.read(30_000, &mut buffer).is_err());
        }
        let readings: Vec<_> = imu.read(40_000, &mut buffer).unwrap().collect();
        assert_eq!(
            readings,
            [reading([1, 2, 3], None, Loss::Nothing, 0x0E00)],
            "{flag_is_lost}"
        );
        mock.done();
    }
}
