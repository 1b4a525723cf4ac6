//! An image in which a fast timer sends numbered samples at any instruction of the main loop that receives them.
//!
//! The main loop never disables the interrupt, so that it comes between any two instructions of the queue. Work of
//! varying length makes the queue empty, full, and anything in between. Every sample must come in its order, or be
//! counted as lost at its place. The exit status tells whether that holds.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
#[path = "../interrupt/timer.rs"]
mod timer;

#[cfg(target_os = "none")]
mod image {
    use allanite::queue::{self, Queued, Receiver, Sender};
    use core::cell::RefCell;
    use core::hint::black_box;
    use core::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};
    #[cfg(target_arch = "arm")]
    use cortex_m::singleton;
    use critical_section::Mutex;
    use defmt_semihosting as _;
    use heapless::spsc::Queue;
    #[cfg(target_arch = "riscv32")]
    use riscv::singleton;

    /// The number of samples.
    const SAMPLES: u32 = 200_000;
    /// The interrupt itself misses one sample in this many.
    const FAILS: u32 = 1009;
    /// The size of the queue, which has room for three samples.
    const ROOM: usize = 4;
    /// The timer's ticks per sample: a hundred to a few hundred instructions in QEMU.
    #[cfg(target_arch = "arm")]
    const INTERVAL: u32 = 7;
    #[cfg(target_arch = "riscv32")]
    const INTERVAL: u32 = 4;

    static SENDER: Mutex<RefCell<Option<Sender<'static, u32>>>> = Mutex::new(RefCell::new(None));
    /// The number of samples that were made.
    static MADE: AtomicU32 = AtomicU32::new(0);
    /// Whether the main loop is receiving.
    static RECEIVING: AtomicBool = AtomicBool::new(false);
    /// The number of samples that were made while it was.
    static AMID: AtomicU32 = AtomicU32::new(0);

    /// Handles the interrupt that says that a sample is ready.
    pub(crate) fn ready() {
        let sample = MADE.load(Relaxed);
        if sample == SAMPLES {
            return;
        }
        if RECEIVING.load(Relaxed) {
            AMID.store(AMID.load(Relaxed) + 1, Relaxed);
        }
        with_sender(|sender| {
            if sample % FAILS == 1 {
                sender.missed(1);
            } else {
                sender.send(sample);
            }
        });
        MADE.store(sample + 1, Relaxed);
    }

    fn with_sender<R: Default>(work: impl FnOnce(&mut Sender<'static, u32>) -> R) -> R {
        critical_section::with(|section| {
            let mut sender = SENDER.borrow_ref_mut(section);
            sender.as_mut().map(work).unwrap_or_default()
        })
    }

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        let Some(queue) = singleton!(: Queue<Queued<u32>, ROOM> = Queue::new()) else {
            semihosting::process::exit(1);
        };
        let (sender, receiver) = queue::split(queue);
        critical_section::with(|section| SENDER.replace(section, Some(sender)));
        crate::timer::start(INTERVAL);
        semihosting::process::exit(i32::from(!take_all(receiver)))
    }

    /// Runs the main loop, and returns whether every sample is accounted for at its place.
    fn take_all(mut receiver: Receiver<'static, u32>) -> bool {
        let (mut next, mut taken, mut gaps, mut empty) = (0, 0_u32, 0_u32, 0_u32);
        let mut random = 1_u32;
        loop {
            // The end is read before the queue, so that the last sample is in the queue if the end is seen.
            let end = MADE.load(Relaxed) == SAMPLES;
            RECEIVING.store(true, Relaxed);
            let received = receiver.receive();
            RECEIVING.store(false, Relaxed);
            let Some(Queued { sample, lost }) = received else {
                if end {
                    break;
                }
                empty += 1;
                continue;
            };
            if sample != next + lost {
                defmt::error!("sample {=u32} came after {=u32}", sample, next);
                return false;
            }
            next = sample + 1;
            taken += 1;
            gaps += u32::from(lost > 0);
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            // Mostly a little work, and now and then so much that the queue overflows, on a fast core too.
            let work = match random >> 28 {
                0..8 => random >> 20 & 0x3F,
                _ => random >> 20 & 7,
            };
            for step in 0..work {
                black_box(step);
            }
            if random >> 28 == 15 {
                let until = SAMPLES.min(MADE.load(Relaxed) + (random >> 20 & 7));
                while MADE.load(Relaxed) < until {
                    core::hint::spin_loop();
                }
            }
        }
        let untold = with_sender(|sender| sender.untold());
        let lost = receiver.lost() + u64::from(untold);
        defmt::info!(
            "total made {=u32} taken {=u32} lost {=u64} gaps {=u32} empty {=u32} amid {=u32}",
            MADE.load(Relaxed),
            taken,
            lost,
            gaps,
            empty,
            AMID.load(Relaxed)
        );
        next + untold == SAMPLES && u64::from(taken) + lost == u64::from(SAMPLES)
    }

    #[panic_handler]
    fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
        defmt::error!("{}", defmt::Display2Format(info));
        semihosting::process::exit(101)
    }
}
