//! The READMEs and the crate's page show what their readers will see.

use clap::Parser as _;
use host_tests::program::output;
use std::{fs, path::Path};
use xtask::{
    CommandLine, cost,
    firmware::{
        Precision, Way,
        budgets::{self, target},
        figures,
    },
};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

/// The project's page.
const README: &str = "README.md";

/// The manual of the command line, with the figures.
const MANUAL: &str = "host-tests/README.md";

/// The crate's page is the documentation of this file.
const CRATE_PAGE: &str = "src/lib.rs";

/// A rounded figure of the crate's page may differ by this share from the budget.
const ROUNDED: f64 = 0.1;

/// The text of a file.
fn text(path: &str) -> String {
    let text = fs::read_to_string(Path::new(ROOT).join(path));
    text.unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Commands of the `console` blocks, and the lines shown of each.
fn examples(page: &str) -> Vec<(&str, Vec<&str>)> {
    let mut examples: Vec<(&str, Vec<&str>)> = Vec::new();
    let mut inside = false;
    for line in page.lines() {
        match line {
            "```console" => inside = true,
            "```" => inside = false,
            _ if !inside => {}
            _ => match line.strip_prefix("$ cargo allanite ") {
                Some(command) => examples.push((command, Vec::new())),
                None => examples.last_mut().expect("a command first").1.push(line),
            },
        }
    }
    examples
}

/// Takes the lines shown from those printed, in order: `...` stands for any number of lines.
fn find(shown: &[&str], printed: &[&str]) -> Result<(), String> {
    let mut rest = printed;
    for part in shown.split(|line| *line == "...") {
        if part.is_empty() {
            continue;
        }
        let found = rest.windows(part.len()).position(|window| window == part);
        let at =
            found.ok_or_else(|| format!("not printed, in this order:\n{}", part.join("\n")))?;
        rest = &rest[at + part.len()..];
    }
    Ok(())
}

/// Runs the commands of a page, of which there are at least so many.
fn commands_print_what_is_shown(path: &str, least: usize) {
    let page = text(path);
    let examples = examples(&page);
    assert!(examples.len() >= least, "{path}: {examples:?}");
    for (command, shown) in examples {
        let arguments: Vec<&str> = command.split_whitespace().collect();
        let printed = output(Path::new(ROOT), &arguments);
        let printed: Vec<&str> = printed.lines().map(str::trim_end).collect();
        assert!(shown.iter().filter(|line| **line != "...").count() >= 3);
        if let Err(missing) = find(&shown, &printed) {
            panic!(
                "{path}: {command}: {missing}\nprinted:\n{}",
                printed.join("\n")
            );
        }
    }
}

#[test]
fn commands_of_the_readme_print_what_is_shown() {
    commands_print_what_is_shown(README, 1);
}

#[test]
fn commands_of_the_manual_print_what_is_shown() {
    commands_print_what_is_shown(MANUAL, 4);
}

#[test]
fn the_readme_has_at_most_150_lines() {
    let lines = text(README).lines().count();
    assert!((50..=150).contains(&lines), "{lines} lines");
}

#[test]
fn pictures_of_the_manual_are_those_that_plot_draws() {
    let folder = tempfile::TempDir::new().expect("a folder");
    for (step, picture) in [("0", "adis16405-gz-0.svg"), ("9", "adis16405-gz-last.svg")] {
        let input = "host-tests/data/adis16405.json";
        let drawn = folder.path().join(picture);
        let file = drawn.to_string_lossy().into_owned();
        let what = ["--axis", "gz", "--what", "spectrum", "--step", step];
        let arguments = [&["plot", input, "--output", &file], &what[..]].concat();
        output(Path::new(ROOT), &arguments);
        let shown = text(&format!("host-tests/pictures/{picture}"));
        let drawn = fs::read_to_string(drawn).expect("a picture");
        assert!(
            shown == drawn,
            "draw it again: cargo allanite {}",
            arguments
                .join(" ")
                .replace(&file, &format!("host-tests/pictures/{picture}"))
        );
    }
}

/// Files that a page links to or draws, without the place in them.
fn links(page: &str) -> impl Iterator<Item = &str> {
    let targets = page.split("](").skip(1);
    let targets = targets.filter_map(|rest| rest.split([')', '#']).next());
    targets.filter(|target| !target.is_empty() && !target.contains("://"))
}

#[test]
fn files_that_are_linked_exist() {
    for (path, least) in [(README, 5), (MANUAL, 1)] {
        let page = text(path);
        let folder = Path::new(ROOT).join(path);
        let folder = folder.parent().expect("a file in a folder");
        assert!(links(&page).count() >= least, "{path}");
        for link in links(&page) {
            assert!(
                folder.join(link).exists(),
                "{path} links to {link}, which is missing"
            );
        }
    }
}

#[test]
fn figures_are_those_of_the_budgets() {
    let shown = figures::readme(&budgets::committed(Way::Rustup).unwrap()).unwrap();
    assert!(shown.lines().count() > 20);
    assert!(text(MANUAL).contains(&shown), "{MANUAL} lacks:\n{shown}");
}

#[test]
fn the_cost_of_a_product_is_what_the_calculator_says() {
    let page = text(MANUAL);
    let mut commands = page
        .lines()
        .filter_map(|line| line.strip_prefix("$ cargo xtask cost "));
    let arguments = commands.next().expect("a command");
    let line = ["xtask", "cost"].into_iter().chain(arguments.split(' '));
    let product = CommandLine::try_parse_from(line)
        .expect("valid arguments")
        .product();
    let budgets = budgets::committed(Way::Rustup).unwrap();
    let table = cost::table(&product.expect("a product"), &budgets).unwrap();
    assert!(
        table.lines().count() > 8 && page.contains(&table),
        "{MANUAL} lacks:\n{table}"
    );
}

/// The number at the start of the last column of the row that begins so; a blank parts thousands.
fn shown_figure(page: &str, row: &str) -> f64 {
    let start = format!("//! | {row} | ");
    let mut rows = page.lines().filter_map(|line| line.strip_prefix(&start));
    let figure = rows
        .next()
        .unwrap_or_else(|| panic!("{CRATE_PAGE} has no row `{row}`"));
    let end = figure.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == ' '));
    let number = figure[..end.unwrap_or(figure.len())].replace(' ', "");
    let number: f64 = number.parse().unwrap_or_else(|_| panic!("{figure}"));
    if figure.contains("million") {
        1e6 * number
    } else {
        number
    }
}

#[test]
fn rounded_figures_of_the_crates_page_are_near_the_budgets() {
    let page = text(CRATE_PAGE);
    let budgets = budgets::committed(Way::Rustup).unwrap();
    let budgets = &budgets[target(Precision::Single)];
    for (row, budget) in [
        (
            "a sample into an accumulator, any number of octaves",
            "instructions_per_sample",
        ),
        (
            "RAM of an accumulator of 24 octaves",
            "ram_bytes_per_axis_24",
        ),
        (
            "flash of accumulator, curve and fit",
            "flash_bytes_with_fit",
        ),
        (
            "flash with the diagnosis and the whole catalogue",
            "flash_bytes_with_diagnosis",
        ),
        ("a fit of 20 octaves", "instructions_fit_20"),
        (
            "RAM of a spectrum, for an axis",
            "ram_bytes_per_axis_of_spectrum",
        ),
        (
            "flash with diagnosis and spectrum",
            "flash_bytes_with_spectrum",
        ),
    ] {
        let (shown, budget) = (shown_figure(&page, row), budgets[budget].as_f64().unwrap());
        assert!(
            (shown / budget - 1.0).abs() < ROUNDED,
            "{CRATE_PAGE}: {row}: {shown} is shown, the budget is {budget}"
        );
    }
}

#[test]
fn memory_that_is_promised_is_enough() {
    let promise = "fit into 122 KiB of flash and 34 KiB of RAM of a Cortex-M4F";
    assert!(text(README).contains(promise), "{README} lacks: {promise}");
    for way in Way::ALL {
        promised(way);
    }
}

fn promised(way: Way) {
    let budgets = budgets::committed(way).unwrap();
    for core in budgets["cores"].as_array().unwrap() {
        let ram = core["ram_bytes"].as_u64().unwrap();
        assert!(
            core["core"] != "Cortex-M0" || ram < 16 * 1024,
            "{way}: {core}"
        );
    }
    let most = |precision, figure: &str, kibibytes: u64| {
        let bytes = budgets[target(precision)][figure].as_u64().unwrap();
        assert!(bytes <= kibibytes * 1024, "{way}: {figure}: {bytes}");
    };
    for precision in Precision::ALL {
        most(precision, "flash_bytes_accumulator", 4);
        most(precision, "stack_bytes_fit_20", 15);
    }
    most(
        Precision::Single,
        "ram_bytes_three_axes_20_with_diagnosis",
        34,
    );
    most(
        Precision::Double,
        "ram_bytes_three_axes_20_with_diagnosis",
        46,
    );
    most(Precision::Single, "flash_bytes_with_fit", 42);
    most(Precision::Single, "flash_bytes_with_diagnosis", 122);
}
