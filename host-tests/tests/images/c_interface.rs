//! The interface for C: its header, a product in C on this host and in QEMU, and calls with hostile arguments.

use std::{fs, process::Command};
use xtask::firmware::c_library::{Contents, folder, host_library, host_program, package};

/// Makes the header anew if this variable is set.
const RENEW: &str = "ALLANITE_RENEW_HEADER";

#[test]
fn the_header_is_that_of_the_source() {
    let config =
        cbindgen::Config::from_file(folder().join("cbindgen.toml")).expect("a configuration");
    let bindings = cbindgen::Builder::new()
        .with_crate(folder())
        .with_config(config)
        .generate()
        .expect("a header");
    let mut made = Vec::new();
    bindings.write(&mut made);
    let made = String::from_utf8(made).expect("text");
    let path = folder().join("include/allanite.h");
    if std::env::var_os(RENEW).is_some() {
        fs::write(&path, &made).expect("a folder to write to");
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        committed == made,
        "the header is out of date: {RENEW}=1 cargo test -p allanite-cli --test images c_interface"
    );
}

/// A project in C99 that finds the library as the one of a user does.
const PROJECT: &str = "cmake_minimum_required(VERSION 3.16)
project(product C)
set(CMAKE_C_STANDARD 99)
set(CMAKE_C_EXTENSIONS OFF)
add_compile_options(-Wall -Wextra -pedantic -Werror)
find_package(allanite CONFIG REQUIRED PATHS ${PACKAGE} NO_DEFAULT_PATH)
add_executable(product main.c)
target_link_libraries(product allanite::allanite m pthread dl)
";

const MAIN: &str = r#"#include "allanite.h"
#include <stdio.h>
static AllaniteGyro gyro;
int main(void) {
    AllaniteStatus made = allanite_gyro_init(&gyro, sizeof gyro, 100.0f);
    printf("%d %d\n", ALLANITE_OCTAVES, (int)made);
    return 0;
}
"#;

#[test]
fn a_project_of_cmake_in_c99_finds_the_package() {
    let folder = tempfile::tempdir().expect("a folder");
    let of = |name: &str| folder.path().join(name);
    let library = host_library().unwrap_or_else(|error| panic!("{error:#}"));
    package(&library, Contents::ALL, &of("package")).unwrap_or_else(|error| panic!("{error:#}"));
    fs::write(of("CMakeLists.txt"), PROJECT).expect("a project");
    fs::write(of("main.c"), MAIN).expect("a program");
    let run = |program: &str, arguments: &[&str]| {
        let run = Command::new(program)
            .args(arguments)
            .current_dir(folder.path())
            .output()
            .unwrap_or_else(|error| panic!("{program}: {error}"));
        let said = String::from_utf8_lossy(&run.stdout).into_owned();
        assert!(
            run.status.success(),
            "{said}{}",
            String::from_utf8_lossy(&run.stderr)
        );
        said
    };
    let place = format!("-DPACKAGE={}", of("package").display());
    run("cmake", &["-B", "build", &place, "."]);
    run("cmake", &["--build", "build"]);
    assert_eq!(run("./build/product", &[]), "20 0\n");
    let contents = Contents {
        octaves: 26,
        ..Contents::ALL
    };
    // With another number of octaves, the package says so to the compiler.
    package(&library, contents, &of("package")).expect("a package");
    run("cmake", &["-B", "build", &place, "."]);
    run("cmake", &["--build", "build"]);
    assert!(run("./build/product", &[]).starts_with("26 "));
}

/// What Zephyr does with a module, as far as a module can go wrong: its CMake code is run with functions that tell their
/// arguments.
const ZEPHYR: &str = "function(zephyr_library_import name path)
  if(NOT EXISTS ${path})
    message(FATAL_ERROR \"no library ${path}\")
  endif()
  message(STATUS \"library ${name}\")
endfunction()
function(zephyr_include_directories path)
  if(NOT EXISTS ${path}/allanite.h)
    message(FATAL_ERROR \"no header\")
  endif()
  message(STATUS \"header\")
endfunction()
function(zephyr_compile_definitions)
  message(STATUS \"define ${ARGN}\")
endfunction()
include(${PACKAGE}/zephyr/CMakeLists.txt)
";

#[test]
fn the_package_is_a_module_of_zephyr() {
    let folder = tempfile::tempdir().expect("a folder");
    let of = |name: &str| folder.path().join(name);
    fs::write(of("library.a"), "").expect("a file");
    let contents = Contents {
        octaves: 14,
        one_axis: true,
    };
    package(&of("library.a"), contents, &of("package")).unwrap_or_else(|error| panic!("{error:#}"));
    let module = fs::read_to_string(of("package/zephyr/module.yml")).expect("a module");
    assert!(module.contains("kconfig: zephyr/Kconfig"), "{module}");
    fs::write(of("zephyr.cmake"), ZEPHYR).expect("a script");
    let said = |configured: &str| {
        let run = Command::new("cmake")
            .arg(format!("-DPACKAGE={}", of("package").display()))
            .args([configured, "-P"])
            .arg(of("zephyr.cmake"))
            .output()
            .unwrap_or_else(|error| panic!("cmake: {error}"));
        assert!(
            run.status.success(),
            "{}",
            String::from_utf8_lossy(&run.stderr)
        );
        String::from_utf8_lossy(&run.stdout).into_owned()
    };
    let linked = said("-DCONFIG_ALLANITE=y");
    for wanted in [
        "library allanite",
        "header",
        "define ALLANITE_OCTAVES_14;ALLANITE_ONE_AXIS",
    ] {
        assert!(linked.contains(wanted), "{linked}");
    }
    assert_eq!(said("-DCONFIG_ALLANITE=n"), "");
}

#[test]
fn hostile_calls_are_refused_and_harm_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let said = host_program(&["hostile.c", "host.c"], folder.path());
    let said = said.unwrap_or_else(|error| panic!("{error:#}"));
    assert_eq!(said, ["refused as they should be"]);
}

/// The rate of the product's first axis follows the temperature by half a count of 1/131 deg/s for each 0.01 K, 20 s late.
#[test]
fn a_temperature_that_a_rate_follows_late_leaves_no_random_walk() {
    let folder = tempfile::tempdir().expect("a folder");
    let said = host_program(&["product.c", "host.c"], folder.path());
    let said = said.unwrap_or_else(|error| panic!("{error:#}"));
    let follows = said
        .iter()
        .find_map(|line| line.strip_prefix("follows the temperature "));
    let bits = follows.expect("a line").split_whitespace();
    let values: Vec<f32> = bits
        .map(|bits| f32::from_bits(u32::from_str_radix(bits, 16).expect("hexadecimal digits")))
        .collect();
    let [slope, slope_error, lag_s, _] = values[..] else {
        panic!("{said:?}");
    };
    let exact = 0.5 / 131.0 / 0.01;
    assert!(
        (slope - exact).abs() < 2.0 * slope_error && slope_error < 0.06 * exact,
        "{values:?}"
    );
    assert!((8.0..42.0).contains(&lag_s), "{values:?}");
    let mut walks = said.iter().filter(|line| line.contains("rate_random_walk"));
    let last = walks.next_back().expect("a walk");
    assert!(!last.contains("state 0"), "{said:?}");
}
