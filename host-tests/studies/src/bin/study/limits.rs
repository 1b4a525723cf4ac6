//! What is called adequate, what passes a limit, and which promises are kept.

use allanite_studies::limits::{self, Door, GAINS, KINDS, LIMITED, promises, study};

pub(crate) fn print(records: u64, seed: u64, factor: f64) {
    print_judged(records, seed, factor);
    print_promises(records, seed);
}

fn print_judged(records: u64, seed: u64, factor: f64) {
    let [least, most] = GAINS;
    println!(
        "{records} records of each kind from seed {seed} on, ideal gain {least} to {most}; limits of {factor} times the truth"
    );
    println!("counts by the diagnosis / by the small fit of a device");
    print!("{:<12} {:>7} {:>12}", "kind", "records", "adequate");
    for (_, symbol) in LIMITED {
        print!(" {:>12}", format!("{symbol} passes"));
    }
    println!();
    for kind in KINDS {
        let limits::Tally {
            records,
            adequate,
            passed,
        } = study(kind, factor, seed, records);
        let name = format!("{kind:?}");
        let [of_diagnosis, of_fit] = adequate;
        let pair = format!("{of_diagnosis} / {of_fit}");
        print!("{name:<12} {records:>7} {pair:>12}");
        for (place, _) in LIMITED.iter().enumerate() {
            let pair = format!("{} / {}", passed[0][place], passed[1][place]);
            print!(" {pair:>12}");
        }
        println!();
    }
}

pub(crate) fn print_promises(records: u64, seed: u64) {
    for (door, fit) in [(Door::Fit, "the fit"), (Door::FiveTerms, "the small fit")] {
        for (place, name) in [(2, "bias instability"), (3, "rate random walk")] {
            let found = promises(door, place, seed, records);
            println!(
                "of {} records of which {fit} says in which length {name} of a size would show, a gyro with this size keeps {}",
                found.made, found.kept
            );
        }
    }
}
