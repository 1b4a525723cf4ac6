/// The pause after the address of an indirect register before its value is read or written, in µs. The
/// drivers of TDK and of Linux wait for 4 µs.
const INDIRECT_WAIT_US: u32 = 10;

/// The buses over which a write is sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Bus {
    /// Both buses.
    Any,
    /// SPI only.
    Spi,
    /// I²C only.
    I2c,
}

/// One write of a start-up sequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Write {
    /// The address of the register.
    pub register: u8,
    /// The high byte of the address, for a register that is reached indirectly: see [`Write::indirect`].
    /// `None` for a register on the bus.
    pub page: Option<u8>,
    /// The value to write.
    pub value: u8,
    /// The bits that keep what they are. If there are any, the register is read first.
    pub kept: u8,
    /// The pause after the write, in µs, before the next access.
    pub wait_us: u32,
    /// The buses over which the write is sent. Over another bus it is left out.
    pub bus: Bus,
}

impl Write {
    /// Writes `value` over either bus, without a pause.
    pub const fn new(register: u8, value: u8) -> Self {
        Self {
            register,
            page: None,
            value,
            kept: 0,
            wait_us: 0,
            bus: Bus::Any,
        }
    }

    /// Writes a register behind the three registers of an indirect access: its 16-bit address goes to 0x7C and
    /// 0x7D, high byte first, and its value to 0x7E. So does the ICM-45686.
    pub const fn indirect(address: u16, value: u8) -> Self {
        let [page, register] = address.to_be_bytes();
        Self {
            page: Some(page),
            wait_us: INDIRECT_WAIT_US,
            ..Self::new(register, value)
        }
    }

    /// Keeps the bits that are set in `kept`.
    pub const fn keeping(self, kept: u8) -> Self {
        Self { kept, ..self }
    }

    /// Adds a pause of `wait_us` µs after the write.
    pub const fn wait_us(self, wait_us: u32) -> Self {
        Self { wait_us, ..self }
    }

    /// Restricts the write to SPI.
    pub const fn spi_only(self) -> Self {
        Self {
            bus: Bus::Spi,
            ..self
        }
    }

    /// Restricts the write to I²C.
    pub const fn i2c_only(self) -> Self {
        Self {
            bus: Bus::I2c,
            ..self
        }
    }

    /// Whether the write is sent over SPI, or over I²C.
    pub(super) const fn is_sent(&self, over_spi: bool) -> bool {
        match self.bus {
            Bus::Any => true,
            Bus::Spi => over_spi,
            Bus::I2c => !over_spi,
        }
    }

    /// The accesses to the bus that make the write.
    pub(super) const fn accesses(&self) -> &'static [Access] {
        use Access::{Gap, Low, Page, Pause, Read, Value};
        match (self.page.is_some(), self.kept != 0) {
            (false, false) => &[Value, Pause],
            (false, true) => &[Read, Value, Pause],
            (true, false) => &[Page, Low, Value, Pause],
            // A read moves the address on.
            (true, true) => &[Page, Low, Gap, Read, Page, Low, Value, Pause],
        }
    }

    /// The register on the bus that takes the value.
    pub(super) const fn target(&self) -> u8 {
        match self.page {
            Some(_) => Access::VALUE,
            None => self.register,
        }
    }

    /// The value to write if the register holds `old`.
    pub(super) const fn merged(&self, old: u8) -> u8 {
        old & self.kept | self.value & !self.kept
    }
}

/// One access of a write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Access {
    /// The high byte of the address is written.
    Page,
    /// The low byte of the address is written.
    Low,
    /// The pause before an indirect read.
    Gap,
    /// The value is read.
    Read,
    /// The value is written.
    Value,
    /// The pause after the write.
    Pause,
}

impl Access {
    /// The register that takes the high byte of an indirect address.
    pub(super) const PAGE: u8 = 0x7C;
    /// The register that takes the low byte of an indirect address.
    pub(super) const LOW: u8 = 0x7D;
    /// The register behind which the value lies.
    const VALUE: u8 = 0x7E;
    /// The pause before an indirect read, in µs.
    pub(super) const GAP_US: u32 = INDIRECT_WAIT_US;
}

/// A list of at most `N` writes, which constant functions can build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Writes<const N: usize> {
    writes: [Write; N],
    length: usize,
}

impl<const N: usize> Writes<N> {
    /// An empty list.
    pub const NONE: Self = Self {
        writes: [Write::new(0, 0); N],
        length: 0,
    };

    /// A list of the given writes. More than `N` of them are an error of compilation.
    pub const fn of<const LENGTH: usize>(given: [Write; LENGTH]) -> Self {
        const { assert!(LENGTH <= N, "too many writes for the list") };
        let mut writes = [Write::new(0, 0); N];
        let mut k = 0;
        while k < LENGTH && k < N {
            writes[k] = given[k];
            k += 1;
        }
        Self {
            writes,
            length: LENGTH,
        }
    }

    /// The writes.
    pub const fn as_slice(&self) -> &[Write] {
        match self.writes.as_slice().split_at_checked(self.length) {
            Some((used, _)) => used,
            None => &self.writes,
        }
    }
}
