//! What the appliance's images have in common: the world that a reset leaves as it is, the sensor's FIFO, the
//! watchdog, and the log.

use allanite::{
    axis::Sample,
    queue::{self, Queued, Receiver, Sender},
};
use core::{fmt::Arguments, mem::MaybeUninit, ops::ControlFlow, str::FromStr};
use cortex_m::{
    peripheral::{SCB, SYST, syst::SystClkSource},
    singleton,
};
use defmt_semihosting as _;
use demonstration::appliance::{
    BUFFER, BURST, Failure, Gyro, GyroRecord, Plan, Progress, Recorder, Report, Source, Stored,
    World,
};
use heapless::spsc::Queue;

/// The timer's ticks from one burst of the FIFO to the next: 512 000 instructions in QEMU. A core of 64 million
/// instructions a second would get 1000 samples a second, ten times as many as the record has.
const INTERVAL: u32 = 12_800;

/// The size of the queue, which holds the samples of fifteen bursts.
const ROOM: usize = 128;

/// The number of operations of the flash in a pass. A piece of a look is long, so that with 32 operations and shorter
/// intervals of the timer a snapshot was not complete before the next one.
const OPERATIONS: u32 = 256;

/// Says that the memory holds a world.
const MARK: u64 = 0x616c_6c61_6e69_7465;

/// The sensor's FIFO, which hands its samples over in bursts.
pub(crate) struct Fifo {
    source: &'static mut Source,
    sender: Sender<'static, Sample<3, 1>>,
}

impl Fifo {
    /// Hands a burst over. The power may fail within it.
    pub(crate) fn burst(&mut self) {
        for _ in 0..BURST {
            let (sample, plan) = self.source.sample();
            if plan == Plan::Cut {
                SCB::sys_reset();
            }
            self.sender.send(sample);
        }
    }
}

/// The product apart from its FIFO and its watchdog.
pub(crate) struct Product {
    recorder: Recorder<'static>,
    stored: &'static mut Stored,
    receiver: Receiver<'static, Sample<3, 1>>,
}

/// Switches the product on.
pub(crate) fn switch_on() -> (Product, Fifo) {
    match try_switch_on() {
        Ok(Some(parts)) => parts,
        Ok(None) => {
            defmt::error!("the product was switched on twice, or without a seed");
            semihosting::process::exit(2)
        }
        Err(failure) => fail(failure),
    }
}

fn try_switch_on() -> Result<Option<(Product, Fifo)>, Failure> {
    let Some(world) = world() else {
        return Ok(None);
    };
    let memory = || {
        Some((
            singleton!(: Gyro = Gyro::new())?,
            singleton!(: [u8; BUFFER] = [0; BUFFER])?,
            singleton!(: Queue<Queued<Sample<3, 1>>, ROOM> = Queue::new())?,
        ))
    };
    let Some((gyro, buffer, queue)) = memory() else {
        return Ok(None);
    };
    let (sender, receiver) = queue::split(queue);
    let World { source, stored } = world;
    let (recorder, restart) = Recorder::switch_on(gyro, buffer, &stored.flash, source.made())?;
    log(format_args!("start {} {restart:?}", stored.starts));
    let product = Product {
        recorder,
        stored,
        receiver,
    };
    Ok(Some((product, Fifo { source, sender })))
}

/// The world, which is made when the board is switched on and which outlasts every reset. `None` if it was taken
/// before.
#[allow(unsafe_code)]
fn world() -> Option<&'static mut World> {
    /// The start-up code leaves this section as it is, and so does QEMU when it resets the board.
    #[unsafe(link_section = ".uninit.world")]
    static mut WORLD: MaybeUninit<(u64, World)> = MaybeUninit::uninit();

    singleton!(: () = ())?;
    let memory = &raw mut WORLD;
    // SAFETY: the singleton lets only one caller pass, who alone knows of this static. The mark is read as plain
    // bytes, which may have any value. It is written after the world, and QEMU's memory is zero at first.
    let world = unsafe {
        let memory = (*memory).as_mut_ptr();
        let mark = &raw mut (*memory).0;
        let world = &raw mut (*memory).1;
        if mark.read_volatile() != MARK {
            let mut new = World::new(argument(1)?);
            new.stored.undivided = argument(2).unwrap_or(false);
            world.write(new);
            mark.write_volatile(MARK);
        }
        &mut *world
    };
    if world.stored.starts > 0 {
        defmt::info!(
            "cut {} {}",
            defmt::Display2Format(&world.cut()),
            defmt::Debug2Format(&world.stored.counts)
        );
    }
    world.switch_on();
    Some(world)
}

/// An argument of the image. The first one is its name.
fn argument<T: FromStr>(index: usize) -> Option<T> {
    let arguments = semihosting::experimental::env::args::<64>().ok()?;
    (&arguments).nth(index)?.ok()?.parse().ok()
}

impl Product {
    /// Takes the samples that wait, and does a short piece of work.
    pub(crate) fn pass(&mut self) -> Progress {
        self.take();
        let mut progress = self.recorder.step();
        for _ in 0..OPERATIONS {
            // An operation of the flash cannot be divided, so that the power fails before or after it.
            let is_storing =
                critical_section::with(|_| self.recorder.store(&mut self.stored.flash));
            if !is_storing {
                break;
            }
            progress = Progress::Working;
        }
        progress
    }

    /// Takes the samples that wait.
    fn take(&mut self) {
        while let Some(queued) = self.receiver.receive() {
            if let Err(failure) = self.recorder.push(queued) {
                fail(failure);
            }
        }
        critical_section::with(|_| {
            self.stored.taken = self.recorder.taken();
            self.stored.counts = self.recorder.counts();
        });
    }

    /// The record of every axis, when the record is complete.
    pub(crate) fn records(&self) -> [GyroRecord; 3] {
        [0, 1, 2].map(|axis| {
            let records = self.recorder.record(axis);
            records.unwrap_or_else(|failure| fail(failure))
        })
    }
}

/// The product after the record.
pub(crate) struct Last<'p> {
    report: Report<'p>,
    stored: &'p mut Stored,
    receiver: &'p mut Receiver<'static, Sample<3, 1>>,
    /// The number of samples that were taken meanwhile, which belong to no record.
    meanwhile: u32,
    /// Whether the report and its diagnosis are done in one piece, which is longer than the watchdog permits. That is so
    /// after the first record, if the arguments say so.
    is_undivided: bool,
}

impl Product {
    /// Begins the report on the complete record.
    // Inlined, so that the diagnosis is built where it stays.
    #[inline(always)]
    pub(crate) fn finish<'p>(&'p mut self, records: &'p [GyroRecord; 3]) -> Last<'p> {
        Last {
            report: Report::new(self.recorder.gyro(), self.recorder.self_test(), records),
            is_undivided: core::mem::take(&mut self.stored.undivided),
            stored: self.stored,
            receiver: &mut self.receiver,
            meanwhile: 0,
        }
    }
}

impl Last<'_> {
    /// Does a part of the report. Between its pieces it takes the samples that wait, and feeds the watchdog.
    pub(crate) fn pass(&mut self, watchdog: &mut Watchdog) -> Progress {
        loop {
            // The lines before the diagnosis are fed too, so that the reset comes while it computes and not within a line.
            let is_fed = !(self.is_undivided && self.report.is_diagnosing());
            let mut pause = || {
                while let Some(queued) = self.receiver.receive() {
                    self.meanwhile += 1;
                    self.stored.counts.lost += queued.lost;
                }
                if is_fed {
                    watchdog.feed();
                }
                ControlFlow::Continue(())
            };
            let _ = pause();
            let progress = self.report.step(&mut log, &mut pause);
            let progress = progress.unwrap_or_else(|failure| fail(failure));
            if progress != Progress::Working || !self.is_undivided {
                return progress;
            }
        }
    }

    /// Logs what the watchdog saw, and ends the image.
    pub(crate) fn end(&self, watchdog: &Watchdog) -> ! {
        let (meanwhile, counts) = (self.meanwhile, self.stored.counts);
        log(format_args!("end meanwhile {meanwhile} {counts:?}"));
        log(format_args!(
            "longest {} of {}",
            watchdog.longest,
            Watchdog::TICKS
        ));
        semihosting::process::exit(0)
    }
}

/// Interrupts after each burst.
pub(crate) fn start_timer(mut timer: SYST) {
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(INTERVAL - 1);
    timer.clear_current();
    timer.enable_interrupt();
    timer.enable_counter();
}

/// The board's watchdog. When it was not fed in time, it raises the NMI, whose handler waits. When it was not fed
/// for as long again, it resets the board.
///
/// Arm CMSDK APB watchdog (DDI 0479, section 4.5), at the address of Application Note AN386. The section was
/// not verified; the registers agree with QEMU's model `cmsdk-apb-watchdog`.
pub(crate) struct Watchdog {
    longest: u32,
}

#[allow(unsafe_code)]
impl Watchdog {
    /// The ticks of the 25 MHz clock from a feed to the NMI. A tick lasts 40 instructions in QEMU.
    const TICKS: u32 = 125_000;

    const BASE: usize = 0x4000_8000;
    const LOAD: usize = Self::BASE;
    const VALUE: usize = Self::BASE + 4;
    /// Bit 0 starts the counter and enables the interrupt, and bit 1 enables the reset.
    const CONTROL: usize = Self::BASE + 8;
    const CLEAR_INTERRUPT: usize = Self::BASE + 12;

    /// Starts the watchdog.
    pub(crate) fn start() -> Self {
        Self::write(Self::LOAD, Self::TICKS);
        Self::write(Self::CONTROL, 0b11);
        Self { longest: 0 }
    }

    /// Feeds the watchdog.
    pub(crate) fn feed(&mut self) {
        // SAFETY: the boards with this watchdog let it be read at any time.
        let left = unsafe { (Self::VALUE as *const u32).read_volatile() };
        self.longest = self.longest.max(Self::TICKS.saturating_sub(left));
        Self::write(Self::CLEAR_INTERRUPT, 1);
    }

    fn write(register: usize, value: u32) {
        // SAFETY: only this type writes to the watchdog, and its registers are whole words.
        unsafe { (register as *mut u32).write_volatile(value) };
    }
}

fn log(line: Arguments<'_>) {
    defmt::info!("{}", defmt::Display2Format(&line));
}

fn fail(failure: Failure) -> ! {
    defmt::error!("the product stopped: {}", defmt::Debug2Format(&failure));
    semihosting::process::exit(1)
}
