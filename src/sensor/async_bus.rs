use super::{
    I2cBus, Interface, SpiBus,
    bus::{SpiHeader, spi_header},
};
use embedded_hal_async::{
    i2c::I2c,
    spi::{Operation, SpiDevice},
};

/// A bus with one sensor on it, which is accessed as registers of 8 bits, without blocking. It is the counterpart
/// of [`Registers`](super::Registers).
#[expect(
    async_fn_in_trait,
    reason = "as in embedded-hal-async, whose futures need not be Send"
)]
pub trait AsyncRegisters {
    /// The error of the bus.
    type Error;

    /// Whether the bus is SPI. It selects the writes that are sent: see [`Write::bus`](super::Write::bus).
    const IS_SPI: bool;

    /// Reads in one transaction, beginning with `register`: consecutive registers, or a FIFO behind the register.
    ///
    /// # Errors
    /// The error of the bus.
    async fn read(
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
    async fn write_frame(&mut self, interface: &Interface, frame: &[u8])
    -> Result<(), Self::Error>;

    /// Writes one register.
    ///
    /// # Errors
    /// The error of the bus.
    async fn write(
        &mut self,
        interface: &Interface,
        register: u8,
        value: u8,
    ) -> Result<(), Self::Error> {
        self.write_frame(interface, &[register, value]).await
    }
}

impl<SPI: SpiDevice> AsyncRegisters for SpiBus<SPI> {
    type Error = SPI::Error;

    const IS_SPI: bool = true;

    async fn read(
        &mut self,
        interface: &Interface,
        register: u8,
        bytes: &mut [u8],
    ) -> Result<(), Self::Error> {
        let header: SpiHeader = spi_header(interface, register);
        let mut operations = [Operation::Write(header.bytes()), Operation::Read(bytes)];
        self.0.transaction(&mut operations).await
    }

    async fn write_frame(&mut self, _: &Interface, frame: &[u8]) -> Result<(), Self::Error> {
        self.0.write(frame).await
    }
}

impl<I2C: I2c> AsyncRegisters for I2cBus<I2C> {
    type Error = I2C::Error;

    const IS_SPI: bool = false;

    async fn read(
        &mut self,
        interface: &Interface,
        register: u8,
        bytes: &mut [u8],
    ) -> Result<(), Self::Error> {
        let address = self.address(interface);
        self.i2c
            .write_read(address, &[register | interface.i2c_read], bytes)
            .await
    }

    async fn write_frame(
        &mut self,
        interface: &Interface,
        frame: &[u8],
    ) -> Result<(), Self::Error> {
        let address = self.address(interface);
        self.i2c.write(address, frame).await
    }
}
