//! What the tests of three cores and those of every core check.

use xtask::firmware::{Core, Image, agreement, run};

/// An image computes the same bits as this host.
pub(crate) fn agree_to_the_bit(core: &Core) {
    let difference = agreement::difference(core);
    let difference = difference.unwrap_or_else(|error| panic!("{core}: {error:#}"));
    assert_eq!(difference, None, "{core}");
}

/// A whole product, with every part switched on, prints on a core what it prints on this host.
pub(crate) fn finds_what_the_host_finds(core: &Core) {
    let told = |lines: Result<Vec<String>, anyhow::Error>| {
        lines.unwrap_or_else(|error| panic!("{core}: {error:#}"))
    };
    let there = told(agreement::told(core, "product", &[]));
    println!("{core}\n{}", there.join("\n"));
    let here = told(agreement::told_here(core.precision, "product", &[]));
    assert_eq!(agreement::first_difference(&here, &there), None, "{core}");
    let starts = |start: &str| there.iter().filter(|line| line.starts_with(start)).count();
    assert!(starts("look ") >= 3 && starts("covariate ") > 20 && starts("kurtosis ") > 20);
    assert_eq!(
        (
            starts("snapshot "),
            starts("restored "),
            starts("invalid None")
        ),
        (1, 1, 3)
    );
    let followed = (starts("added covariate "), starts("dependence "));
    assert_eq!(followed, (1, 1));
    let image = Image::build_for("product", core);
    let section = image.and_then(|image| image.section_of("::GYRO"));
    assert_eq!(section.unwrap_or_else(|error| panic!("{error:#}")), ".bss");
}

/// The linker finds no path to a panic in an image.
pub(crate) fn has_no_path_to_a_panic(name: &str, core: &Core, profile: &str) {
    let found = panic_paths(name, core, profile);
    assert_eq!(found, [""; 0], "{name}, {core}, {profile}");
}

/// The functions of an image that a panic needs.
pub(crate) fn panic_paths(name: &str, core: &Core, profile: &str) -> Vec<String> {
    Image::build_with(name, core, profile)
        .and_then(|image| image.panic_paths())
        .unwrap_or_else(|error| panic!("{error:#}"))
}

/// Interrupts at any instruction of the receiver lose no sample without its place.
pub(crate) fn keeps_every_place(core: &Core) {
    println!("{core}");
    let run = Image::build_for("race", core).and_then(|image| run(&image));
    let run = run.unwrap_or_else(|error| panic!("{error:#}"));
    println!("{}", run.lines.join("\n"));
    assert!(run.status.success(), "the image ended with {}", run.status);
    let total = run.lines.last().expect("a line");
    let names = ["made", "taken", "lost", "gaps", "empty", "amid"];
    let [made, taken, lost, gaps, empty, amid] = numbers(total, names);
    assert_eq!((made, taken + lost), (200_000, made));
    // The queue was full and empty many times, and many interrupts came within a call of the receiver.
    assert!(gaps > 1000 && empty > 1000 && amid > 1000, "{total}");
}

/// The numbers that follow these words in a line.
pub(crate) fn numbers<const N: usize>(line: &str, names: [&str; N]) -> [u32; N] {
    let words: Vec<&str> = line.split([' ', ',']).collect();
    names.map(|name| {
        let place = words.iter().position(|word| *word == name);
        let number = place.and_then(|place| words.get(place + 1)?.parse().ok());
        number.unwrap_or_else(|| panic!("{line:?} does not contain {name}"))
    })
}
