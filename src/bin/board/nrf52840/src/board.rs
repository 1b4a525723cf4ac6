//! The board: what is connected where.

use crate::store::Flash;
use embassy_embedded_hal::{adapter::BlockingAsync, shared_bus::asynch::spi::SpiDevice};
use embassy_nrf::{
    bind_interrupts,
    config::{Config, LfclkSource},
    gpio::{Input, Level, Output, OutputDrive, Pull},
    nvmc::Nvmc,
    peripherals::SPI2,
    spim::{self, Spim},
};
use embassy_sync::{blocking_mutex::raw::NoopRawMutex, mutex::Mutex};
use static_cell::StaticCell;

bind_interrupts!(struct Interrupts {
    SPI2 => spim::InterruptHandler<SPI2>;
});

/// The bus, which other devices may share.
type Bus = Mutex<NoopRawMutex, Spim<'static>>;

/// The sensor on the bus.
pub type Device = SpiDevice<'static, NoopRawMutex, Spim<'static>, Output<'static>>;

/// Everything that the program uses.
pub struct Board {
    pub device: Device,
    /// INT1 of the sensor.
    pub signal: Input<'static>,
    pub flash: Flash,
}

impl Board {
    /// Sets the pins up. It is called once.
    pub fn start() -> Self {
        static BUS: StaticCell<Bus> = StaticCell::new();

        let mut config = Config::default();
        // The sensor's rate is measured against this clock, and the internal one would be off by up to 2 %.
        config.lfclk_source = LfclkSource::ExternalXtal;
        let p = embassy_nrf::init(config);
        let mut config = spim::Config::default();
        config.frequency = spim::Frequency::M8;
        let (sck, miso, mosi) = (p.P1_15, p.P1_14, p.P1_13);
        let bus = Spim::new(p.SPI2, Interrupts, sck, miso, mosi, config);
        let bus = BUS.init(Mutex::new(bus));
        let select = Output::new(p.P1_12, Level::High, OutputDrive::Standard);
        Self {
            device: SpiDevice::new(bus, select),
            // The sensor's pin is an open drain.
            signal: Input::new(p.P1_11, Pull::Up),
            flash: BlockingAsync::new(Nvmc::new(p.NVMC)),
        }
    }
}
