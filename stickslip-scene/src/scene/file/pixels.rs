//! The pixels of PNG and TIFF files, as one grey or label each.

use std::cmp::Ordering;
use std::io::Cursor;

/// One image of a file.
pub struct Slice {
    /// Pixels along x and y.
    pub size: [usize; 2],
    /// Row by row, the uppermost first, each from the left.
    pub values: Vec<f32>,
}

/// A byte of a file holds at most about so many of an image's, as packed by deflate or LZW.
const MOST_UNPACKED: usize = 2048;

/// The image of a PNG file of at most so many pixels: greys, those of an indexed file their numbers in the palette;
/// what is transparent keeps its grey.
///
/// # Errors
/// What is wrong, in words.
pub fn png(bytes: &[u8], most: usize) -> Result<Vec<Slice>, String> {
    let garbled = |reason: png::DecodingError| format!("no PNG: {reason}");
    // A line of pixels at a time; eight bytes are the most that a pixel has.
    let limits = png::Limits { bytes: 1 << 26 };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(png::Transformations::IDENTITY);
    let mut reader = decoder.read_info().map_err(garbled)?;
    let [width, height] = [reader.info().width, reader.info().height].map(|side| side as usize);
    let size = checked([width, height], most)?;
    let (color, depth) = reader.output_color_type();
    let length = reader.output_buffer_size().ok_or("too many pixels")?;
    if length / MOST_UNPACKED > bytes.len() {
        return Err(format!(
            "{width} x {height} pixels in a file of {} bytes, which ends early",
            bytes.len()
        ));
    }
    let mut buffer = vec![0; length];
    let frame = reader.next_frame(&mut buffer).map_err(garbled)?;
    let (bits, samples) = (depth as usize, color.samples());
    let sample = |row: &[u8], number: usize| -> f32 {
        match bits {
            8 => f32::from(row[number]),
            16 => f32::from(u16::from_be_bytes([row[2 * number], row[2 * number + 1]])),
            _ => {
                let shift = 8 - bits - number * bits % 8;
                f32::from(row[number * bits / 8] >> shift & ((1 << bits) - 1))
            }
        }
    };
    let mut values = Vec::with_capacity(width * height);
    for (y, row) in buffer.chunks_exact(frame.line_size).take(height).enumerate() {
        for x in 0..width {
            let value = sample(row, x * samples);
            if samples >= 3 && (1..3).any(|k| sample(row, x * samples + k) != value) {
                return Err(format!("colours, first at column {} of row {}", x + 1, y + 1));
            }
            values.push(value);
        }
    }
    Ok(vec![Slice { size, values }])
}

/// The pages of a TIFF file of at most so many pixels in all.
///
/// # Errors
/// What is wrong, in words.
pub fn tiff(bytes: &[u8], most: usize) -> Result<Vec<Slice>, String> {
    use tiff::decoder::{Decoder, DecodingResult};
    let garbled = |reason: tiff::TiffError| format!("no TIFF: {reason}");
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(garbled)?;
    let (mut slices, mut left) = (Vec::new(), most);
    loop {
        let (width, height) = decoder.dimensions().map_err(garbled)?;
        let size = checked([width as usize, height as usize], left)?;
        if size[0] * size[1] / MOST_UNPACKED > bytes.len() {
            return Err(format!(
                "{width} x {height} pixels in a file of {} bytes, which ends early",
                bytes.len()
            ));
        }
        left -= size[0] * size[1];
        let color = decoder.colortype().map_err(garbled)?;
        if !matches!(color, tiff::ColorType::Gray(8 | 16 | 32 | 64)) {
            return Err(format!("pixels of the kind {color:?}"));
        }
        let values: Vec<f32> = match decoder.read_image().map_err(garbled)? {
            DecodingResult::U8(values) => values.into_iter().map(f32::from).collect(),
            DecodingResult::U16(values) => values.into_iter().map(f32::from).collect(),
            DecodingResult::U32(values) => values.into_iter().map(|value| value as f32).collect(),
            DecodingResult::I8(values) => values.into_iter().map(f32::from).collect(),
            DecodingResult::I16(values) => values.into_iter().map(f32::from).collect(),
            DecodingResult::I32(values) => values.into_iter().map(|value| value as f32).collect(),
            DecodingResult::F32(values) => values,
            DecodingResult::F64(values) => values.into_iter().map(|value| value as f32).collect(),
            _ => return Err(format!("numbers of {color:?} that are not read")),
        };
        if values.len() < size[0] * size[1] {
            return Err("it ends early".to_string());
        }
        slices.push(Slice { size, values });
        if !decoder.more_images() {
            return Ok(slices);
        }
        decoder.next_image().map_err(garbled)?;
    }
}

fn checked([width, height]: [usize; 2], most: usize) -> Result<[usize; 2], String> {
    let count = width.checked_mul(height).filter(|count| (1..=most).contains(count));
    count
        .map(|_| [width, height])
        .ok_or_else(|| format!("{width} x {height} pixels, of at most {most} in all"))
}

/// Names in the order in which people count: `slice 9` is before `slice 10`.
pub fn counted(a: &str, b: &str) -> Ordering {
    let (mut a, mut b) = (a, b);
    loop {
        let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
        let [of_a, of_b] = [digits(a), digits(b)];
        if of_a > 0 && of_b > 0 {
            let [x, y] = [&a[..of_a], &b[..of_b]].map(|digits| digits.trim_start_matches('0'));
            let order = x.len().cmp(&y.len()).then_with(|| x.cmp(y));
            if order != Ordering::Equal {
                return order;
            }
            (a, b) = (&a[of_a..], &b[of_b..]);
            continue;
        }
        let (mut of_a, mut of_b) = (a.chars(), b.chars());
        match (of_a.next(), of_b.next()) {
            (Some(x), Some(y)) if x == y => (a, b) = (of_a.as_str(), of_b.as_str()),
            (x, y) => return x.cmp(&y),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encoded(color: png::ColorType, depth: png::BitDepth, data: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 3, 2);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == png::ColorType::Indexed {
            encoder.set_palette(vec![0; 48]);
        }
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(data).expect("data");
        drop(writer);
        bytes
    }

    #[test]
    fn greys_of_all_depths_and_indices_are_numbers() {
        use png::{BitDepth, ColorType};
        for (color, depth, data, expected) in [
            (
                ColorType::Grayscale,
                BitDepth::Eight,
                &[1, 2, 3, 4, 5, 255][..],
                [1.0, 2.0, 3.0, 4.0, 5.0, 255.0],
            ),
            (ColorType::Indexed, BitDepth::Four, &[0x12, 0x30, 0x45, 0xf0], [1.0, 2.0, 3.0, 4.0, 5.0, 15.0]),
            (
                ColorType::Grayscale,
                BitDepth::One,
                &[0b1010_0000, 0b0110_0000],
                [1.0, 0.0, 1.0, 0.0, 1.0, 1.0],
            ),
            (
                ColorType::Grayscale,
                BitDepth::Sixteen,
                &[0, 1, 0, 2, 0, 3, 0, 4, 0, 5, 255, 255],
                [1.0, 2.0, 3.0, 4.0, 5.0, 65535.0],
            ),
            (
                ColorType::Rgb,
                BitDepth::Eight,
                &[1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6],
                [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
            ),
        ] {
            let slices = png(&encoded(color, depth, data), 6).expect("an image");
            assert_eq!(
                (slices[0].size, &slices[0].values[..]),
                ([3, 2], &expected[..]),
                "{color:?} {depth:?}"
            );
        }
    }

    #[test]
    fn what_is_no_image_or_too_large_is_refused() {
        let image = encoded(png::ColorType::Grayscale, png::BitDepth::Eight, &[0; 6]);
        let colours = encoded(
            png::ColorType::Rgb,
            png::BitDepth::Eight,
            &[1, 1, 1, 2, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
        );
        for (bytes, most, expected) in [
            (&image[..], 5, "3 x 2 pixels, of at most 5 in all"),
            (&image[..40], 6, "no PNG: "),
            (&colours, 6, "colours, first at column 2 of row 1"),
        ] {
            let found = png(bytes, most).err().expect("no image");
            assert!(found.starts_with(expected), "{found}");
        }
        for end in 0..image.len() {
            let _ = png(&image[..end], 6);
        }
        assert!(tiff(b"II*\0\x08\0\0\0", 100).err().expect("no image").starts_with("no TIFF: "));
    }

    #[test]
    fn more_pixels_than_a_file_can_hold_take_no_memory() {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 1 << 15, 1 << 15);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Sixteen);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_chunk(png::chunk::IDAT, &[0x78, 1]).expect("data");
        drop(writer);
        let found = png(&bytes, 1 << 30).err().expect("no image");
        assert!(found.starts_with("32768 x 32768 pixels in a file of "), "{found}");
        // Little-endian; width and height of 32768, eight bits, greys, and a strip of one byte.
        let mut bytes = b"II*\0\x08\0\0\0\x07\0".to_vec();
        for (tag, kind, value) in [
            (256_u16, 4_u16, 1_u32 << 15),
            (257, 4, 1 << 15),
            (258, 3, 8),
            (262, 3, 1),
            (273, 4, 8),
            (278, 4, 1 << 15),
            (279, 4, 1),
        ] {
            bytes.extend(tag.to_le_bytes());
            bytes.extend(kind.to_le_bytes());
            bytes.extend(1_u32.to_le_bytes());
            bytes.extend(value.to_le_bytes());
        }
        bytes.extend([0; 4]);
        let found = tiff(&bytes, 1 << 30).err().expect("no image");
        assert!(found.starts_with("32768 x 32768 pixels in a file of "), "{found}");
    }

    #[test]
    fn pages_of_a_tiff_come_in_their_order() {
        let mut bytes = Cursor::new(Vec::new());
        let mut encoder = tiff::encoder::TiffEncoder::new(&mut bytes).expect("a file");
        for page in [[1_u16, 2, 3, 4], [5, 6, 7, 800]] {
            encoder.write_image::<tiff::encoder::colortype::Gray16>(2, 2, &page).expect("a page");
        }
        let bytes = bytes.into_inner();
        let slices = tiff(&bytes, 8).expect("two pages");
        assert_eq!(slices.iter().map(|slice| slice.values[3]).collect::<Vec<_>>(), [4.0, 800.0]);
        assert_eq!(tiff(&bytes, 7).err().expect("too large"), "2 x 2 pixels, of at most 3 in all");
        for end in 0..bytes.len() {
            let _ = tiff(&bytes[..end], 8);
        }
    }

    #[test]
    fn nine_comes_before_ten() {
        let mut names = ["slice 10", "slice 9", "slice 009b", "a", "slice 1", "slice 010"];
        names.sort_by(|a, b| counted(a, b));
        assert_eq!(names, ["a", "slice 1", "slice 9", "slice 009b", "slice 10", "slice 010"]);
    }
}
