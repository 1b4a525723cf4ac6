use host_tests::firmware::{Core, measure};
fn main() {
    let which: Vec<String> = std::env::args().skip(1).collect();
    for core in Core::all() {
        let name = format!("{}/{}", core.name, core.precision.name());
        if which.iter().any(|w| name.starts_with(w.as_str())) {
            println!("{name}");
            for (k, v) in measure::figures(&core).unwrap() {
                println!("  {k} {v}");
            }
            for (k, v) in measure::flash_by_part(&core).unwrap() {
                println!("  {k} {v}");
            }
        }
    }
}
