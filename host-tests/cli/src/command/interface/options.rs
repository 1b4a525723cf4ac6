//! Options without a command.

use allanite_log::failure::Failure;
use clap::{Args, Command, Error};

/// Reads options that are written as on the command line.
///
/// # Errors
/// When an option is unknown or its value is not valid.
pub(super) fn parse<A: Args>(options: &[String]) -> Result<A, Failure> {
    let command = Command::new("allanite")
        .no_binary_name(true)
        .disable_help_flag(true);
    let matches = A::augment_args(command).try_get_matches_from(options);
    let parsed = matches.and_then(|matches| A::from_arg_matches(&matches));
    parsed.map_err(|error| refused(&error))
}

/// The failure in one line. The remedy is what clap says below its first line.
fn refused(error: &Error) -> Failure {
    let text = error.to_string();
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let what = lines.next().unwrap_or_default();
    let what = what.strip_prefix("error: ").unwrap_or(what);
    let mut remedies = lines.filter_map(|line| {
        let values = line.strip_prefix("[possible values: ");
        let values = values.and_then(|line| line.strip_suffix(']'));
        let tip = line.strip_prefix("tip: ").map(str::to_owned);
        values.map(|values| format!("choose from {values}")).or(tip)
    });
    let remedy = remedies.next();
    // A value that its type refuses says why behind a colon.
    match (remedy, what.rsplit_once("': ")) {
        (Some(remedy), _) => Failure::option(what, remedy),
        (None, Some((what, remedy))) => Failure::option(format!("{what}'"), remedy),
        (None, None) => Failure::option(what, "correct the option"),
    }
}

#[cfg(test)]
mod tests {
    use super::parse;
    use crate::command::input::record::LogArguments;

    fn refusal(option: &str) -> String {
        let parsed = parse::<LogArguments>(&[option.to_owned()]);
        parsed.expect_err(option).to_string()
    }

    #[test]
    fn options_are_read_as_on_the_command_line() {
        let options = ["--rate=100", "--unit=rad/s", "--columns=gx,gy=2"].map(str::to_owned);
        let options = parse::<LogArguments>(&options).expect("options").options();
        assert_eq!(options.rate_hz, Some(100.0));
        assert_eq!(options.columns.map(|columns| columns.len()), Some(2));
    }

    #[test]
    fn a_refusal_is_one_line_with_a_remedy() {
        for (option, what, remedy) in [
            ("--unit=mph", "'mph'", "choose from deg/s, rad/s"),
            ("--rate=fast", "'fast'", "invalid float literal"),
            ("--rat=1", "'--rat'", "a similar argument exists: '--rate'"),
        ] {
            let refusal = refusal(option);
            assert!(!refusal.contains('\n'), "{refusal}");
            let (found, advised) = refusal.rsplit_once("; ").expect("a remedy");
            assert!(
                found.contains(what) && advised.contains(remedy),
                "{refusal}"
            );
        }
    }
}
