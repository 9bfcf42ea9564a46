//! An image that is drawn larger than it is saved: averaging smooths every edge, whoever drew it.

use super::{DrawError, Rgb};
use crate::files;
use plotters::coord::Shift;
use plotters::prelude::{BitMapBackend, DrawingArea, FontStyle, IntoDrawingArea};
use rayon::prelude::*;
use std::path::Path;
use std::sync::Once;
use stickslip::image::Image;

/// Pixels drawn along each side of a pixel saved, for pictures of particles.
pub const SAMPLES: usize = 2;

/// What lines and letters are drawn on.
pub type Ink<'a> = DrawingArea<BitMapBackend<'a>, Shift>;

/// An RGB image on a background of one colour.
pub struct Canvas {
    /// Width and height as drawn.
    pub size: [usize; 2],
    /// Pixels drawn along each side of a pixel saved.
    samples: usize,
    /// Rows from the top, three bytes a pixel.
    pub pixels: Vec<u8>,
}

impl Canvas {
    /// A white canvas for a file of this width and height in pixels, drawn `samples` times larger.
    pub fn new(size: [usize; 2], samples: usize) -> Self {
        Canvas::colored(size, samples, [255; 3])
    }

    /// The same in another colour.
    pub fn colored(size: [usize; 2], samples: usize, color: [u8; 3]) -> Self {
        register_font();
        let size = size.map(|side| side * samples);
        Canvas { size, samples, pixels: color.repeat(size[0] * size[1]) }
    }

    /// The canvas for lines and letters; lengths are in drawn pixels.
    pub fn ink(&mut self) -> Ink<'_> {
        let size = (self.size[0] as u32, self.size[1] as u32);
        BitMapBackend::with_buffer(&mut self.pixels, size).into_drawing_area()
    }

    /// Paints every pixel of a rectangle (left, top, width, height) for which `color` has one; rows in parallel.
    pub fn paint(&mut self, area: [usize; 4], color: impl Fn(usize, usize) -> Option<Rgb> + Sync) {
        let [left, top, width, height] = area;
        let rows = self.pixels.par_chunks_exact_mut(3 * self.size[0]).skip(top).take(height);
        rows.enumerate().for_each(|(y, row)| {
            for x in 0..width {
                if let Some(rgb) = color(x, y) {
                    let start = 3 * (left + x);
                    row[start..start + 3].copy_from_slice(&rgb.map(|c| (c * 255.0 + 0.5) as u8));
                }
            }
        });
    }

    /// The image at the size of the file: each pixel the mean of its samples.
    pub fn image(&self) -> Image {
        let ([width, _], samples) = (self.size, self.samples);
        let rows = self.pixels.par_chunks_exact(3 * width * samples);
        let pixels = rows.flat_map_iter(|rows| {
            (0..width / samples * 3).map(move |i| {
                let (x, channel) = (i / 3 * samples, i % 3);
                let sample = |k: usize| rows[3 * ((k / samples) * width + x + k % samples) + channel];
                let sum: u32 = (0..samples * samples).map(|k| u32::from(sample(k))).sum();
                (sum / (samples * samples) as u32) as u8
            })
        });
        Image::opaque(self.size.map(|side| side / samples), pixels.collect())
    }

    /// Marks the pixels within a radius of a place, both in drawn pixels.
    pub fn dot(&mut self, [x, y]: [f64; 2], radius: f64, color: Rgb) {
        let span = |center: f64, end: usize| {
            let low = (center - radius).floor().max(0.0) as usize;
            low..((center + radius).ceil().max(0.0) as usize).min(end)
        };
        let bytes = color.map(|c| (c * 255.0 + 0.5) as u8);
        for row in span(y, self.size[1]) {
            for column in span(x, self.size[0]) {
                let [dx, dy] = [column as f64 + 0.5 - x, row as f64 + 0.5 - y];
                if dx * dx + dy * dy <= radius * radius {
                    let start = 3 * (row * self.size[0] + column);
                    self.pixels[start..start + 3].copy_from_slice(&bytes);
                }
            }
        }
    }
}

/// An image without its background, from what it is on white and on black: whatever was drawn over the background with
/// an opacity a shows
///
/// ```text
/// on white = a color + (1 - a) 255,   on black = a color,   so   a = 1 - (on white - on black) / 255
/// ```
pub fn without_background(on_white: &Image, on_black: &Image) -> Image {
    let pairs = || on_white.pixels.chunks_exact(3).zip(on_black.pixels.chunks_exact(3));
    // The three colours differ by rounding.
    let opacity = |(white, black): (&[u8], &[u8])| {
        let shine = (0..3).map(|i| white[i].saturating_sub(black[i])).max();
        255 - shine.unwrap_or_default()
    };
    let opacity: Vec<u8> = pairs().map(opacity).collect();
    let color = |((_, black), &a): ((&[u8], &[u8]), &u8)| {
        [0, 1, 2].map(|i| (u32::from(black[i]) * 255).checked_div(a.into()).unwrap_or(0).min(255) as u8)
    };
    let pixels = pairs().zip(&opacity).flat_map(color).collect();
    Image { size: on_white.size, pixels, opacity }
}

/// Writes an image as PNG.
///
/// # Errors
/// The file cannot be written.
pub fn save(image: &Image, path: &Path) -> Result<(), DrawError> {
    files::write(path, files::PNG, |file| image.write_png(file))
        .map_err(|source| DrawError::Write { path: path.to_path_buf(), source })
}

/// Makes the embedded DejaVu Sans known as `sans-serif`, so that no font need be installed.
pub fn register_font() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let (normal, bold) = (dejavu::sans::regular(), dejavu::sans::bold());
        for (style, bytes) in [(FontStyle::Normal, normal), (FontStyle::Bold, bold)] {
            let registered = plotters::style::register_font("sans-serif", style, bytes);
            registered.ok().expect("the embedded font is a valid font");
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_covered_pixels_are_grey() {
        let mut canvas = Canvas::new([3, 2], 2);
        canvas.paint([0, 0, 1, 4], |_, _| Some([0.0; 3]));
        let averaged = canvas.image().pixels;
        assert_eq!(averaged.len(), 3 * 3 * 2);
        assert_eq!(averaged[0], 127);
        assert_eq!(averaged[3], 255);
    }

    #[test]
    fn what_white_and_black_show_gives_color_and_opacity() {
        let on = |background| {
            let mut canvas = Canvas::colored([2, 1], 2, [background; 3]);
            canvas.paint([0, 0, 1, 2], |_, _| Some([1.0, 0.5, 0.0]));
            canvas.image()
        };
        let image = without_background(&on(255), &on(0));
        assert!((126..=129).contains(&image.opacity[0]), "{:?}", image.opacity);
        assert_eq!(image.opacity[1], 0);
        let [r, g, b] = image.color(0, 0);
        assert!(r > 250 && (125..=130).contains(&g) && b == 0, "{r} {g} {b}");
    }
}
