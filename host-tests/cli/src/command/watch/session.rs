//! The session of `watch`: reads, accumulates, shows and saves a recording.
//!
//! A thread reads the input, and a second one accumulates and saves it. The main thread at intervals fits and shows what
//! is recorded. At the end of the input, and on SIGINT (Ctrl-C), SIGTERM, SIGQUIT or SIGHUP, everything that has been read
//! is accumulated, the curve is saved and the last fit is printed. The curve is also saved at intervals, each time as a
//! complete file.

use super::{
    arguments::Arguments,
    diagnosis::{Diagnoser, Found},
    recorder::{Flags, Recorder},
    recording::{Numbers, Recording},
    saving::Saving,
    screen::Screen,
    signals,
    source::Source,
    status::Status,
};
use crate::command::{
    input::record,
    output::{file::OutputFile, progress},
};
use allanite_host::{curve_file::AxisCurve, fit};
use allanite_log::failure::{Failure, Place, plural, report};
use console::Term;
use std::{
    io::Write,
    time::{Duration, Instant},
};

/// Longest wait before the clock is checked. Chosen by hand.
const MOMENT: Duration = Duration::from_millis(50);

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
        None => Source::StandardInput,
    };
    let flags = Flags::default();
    signals::catch(&flags).map_err(|error| {
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
        None => "standard input",
    };
    let saving = Saving::new(arguments.output.clone());
    let recorder = Recorder::start(recording, received, saving, save_every, flags);
    let recorder = recorder.map_err(|error| {
        Failure::option(
            format!("no thread can be started: {error}"),
            "end other programs",
        )
    })?;
    let mut watch = Watch {
        recorder,
        place,
        announced: None,
        diagnoser: Diagnoser::new(diagnose_every),
        screen,
    };
    let every = if watch.screen.is_some() {
        FRAME
    } else {
        print_every
    };
    let shown = watch.follow(every, output);
    // Whatever the terminal does, the samples received so far are saved before it is restored.
    let ended = watch.recorder.end();
    watch.screen = None;
    // Whatever failed, the fit is printed, because nothing else may be left of the record. The failure
    // is told last.
    let finished = watch.finish(output);
    shown?;
    if let Some(ended) = ended {
        ended.received?;
        ended.saved?;
    }
    finished
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
    recorder: Recorder,
    /// Where the samples come from.
    place: &'a str,
    /// The trouble with saving that was told last.
    announced: Option<String>,
    diagnoser: Diagnoser,
    screen: Option<Screen>,
}

impl Watch<'_> {
    /// Shows the recording until it ends.
    fn follow(&mut self, show_every: Duration, output: &mut impl Write) -> Result<(), Failure> {
        let mut shown = Instant::now();
        while !self.recorder.has_ended_within(MOMENT) {
            self.announce();
            let recorder = &self.recorder;
            self.diagnoser
                .advance(|| recorder.recording().curves().ok().flatten());
            if shown.elapsed() >= show_every {
                self.show(output)?;
                shown = Instant::now();
            }
        }
        Ok(())
    }

    /// Tells trouble with saving when it begins, if there is no screen, which shows it all the time.
    fn announce(&mut self) {
        let trouble = self.recorder.saving().trouble().map(String::from);
        if let (Some(trouble), None, None) = (&trouble, &self.announced, &self.screen) {
            report(format_args!("not saved: {trouble}"));
        }
        self.announced = trouble;
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
        let saving = self.recorder.saving().sentence();
        Status::of(self.recorder.snapshot(), &self.diagnoser, saving)
    }

    /// Prints the last fit in the form of `fit`, and what a diagnosis says of the whole recording.
    fn finish(&self, output: &mut impl Write) -> Result<(), Failure> {
        let recording = self.recorder.recording();
        if recording.curves()?.is_none() {
            return Err(Failure::option(
                format!(
                    "{}: received {} and {}, but a curve needs 9 samples",
                    self.place,
                    plural(recording.samples(), "sample"),
                    plural(recording.garbled(), "invalid line")
                ),
                recording.remedy().unwrap_or_else(|| {
                    "record longer, and check that each line has one whole number for each axis"
                        .into()
                }),
            ));
        }
        // The status locks the recording too.
        drop(recording);
        let status = self.status();
        let recording = self.recorder.recording();
        if recording.garbled() > 0 && !progress::is_quiet() {
            report(status.losses());
            if let Some(remedy) = recording.remedy() {
                report(remedy);
            }
        }
        if recording.is_unfinished() && !progress::is_quiet() {
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
        let is_fitted =
            |axis: &AxisCurve| fitted.iter().any(|fitted| fitted.axis.axis == axis.axis);
        let found: Vec<Found> = recording
            .curves()?
            .into_iter()
            .flatten()
            .filter(|(axis, _)| is_fitted(axis))
            .filter_map(Found::of)
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
