use super::Interface;
use embedded_hal::{
    i2c::I2c,
    spi::{Operation, SpiDevice},
};

/// The largest number of dummy bytes of a read over SPI.
const MAX_DUMMIES: usize = 3;

/// A bus with one sensor on it, which is accessed as registers of 8 bits.
pub trait Registers {
    /// The error of the bus.
    type Error;

    /// Whether the bus is SPI. It selects the writes that are sent: see [`Write::bus`](super::Write::bus).
    const IS_SPI: bool;

    /// Reads in one transaction, beginning with `register`: consecutive registers, or a FIFO behind the register.
    ///
    /// # Errors
    /// The error of the bus.
    fn read(
        &mut self,
        interface: &Interface,
        register: u8,
        bytes: &mut [u8],
    ) -> Result<(), Self::Error>;

    /// Writes in one transaction: a register, which is the first byte, and what follows it to this register and those
    /// after it, or to a memory behind the register.
    ///
    /// # Errors
    /// The error of the bus.
    fn write_frame(&mut self, interface: &Interface, frame: &[u8]) -> Result<(), Self::Error>;

    /// Writes one register.
    ///
    /// # Errors
    /// The error of the bus.
    fn write(&mut self, interface: &Interface, register: u8, value: u8) -> Result<(), Self::Error> {
        self.write_frame(interface, &[register, value])
    }
}

/// The address of a read over SPI, and the dummy bytes that follow it.
pub(super) struct SpiHeader {
    bytes: [u8; 1 + MAX_DUMMIES],
    dummies: usize,
}

impl SpiHeader {
    /// The bytes to send.
    pub(super) fn bytes(&self) -> &[u8] {
        self.bytes.get(..=self.dummies).unwrap_or(&self.bytes)
    }
}

/// The header of a read over SPI.
pub(super) fn spi_header(interface: &Interface, register: u8) -> SpiHeader {
    let mut bytes = [0; 1 + MAX_DUMMIES];
    bytes[0] = register | interface.spi_read;
    let dummies = usize::from(interface.spi_dummies).min(MAX_DUMMIES);
    SpiHeader { bytes, dummies }
}

/// A sensor on an SPI bus. `SPI` also drives the chip select. A `&mut` of a device is a device as well.
#[derive(Clone, Debug)]
pub struct SpiBus<SPI>(pub(super) SPI);

impl<SPI> SpiBus<SPI> {
    /// A bus that owns the device.
    pub const fn new(spi: SPI) -> Self {
        Self(spi)
    }

    /// Returns the device.
    pub fn release(self) -> SPI {
        self.0
    }
}

impl<SPI: SpiDevice> Registers for SpiBus<SPI> {
    type Error = SPI::Error;

    const IS_SPI: bool = true;

    fn read(
        &mut self,
        interface: &Interface,
        register: u8,
        bytes: &mut [u8],
    ) -> Result<(), Self::Error> {
        let header = spi_header(interface, register);
        let mut operations = [Operation::Write(header.bytes()), Operation::Read(bytes)];
        self.0.transaction(&mut operations)
    }

    fn write_frame(&mut self, _: &Interface, frame: &[u8]) -> Result<(), Self::Error> {
        self.0.write(frame)
    }
}

/// A sensor on an I²C bus.
#[derive(Clone, Debug)]
pub struct I2cBus<I2C> {
    pub(super) i2c: I2C,
    address: Option<u8>,
}

impl<I2C> I2cBus<I2C> {
    /// A bus whose sensor is at the address in its description.
    pub const fn new(i2c: I2C) -> Self {
        Self { i2c, address: None }
    }

    /// A bus whose sensor is at another 7-bit address.
    pub const fn at(i2c: I2C, address: u8) -> Self {
        Self {
            i2c,
            address: Some(address),
        }
    }

    /// Returns the bus.
    pub fn release(self) -> I2C {
        self.i2c
    }

    pub(super) fn address(&self, interface: &Interface) -> u8 {
        self.address.unwrap_or(interface.i2c_address)
    }
}

impl<I2C: I2c> Registers for I2cBus<I2C> {
    type Error = I2C::Error;

    const IS_SPI: bool = false;

    fn read(
        &mut self,
        interface: &Interface,
        register: u8,
        bytes: &mut [u8],
    ) -> Result<(), Self::Error> {
        let address = self.address(interface);
        self.i2c
            .write_read(address, &[register | interface.i2c_read], bytes)
    }

    fn write_frame(&mut self, interface: &Interface, frame: &[u8]) -> Result<(), Self::Error> {
        let address = self.address(interface);
        self.i2c.write(address, frame)
    }
}
