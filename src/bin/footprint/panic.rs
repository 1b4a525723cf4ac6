//! The panic handler of the images whose size is measured.

/// The linker leaves this function out of an image in which nothing can panic. Therefore an image without
/// this symbol has no path to a panic. The function must not be inlined, or the symbol would be missing.
#[inline(never)]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    semihosting::process::exit(101)
}
