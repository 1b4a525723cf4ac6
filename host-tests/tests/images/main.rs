//! The images in QEMU, the boards to copy, and the library for C.

mod c_interface;
mod check;
mod product;
mod thorough;
mod three_cores;
