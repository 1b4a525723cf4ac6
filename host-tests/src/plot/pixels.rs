//! A drawing as pixels, with a font of its own: what a machine has installed does not matter.

use resvg::{
    tiny_skia::{Pixmap, Transform},
    usvg::{self, Options, Tree},
};
use thiserror::Error;

/// Pixels of one unit of the drawing: sharp on paper.
const SCALE: f32 = 2.0;

/// Why there is no picture.
#[derive(Debug, Error)]
pub enum PixelError {
    /// The drawing is no SVG.
    #[error(transparent)]
    Svg(#[from] usvg::Error),
    /// The picture would be too large.
    #[error("too many figures for one picture")]
    TooLarge,
    /// The picture could not be written down.
    #[error("{0}")]
    Png(String),
}

/// The pixels of an SVG drawing, as the bytes of a PNG file.
///
/// # Errors
/// Where the drawing is no SVG, or too large.
pub fn png(svg: &str) -> Result<Vec<u8>, PixelError> {
    let mut options = Options::default();
    for font in [dejavu::sans::regular(), dejavu::sans::bold()] {
        options.fontdb_mut().load_font_data(font.to_vec());
    }
    let tree = Tree::from_str(svg, &options)?;
    let size = tree.size().to_int_size().scale_by(SCALE);
    let pixmap = size.and_then(|size| Pixmap::new(size.width(), size.height()));
    let mut pixmap = pixmap.ok_or(PixelError::TooLarge)?;
    let scale = Transform::from_scale(SCALE, SCALE);
    resvg::render(&tree, scale, &mut pixmap.as_mut());
    pixmap
        .encode_png()
        .map_err(|error| PixelError::Png(error.to_string()))
}
