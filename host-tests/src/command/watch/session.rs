//! The session of `watch`: reads, accumulates, shows and saves a recording.
//!
//! A thread reads the input. The main thread accumulates it and at intervals fits and shows it. At the
//! end of the input, and on SIGINT (Ctrl-C) or SIGTERM, everything that has been read is accumulated,
//! the curve is saved and the last fit is printed. The curve is also saved at intervals, each time as a
//! complete file.

use super::{
    arguments::Arguments,
    diagnosis::{Diagnoser, Found},
    recording::{Numbers, Recording},
    screen::Screen,
    source::{Received, Source},
    status::Status,
};
use crate::{
    command::{
        fit,
        input::record,
        output::{file::OutputFile, progress},
    },
    curve_file::CurveFile,
    failure::{Failure, Place, one_line, plural, report},
};
use console::Term;
use std::{
    io::{self, Write},
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering::Relaxed},
        mpsc::{Receiver, RecvTimeoutError},
    },
    time::{Duration, Instant},
};

/// Longest wait for input before signals and the clock are checked. Chosen by hand.
const MOMENT: Duration = Duration::from_millis(50);

/// After an interruption, input that arrives without a longer pause counts as received before it.
/// Chosen by hand.
const PAUSE: Duration = Duration::from_millis(20);
/// After an interruption, a source that never pauses is read for this long at most. Chosen by hand.
const PATIENCE: Duration = Duration::from_millis(500);

/// Time from one drawing of the screen to the next. Chosen by hand.
const FRAME: Duration = Duration::from_millis(1000);

/// Runs the command.
pub(in crate::command) fn run(
    arguments: &Arguments,
    output: &mut impl Write,
) -> Result<(), Failure> {
    let save_every = seconds("--save-every", arguments.save_every)?;
    let print_every = seconds("--print-every", arguments.print_every)?;
    let diagnose_every = seconds("--diagnose-every", arguments.diagnose_every)?;
    if let Some(path) = &arguments.output {
        if !record::is_curve(path) {
            return Err(
                Place::file(path).failure("a curve file must end in .json", "rename the output")
            );
        }
        // The file is dropped at once: an output that cannot be written is refused before hours of
        // recording.
        drop(OutputFile::create(path, [])?);
    }
    let Arguments { rate, unit, .. } = *arguments;
    let scale = arguments.scale.unwrap_or(1.0);
    let numbers = if arguments.decimals {
        Numbers::Rates
    } else {
        Numbers::Counts
    };
    let recording = Recording::new(rate, scale, numbers, unit, arguments.axes.clone())?;
    let source = match &arguments.port {
        Some(port) => Source::SerialPort {
            port: port.clone(),
            baud: arguments.baud,
        },
        None if arguments.image => Source::Image,
        None => Source::StandardInput,
    };
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = interrupted.clone();
    ctrlc::set_handler(move || flag.store(true, Relaxed)).map_err(|error| {
        Failure::option(
            format!("interruptions cannot be caught: {error}"),
            "start the program in another environment",
        )
    })?;
    let received = source.listen()?;
    let screen = if Term::stdout().is_term() && !progress::is_quiet() {
        Some(Screen::open().map_err(|error| Failure::standard_output(&error))?)
    } else {
        None
    };
    let place = match &arguments.port {
        Some(port) => port,
        None if arguments.image => "the image",
        None => "standard input",
    };
    let mut watch = Watch {
        recording,
        place,
        received,
        interrupted,
        path: arguments.output.as_deref(),
        saved: None,
        trouble: None,
        diagnoser: Diagnoser::new(diagnose_every),
        screen,
    };
    let every = if watch.screen.is_some() {
        FRAME
    } else {
        print_every
    };
    let ended = watch.follow(every, save_every, output);
    // Even after a failure the terminal is restored and the samples received so far are saved.
    watch.screen = None;
    if ended.as_ref().is_ok_and(|ended| *ended == Ended::Input) {
        watch.recording.end();
    }
    // Whatever failed, the fit is printed, because nothing else may be left of the record. The failure
    // is told last.
    let saved = watch.save();
    watch.trouble = saved.as_ref().err().map(Failure::to_string);
    let finished = watch.finish(output);
    ended?;
    saved?;
    finished
}

/// What ended a recording.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ended {
    Input,
    Interruption,
}

/// The length of time that an option gives in seconds.
///
/// # Errors
/// When the value is not a positive number of seconds.
fn seconds(option: &str, value: f64) -> Result<Duration, Failure> {
    let valid = Duration::try_from_secs_f64(value).ok();
    valid.filter(|time| !time.is_zero()).ok_or_else(|| {
        Failure::option(
            format!("{option} {value} is impossible"),
            "give a positive number of seconds",
        )
    })
}

/// The state of a session.
struct Watch<'a> {
    recording: Recording,
    /// Where the samples come from.
    place: &'a str,
    received: Receiver<Received>,
    interrupted: Arc<AtomicBool>,
    path: Option<&'a Path>,
    saved: Option<Instant>,
    /// The message of the last saving, if it failed.
    trouble: Option<String>,
    diagnoser: Diagnoser,
    screen: Option<Screen>,
}

impl Watch<'_> {
    /// Records and shows until the input ends or the user interrupts.
    fn follow(
        &mut self,
        show_every: Duration,
        save_every: Duration,
        output: &mut impl Write,
    ) -> Result<Ended, Failure> {
        let (mut shown, mut saved) = (Instant::now(), Instant::now());
        loop {
            let ended = self.receive(MOMENT)?;
            if self.interrupted.load(Relaxed) {
                self.drain()?;
                return Ok(Ended::Interruption);
            }
            if ended {
                return Ok(Ended::Input);
            }
            if saved.elapsed() >= save_every {
                let trouble = self.save().err().map(|failure| failure.to_string());
                self.announce(trouble);
                saved = Instant::now();
            }
            let recording = &self.recording;
            self.diagnoser.advance(|| recording.curves().ok().flatten());
            if shown.elapsed() >= show_every {
                self.show(output)?;
                shown = Instant::now();
            }
        }
    }

    /// Keeps the trouble with saving for the screen. Without a screen, trouble is told when it begins.
    fn announce(&mut self, trouble: Option<String>) {
        if let (Some(trouble), None, None) = (&trouble, &self.trouble, &self.screen) {
            report(format_args!("not saved: {trouble}"));
        }
        self.trouble = trouble;
    }

    /// Takes the next bytes, if they arrive within this time. Returns true when the input has ended.
    fn receive(&mut self, time: Duration) -> Result<bool, Failure> {
        match self.received.recv_timeout(time) {
            Ok(Received::Bytes(bytes)) => {
                self.recording.take(&bytes);
                Ok(false)
            }
            Ok(Received::Failure(failure)) => Err(failure),
            Err(RecvTimeoutError::Timeout) => Ok(false),
            Err(RecvTimeoutError::Disconnected) => Ok(true),
        }
    }

    /// Takes the bytes that had arrived before the interruption.
    fn drain(&mut self) -> Result<(), Failure> {
        let begun = Instant::now();
        while begun.elapsed() < PATIENCE {
            match self.received.recv_timeout(PAUSE) {
                Ok(Received::Bytes(bytes)) => self.recording.take(&bytes),
                Ok(Received::Failure(failure)) => return Err(failure),
                Err(_) => break,
            }
        }
        Ok(())
    }

    fn show(&mut self, output: &mut impl Write) -> Result<(), Failure> {
        let status = self.status();
        let shown = match &mut self.screen {
            Some(screen) => screen.draw(&status),
            None => writeln!(output, "{}", status.line()).and_then(|()| output.flush()),
        };
        shown.map_err(|error| Failure::standard_output(&error))
    }

    fn status(&self) -> Status {
        let saving = match (&self.trouble, self.path, self.saved) {
            (Some(trouble), ..) => format!("not saved: {trouble}"),
            (None, None, _) => "not saved: --output was not given".into(),
            (None, Some(path), None) => format!("{} is not saved yet", path.display()),
            (None, Some(path), Some(at)) => {
                format!(
                    "{} was saved {} s ago",
                    path.display(),
                    at.elapsed().as_secs()
                )
            }
        };
        Status::of(&self.recording, &self.diagnoser, one_line(&saving))
    }

    /// Saves the curve as a complete file, if there is an output and the record is long enough.
    fn save(&mut self) -> Result<(), Failure> {
        let Some(path) = self.path else {
            return Ok(());
        };
        // The record is still too short for a curve. If it stays so, `finish` reports that.
        let Some(curves) = self.recording.curves()? else {
            return Ok(());
        };
        let fail = |error: io::Error| Place::file(path).io(&error);
        let json = CurveFile::new(curves).to_json();
        let json = json.map_err(|error| fail(error.into()))?;
        let mut file = OutputFile::create(path, [])?;
        file.write_all(json.as_bytes()).map_err(fail)?;
        file.commit()?;
        self.saved = Some(Instant::now());
        Ok(())
    }

    /// Prints the last fit in the form of `fit`, and what a diagnosis says of the whole recording.
    fn finish(&self, output: &mut impl Write) -> Result<(), Failure> {
        if self.recording.curves()?.is_none() {
            return Err(Failure::option(
                format!(
                    "{}: received {} and {}, but a curve needs 9 samples",
                    self.place,
                    plural(self.recording.samples(), "sample"),
                    plural(self.recording.garbled(), "invalid line")
                ),
                self.recording.remedy().unwrap_or_else(|| {
                    "record longer, and check that each line has one whole number for each axis"
                        .into()
                }),
            ));
        }
        let status = self.status();
        if self.recording.garbled() > 0 && !progress::is_quiet() {
            report(status.losses());
            if let Some(remedy) = self.recording.remedy() {
                report(remedy);
            }
        }
        if self.recording.is_unfinished() && !progress::is_quiet() {
            report("the last line has no line end: it may be cut off");
        }
        let unfitted: Vec<String> = status
            .axes
            .iter()
            .filter_map(|axis| Some(format!("axis {}: {}", axis.name, axis.why.as_ref()?)))
            .collect();
        let fitted: Vec<_> = status
            .axes
            .into_iter()
            .filter_map(|axis| axis.fitted)
            .collect();
        let found: Vec<Found> = fitted
            .iter()
            .filter_map(|fitted| Found::of(fitted.axis.clone()))
            .collect();
        fit::table::print(&fitted, output)
            .and_then(|()| writeln!(output))
            .and_then(|()| {
                found
                    .iter()
                    .try_for_each(|found| writeln!(output, "{}: {}", found.axis, found.sentence))
            })
            .and_then(|()| output.flush())
            .map_err(|error| Failure::standard_output(&error))?;
        // An axis whose values never change has no fit.
        if unfitted.is_empty() {
            Ok(())
        } else {
            Err(Failure::option(
                format!("{}: no fit: {}", self.place, unfitted.join("; ")),
                "check the sensor and the scale",
            ))
        }
    }
}
