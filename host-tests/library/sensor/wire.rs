//! A bus to a simulated sensor, whose transfers can fail or stall one by one.

use super::chip::{Chip, Kind};
use allanite::sensor::{I2cBus, SpiBus};
use embedded_hal::{i2c, spi};
use std::{cell::RefCell, rc::Rc};

/// How a transfer fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fault {
    /// The sensor does not notice the transfer.
    Before,
    /// The sensor takes part in it, and what it sends is lost.
    After,
}

impl spi::Error for Fault {
    fn kind(&self) -> spi::ErrorKind {
        spi::ErrorKind::Other
    }
}

impl i2c::Error for Fault {
    fn kind(&self) -> i2c::ErrorKind {
        i2c::ErrorKind::Bus
    }
}

/// A sensor and its bus.
pub(crate) struct World {
    pub(crate) chip: Chip,
    /// The number of transfers so far, failed ones included.
    pub(crate) transfers: usize,
    /// The transfer that fails, and how.
    pub(crate) fault: Option<(usize, Fault)>,
    /// Every transfer: its first byte without the bit of a read, and the number of bytes to read.
    pub(crate) log: Vec<(u8, usize)>,
    /// A byte of the next content that is replaced, and by what it is combined with an exclusive or.
    pub(crate) damage: Option<(usize, u8)>,
    /// The number of contents before that.
    pub(crate) skip: usize,
    /// The asynchronous transfer that never ends.
    stall: Option<usize>,
}

impl World {
    fn transfer(&mut self, written: &[u8], read: &mut [u8]) -> Result<(), Fault> {
        let fault = self.fault.filter(|(at, _)| *at == self.transfers);
        self.transfers += 1;
        self.log.push((written[0], read.len()));
        if let Some((_, Fault::Before)) = fault {
            return Err(Fault::Before);
        }
        match (written, &mut *read) {
            (&[register, value], []) => self.chip.write(register, value),
            (&[register], bytes) => {
                self.chip.read(register, bytes);
                if bytes.len() > 3 && self.damage.is_some() {
                    if self.skip > 0 {
                        self.skip -= 1;
                    } else if let Some((at, with)) = self.damage.take() {
                        bytes[at] ^= with;
                    }
                }
            }
            _ => panic!("an odd transfer: {written:02x?}"),
        }
        match fault {
            Some((_, fault)) => {
                read.fill(0xFF);
                Err(fault)
            }
            None => Ok(()),
        }
    }
}

/// A bus to a simulated sensor. Clones lead to the same sensor.
#[derive(Clone)]
pub(crate) struct Wire(pub(crate) Rc<RefCell<World>>);

impl Wire {
    pub(crate) fn new(kind: Kind) -> Self {
        Self(Rc::new(RefCell::new(World {
            chip: Chip::new(kind),
            transfers: 0,
            fault: None,
            log: Vec::new(),
            damage: None,
            skip: 0,
            stall: None,
        })))
    }

    pub(crate) fn spi(&self) -> SpiBus<Self> {
        SpiBus::new(self.clone())
    }

    pub(crate) fn i2c(&self) -> I2cBus<Self> {
        I2cBus::new(self.clone())
    }

    pub(crate) fn take(&self, samples: u64) {
        self.0.borrow_mut().chip.take(samples);
    }

    pub(crate) fn taken(&self) -> u64 {
        self.0.borrow().chip.taken
    }

    /// Lets the transfer after `transfers` further ones fail.
    pub(crate) fn fail(&self, transfers: usize, fault: Fault) {
        let world = &mut *self.0.borrow_mut();
        world.fault = Some((world.transfers + transfers, fault));
    }

    /// Lets the transfer after `transfers` further ones stay unfinished, if it is asynchronous.
    pub(crate) fn stall(&self, transfers: usize) {
        let world = &mut *self.0.borrow_mut();
        world.stall = Some(world.transfers + transfers);
    }

    /// Does not return while a transfer stays unfinished. What it reads is lost to the sensor.
    async fn stalled(&self) {
        let stall = self.0.borrow().stall;
        if stall == Some(self.transfers() - 1) {
            self.0.borrow_mut().stall = None;
            std::future::pending::<()>().await;
        }
    }

    pub(crate) fn transfers(&self) -> usize {
        self.0.borrow().transfers
    }

    fn spi_transfer(&self, operations: &mut [spi::Operation<'_, u8>]) -> Result<(), Fault> {
        let world = &mut *self.0.borrow_mut();
        match operations {
            [spi::Operation::Write(header), spi::Operation::Read(bytes)] => {
                let register = header[0].checked_sub(0x80).expect("the mark of a read");
                world.transfer(&[register], bytes)
            }
            [spi::Operation::Write(written)] => world.transfer(written, &mut []),
            _ => panic!("odd operations"),
        }
    }

    fn i2c_transfer(&self, operations: &mut [i2c::Operation<'_>]) -> Result<(), Fault> {
        let world = &mut *self.0.borrow_mut();
        match operations {
            [i2c::Operation::Write(header), i2c::Operation::Read(bytes)] => {
                world.transfer(header, bytes)
            }
            [i2c::Operation::Write(written)] => world.transfer(written, &mut []),
            _ => panic!("odd operations"),
        }
    }
}

impl spi::ErrorType for Wire {
    type Error = Fault;
}

impl spi::SpiDevice for Wire {
    fn transaction(&mut self, operations: &mut [spi::Operation<'_, u8>]) -> Result<(), Fault> {
        self.spi_transfer(operations)
    }
}

impl embedded_hal_async::spi::SpiDevice for Wire {
    async fn transaction(
        &mut self,
        operations: &mut [spi::Operation<'_, u8>],
    ) -> Result<(), Fault> {
        let done = self.spi_transfer(operations);
        self.stalled().await;
        done
    }
}

impl i2c::ErrorType for Wire {
    type Error = Fault;
}

impl i2c::I2c for Wire {
    fn transaction(&mut self, _: u8, operations: &mut [i2c::Operation<'_>]) -> Result<(), Fault> {
        self.i2c_transfer(operations)
    }
}

impl embedded_hal_async::i2c::I2c for Wire {
    async fn transaction(
        &mut self,
        _: u8,
        operations: &mut [i2c::Operation<'_>],
    ) -> Result<(), Fault> {
        self.i2c_transfer(operations)
    }
}

/// A delay that takes no time.
pub(crate) struct NoDelay;

impl embedded_hal::delay::DelayNs for NoDelay {
    fn delay_ns(&mut self, _: u32) {}
}

impl embedded_hal_async::delay::DelayNs for NoDelay {
    async fn delay_ns(&mut self, _: u32) {}
}
