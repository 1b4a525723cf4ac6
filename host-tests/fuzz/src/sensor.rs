//! Sensors on a bus whose every transfer answers any bytes or an error.

use allanite::{
    Axes,
    sensor::{
        CATALOGUE, Description, Error, FifoImu, I2cBus, Imu, Pace, Reading, Registers, SpiBus,
    },
};
use embedded_hal::{delay::DelayNs, i2c, spi};
use std::{cell::RefCell, rc::Rc};

/// The most transfers of a read. The longest empties a FIFO and asks for its count and its content.
const MOST_TRANSFERS: usize = 8;

/// The most transfers of a start, which waits for a reset.
const MOST_TO_START: usize = 200;

/// Reads the sensor that the first byte selects from a bus that the others control.
pub fn check(bytes: &[u8]) {
    let Some((&[sensor, size], rest)) = bytes.split_first_chunk() else {
        return;
    };
    let description = CATALOGUE[usize::from(sensor) % CATALOGUE.len()];
    let world = World(Rc::new(RefCell::new(State {
        bytes: rest.to_vec(),
        at: 0,
        identity: description.identity,
        answer: description.identities[0],
        transfers: 0,
        failed: 0,
    })));
    let buffer = &mut vec![0; usize::from(size) * 4];
    match (sensor & 0x20, sensor & 0x40) {
        (0, 0) => read(SpiBus::new(world.clone()), &world, description),
        (0, _) => read(I2cBus::new(world.clone()), &world, description),
        (_, 0) => burst(SpiBus::new(world.clone()), &world, description, buffer),
        (..) => burst(I2cBus::new(world.clone()), &world, description, buffer),
    }
}

/// What every transfer asks: the next bytes say whether it fails, and what it answers.
struct State {
    bytes: Vec<u8>,
    at: usize,
    identity: u8,
    answer: u8,
    transfers: usize,
    failed: usize,
}

impl State {
    fn next(&mut self) -> u8 {
        let byte = self.bytes.get(self.at).copied().unwrap_or(0);
        self.at += 1;
        byte
    }

    fn is_over(&self) -> bool {
        self.at >= self.bytes.len()
    }

    fn transfer(&mut self, register: Option<u8>, to: &mut [u8]) -> Result<(), Fault> {
        self.transfers += 1;
        let control = self.next();
        match control {
            // The transfer fails, and what it read by then is anything.
            0xF0.. => {
                to.fill(control);
                self.failed += 1;
                return Err(Fault(control));
            }
            // The sensor that is expected answers.
            _ if register.is_some_and(|register| register & 0x7F == self.identity & 0x7F)
                && control & 1 == 0 =>
            {
                to.fill(self.answer);
            }
            // A few bytes over and over, so that a small input fills a long burst.
            0x40..0xC0 => {
                let count = usize::from(control % 16) + 1;
                let few: Vec<u8> = (0..count).map(|_| self.next()).collect();
                for (to, from) in to.iter_mut().zip(few.iter().cycle()) {
                    *to = *from;
                }
            }
            _ => to.iter_mut().for_each(|to| *to = self.next()),
        }
        Ok(())
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Fault(u8);

impl spi::Error for Fault {
    fn kind(&self) -> spi::ErrorKind {
        spi::ErrorKind::Other
    }
}

impl i2c::Error for Fault {
    fn kind(&self) -> i2c::ErrorKind {
        i2c::ErrorKind::Other
    }
}

#[derive(Clone)]
struct World(Rc<RefCell<State>>);

impl World {
    /// The numbers of transfers and of those that failed.
    fn transfers(&self) -> (usize, usize) {
        let state = self.0.borrow();
        (state.transfers, state.failed)
    }

    fn next(&self) -> u8 {
        self.0.borrow_mut().next()
    }

    fn is_over(&self) -> bool {
        self.0.borrow().is_over()
    }
}

impl spi::ErrorType for World {
    type Error = Fault;
}

impl spi::SpiDevice for World {
    fn transaction(&mut self, operations: &mut [spi::Operation<'_, u8>]) -> Result<(), Fault> {
        let mut register = None;
        for operation in operations {
            match operation {
                spi::Operation::Write(bytes) => register = bytes.first().copied(),
                spi::Operation::Read(to) => self.0.borrow_mut().transfer(register, to)?,
                other => panic!("not an operation that a sensor needs: {other:?}"),
            }
        }
        Ok(())
    }
}

impl i2c::ErrorType for World {
    type Error = Fault;
}

impl i2c::I2c for World {
    fn transaction(&mut self, _: u8, operations: &mut [i2c::Operation<'_>]) -> Result<(), Fault> {
        let mut register = None;
        let mut reads = false;
        for operation in &mut *operations {
            match operation {
                i2c::Operation::Write(bytes) => register = bytes.first().copied(),
                i2c::Operation::Read(to) => {
                    reads = true;
                    self.0.borrow_mut().transfer(register, to)?;
                }
            }
        }
        match reads {
            true => Ok(()),
            // A write can fail too.
            false => self.0.borrow_mut().transfer(None, &mut []),
        }
    }
}

/// A delay that takes no time.
struct NoDelay;

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _: u32) {}
}

type Gyro = Axes<8, 1, (), ()>;

fn temperature(reading: &Reading) -> [i32; 1] {
    [reading.temperature.unwrap_or(0).into()]
}

/// Checks a start: it ends, and fails only with the bus or with another sensor's identity.
fn started<I>(world: &World, imu: Result<I, Error<Fault>>) -> Option<I> {
    let (transfers, failed) = world.transfers();
    assert!(transfers <= MOST_TO_START, "{transfers} transfers to start");
    match imu {
        Ok(imu) => Some(imu),
        Err(error) => {
            match error {
                Error::Bus { .. } => assert!(failed > 0, "no transfer failed"),
                Error::WrongIdentity { .. } | Error::NoFifo { .. } => {}
                other => panic!("{other:?}"),
            }
            None
        }
    }
}

/// Reads one sample at a time.
fn read<B: Registers<Error = Fault>>(bus: B, world: &World, description: &'static Description) {
    let Some(mut imu) = started(world, Imu::start(bus, description, &mut NoDelay)) else {
        return;
    };
    let mut axes = Gyro::new();
    let mut pace = Pace::new(description.rate_hz).unwrap();
    let (mut samples, mut errors, mut now_us) = (0, 0, 0_u32);
    while !world.is_over() {
        let (transfers, failed) = world.transfers();
        let outcome = imu.read();
        let (after, failed_after) = world.transfers();
        assert!(after - transfers <= MOST_TRANSFERS);
        match &outcome {
            Ok(reading) => {
                assert_eq!(failed, failed_after, "a failure was hidden");
                if let Some(reading) = reading {
                    assert!(
                        reading
                            .gyro
                            .iter()
                            .all(|&count| i16::try_from(count).is_ok())
                    );
                    samples += 1;
                    now_us = now_us.wrapping_add(u32::from(world.next()) << 8);
                    let _ = pace.stamp(now_us);
                    let _ = (pace.measured_hz(), pace.check());
                }
            }
            Err(Error::Bus { .. }) => {
                assert!(failed_after > failed, "no transfer failed");
                errors += 1;
            }
            Err(other) => panic!("{other:?}"),
        }
        let before = axes.losses();
        axes.record_outcome(&outcome, temperature);
        assert!(axes.losses() - before <= 1);
        assert!(outcome.is_ok() || axes.losses() > before);
    }
    axes.release();
    assert_eq!(axes.samples(), samples);
    assert!(axes.losses() >= errors);
}

/// Reads bursts from a FIFO.
fn burst<B: Registers<Error = Fault>>(
    bus: B,
    world: &World,
    description: &'static Description,
    buffer: &mut [u8],
) {
    let Some(mut imu) = started(world, FifoImu::start(bus, description, &mut NoDelay)) else {
        return;
    };
    let mut axes = Gyro::new();
    let (mut samples, mut now_us, mut last) = (0, 0_u32, None);
    while !world.is_over() {
        let (transfers, failed) = world.transfers();
        let jump = u32::from(world.next());
        now_us = now_us.wrapping_add(if jump < 250 { jump << 10 } else { jump << 24 });
        let length = buffer.len();
        match imu.read(now_us, buffer) {
            Ok(burst) => {
                if jump % 2 == 0 {
                    let before = axes.samples();
                    let recorded = axes.record_burst(burst, temperature);
                    let more = axes.samples() - before;
                    assert!(recorded.is_err() || recorded == Ok(more as u32));
                    samples += more;
                } else {
                    let mut readings = 0;
                    for reading in burst {
                        readings += 1;
                        assert!(readings <= length, "more readings than bytes");
                        let Ok(reading) = reading else {
                            break;
                        };
                        let ticks = reading.ticks.expect("a FIFO has times");
                        assert!(last.is_none_or(|last| ticks > last), "a sample came twice");
                        last = Some(ticks);
                        axes.record_outcome::<Fault>(&Ok(Some(reading)), temperature);
                        samples += 1;
                    }
                }
            }
            Err(Error::Bus { .. }) => {
                assert!(world.transfers().1 > failed, "no transfer failed");
            }
            Err(Error::BufferTooSmall { needed }) => {
                assert!(needed > length);
                return;
            }
            Err(other) => panic!("{other:?}"),
        }
        assert!(world.transfers().0 - transfers <= MOST_TRANSFERS);
        let clock = imu.clock();
        let finite = |x: Option<f64>| x.is_none_or(f64::is_finite);
        assert!(finite(clock.error_ppm()) && finite(clock.measured_hz()));
        let _ = clock.check();
    }
    axes.release();
    assert_eq!(axes.samples(), samples);
}
