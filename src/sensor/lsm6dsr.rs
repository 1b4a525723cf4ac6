use super::{
    Configuration, ConfigurationError, Description, configuration::checked, lsm6dso::family,
};

/// The description of an LSM6DSR with another configuration than that of [`LSM6DSR`]: the rates, ranges and watermarks of
/// the [LSM6DSO](super::lsm6dso()). Its own range of 4000 °/s is not described.
///
/// # Errors
/// [`ConfigurationError`] for all else.
pub const fn lsm6dsr(wanted: Configuration) -> Result<Description, ConfigurationError> {
    family("LSM6DSR", &[0x6B], wanted)
}

/// ST LSM6DSR, ±250 °/s at 104 Hz in high-performance mode, behind the low pass LPF2 at 33 Hz. The LSM6DSRX and the
/// ISM330DHCX have the same identity.
///
/// Registers and words of the FIFO are those of the [`LSM6DSO`](super::LSM6DSO): Linux' `st_lsm6dsx_core.c` describes both by
/// one table, and ST's lsm6dsr-pid has the same codes as its lsm6dso-pid:
///
/// | register | value | public drivers |
/// |---|---|---|
/// | WHO_AM_I 0x0F | 0x6B | the same: Linux, ST's lsm6dsr-pid |
/// | CTRL3_C 0x12 | 0x01, then 0x44 | the same bits: ST's lsm6dsr-pid |
/// | CTRL2_G 0x11 | 0x40 | the same codes: Linux, ST's lsm6dsr-pid; its lowest bit, FS_4000, stays 0 |
///
/// Not verified: the data sheet was not at hand. That the cut-offs of LPF2 are those of the LSM6DSO follows from the common
/// table only.
pub static LSM6DSR: Description = checked(lsm6dsr(Configuration::new(104, 250)));
