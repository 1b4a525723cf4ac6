//! The images on every core, in QEMU, the boards to copy, and the library for C.

mod boards;
mod c_interface;
mod every_core;
mod product;
