//! Every command and option that a page names is one of the program.

use crate::page::{Page, files, pages, text};
use clap::CommandFactory as _;
use std::{
    collections::{BTreeMap, BTreeSet},
    process::Command,
};

/// Options of other programs that pages name alone, such as those of cargo.
const FOREIGN: [&str; 3] = ["--strip-components", "--check", "--root"];

/// The mark of a task that passes its arguments on to another program.
const PASSED_ON: &str = "*";

/// What the program prints.
fn printed(arguments: &[&str]) -> String {
    let run = Command::new(env!("CARGO_BIN_EXE_allanite"))
        .args(arguments)
        .output();
    String::from_utf8(run.expect("the program starts").stdout).expect("text")
}

/// The words of a help that are options.
fn options(help: &str) -> BTreeSet<String> {
    let words = help.split([' ', '\n', ',', '[', ']', '`', ':', '=', '.', ')']);
    let words = words.filter(|word| word.len() > 2 && word.starts_with("--"));
    words.map(str::to_owned).collect()
}

/// The commands that a help lists.
pub(crate) fn commands() -> Vec<String> {
    let help = printed(&["--help"]);
    let list = help.split("\nCommands:\n").nth(1).expect("commands");
    let list = list.split("\n\n").next().expect("their end");
    let lines = list.lines().filter_map(|line| line.strip_prefix("  "));
    let lines = lines.filter(|line| !line.starts_with(' '));
    let names = lines.filter_map(|line| line.split(' ').next());
    names
        .filter(|name| *name != "help")
        .map(str::to_owned)
        .collect()
}

/// The help of a command.
pub(crate) fn help(command: &str) -> String {
    printed(&[command, "--help"])
}

/// The commands of the program and of the tasks, each with its options.
struct Known {
    program: BTreeMap<String, BTreeSet<String>>,
    tasks: BTreeMap<String, BTreeSet<String>>,
}

impl Known {
    fn read() -> Self {
        let program = commands().into_iter().map(|name| {
            let options = options(&help(&name));
            (name, options)
        });
        let tasks = xtask::CommandLine::command();
        let tasks = tasks.get_subcommands().map(|task| {
            let options = task.get_arguments().filter_map(|option| option.get_long());
            let mut options: BTreeSet<String> = options.map(|name| format!("--{name}")).collect();
            if task
                .get_arguments()
                .any(|argument| argument.is_trailing_var_arg_set())
            {
                options.insert(PASSED_ON.to_owned());
            }
            (task.get_name().to_owned(), options)
        });
        Self {
            program: program.collect(),
            tasks: tasks.chain(optional_tasks()).collect(),
        }
    }

    /// What is wrong with a command, if anything is.
    fn fault(&self, command: &str, studies: &Studies) -> Option<String> {
        let line = command.trim().trim_start_matches("$ ");
        let (known, rest) = if let Some(rest) = line.strip_prefix("cargo xtask ") {
            (&self.tasks, rest)
        } else {
            let starts = ["cargo allanite-full ", "cargo allanite ", "allanite "];
            let rest = starts.iter().find_map(|start| line.strip_prefix(start))?;
            (&self.program, rest)
        };
        let mut words = rest.split_whitespace();
        let name = words.next()?.trim_matches([',', '.']);
        if !name.starts_with(|c: char| c.is_ascii_lowercase()) {
            return None; // a part to fill in, such as COMMAND
        }
        let Some(options) = known.get(name) else {
            return Some(format!("there is no `{name}`"));
        };
        if name == "study" {
            return studies.fault(words);
        }
        let given = words.filter(|word| word.starts_with("--"));
        let mut given = given.filter_map(|word| word.split('=').next());
        let wrong = given.find(|word| *word != "--" && !options.contains(*word))?;
        let is_passed_on = options.contains(PASSED_ON);
        (!is_passed_on && wrong != "--help").then(|| format!("`{name}` has no {wrong}"))
    }

    /// Whether any command or task has an option.
    fn has(&self, option: &str) -> bool {
        let all = self.program.values().chain(self.tasks.values());
        all.into_iter().any(|options| options.contains(option))
    }
}

/// The tasks that a feature adds, which tests build without, as the source declares them.
fn optional_tasks() -> Vec<(String, BTreeSet<String>)> {
    let source = text("host-tests/xtask/src/lib.rs");
    let tasks = source.split("\n    #[cfg(feature = \"").skip(1);
    let tasks = tasks.filter_map(|rest| rest.split_once("\")]\n    "));
    let tasks = tasks.filter_map(|(_, rest)| rest.split_once(" {\n"));
    let tasks = tasks.filter(|(name, _)| name.chars().all(char::is_alphanumeric));
    let tasks = tasks.map(|(name, rest)| {
        let body = rest.split("\n    }").next().expect("a part");
        (kebab(name), declared_options(body).into_iter().collect())
    });
    tasks.collect()
}

/// The studies and their options, as their sources declare them.
pub(crate) struct Studies {
    pub(crate) names: BTreeSet<String>,
    options: BTreeSet<String>,
}

impl Studies {
    pub(crate) fn read() -> Self {
        const DECLARATION: &str = "\nenum Study {\n";
        let sources = files("rs");
        let declares = |path: &&String| text(path).contains(DECLARATION);
        let main = sources.iter().find(declares).expect("the studies");
        let folder = main.rsplit_once('/').expect("a folder").0;
        let body = text(main);
        let body = body.split(DECLARATION).nth(1).expect("variants");
        let body = body.split("\n}\n").next().expect("their end");
        let shown = body.split("#[command(hide = true)]\n    ").enumerate();
        // What is hidden comes first in all parts but the first one.
        let lines = shown.flat_map(|(at, part)| part.lines().skip(at.min(1)));
        let variants = lines.filter_map(|line| line.strip_prefix("    "));
        let variants = variants.filter(|line| line.starts_with(|c: char| c.is_ascii_uppercase()));
        let names = variants.filter_map(|line| line.split([' ', '(', ',']).next());
        let mut options = BTreeSet::new();
        for path in sources.iter().filter(|path| path.starts_with(folder)) {
            options.extend(declared_options(&text(path)));
        }
        Self {
            names: names.map(kebab).collect(),
            options,
        }
    }

    fn fault<'a>(&self, mut words: impl Iterator<Item = &'a str>) -> Option<String> {
        let name = words.next()?.trim_matches([',', '.']);
        let is_name = name.starts_with(|c: char| c.is_ascii_lowercase());
        if is_name && name != "help" && !self.names.contains(name) {
            return Some(format!("there is no study `{name}`"));
        }
        let mut options = words.filter(|word| word.starts_with("--"));
        let wrong = options.find(|word| !self.options.contains(*word))?;
        Some(format!("no study has {wrong}"))
    }
}

/// The name of an option or of a command, from that of a field or of a variant.
fn kebab(name: &str) -> String {
    let mut kebab = String::new();
    for (at, character) in name.chars().enumerate() {
        if character.is_ascii_uppercase() && at > 0 {
            kebab.push('-');
        }
        kebab.push(match character {
            '_' => '-',
            other => other.to_ascii_lowercase(),
        });
    }
    kebab
}

/// The options that a source declares: the fields behind an attribute with `long`.
fn declared_options(source: &str) -> Vec<String> {
    let mut options = Vec::new();
    let mut attributes = source.split("#[arg(").skip(1);
    while let Some((attribute, rest)) = attributes.next().and_then(|part| part.split_once(")]\n")) {
        let field = rest.trim_start().split(':').next().expect("a part");
        let is_field = !field.is_empty() && field.chars().all(|c| c.is_alphanumeric() || c == '_');
        if attribute.starts_with("long") && is_field {
            options.push(format!("--{}", kebab(field)));
        }
    }
    options
}

/// The commands of a page: lines of its blocks and code in its sentences, also behind a pipe.
fn commands_of(page: &Page) -> Vec<String> {
    let code = page.code();
    let commands = code.iter().flat_map(|code| code.split('|'));
    commands.map(str::to_owned).collect()
}

#[test]
fn commands_that_pages_name_exist() {
    let (known, studies) = (Known::read(), Studies::read());
    assert!(known.program.len() > 12 && known.tasks.len() > 12);
    assert!(studies.names.len() > 25, "{:?}", studies.names);
    let (mut named, mut faults) = (0, Vec::new());
    for page in pages() {
        for command in commands_of(&page) {
            named += usize::from(command.contains("allanite ") || command.contains("xtask "));
            if let Some(fault) = known.fault(&command, &studies) {
                faults.push(format!("{}: {command}: {fault}", page.path));
            }
        }
    }
    assert!(named > 120, "{named} commands");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn options_that_pages_name_alone_exist() {
    let (known, studies) = (Known::read(), Studies::read());
    let (mut named, mut missing) = (0, Vec::new());
    for page in pages() {
        // A program of its own, which is built apart.
        let is_apart = page.path.ends_with("fleets.md");
        for code in page.code().iter().filter(|code| code.starts_with("--")) {
            let option = code.split([' ', '=']).next().expect("a part");
            let is_known = known.has(option) || studies.options.contains(option);
            named += 1;
            if option != "--" && !is_known && !FOREIGN.contains(&option) && !is_apart {
                missing.push(format!("{}: {option}", page.path));
            }
        }
    }
    assert!(named > 40, "{named} options");
    assert!(
        missing.is_empty(),
        "no program has:\n{}",
        missing.join("\n")
    );
}

/// The names of all functions, modules and files of Rust.
fn names() -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for path in files("rs") {
        let source = text(&path);
        for declared in ["fn ", "mod "] {
            let rest = source.split(declared).skip(1);
            let declared = rest.filter_map(|rest| {
                rest.split(|c: char| !(c.is_alphanumeric() || c == '_'))
                    .next()
            });
            names.extend(declared.map(str::to_owned));
        }
        let name = path.rsplit('/').next().expect("a name");
        names.insert(name.trim_end_matches(".rs").to_owned());
    }
    names
}

/// Whether cargo finds a test program of this name.
fn is_test_program(name: &str) -> bool {
    let manifests = files("toml");
    let declared = format!("[[test]]\nname = \"{name}\"\n");
    let found = [
        format!("/tests/{name}.rs"),
        format!("/tests/{name}/main.rs"),
    ];
    files("rs")
        .iter()
        .any(|path| found.iter().any(|end| path.ends_with(end)))
        || manifests.iter().any(|path| text(path).contains(&declared))
}

#[test]
fn tests_that_pages_name_exist() {
    let names = names();
    let (mut named, mut missing) = (0, Vec::new());
    for page in pages() {
        for code in page.code() {
            let Some(rest) = code.trim().strip_prefix("cargo test ") else {
                continue;
            };
            let words: Vec<&str> = rest.split_whitespace().collect();
            for (at, word) in words.iter().enumerate() {
                let before = at.checked_sub(1).map_or("", |before| words[before]);
                let is_value =
                    ["-p", "--package", "--features", "--manifest-path"].contains(&before);
                let is_there = match before {
                    "--test" => is_test_program(word),
                    _ if is_value || word.starts_with('-') => continue,
                    _ => {
                        let name = word.split("::").find(|part| !part.is_empty());
                        let name = name.expect("a name");
                        names.iter().any(|known| known.contains(name))
                    }
                };
                named += 1;
                if !is_there {
                    missing.push(format!("{}: {code}: {word}", page.path));
                }
            }
        }
    }
    assert!(named > 25, "{named} tests");
    assert!(missing.is_empty(), "not there:\n{}", missing.join("\n"));
}

#[test]
fn a_wrong_command_is_a_fault() {
    let (known, studies) = (Known::read(), Studies::read());
    for wrong in [
        "cargo allanite fitt LOG.csv",
        "$ cargo allanite fit LOG.csv --rates 100",
        "cargo xtask benches",
        "cargo xtask bench --budgets",
        "cargo xtask study nothing",
        "cargo xtask study lines --rows 1",
    ] {
        assert!(known.fault(wrong, &studies).is_some(), "{wrong}");
    }
    for right in [
        "cargo allanite COMMAND --help",
        "allanite fit - --rate=100",
        "cargo xtask study lines --records 10",
        "cargo test --test cli",
    ] {
        assert_eq!(known.fault(right, &studies), None, "{right}");
    }
}
