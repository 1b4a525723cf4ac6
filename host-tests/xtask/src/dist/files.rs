//! Files to be packed, and the system's own tools, which pack them to the same bytes whenever and by whomever they are called.

use super::crates::answer;
use anyhow::{Context as _, Result};
use std::{fs, path::Path, process::Command};

/// A file to be packed.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Packed {
    /// Where it is installed, below the folder that things are installed to.
    pub(super) path: String,
    pub(super) bytes: Vec<u8>,
    pub(super) is_program: bool,
}

impl Packed {
    pub(super) fn new(path: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        Self {
            path: path.into(),
            bytes: bytes.into(),
            is_program: false,
        }
    }
}

/// Writes the files below a folder. Everybody may read them, whatever this user's mask is.
pub(super) fn write(folder: &Path, files: &[Packed]) -> Result<()> {
    for file in files {
        let path = folder.join(&file.path);
        let above = path.parent().unwrap_or(folder);
        fs::create_dir_all(above)
            .and_then(|()| fs::write(&path, &file.bytes))
            .with_context(|| path.display().to_string())?;
        #[cfg(unix)]
        if file.is_program {
            use std::os::unix::fs::PermissionsExt as _;
            fs::set_permissions(&path, fs::Permissions::from_mode(0o755))?;
        }
    }
    let mut readable = Command::new("chmod");
    readable.args(["-R", "u=rwX,go=rX"]).arg(folder);
    answer(&mut readable)?;
    Ok(())
}

/// Packs files below a folder as gzip, each for itself, without a name and a time in it.
pub(super) fn gzip(folder: &Path, paths: &[String]) -> Result<()> {
    let mut pack = Command::new("gzip");
    pack.arg("-9n").args(paths);
    answer(pack.current_dir(folder))?;
    Ok(())
}

/// The files below a folder of this name as a tar archive in gzip: in the order of their paths, owned by root, of one time.
pub(super) fn archive(files: &[Packed], name: &str, epoch: u64) -> Result<Vec<u8>> {
    let folder = tempfile::tempdir()?;
    write(&folder.path().join(name), files)?;
    let mut pack = Command::new("tar");
    pack.args(["--create", "--format=gnu", "--sort=name", "--owner=root:0"])
        .args(["--group=root:0", "--use-compress-program=gzip -9n"])
        .arg(format!("--mtime=@{epoch}"))
        .args(["--file=packed", name]);
    answer(pack.current_dir(folder.path())).context("the archive needs the `tar` of GNU")?;
    Ok(fs::read(folder.path().join("packed"))?)
}

/// The digits of a hash.
pub(super) fn hexadecimal(hash: &[u8]) -> String {
    hash.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn archive_does_not_depend_on_the_order_and_has_every_folder() {
        let mut files = vec![
            Packed::new("share/b", "second"),
            Packed::new("bin/a", "first"),
            Packed::new("share/doc/c", vec![7; 3000]),
        ];
        files[1].is_program = true;
        let packed = archive(&files, "all", 86_400).unwrap();
        files.reverse();
        assert_eq!(archive(&files, "all", 86_400).unwrap(), packed);
        assert_ne!(archive(&files, "all", 86_401).unwrap(), packed);
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("packed.tar.gz");
        fs::write(&file, packed).unwrap();
        let mut list = Command::new("tar");
        list.args(["--list", "--verbose", "--numeric-owner", "--utc", "--file"]);
        let list = answer(list.arg(file)).unwrap();
        let lines: Vec<Vec<&str>> = list
            .lines()
            .map(|it| it.split_whitespace().collect())
            .collect();
        let expected = [
            "drwxr-xr-x 0/0 0 1970-01-02 00:00 all/",
            "drwxr-xr-x 0/0 0 1970-01-02 00:00 all/bin/",
            "-rwxr-xr-x 0/0 5 1970-01-02 00:00 all/bin/a",
            "drwxr-xr-x 0/0 0 1970-01-02 00:00 all/share/",
            "-rw-r--r-- 0/0 6 1970-01-02 00:00 all/share/b",
            "drwxr-xr-x 0/0 0 1970-01-02 00:00 all/share/doc/",
            "-rw-r--r-- 0/0 3000 1970-01-02 00:00 all/share/doc/c",
        ];
        let lines: Vec<String> = lines.iter().map(|line| line.join(" ")).collect();
        assert_eq!(lines, expected);
    }
}
