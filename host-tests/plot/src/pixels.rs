//! A drawing as pixels. The program brings its own font, so the fonts of the machine do not matter.

use resvg::{
    tiny_skia::{Color, Pixmap, Transform},
    usvg::{self, Options, Tree},
};
use std::io::{self, Write as _};
use thiserror::Error;

/// Pixels for one unit of the drawing. Two make a picture that is sharp in print.
const SCALE: f32 = 2.0;

/// The rows of pixels that are drawn at a time.
const STRIP: u32 = 512;

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
    #[error(transparent)]
    Png(#[from] png::EncodingError),
    /// The pixels could not be packed.
    #[error(transparent)]
    Packed(#[from] io::Error),
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
    let size = size.ok_or(PixelError::TooLarge)?;
    let (width, height) = (size.width(), size.height());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer()?;
    // A strip at a time, because all pixels of a few axes would take some hundred megabytes.
    let mut strip = Pixmap::new(width, STRIP.min(height)).ok_or(PixelError::TooLarge)?;
    for top in (0..height).step_by(STRIP as usize) {
        strip.fill(Color::TRANSPARENT);
        let place = Transform::from_row(SCALE, 0.0, 0.0, SCALE, 0.0, -(top as f32));
        resvg::render(&tree, place, &mut strip.as_mut());
        let rows = STRIP.min(height - top);
        let pixels = strip.pixels().iter().take((width * rows) as usize);
        let colours = pixels.map(|pixel| pixel.demultiply());
        let colours = colours.flat_map(|c| [c.red(), c.green(), c.blue(), c.alpha()]);
        stream.write_all(&colours.collect::<Vec<u8>>())?;
    }
    stream.finish()?;
    drop(writer);
    Ok(bytes)
}
