//! Images of eight bits a colour, as PNG files and as animated PNG files, which browsers play.

use std::borrow::Cow;
use std::fs::File;
use std::io::{self, BufReader, Write};
use std::path::Path;

/// An image: sRGB, three bytes a pixel, rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// Red, green and blue of each pixel.
    pub pixels: Vec<u8>,
    /// How much each pixel hides of what lies behind the image, 0 to 255; empty if all hide everything.
    pub opacity: Vec<u8>,
}

/// A byte of a PNG file holds at most so many of its image, as packed by deflate.
const MOST_UNPACKED: u64 = 1032;

impl Image {
    /// An image of one colour.
    pub fn new(size: [usize; 2], color: [u8; 3]) -> Self {
        Image::opaque(size, color.repeat(size[0] * size[1]))
    }

    /// An image that hides what lies behind it.
    pub fn opaque(size: [usize; 2], pixels: Vec<u8>) -> Self {
        Image { size, pixels, opacity: Vec::new() }
    }

    /// Red, green, blue and opacity of each pixel.
    pub fn with_opacity(&self) -> Vec<u8> {
        let opacity = self.opacity.iter().copied().chain(std::iter::repeat(255));
        self.pixels.chunks_exact(3).zip(opacity).flat_map(|(rgb, a)| [rgb[0], rgb[1], rgb[2], a]).collect()
    }

    /// The colour of a pixel, counted from the left and from the top.
    ///
    /// # Panics
    /// The pixel is outside.
    pub fn color(&self, x: usize, y: usize) -> [u8; 3] {
        assert!(x < self.size[0]);
        let start = 3 * (y * self.size[0] + x);
        [self.pixels[start], self.pixels[start + 1], self.pixels[start + 2]]
    }

    /// Writes the image as PNG.
    ///
    /// # Errors
    /// The writer refuses.
    pub fn write_png(&self, to: &mut dyn Write) -> io::Result<()> {
        let mut writer = self.encoder(to).write_header()?;
        writer.write_image_data(&self.data())?;
        Ok(writer.finish()?)
    }

    /// The pixels as PNG files have them.
    fn data(&self) -> Cow<'_, [u8]> {
        if self.opacity.is_empty() { Cow::Borrowed(&self.pixels) } else { Cow::Owned(self.with_opacity()) }
    }

    /// Reads a PNG file that [`Image::write_png`] wrote.
    ///
    /// # Errors
    /// The file cannot be read, is damaged, or has another kind of pixels.
    pub fn read_png(path: &Path) -> io::Result<Self> {
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        let mut reader = png::Decoder::new(BufReader::new(file)).read_info()?;
        let size = [reader.info().width as usize, reader.info().height as usize];
        let wrong = |what| io::Error::new(io::ErrorKind::InvalidData, what);
        let channels = match reader.output_color_type() {
            (png::ColorType::Rgb, png::BitDepth::Eight) => 3,
            (png::ColorType::Rgba, png::BitDepth::Eight) => 4,
            _ => return Err(wrong("not an image of eight bits a colour")),
        };
        let bytes = reader.output_buffer_size().filter(|&bytes| bytes as u64 <= MOST_UNPACKED * length);
        let mut pixels = vec![0; bytes.ok_or_else(|| wrong("more pixels than the file can hold"))?];
        reader.next_frame(&mut pixels)?;
        if channels == 3 {
            return Ok(Image::opaque(size, pixels));
        }
        let opacity = pixels.iter().skip(3).step_by(4).copied().collect();
        let pixels = pixels.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        Ok(Image { size, pixels, opacity })
    }

    fn encoder<'a>(&self, to: &'a mut dyn Write) -> png::Encoder<'static, &'a mut dyn Write> {
        let mut encoder = png::Encoder::new(to, self.size[0] as u32, self.size[1] as u32);
        let opaque = self.opacity.is_empty();
        encoder.set_color(if opaque { png::ColorType::Rgb } else { png::ColorType::Rgba });
        // Pictures are written while a run goes on: a little larger, but many times faster than with the default.
        encoder.set_compression(png::Compression::Fast);
        let software = encoder.add_text_chunk("Software".to_string(), "Stickslip".to_string());
        software.expect("any text is taken");
        encoder
    }
}

/// Writes images as one animated PNG (APNG) that plays for ever, `rate` images a second.
///
/// A program that does not know animations shows the first image. Images are asked for one by one, so that a long film
/// need not fit into memory.
///
/// # Errors
/// There are no images, one cannot be had or has another size than the first, or the writer refuses.
pub fn write_animation(
    mut images: impl ExactSizeIterator<Item = io::Result<Image>>,
    rate: f64,
    to: &mut dyn Write,
) -> io::Result<()> {
    let count = images.len() as u32;
    let wrong = |what| io::Error::new(io::ErrorKind::InvalidInput, what);
    let first = images.next().ok_or_else(|| wrong("an animation of no images"))??;
    let mut encoder = first.encoder(to);
    encoder.set_animated(count, 0)?;
    // The delay is a fraction of two small whole numbers.
    encoder.set_frame_delay((1000.0 / rate).round().clamp(1.0, 60_000.0) as u16, 1000)?;
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&first.data())?;
    for image in images {
        let image = image?;
        if image.size != first.size || image.opacity.len() != first.opacity.len() {
            return Err(wrong("an animation of images of different sizes"));
        }
        writer.write_image_data(&image.data())?;
    }
    Ok(writer.finish()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(shade: u8) -> Image {
        let mut image = Image::new([7, 5], [shade, 2, 200]);
        image.pixels[3] = 255 - shade;
        image
    }

    #[test]
    fn an_image_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        image(9).write_png(&mut File::create(&path).unwrap()).unwrap();
        assert_eq!(Image::read_png(&path).unwrap(), image(9));
        let clear = Image { opacity: (0..35).collect(), ..image(9) };
        clear.write_png(&mut File::create(&path).unwrap()).unwrap();
        assert_eq!(Image::read_png(&path).unwrap(), clear);
    }

    #[test]
    fn an_image_of_more_pixels_than_its_file_holds_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let file = File::create(&path).unwrap();
        let mut encoder = png::Encoder::new(file, 1 << 20, 1 << 20);
        encoder.set_color(png::ColorType::Rgb);
        encoder.write_header().unwrap().write_chunk(png::chunk::IDAT, &[0x78, 1]).unwrap();
        assert!(Image::read_png(&path).unwrap_err().to_string().contains("more pixels"));
    }

    #[test]
    fn an_animation_has_every_image_and_its_delay() {
        let mut file = Vec::new();
        write_animation([3, 60, 120].into_iter().map(|shade| Ok(image(shade))), 8.0, &mut file).unwrap();
        let mut reader = png::Decoder::new(io::Cursor::new(file)).read_info().unwrap();
        let control = reader.info().animation_control.unwrap();
        assert_eq!((control.num_frames, control.num_plays), (3, 0));
        for shade in [3, 60, 120] {
            let mut pixels = vec![0; 3 * 7 * 5];
            reader.next_frame(&mut pixels).unwrap();
            assert_eq!(pixels, image(shade).pixels);
            let frame = reader.info().frame_control.unwrap();
            assert_eq!((frame.delay_num, frame.delay_den), (125, 1000));
        }
    }

    #[test]
    fn images_of_two_sizes_make_no_animation() {
        let images = [Ok(image(1)), Ok(Image::new([4, 4], [0; 3]))];
        assert!(write_animation(images.into_iter(), 8.0, &mut Vec::new()).is_err());
        let nothing: [io::Result<Image>; 0] = [];
        assert!(write_animation(nothing.into_iter(), 8.0, &mut Vec::new()).is_err());
    }
}
