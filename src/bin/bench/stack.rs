//! Stack that a call uses, by painting it beforehand.

#![allow(unsafe_code)]

use core::ptr;

/// The most that is painted, and the word that it is painted with.
const MOST: usize = 256 * 1024;
const PAINT: u32 = 0x5AFE_57AC;

unsafe extern "C" {
    /// Where the static data end: cortex-m-rt and riscv-rt name it alike.
    static __sheap: u32;
}

/// Bytes of stack below this function's own that `work` uses.
#[inline(never)]
pub(crate) fn used_by(work: impl FnOnce()) -> usize {
    // An interrupt in between would put its frame there too.
    critical_section::with(|_| {
        let top = pointer() & !3;
        let end_of_data = &raw const __sheap as usize;
        let bottom = end_of_data.max(top.saturating_sub(MOST));
        let mut address = bottom;
        while address < top {
            // SAFETY: RAM between the static data and the stack pointer is nobody's, and this loop
            // calls nothing.
            unsafe { ptr::write_volatile(address as *mut u32, PAINT) };
            address += 4;
        }
        work();
        let mut intact = bottom;
        // SAFETY: the words painted above.
        while intact < top && unsafe { ptr::read_volatile(intact as *const u32) } == PAINT {
            intact += 4;
        }
        top - intact
    })
}

/// The stack pointer.
#[inline(always)]
fn pointer() -> usize {
    let pointer;
    // SAFETY: reads a register.
    unsafe {
        #[cfg(target_arch = "arm")]
        core::arch::asm!("mov {}, sp", out(reg) pointer, options(nomem, nostack));
        #[cfg(target_arch = "riscv32")]
        core::arch::asm!("mv {}, sp", out(reg) pointer, options(nomem, nostack));
    }
    pointer
}
