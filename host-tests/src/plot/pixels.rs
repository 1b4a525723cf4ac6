//! A drawing as pixels. The program brings its own font, so the fonts of the machine do not matter.

use resvg::{
    tiny_skia::{Pixmap, Transform},
    usvg::{self, Options, Tree},
};
use thiserror::Error;

/// Pixels for one unit of the drawing. Two make a picture that is sharp in print.
const SCALE: f32 = 2.0;

/// The reason why a picture cannot be made.
#[derive(Debug, Error)]
pub enum PixelError {
    /// The drawing is not valid SVG.
    #[error(transparent)]
    Svg(#[from] usvg::Error),
    /// The picture would be too large.
    #[error("the picture has too many figures")]
    TooLarge,
    /// The picture could not be encoded as PNG.
    #[error("{0}")]
    Png(String),
}

/// The pixels of an SVG drawing, as the bytes of a PNG file.
///
/// # Errors
/// When the drawing is not valid SVG, is too large, or cannot be encoded.
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
