//! The experiment of the paper.

use allanite_studies::paper;
use anyhow::{Context as _, Result, bail};
use std::{fs, path::Path};

pub(crate) fn print(records: u64, json: bool, figure: Option<&Path>) -> Result<()> {
    if let Some(path) = figure {
        draw(path).with_context(|| path.display().to_string())?;
    }
    let experiment = paper::study(records);
    if json {
        println!("{}", serde_json::to_string_pretty(&experiment)?);
    } else {
        print!("{experiment}");
    }
    Ok(())
}

/// Draws the first record of each gyro.
fn draw(path: &Path) -> Result<()> {
    let drawing = || paper::figure::figure(0);
    let bytes = match path.extension().and_then(|extension| extension.to_str()) {
        Some("svg") => drawing().into_bytes(),
        #[cfg(feature = "pictures")]
        Some("png") => allanite_plot::png(&drawing())?,
        _ => bail!("a figure must end in .svg, or in .png with the feature `pictures`"),
    };
    Ok(fs::write(path, bytes)?)
}
