//! The images on every core, in QEMU, and the library for C.

mod c_interface;
mod every_core;
mod product;
