//! Measures the stack that a call uses, by painting the stack beforehand.

#![allow(unsafe_code)]

use core::ptr;

/// The largest number of bytes that are painted.
const MOST: usize = 256 * 1024;
/// The word that they are painted with.
const PAINT: u32 = 0x5AFE_57AC;

unsafe extern "C" {
    /// The end of the static data. Both cortex-m-rt and riscv-rt give it this name.
    static __sheap: u32;
}

/// The number of bytes of stack that `work` uses below the frame of this function.
#[inline(never)]
pub(crate) fn used_by(work: impl FnOnce()) -> usize {
    // An interrupt during the measurement would put its frame on the same stack.
    critical_section::with(|_| {
        let top = pointer() & !3;
        let end_of_data = &raw const __sheap as usize;
        let bottom = end_of_data.max(top.saturating_sub(MOST));
        let mut address = bottom;
        while address < top {
            // SAFETY: nothing uses the RAM between the static data and the stack pointer, and this loop
            // makes no calls.
            unsafe { ptr::write_volatile(address as *mut u32, PAINT) };
            address += 4;
        }
        work();
        let mut intact = bottom;
        // SAFETY: these words were painted above.
        while intact < top && unsafe { ptr::read_volatile(intact as *const u32) } == PAINT {
            intact += 4;
        }
        top - intact
    })
}

/// The value of the stack pointer.
#[inline(always)]
fn pointer() -> usize {
    let pointer;
    // SAFETY: the instruction only reads a register.
    unsafe {
        #[cfg(target_arch = "arm")]
        core::arch::asm!("mov {}, sp", out(reg) pointer, options(nomem, nostack));
        #[cfg(target_arch = "riscv32")]
        core::arch::asm!("mv {}, sp", out(reg) pointer, options(nomem, nostack));
    }
    pointer
}
