//! The product without interrupts: it is cut where another run of it was cut, and does the same.

use super::{Cut, Failure, Gyro, Progress, Recorder, Report, SAMPLES, World};
use allanite::queue::Queued;
use core::{fmt::Arguments, ops::ControlFlow};

/// Runs the product of a seed with these power cuts, and prints a line for each start and the report.
///
/// # Errors
/// [`Failure`].
pub fn replay(
    seed: u64,
    cuts: &[Cut],
    gyro: &mut Gyro,
    buffer: &mut [u8],
    mut line: impl FnMut(Arguments<'_>),
) -> Result<(), Failure> {
    let mut world = World::new(seed);
    let mut cuts = cuts.iter();
    loop {
        world.switch_on();
        let World { source, stored } = &mut world;
        let (mut recorder, restart) =
            Recorder::switch_on(gyro, buffer, &stored.flash, source.made())?;
        line(format_args!("start {} {restart:?}", stored.starts));
        let cut = cuts.next().copied();
        let end = cut.map_or(SAMPLES, |cut| cut.taken);
        let last = cut.map_or(u32::MAX, |cut| cut.operations);
        loop {
            while recorder.step() == Progress::Working {}
            while stored.flash.operations() < last && recorder.store(&mut stored.flash) {}
            if recorder.taken() >= end {
                break;
            }
            let (sample, _) = source.sample();
            recorder.push(Queued { sample, lost: 0 })?;
        }
        let Some(cut) = cut else {
            let records = [
                recorder.record(0)?,
                recorder.record(1)?,
                recorder.record(2)?,
            ];
            let mut report = Report::new(recorder.gyro(), recorder.self_test(), &records);
            let mut pause = || ControlFlow::Continue(());
            while report.step(&mut line, &mut pause)? == Progress::Working {}
            return Ok(());
        };
        while source.made() < cut.made {
            source.sample();
        }
    }
}
