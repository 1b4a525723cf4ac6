use host_tests::firmware::{CORTEX_M4F, Image, run_with};
#[test]
fn tmp() {
    let image = Image::build_for("bench", &CORTEX_M4F).unwrap();
    let run = run_with(&image, &["full"]).unwrap();
    for l in run.lines {
        println!("{l}");
    }
}
