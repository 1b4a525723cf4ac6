//! The BMI270, which takes nothing but power modes before its configuration file was uploaded. The chip is simulated by
//! Bosch's SensorAPI and independently of the library.

use super::wire::Fault;
use allanite::sensor::{
    AsyncRegisters, CATALOGUE, Description, Error, Flaw, I2cBus, Imu, Loss, Reading, Registers,
    SpiBus, bmi270,
};
use embedded_hal::{i2c, spi};
use pollster::block_on;
use std::{cell::RefCell, rc::Rc};

/// Files of both lengths that Bosch publishes; the shorter one does not end with a whole block.
const LONG: [u8; 8192] = file();
const SHORT: [u8; 328] = file();

/// No two words of a file are the same.
const fn file<const LENGTH: usize>() -> [u8; LENGTH] {
    let mut bytes = [0; LENGTH];
    let mut k = 0;
    while k < LENGTH {
        let word = (k / 2) as u16 ^ 0x2EC8;
        bytes[k] = word.to_le_bytes()[k % 2];
        k += 1;
    }
    bytes
}

static WITH_LONG: Description = bmi270(&LONG);
static WITH_SHORT: Description = bmi270(&SHORT);

struct Chip {
    registers: [u8; 128],
    /// The memory behind INIT_DATA, and how many of its bytes were written.
    memory: Vec<u8>,
    written: usize,
    /// The file that the chip accepts.
    file: &'static [u8],
    /// Over SPI, whether the chip listens to it.
    listens: bool,
    /// Whether the memory may be written, which needs a reset, and whether it was.
    may_load: bool,
    /// The time in µs, and when the chip has started with its file.
    now_us: u64,
    ready_us: Option<u64>,
    /// The earliest time of the next access.
    idle_us: u64,
    transfers: usize,
    fault: Option<usize>,
    /// Every transfer by its register, and the number of bytes.
    log: Vec<(u8, usize)>,
}

impl Chip {
    fn new(file: &'static [u8]) -> Self {
        let mut chip = Self {
            registers: [0; 128],
            memory: vec![0; 8192],
            written: 0,
            file,
            listens: false,
            may_load: true,
            now_us: 0,
            ready_us: None,
            idle_us: 0,
            transfers: 0,
            fault: None,
            log: Vec::new(),
        };
        chip.reset();
        chip
    }

    fn reset(&mut self) {
        self.registers = [0; 128];
        self.registers[0x00] = 0x24;
        // Advanced power save.
        self.registers[0x7C] = 0x03;
        self.listens = false;
        self.may_load = true;
        self.ready_us = None;
        self.written = 0;
    }

    /// An access, after which the chip needs a pause.
    fn access(&mut self, is_write: bool, register: u8, bytes: usize) -> Result<(), Fault> {
        let at = self.transfers;
        self.transfers += 1;
        self.log.push((register, bytes));
        if self.fault == Some(at) {
            return Err(Fault::Before);
        }
        assert!(self.now_us >= self.idle_us, "too soon: {register:#04x}");
        let saves_power = self.registers[0x7C] & 1 == 1;
        // Linux writes right after it has read the identity.
        let is_identity = register == 0x00 && self.listens;
        self.idle_us = self.now_us
            + match (saves_power, is_write) {
                (true, _) if is_identity => 0,
                (true, _) => 450,
                (false, true) => 2,
                (false, false) => 0,
            };
        Ok(())
    }

    fn write(&mut self, frame: &[u8]) -> Result<(), Fault> {
        let (&register, bytes) = frame.split_first().unwrap();
        assert!(self.listens, "a write that the chip does not hear");
        self.access(true, register, bytes.len())?;
        let saves_power = self.registers[0x7C] & 1 == 1;
        match register {
            0x7E if bytes == [0xB6] => {
                self.reset();
                self.idle_us = self.now_us + 2000;
                return Ok(());
            }
            0x7C => {}
            _ => assert!(!saves_power, "{register:#04x} is out of reach"),
        }
        match register {
            0x5E => {
                let [low, high] = [self.registers[0x5B], self.registers[0x5C]].map(usize::from);
                assert!(low < 16);
                let at = 2 * (high << 4 | low);
                if self.may_load && self.registers[0x59] & 1 == 0 {
                    self.memory[at..at + bytes.len()].copy_from_slice(bytes);
                    self.written += bytes.len();
                }
                assert_eq!(bytes.len() % 2, 0);
                return Ok(());
            }
            0x59 if bytes == [1] => {
                self.ready_us = Some(self.now_us + 140_000);
                self.may_load = false;
            }
            0x40..0x5B | 0x7D if self.registers[0x59] == 1 => {
                assert!(
                    self.is_ready(),
                    "{register:#04x} before the chip has started"
                );
            }
            0x59 | 0x5B | 0x7C => {}
            _ => panic!("{register:#04x} was written"),
        }
        let from = usize::from(register);
        self.registers[from..from + bytes.len()].copy_from_slice(bytes);
        Ok(())
    }

    fn is_accepted(&self) -> bool {
        self.written == self.file.len() && self.memory[..self.file.len()] == *self.file
    }

    fn is_ready(&self) -> bool {
        self.ready_us
            .is_some_and(|ready_us| self.now_us >= ready_us)
            && self.is_accepted()
    }

    fn read(&mut self, register: u8, bytes: &mut [u8]) -> Result<(), Fault> {
        self.access(false, register, bytes.len())?;
        if !self.listens {
            bytes.fill(0xFF);
            return Ok(());
        }
        let is_over = self
            .ready_us
            .is_some_and(|ready_us| self.now_us >= ready_us);
        self.registers[0x21] = match is_over {
            // The upper bits tell of other errors.
            true if self.is_accepted() => 0x21,
            true => 0x02,
            false => 0x00,
        };
        let is_on = self.is_ready() && self.registers[0x7D] & 0x02 != 0;
        self.registers[0x03] = if is_on { 0x40 } else { 0 };
        self.registers[0x12..0x18].copy_from_slice(&[0xFE, 0xFF, 0x34, 0x12, 0x00, 0x80]);
        self.registers[0x22..0x24].copy_from_slice(&[0x00, 0x02]);
        let from = usize::from(register);
        bytes.copy_from_slice(&self.registers[from..from + bytes.len()]);
        Ok(())
    }
}

/// A bus to a chip. Clones lead to the same chip.
#[derive(Clone)]
struct Wire(Rc<RefCell<Chip>>);

impl Wire {
    fn new(file: &'static [u8]) -> Self {
        Self(Rc::new(RefCell::new(Chip::new(file))))
    }

    fn spi(&self) -> SpiBus<Self> {
        SpiBus::new(self.clone())
    }

    fn i2c(&self) -> I2cBus<I2cWire> {
        I2cBus::new(I2cWire(self.clone()))
    }

    fn delay(&self) -> Delay {
        Delay(self.clone())
    }

    fn transaction(&self, operations: &mut [spi::Operation<'_, u8>]) -> Result<(), Fault> {
        let chip = &mut *self.0.borrow_mut();
        let done = match operations {
            [spi::Operation::Write(header), spi::Operation::Read(bytes)] => {
                let &[register, _dummy] = *header else {
                    panic!("a read over SPI has one dummy byte")
                };
                chip.read(register.checked_sub(0x80).unwrap(), bytes)
            }
            [spi::Operation::Write(frame)] => chip.write(frame),
            _ => panic!("odd operations"),
        };
        // The edge of chip select comes before the reset.
        let is_reset = matches!(operations, [spi::Operation::Write([0x7E, 0xB6])]);
        chip.listens = !is_reset;
        done
    }
}

impl spi::ErrorType for Wire {
    type Error = Fault;
}

impl spi::SpiDevice for Wire {
    fn transaction(&mut self, operations: &mut [spi::Operation<'_, u8>]) -> Result<(), Fault> {
        Wire::transaction(self, operations)
    }
}

impl embedded_hal_async::spi::SpiDevice for Wire {
    async fn transaction(
        &mut self,
        operations: &mut [spi::Operation<'_, u8>],
    ) -> Result<(), Fault> {
        Wire::transaction(self, operations)
    }
}

/// The same chip over I²C, to which it always listens.
#[derive(Clone)]
struct I2cWire(Wire);

impl I2cWire {
    fn transaction(&self, address: u8, operations: &mut [i2c::Operation<'_>]) -> Result<(), Fault> {
        assert_eq!(address, 0x68);
        let chip = &mut *self.0.0.borrow_mut();
        chip.listens = true;
        match operations {
            [i2c::Operation::Write(header), i2c::Operation::Read(bytes)] => {
                assert_eq!(header.len(), 1);
                chip.read(header[0], bytes)
            }
            [i2c::Operation::Write(frame)] => chip.write(frame),
            _ => panic!("odd operations"),
        }
    }
}

impl i2c::ErrorType for I2cWire {
    type Error = Fault;
}

impl i2c::I2c for I2cWire {
    fn transaction(
        &mut self,
        address: u8,
        operations: &mut [i2c::Operation<'_>],
    ) -> Result<(), Fault> {
        I2cWire::transaction(self, address, operations)
    }
}

impl embedded_hal_async::i2c::I2c for I2cWire {
    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [i2c::Operation<'_>],
    ) -> Result<(), Fault> {
        I2cWire::transaction(self, address, operations)
    }
}

/// A delay that moves the chip's time on.
struct Delay(Wire);

impl embedded_hal::delay::DelayNs for Delay {
    fn delay_ns(&mut self, _: u32) {
        unreachable!("microseconds are enough")
    }
    fn delay_us(&mut self, us: u32) {
        self.0.0.borrow_mut().now_us += u64::from(us);
    }
}

impl embedded_hal_async::delay::DelayNs for Delay {
    async fn delay_ns(&mut self, _: u32) {
        unreachable!("microseconds are enough")
    }
    async fn delay_us(&mut self, us: u32) {
        self.0.0.borrow_mut().now_us += u64::from(us);
    }
}

/// Starts the sensor and reads a sample.
fn run<B>(
    is_async: bool,
    bus: B,
    wire: &Wire,
    description: &'static Description,
) -> Result<Option<Reading>, Error<Fault>>
where
    B: Registers<Error = Fault> + AsyncRegisters<Error = Fault>,
{
    let delay = &mut wire.delay();
    if is_async {
        block_on(async {
            let mut imu = Imu::start_async(bus, description, delay).await?;
            imu.read_async().await
        })
    } else {
        Imu::start(bus, description, delay)?.read()
    }
}

/// Starts over either bus, in either way.
fn run_over(
    over_spi: bool,
    is_async: bool,
    wire: &Wire,
    description: &'static Description,
) -> Result<Option<Reading>, Error<Fault>> {
    match over_spi {
        true => run(is_async, wire.spi(), wire, description),
        false => run(is_async, wire.i2c(), wire, description),
    }
}

const WAYS: [(bool, bool); 4] = [(false, false), (false, true), (true, false), (true, true)];

const SAMPLE: Reading = Reading {
    gyro: [-2, 0x1234, -0x8000],
    temperature: Some(0x0200),
    loss: Loss::Nothing,
    ticks: None,
};

#[test]
fn the_file_is_uploaded_over_either_bus_and_in_either_way() {
    for (over_spi, is_async) in WAYS {
        for (description, file) in [(&WITH_LONG, &LONG[..]), (&WITH_SHORT, &SHORT)] {
            let wire = Wire::new(file);
            let sample = run_over(over_spi, is_async, &wire, description);
            assert_eq!(sample, Ok(Some(SAMPLE)), "{over_spi} {is_async}");
            let chip = wire.0.borrow();
            assert!(chip.is_accepted());
            assert_eq!(chip.memory[file.len()..], vec![0; 8192 - file.len()]);
            // The settings, by the codes of Bosch's SensorAPI.
            let settings = [
                (0x42, 0xC9),
                (0x43, 0x03),
                (0x53, 0x0A),
                (0x58, 0x04),
                (0x7D, 0x0A),
            ];
            for (register, value) in settings {
                assert_eq!(chip.registers[register], value, "{register:#04x}");
            }
            let blocks = chip.log.iter().filter(|(register, _)| *register == 0x5E);
            assert_eq!(blocks.count(), file.len().div_ceil(32));
        }
    }
}

#[test]
fn both_ways_make_the_same_transfers() {
    for over_spi in [false, true] {
        let logs = [false, true].map(|is_async| {
            let wire = Wire::new(&SHORT);
            run_over(over_spi, is_async, &wire, &WITH_SHORT).unwrap();
            let chip = wire.0.borrow();
            (chip.log.clone(), chip.now_us)
        });
        assert_eq!(logs[0], logs[1]);
    }
}

#[test]
fn another_sensor_is_refused_before_anything_is_written() {
    for (over_spi, is_async) in WAYS {
        let wire = Wire::new(&LONG);
        // The BMI260.
        wire.0.borrow_mut().registers[0x00] = 0x27;
        let error = run_over(over_spi, is_async, &wire, &WITH_LONG);
        let expected = Error::WrongIdentity {
            sensor: "BMI270",
            register: 0x00,
            found: 0x27,
            expected: &[0x24],
        };
        assert_eq!(error, Err(expected));
        let chip = wire.0.borrow();
        assert_eq!(chip.log, vec![(0x00, 1); if over_spi { 2 } else { 1 }]);
    }
}

#[test]
fn a_file_that_is_not_accepted_ends_the_start() {
    for (over_spi, is_async) in WAYS {
        // The chip waits for the other file.
        let wire = Wire::new(&LONG);
        let error = run_over(over_spi, is_async, &wire, &WITH_SHORT).unwrap_err();
        let expected = Error::Upload {
            sensor: "BMI270",
            register: 0x21,
            found: 0x02,
            expected: 0x01,
        };
        assert_eq!(error, expected);
        assert_eq!(wire.0.borrow().registers[0x7D], 0, "the gyro stays off");
        let text = error.to_string();
        assert!(text.contains("0x02 instead of 0x01") && !text.contains('\n'));
        // The right one is accepted afterwards, because the start resets the chip.
        assert_eq!(
            run_over(over_spi, is_async, &wire, &WITH_LONG),
            Ok(Some(SAMPLE))
        );
    }
}

#[test]
fn a_fault_at_any_transfer_is_told_and_the_next_start_succeeds() {
    for (over_spi, is_async) in WAYS {
        let wire = Wire::new(&SHORT);
        run_over(over_spi, is_async, &wire, &WITH_SHORT).unwrap();
        let log = wire.0.borrow().log.clone();
        assert!(log.len() > 2 * 11);
        for (at, &(register, _)) in log.iter().enumerate() {
            let wire = Wire::new(&SHORT);
            wire.0.borrow_mut().fault = Some(at);
            let error = run_over(over_spi, is_async, &wire, &WITH_SHORT).unwrap_err();
            let fault = Fault::Before;
            assert_eq!(
                error,
                Error::Bus {
                    register,
                    error: fault
                }
            );
            assert_eq!(wire.0.borrow().transfers, at + 1, "nothing follows a fault");
            wire.0.borrow_mut().now_us += 1000;
            let sample = run_over(over_spi, is_async, &wire, &WITH_SHORT);
            assert_eq!(sample, Ok(Some(SAMPLE)), "{over_spi} {at}");
        }
        // A second start of a chip that runs.
        let sample = run_over(over_spi, is_async, &wire, &WITH_SHORT);
        assert_eq!(sample, Ok(Some(SAMPLE)));
    }
}

#[test]
fn an_image_that_no_chip_can_take_is_found_by_the_check() {
    const ODD: &[u8] = LONG.split_at(327).0;
    for (image, expected) in [
        (&LONG[..], Ok(())),
        (&SHORT, Ok(())),
        (&[], Err(Flaw::Upload)),
        (ODD, Err(Flaw::Upload)),
        (&[0; 8194], Err(Flaw::Upload)),
    ] {
        assert_eq!(bmi270(image).check(), expected, "{} bytes", image.len());
    }
    let mut never = WITH_LONG;
    never.upload.as_mut().unwrap().accepted = 0x11;
    assert_eq!(never.check(), Err(Flaw::Upload));
    assert!(CATALOGUE.iter().all(|it| it.upload.is_none()));
}
