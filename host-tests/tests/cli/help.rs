//! Tests the help and the notes of the program.

use allanite_cli::command::CommandLine;
use clap::{CommandFactory, Parser};
use program::output;
use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
};
use tempfile::TempDir;

/// The names of all commands that users are told of.
fn commands() -> Vec<String> {
    let line = CommandLine::command();
    let names = line
        .get_subcommands()
        .filter(|command| !command.is_hide_set())
        .map(|command| command.get_name().to_owned());
    names.filter(|name| name != "help").collect()
}

#[test]
fn help_of_every_command_has_examples_that_the_program_accepts() {
    assert!(commands().len() >= 9);
    for command in commands() {
        let help = output(Path::new("."), &[&command, "--help"]);
        let examples = help.lines().filter(|line| line.starts_with("  allanite "));
        let own = examples.filter(|line| line.starts_with(&format!("  allanite {command}")));
        let own: Vec<&str> = own.collect();
        assert!(own.len() >= 2, "{help}");
        for example in own {
            let parsed = CommandLine::try_parse_from(example.split_whitespace());
            assert!(parsed.is_ok(), "{example}: {}", parsed.unwrap_err());
        }
        assert!(
            help.contains("Exit status: 0 on success; 2 for bad input"),
            "{help}"
        );
    }
}

#[test]
fn completions_name_every_command_and_bash_reads_its_own() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = output(Path::new("."), &["completions", shell]);
        for command in commands() {
            assert!(script.contains(&command), "{shell}: {command}");
        }
        assert!(script.contains("overbound"), "{shell}");
    }
    let folder = TempDir::new().unwrap();
    let script = folder.path().join("allanite.bash");
    fs::write(&script, output(Path::new("."), &["completions", "bash"])).unwrap();
    let words = "source allanite.bash; COMP_WORDS=(allanite expo); COMP_CWORD=1; \
                 _allanite allanite expo allanite; echo ${COMPREPLY[@]}";
    let bash = Command::new("bash")
        .current_dir(folder.path())
        .args(["--norc", "-c", words])
        .stderr(Stdio::null())
        .output()
        .unwrap();
    assert_eq!(String::from_utf8(bash.stdout).unwrap().trim(), "export");
}

#[test]
fn quiet_keeps_results_and_omits_notes() {
    let folder = TempDir::new().unwrap();
    let counts: String = (0..2000_u64)
        .map(|i| format!("{}\n", i * i * 7919 % 101))
        .collect();
    fs::write(folder.path().join("log.csv"), format!("gx\n{counts}")).unwrap();
    let run = |more: &[&str]| {
        let arguments = [&["fit", "log.csv", "--rate", "100"], more].concat();
        let run = program::run(folder.path(), &arguments);
        assert!(run.status.success());
        (run.stdout, String::from_utf8(run.stderr).unwrap())
    };
    let (loud, notes) = run(&[]);
    let (quiet, nothing) = run(&["--quiet"]);
    assert!(
        notes.contains("no unit given") && nothing.is_empty(),
        "{notes}{nothing}"
    );
    assert_eq!(loud, quiet);
}
