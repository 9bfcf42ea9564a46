//! PLY files: vertices and faces, as text or binary in either order of bytes.
//!
//! Turk (1994), The PLY Polygon File Format. A header names elements, how many of each there are, and what each has;
//! the elements follow. Of `vertex` x, y and z are taken, of `face` the list `vertex_indices` or `vertex_index`;
//! everything else is passed over. What a header announces is believed only as far as there are bytes.

/// Corners of triangles in the units of their file; polygons are cut into fans.
///
/// # Errors
/// What is wrong, in words.
pub fn triangles(bytes: &[u8]) -> Result<Vec<[[f64; 3]; 3]>, String> {
    let mut input = Input { bytes, encoding: Encoding::Text };
    let elements = header(&mut input)?;
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for element in &elements {
        // Each takes a byte at least.
        if element.properties.is_empty() {
            continue;
        }
        if element.count > input.bytes.len() as u64 {
            return Err(format!("{} of `{}` announced, and fewer bytes", element.count, element.name));
        }
        for _ in 0..element.count {
            match element.name.as_str() {
                "vertex" => corners.push(vertex(element, &mut input)?),
                "face" => face(element, &mut input, &corners, &mut triangles)?,
                _ => element.properties.iter().try_for_each(|property| property.read(&mut input, |_| ()))?,
            }
        }
    }
    Ok(triangles)
}

struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

struct Property {
    name: String,
    kind: Kind,
    /// Of a list, what counts its entries.
    counted_by: Option<Kind>,
}

/// How a number is stored.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Signed(usize),
    Unsigned(usize),
    Float(usize),
}

#[derive(Clone, Copy, PartialEq)]
enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// What is left of a file.
struct Input<'a> {
    bytes: &'a [u8],
    encoding: Encoding,
}

const ENDS_EARLY: &str = "it ends early";

/// Bytes that a line of a header may have.
const LONGEST_LINE: usize = 1000;

impl<'a> Input<'a> {
    fn line(&mut self) -> Result<&'a str, String> {
        let end = self.bytes.iter().take(LONGEST_LINE).position(|&byte| byte == b'\n').ok_or("no header")?;
        let line = std::str::from_utf8(&self.bytes[..end]).map_err(|_| "a header that is no text")?;
        self.bytes = &self.bytes[end + 1..];
        Ok(line.trim_end_matches('\r'))
    }

    fn number(&mut self, kind: Kind) -> Result<f64, String> {
        if self.encoding == Encoding::Text {
            let bytes = self.bytes.trim_ascii_start();
            let end = bytes.iter().position(u8::is_ascii_whitespace).unwrap_or(bytes.len());
            let (word, rest) = bytes.split_at(end);
            self.bytes = rest;
            let word = String::from_utf8_lossy(word);
            return match word.parse() {
                Ok(number) => Ok(number),
                Err(_) if word.is_empty() => Err(ENDS_EARLY.to_string()),
                Err(_) => Err(format!("`{word:.20}` where a number should be")),
            };
        }
        let (Kind::Signed(size) | Kind::Unsigned(size) | Kind::Float(size)) = kind;
        let (number, rest) = self.bytes.split_at_checked(size).ok_or(ENDS_EARLY)?;
        self.bytes = rest;
        // As its last bytes if the largest comes first.
        let mut all = [0; 8];
        if self.encoding == Encoding::BigEndian {
            (0..size).for_each(|i| all[i] = number[size - 1 - i]);
        } else {
            all[..size].copy_from_slice(number);
        }
        let bits = u64::from_le_bytes(all);
        Ok(match kind {
            Kind::Unsigned(_) => bits as f64,
            Kind::Signed(_) => {
                let unused = 64 - 8 * size as u32;
                ((bits << unused) as i64 >> unused) as f64
            }
            Kind::Float(4) => f64::from(f32::from_bits(bits as u32)),
            Kind::Float(_) => f64::from_bits(bits),
        })
    }
}

impl Kind {
    fn named(word: &str) -> Result<Self, String> {
        Ok(match word {
            "char" | "int8" => Kind::Signed(1),
            "uchar" | "uint8" => Kind::Unsigned(1),
            "short" | "int16" => Kind::Signed(2),
            "ushort" | "uint16" => Kind::Unsigned(2),
            "int" | "int32" => Kind::Signed(4),
            "uint" | "uint32" => Kind::Unsigned(4),
            "float" | "float32" => Kind::Float(4),
            "double" | "float64" => Kind::Float(8),
            _ => return Err(format!("numbers of the unknown kind `{word:.20}`")),
        })
    }
}

impl Property {
    /// Each of its numbers, of a list the entries.
    fn read(&self, input: &mut Input, mut each: impl FnMut(f64)) -> Result<(), String> {
        let count = self.counted_by.map_or(Ok(1.0), |kind| input.number(kind))?;
        if count < 0.0 || count.fract() != 0.0 || count > input.bytes.len() as f64 {
            return Err(format!("a list of {count} numbers"));
        }
        for _ in 0..count as usize {
            each(input.number(self.kind)?);
        }
        Ok(())
    }
}

fn header(input: &mut Input) -> Result<Vec<Element>, String> {
    if input.line()? != "ply" {
        return Err("no header".to_string());
    }
    let mut elements: Vec<Element> = Vec::new();
    let mut encoding = None;
    loop {
        let line = input.line()?;
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["format", "ascii", _] => encoding = Some(Encoding::Text),
            ["format", "binary_little_endian", _] => encoding = Some(Encoding::LittleEndian),
            ["format", "binary_big_endian", _] => encoding = Some(Encoding::BigEndian),
            ["comment" | "obj_info", ..] | [] => {}
            ["element", name, count] => {
                let count = count.parse().map_err(|_| format!("`{count:.20}` of `{name:.20}`"))?;
                elements.push(Element { name: name.to_string(), count, properties: Vec::new() });
            }
            ["property", ref property @ ..] => {
                let (name, kind, counted_by) = match property {
                    ["list", count, kind, name] => (name, kind, Some(Kind::named(count)?)),
                    [kind, name] => (name, kind, None),
                    _ => return Err(format!("a header with `{line:.40}`")),
                };
                let last = elements.last_mut().ok_or("a property before any element")?;
                let (name, kind) = (name.to_string(), Kind::named(kind)?);
                last.properties.push(Property { name, kind, counted_by });
            }
            ["end_header"] => break,
            _ => return Err(format!("a header with `{line:.40}`")),
        }
    }
    input.encoding = encoding.ok_or("a header without its format")?;
    Ok(elements)
}

fn vertex(element: &Element, input: &mut Input) -> Result<[f64; 3], String> {
    let mut corner = [None; 3];
    for property in &element.properties {
        let axis = ["x", "y", "z"].iter().position(|axis| property.name == *axis);
        property.read(input, |number| {
            if let Some(axis) = axis {
                corner[axis] = Some(number);
            }
        })?;
    }
    match corner {
        [Some(x), Some(y), Some(z)] => Ok([x, y, z]),
        _ => Err("vertices without x, y or z".to_string()),
    }
}

fn face(
    element: &Element,
    input: &mut Input,
    corners: &[[f64; 3]],
    triangles: &mut Vec<[[f64; 3]; 3]>,
) -> Result<(), String> {
    let mut polygon = Vec::new();
    for property in &element.properties {
        let holds_corners = matches!(property.name.as_str(), "vertex_indices" | "vertex_index");
        property.read(input, |number| {
            if holds_corners {
                polygon.push(number);
            }
        })?;
    }
    let corner = |&number: &f64| {
        let known = number >= 0.0 && number.fract() == 0.0 && number < corners.len() as f64;
        let found = known.then(|| corners[number as usize]);
        found.ok_or_else(|| format!("a face with vertex {number} of {}", corners.len()))
    };
    let polygon = polygon.iter().map(corner).collect::<Result<Vec<_>, _>>()?;
    triangles.extend(polygon.windows(2).skip(1).map(|pair| [polygon[0], pair[0], pair[1]]));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TEXT: &str = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty double x\nproperty float y\n\
        property int z\nproperty uchar red\nelement tip 1\nproperty list uchar short of\nelement face 2\n\
        property list uchar int vertex_indices\nend_header\n\
        0 0 0 9\n1 0.5 0 9\n1 1 0 9\n-2 1 -3 9\n2 7 -7\n4 0 1 2 3\n3 0 2 1\n";

    /// The same file in bytes.
    fn binary(large_first: bool) -> Vec<u8> {
        let order = if large_first { "binary_big_endian" } else { "binary_little_endian" };
        let end = TEXT.find("0 0 0 9").expect("the elements");
        let mut bytes = TEXT[..end].replace("ascii", order).into_bytes();
        let mut put = |number: &[u8]| match large_first {
            true => bytes.extend(number),
            false => bytes.extend(number.iter().rev()),
        };
        for (x, y, z) in [(0.0_f64, 0.0_f32, 0_i32), (1.0, 0.5, 0), (1.0, 1.0, 0), (-2.0, 1.0, -3)] {
            put(&x.to_be_bytes());
            put(&y.to_be_bytes());
            put(&z.to_be_bytes());
            put(&[9]);
        }
        put(&[2]);
        [7_i16, -7].iter().for_each(|of| put(&of.to_be_bytes()));
        for face in [&[0_i32, 1, 2, 3][..], &[0, 2, 1]] {
            put(&[face.len() as u8]);
            face.iter().for_each(|corner| put(&corner.to_be_bytes()));
        }
        bytes
    }

    #[test]
    fn text_and_both_orders_of_bytes_hold_the_same_triangles() {
        let [a, b, c, d] = [[0.0; 3], [1.0, 0.5, 0.0], [1.0, 1.0, 0.0], [-2.0, 1.0, -3.0]];
        let expected = Ok(vec![[a, b, c], [a, c, d], [a, c, b]]);
        assert_eq!(triangles(TEXT.as_bytes()), expected);
        assert_eq!(triangles(&binary(true)), expected);
        assert_eq!(triangles(&binary(false)), expected);
        assert_eq!(triangles(TEXT.replace('\n', "\r\n").as_bytes()), expected);
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (from, to, expected) in [
            ("ply\n", "plx\n", "no header"),
            ("format ascii 1.0\n", "", "a header without its format"),
            ("vertex 4", "vertex 4000000000000", "4000000000000 of `vertex` announced, and fewer bytes"),
            ("double x", "double a", "vertices without x, y or z"),
            ("double x", "half x", "numbers of the unknown kind `half`"),
            ("4 0 1 2 3", "4 0 1 2 4", "a face with vertex 4 of 4"),
            ("4 0 1 2 3", "-4 0 1 2 3", "a list of -4 numbers"),
            ("0.5", "half", "`half` where a number should be"),
            ("3 0 2 1\n", "3 0 2", "it ends early"),
        ] {
            assert_eq!(triangles(TEXT.replacen(from, to, 1).as_bytes()), Err(expected.to_string()));
        }
    }

    proptest! {
        /// Whatever is in a file, it is read or refused.
        #[test]
        fn garbled_files_are_refused(
            text in any::<bool>(),
            cut in 0..600usize,
            changes in prop::collection::vec((0..600usize, any::<u8>()), 0..8),
        ) {
            let mut bytes = if text { TEXT.as_bytes().to_vec() } else { binary(cut % 2 == 0) };
            for (at, byte) in changes {
                let at = at % bytes.len();
                bytes[at] = byte;
            }
            bytes.truncate(cut);
            let _ = triangles(&bytes);
        }
    }
}
