//! Whole products that survive power cuts.

use host_tests::demonstration::appliance::{BUFFER, Cut, Gyro, replay};

fn here(seed: u64, cuts: &[Cut]) -> Vec<String> {
    let mut gyro = Box::new(Gyro::new());
    let mut buffer = vec![0; BUFFER];
    let mut lines = Vec::new();
    let done = replay(seed, cuts, &mut gyro, &mut buffer, |line| {
        lines.push(line.to_string());
    });
    done.unwrap_or_else(|failure| panic!("{failure:?}"));
    lines
}

#[test]
fn try_it() {
    let cut = |made, taken, operations| Cut {
        made,
        taken,
        operations,
    };
    for line in here(1, &[]) {
        println!("{line}");
    }
    for line in here(1, &[cut(1007, 1000, 30000), cut(5010, 5000, 100)]) {
        println!("{line}");
    }
}
