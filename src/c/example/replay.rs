//! Plays the calls of the interface for C that the files of a folder encode, and prints the number of the files.

// The target is public in the fuzzer's library, and calls functions of C.
#![allow(unreachable_pub, unsafe_code)]

#[path = "../../../host-tests/fuzz/src/c.rs"]
mod c;

use std::{env, error::Error, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = env::args().nth(1).ok_or("give a folder")?;
    let mut files = 0;
    for entry in fs::read_dir(folder)? {
        let bytes = fs::read(entry?.path())?;
        c::check(&bytes);
        // Programs that end early, too.
        c::check(bytes.get(..bytes.len() / 2).unwrap_or_default());
        files += 1;
    }
    println!("{files}");
    Ok(())
}
