//! The board: what is connected where.

use crate::clock::Clock;
use allanite::sensor::{Interface, Registers};
use embassy_stm32::{
    Peri,
    gpio::{Input, Level, Output, Pull, Speed},
    mode::Blocking,
    peripherals::{PA2, USART2},
    spi::{self, MODE_3, Spi, mode::Master},
    time::Hertz,
    usart::{self, UartTx},
};

/// Everything that the station uses.
pub struct Board {
    pub bus: Bus,
    /// INT1 of the sensor, which is high while a sample waits.
    pub ready: Input<'static>,
    pub clock: Clock,
    pub display: Display,
}

impl Board {
    /// Sets the pins up; `None` if that was done before.
    // A function of its own, so that its variables are gone from the stack when the record is judged.
    #[inline(never)]
    pub fn start() -> Option<Self> {
        let core = cortex_m::Peripherals::take()?;
        let p = embassy_stm32::init(embassy_stm32::Config::default());
        let mut config = spi::Config::default();
        config.mode = MODE_3;
        // The sensor takes 10 MHz, and a sample of 8 bytes takes 100 µs with this.
        config.frequency = Hertz(1_000_000);
        Some(Self {
            bus: Bus {
                spi: Spi::new_blocking(p.SPI1, p.PA5, p.PA7, p.PA6, config),
                select: Output::new(p.PA4, Level::High, Speed::Low),
            },
            ready: Input::new(p.PA3, Pull::Down),
            clock: Clock::start(core.SYST),
            display: Display {
                pass: Output::new(p.PA0, Level::Low, Speed::Low),
                fail: Output::new(p.PA1, Level::Low, Speed::Low),
                uart: p.USART2,
                pin: p.PA2,
            },
        })
    }
}

/// The sensor's bus. It does what [`allanite::sensor::SpiBus`] does, without a device of embedded-hal around the bus, which
/// takes 300 bytes of flash.
pub struct Bus {
    spi: Spi<'static, Blocking, Master>,
    select: Output<'static>,
}

impl Bus {
    /// Sends bytes, and then receives others.
    fn transfer(&mut self, sent: &[u8], received: &mut [u8]) -> Result<(), spi::Error> {
        self.select.set_low();
        // One function for both directions saves flash. The sensor ignores what it gets while it sends.
        let mut bytes = sent.iter();
        let result = bytes.try_for_each(|&byte| self.spi.blocking_transfer_in_place(&mut [byte]));
        let result = result.and_then(|()| self.spi.blocking_transfer_in_place(received));
        self.select.set_high();
        result
    }
}

impl Registers for &mut Bus {
    type Error = spi::Error;

    const IS_SPI: bool = true;

    fn read(
        &mut self,
        interface: &Interface,
        register: u8,
        bytes: &mut [u8],
    ) -> Result<(), spi::Error> {
        // This sensor sends no dummy bytes.
        self.transfer(&[register | interface.spi_read], bytes)
    }

    fn write_frame(&mut self, _: &Interface, frame: &[u8]) -> Result<(), spi::Error> {
        self.transfer(frame, &mut [])
    }
}

/// What shows the verdict: two pins, and text for a person.
pub struct Display {
    pub pass: Output<'static>,
    pub fail: Output<'static>,
    uart: Peri<'static, USART2>,
    pin: Peri<'static, PA2>,
}

impl Display {
    /// Sends text at 115 200 baud.
    pub fn say(&mut self, text: [&str; 3]) {
        let (uart, pin) = (self.uart.reborrow(), self.pin.reborrow());
        // Nobody would read of an error here, and the pins show the verdict.
        let Ok(mut uart) = UartTx::new_blocking(uart, pin, usart::Config::default()) else {
            return;
        };
        for words in text {
            uart.blocking_write(words.as_bytes()).ok();
        }
        uart.blocking_flush().ok();
    }
}
