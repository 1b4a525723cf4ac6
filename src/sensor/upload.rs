use super::{Write, Writes};

/// The number of bytes of a block.
pub(super) const BLOCK: usize = 32;

/// The largest number of bytes of an image: an address has 12 bits and counts words.
pub(super) const MAX_IMAGE: usize = 8192;

/// An image that a sensor needs at every start, such as the configuration file of the BMI270. It is written in blocks of 32
/// bytes after the identity was checked, and before the start-up writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Upload {
    /// The image, an even number of bytes, at most 8192.
    pub image: &'static [u8],
    /// The write that resets the sensor, because it takes an image only once. Over SPI the sensor is woken again
    /// afterwards.
    pub reset: Write,
    /// The writes before the first block.
    pub open: Writes<2>,
    /// The first of the two registers of a block's address, which counts words of two bytes. It takes the lowest four
    /// bits, and the register after it the eight above.
    pub address: u8,
    /// The register that takes the bytes of a block.
    pub data: u8,
    /// The pause after each address and each block, in µs.
    pub wait_us: u32,
    /// The write after the last block. Its pause lasts until the sensor has started with the image.
    pub close: Write,
    /// The register that shows whether the sensor has accepted the image.
    pub status: u8,
    /// The bits of that register which show it.
    pub mask: u8,
    /// What these bits say if the sensor has accepted the image.
    pub accepted: u8,
}

impl Upload {
    /// Whether the sensor can take the image and accept it.
    pub(super) const fn is_possible(&self) -> bool {
        let bytes = self.image.len();
        bytes != 0
            && bytes <= MAX_IMAGE
            && bytes.is_multiple_of(2)
            && self.accepted & !self.mask == 0
            && self.mask != 0
    }
}
