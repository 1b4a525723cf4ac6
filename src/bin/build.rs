//! Links the images by the linker scripts of the run-time crates. A flag in `.cargo/config.toml` would do the same to the
//! projects in `board`, which have flags of their own.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|system| system == "none") {
        for script in ["link.x", "defmt.x"] {
            println!("cargo:rustc-link-arg-bins=-T{script}");
        }
    }
}
