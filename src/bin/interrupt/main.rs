//! An image in which samples pass from an interrupt to the main loop, and every lost sample is reported.
//!
//! A timer takes the place of the sensor's data-ready interrupt. It makes a sample of the simulated gyro and
//! puts it into the queue. Some reads fail, and now and then the main loop is late, so that the queue
//! overflows. Every loss becomes a gap of the record and is logged with its place, so that a host can
//! repeat the record. The exit status tells whether the taken and the lost samples add up to all samples.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod timer;

#[cfg(target_os = "none")]
mod image {
    use allanite::queue::{self, Queued, Receiver, Sender};
    use allanite::{Axis, Scale};
    use core::cell::RefCell;
    #[cfg(target_arch = "arm")]
    use cortex_m::singleton;
    use critical_section::Mutex;
    use defmt_semihosting as _;
    use demonstration::{AMPLITUDES, lines, simulated::SimulatedGyro};
    use heapless::spsc::Queue;
    #[cfg(target_arch = "riscv32")]
    use riscv::singleton;

    const OCTAVES: usize = 12;
    const SEED: u64 = 1024;
    /// The number of samples that the sensor makes.
    const SAMPLES: u32 = 1 << 14;
    /// The timer's ticks per sample: 10 000 to 30 000 instructions in QEMU.
    #[cfg(target_arch = "arm")]
    const INTERVAL: u32 = 400;
    #[cfg(target_arch = "riscv32")]
    const INTERVAL: u32 = 200;
    /// The interrupt fails to read one sample in this many.
    const FAILS: u32 = 3000;
    /// The size of the queue, which has room for fifteen samples.
    const ROOM: usize = 16;
    /// The delays of the main loop: the number of samples that it has taken by then, and the number of
    /// samples that are made before it takes the next one. The last delay lasts to the end of the record.
    const LATE: [(u32, u32); 4] = [(1000, 40), (1200, 15), (5000, 500), (15_700, SAMPLES)];

    /// The state that the interrupt uses.
    struct Sensor {
        gyro: SimulatedGyro,
        sender: Sender<'static, i32>,
        made: u32,
    }

    static SENSOR: Mutex<RefCell<Option<Sensor>>> = Mutex::new(RefCell::new(None));

    /// Handles the interrupt that says that a sample is ready.
    pub(crate) fn ready() {
        with_sensor(|sensor| {
            if sensor.made == SAMPLES {
                return;
            }
            sensor.made += 1;
            match sensor.gyro.next() {
                Some(count) if !sensor.made.is_multiple_of(FAILS) => {
                    sensor.sender.send(count);
                }
                _ => sensor.sender.missed(1),
            }
        });
    }

    fn with_sensor<R: Default>(work: impl FnOnce(&mut Sensor) -> R) -> R {
        critical_section::with(|section| {
            let mut sensor = SENSOR.borrow_ref_mut(section);
            sensor.as_mut().map(work).unwrap_or_default()
        })
    }

    fn made() -> u32 {
        with_sensor(|sensor| sensor.made)
    }

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        let Some(queue) = singleton!(: Queue<Queued<i32>, ROOM> = Queue::new()) else {
            semihosting::process::exit(1);
        };
        let (sender, receiver) = queue::split(queue);
        let gyro = SimulatedGyro::new(AMPLITUDES, SEED);
        let sensor = Sensor {
            gyro,
            sender,
            made: 0,
        };
        critical_section::with(|section| SENSOR.replace(section, Some(sensor)));
        crate::timer::start(INTERVAL);
        semihosting::process::exit(i32::from(!take_all(receiver)))
    }

    /// Runs the main loop, and returns whether every sample that was made is accounted for.
    fn take_all(mut receiver: Receiver<'static, i32>) -> bool {
        let mut gyro = Axis::<OCTAVES, 0, (), ()>::new();
        let mut late = LATE.iter().copied();
        let mut next_late = late.next();
        let mut taken = 0;
        defmt::info!("record seed {=u64} octaves {=usize}", SEED, OCTAVES);
        loop {
            // The end is read before the queue, so that the last sample is in the queue if the end is seen.
            let end = made() == SAMPLES;
            let Some(Queued { sample, lost }) = receiver.receive() else {
                if end {
                    break;
                }
                continue;
            };
            if lost > 0 {
                gyro.lost(lost.into());
                defmt::info!("gap after {=u32} taken, lost {=u32}", taken, lost);
            }
            gyro.push(sample);
            taken += 1;
            if let Some((_, more)) = next_late.filter(|&(when, _)| when == taken) {
                next_late = late.next();
                let until = made().saturating_add(more).min(SAMPLES);
                while made() < until {}
            }
        }
        let untold = with_sensor(|sensor| sensor.sender.untold());
        let lost = receiver.lost() + u64::from(untold);
        defmt::info!(
            "total made {=u32} taken {=u32} lost {=u64}",
            made(),
            taken,
            lost
        );
        let Ok(scale) = Scale::new(1.0 / 131.0, 100.0) else {
            return false;
        };
        let [accumulator] = gyro.accumulators();
        lines::curve(&accumulator.curve(scale), |line| {
            defmt::info!("{}", defmt::Display2Format(&line));
        });
        accumulator.samples() == u64::from(taken) && u64::from(taken) + lost == u64::from(made())
    }

    #[panic_handler]
    fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
        defmt::error!("{}", defmt::Display2Format(info));
        semihosting::process::exit(101)
    }
}
