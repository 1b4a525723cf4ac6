//! Inputs and outputs that are no regular files, and bad live records.

use super::{
    case::{Case, refused},
    text::good,
};

pub(crate) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for name in ["a.csv", "a.csv.gz", "a.npy", "a.mcap", "a.ulg", "a.json"] {
        let command = format!("fit {name} --rate 9");
        let command = command.trim_end_matches(if name == "a.json" { " --rate 9" } else { "" });
        let expecting = |expected: &str| refused("unused", "", command, expected);
        cases.push(expecting("is not a regular file").prepared(&format!("mkfifo {name}")));
        cases.push(expecting("is not a regular file").prepared(&format!("ln -s /dev/zero {name}")));
        cases.push(expecting("is a directory").prepared(&format!("mkdir {name}")));
        cases.push(expecting("no such file").prepared(&format!("ln -s none {name}")));
        cases.push(expecting("a.").prepared(&format!("ln -s {name} {name}")));
    }
    cases.push(refused(
        "a.csv",
        "",
        "fit . --rate 9",
        "a.csv: the file is empty; ",
    ));
    cases.push(refused(
        "unused",
        "",
        "fit a.csv",
        "a.csv: no such file; check the path",
    ));
    cases.push(refused(
        "unused",
        "",
        "fit a.json",
        "a.json: no such file; ",
    ));
    let decode = |commands: &str, expected: &str| {
        refused("unused", "", "decode a.bin", expected).prepared(commands)
    };
    cases.push(decode("mkfifo a.bin", "is not a regular file"));
    cases.push(decode("ln -s /dev/zero a.bin", "is not a regular file"));
    let the_input = "the output is also the input, which would be lost; name another output";
    for (command, expected) in [
        ("export -f c a.csv -o a.csv", the_input),
        ("export -f c a.csv -o b.csv", the_input),
        ("export -f c a.csv -o c.csv", the_input),
        ("plot a.csv -o d.svg", the_input),
        ("report a.csv -o e.html", the_input),
        ("measure a.csv -o f.json", the_input),
        ("export -f c a.csv -o .", "is a directory"),
        ("export -f c a.csv -o none/a.h", "its folder does not exist"),
        ("export -f c a.csv -o loop", "too many symbolic links"),
        (
            "export -f c a.csv --despite-invalid -o /dev/full",
            "no space left",
        ),
    ] {
        let links = "ln a.csv b.csv; ln -s a.csv c.csv; ln -s a.csv d.svg; ln a.csv e.html; \
                     ln a.csv f.json; ln -s loop loop";
        cases.push(refused("a.csv", good(3000), command, expected).prepared(links));
    }
    let watch = |input: &[u8], expected: &str| {
        refused("unused", "", "watch --rate 100", expected).fed(input)
    };
    cases.push(watch(b"", "received 0 samples"));
    cases.push(watch(b"1\n2\n3\n", "received 3 samples"));
    cases.push(watch(&b"5\n".repeat(500), "its values never change"));
    cases.push(watch(
        &b"x\n".repeat(500),
        "received 0 samples and 500 invalid lines",
    ));
    cases.push(watch(
        &[0xff; 1 << 20],
        "received 0 samples and 1 invalid line,",
    ));
    cases.push(watch(
        &b"1,".repeat(1 << 19),
        "received 0 samples and 1 invalid line,",
    ));
    cases
}
