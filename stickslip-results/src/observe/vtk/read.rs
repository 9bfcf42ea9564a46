//! Reading back files of points that a run wrote; it is no reader for the files of other programs.

use super::{BLOCK, Scalar};
use crate::column::Kind;
use crate::observe::file::{ReadError, ReadProblem, open_file, read_bytes};
use crate::observe::xml::attribute;
use flate2::read::ZlibDecoder;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read as _, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// An opened file of points.
pub(in crate::observe) struct PointArrays {
    path: PathBuf,
    bytes: Vec<u8>,
    /// Where the appended data starts.
    appended: usize,
    /// Whether it is packed.
    compressed: bool,
    /// Points of each piece.
    counts: Vec<usize>,
    fields: BTreeMap<String, f64>,
    /// Where the points are.
    positions: Option<ArrayPlace>,
    /// What each point has.
    arrays: BTreeMap<String, ArrayPlace>,
    /// Names of the arrays of what each point has, in the order of the file.
    names: Vec<String>,
}

/// Where an array lies in the appended data, and what it is made of.
struct ArrayPlace {
    kind: String,
    components: usize,
    /// Of each piece.
    offsets: Vec<usize>,
    unit: String,
}

impl ArrayPlace {
    /// Takes the place in the next piece.
    fn go_on(&mut self, next: ArrayPlace) -> Result<(), ReadProblem> {
        if (&self.kind, self.components) != (&next.kind, next.components) {
            return Err(missing("array of one kind in all pieces"));
        }
        self.offsets.extend(next.offsets);
        Ok(())
    }
}

impl PointArrays {
    /// Opens a file and reads what it holds; arrays are unpacked when asked for.
    pub(in crate::observe) fn open(path: &Path) -> Result<Self, ReadError> {
        let bytes = read_bytes(path).map_err(|error| ReadProblem::Io(error).at(path))?;
        let mut points = Self::nothing(path);
        points.read_header(&bytes).map_err(|problem| problem.at(path))?;
        points.bytes = bytes;
        Ok(points)
    }

    /// A piece of the file by itself: of the others no array is read.
    pub(in crate::observe) fn piece(&self, piece: usize) -> Result<Self, ReadError> {
        let open = || -> Result<Self, ReadProblem> {
            let cut = || missing(&format!("complete piece {piece}"));
            let all = || self.positions.iter().chain(self.arrays.values());
            let first = |piece: usize| all().map(|place| place.offsets.get(piece).copied()).min().flatten();
            let (begin, end) = (first(piece).ok_or_else(cut)?, first(piece + 1));
            if all().any(|place| place.offsets.len() != self.counts.len()) {
                return Err(cut());
            }
            let start = self.appended.checked_add(begin).ok_or_else(cut)?;
            let size = end.map_or(Some(usize::MAX), |end| end.checked_sub(begin)).ok_or_else(cut)?;
            let (mut file, mut bytes) = (open_file(&self.path)?, Vec::new());
            file.seek(SeekFrom::Start(start as u64))?;
            file.take(size as u64).read_to_end(&mut bytes)?;
            let alone = |place: &ArrayPlace| ArrayPlace {
                kind: place.kind.clone(),
                components: place.components,
                offsets: vec![place.offsets[piece] - begin],
                unit: place.unit.clone(),
            };
            Ok(PointArrays {
                path: self.path.clone(),
                bytes,
                appended: 0,
                compressed: self.compressed,
                counts: vec![self.counts[piece]],
                fields: self.fields.clone(),
                positions: self.positions.as_ref().map(alone),
                arrays: self.arrays.iter().map(|(name, place)| (name.clone(), alone(place))).collect(),
                names: self.names.clone(),
            })
        };
        open().map_err(|problem| problem.at(&self.path))
    }

    /// Opens a file and reads what it holds, but no array.
    pub(in crate::observe) fn open_head(path: &Path) -> Result<Self, ReadError> {
        let open = || Self::head_of(&mut open_file(path)?, path);
        open().map_err(|problem| problem.at(path))
    }

    fn head_of(file: &mut File, path: &Path) -> Result<Self, ReadProblem> {
        let (mut bytes, mut points) = (Vec::new(), Self::nothing(path));
        loop {
            let before = bytes.len();
            let read = file.take(HEAD).read_to_end(&mut bytes)?;
            // What ends it may lie across what is read at a time.
            if read == 0 || appended(&bytes[before.saturating_sub(2 * TAG.len())..]).is_some() {
                points.read_header(&bytes)?;
                return Ok(points);
            }
        }
    }

    fn nothing(path: &Path) -> Self {
        PointArrays {
            path: path.to_path_buf(),
            bytes: Vec::new(),
            appended: 0,
            compressed: false,
            counts: Vec::new(),
            fields: BTreeMap::new(),
            positions: None,
            arrays: BTreeMap::new(),
            names: Vec::new(),
        }
    }

    /// How many pieces the file has.
    pub(in crate::observe) fn pieces(&self) -> usize {
        self.counts.len()
    }

    fn read_header(&mut self, bytes: &[u8]) -> Result<(), ReadProblem> {
        let (end, start) = appended(bytes).ok_or_else(|| missing("appended raw data"))?;
        self.appended = start;
        // The appended data is no XML: the reader must not see it.
        let header = str::from_utf8(&bytes[..end]).map_err(|_| missing("readable header"))?;

        let mut reader = Reader::from_str(header);
        let (mut field, mut section) = (None, String::new());
        loop {
            match reader.read_event()? {
                Event::Start(tag) if tag.name().0 == "VTKFile" => {
                    self.compressed = attribute::<String>(&tag, "compressor").is_ok();
                    if self.compressed {
                        expect(&tag, "compressor", "vtkZLibDataCompressor")?;
                    }
                    expect(&tag, "header_type", "UInt64")?;
                }
                Event::Start(tag) if tag.name().0 == "Piece" => {
                    self.counts.push(attribute(&tag, "NumberOfPoints")?);
                }
                Event::Start(tag) if tag.name().0 == "DataArray" => {
                    field = Some(attribute(&tag, "Name")?);
                }
                Event::Text(text) => {
                    if let Some(name) = field.take() {
                        let value = text.trim().parse().map_err(|_| missing(&format!("number in {name}")))?;
                        self.fields.insert(name, value);
                    }
                }
                Event::Empty(tag) if tag.name().0 == "DataArray" => {
                    let place = ArrayPlace {
                        kind: attribute(&tag, "type")?,
                        components: attribute(&tag, "NumberOfComponents")?,
                        offsets: vec![attribute(&tag, "offset")?],
                        unit: attribute(&tag, "Unit").unwrap_or_default(),
                    };
                    let name: String = attribute(&tag, "Name")?;
                    match (&section[..], &mut self.positions, self.arrays.get_mut(&name)) {
                        ("Points", Some(positions), _) => positions.go_on(place)?,
                        ("Points", positions, _) => *positions = Some(place),
                        ("PointData", _, Some(array)) => array.go_on(place)?,
                        ("PointData", _, None) => {
                            self.names.push(name.clone());
                            self.arrays.insert(name, place);
                        }
                        // Each point is a cell of its own.
                        _ => {}
                    }
                }
                Event::Start(tag) => section = tag.name().0.to_string(),
                Event::Eof => return Ok(()),
                _ => {}
            }
        }
    }

    /// A number that holds for the whole file.
    pub(in crate::observe) fn field(&self, name: &str) -> Result<f64, ReadError> {
        self.fields.get(name).copied().ok_or_else(|| missing(&format!("field `{name}`")).at(&self.path))
    }

    /// Names of what each point has, in their order.
    pub(in crate::observe) fn names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(String::as_str)
    }

    /// How many points there are.
    pub(in crate::observe) fn count(&self) -> usize {
        self.counts.iter().fold(0, |sum, count| sum.saturating_add(*count))
    }

    /// Unit of an array and what each point has in it; `None` if there is no such array of real numbers.
    pub(in crate::observe) fn description(&self, name: &str) -> Option<(&str, Kind)> {
        let ArrayPlace { unit, components, .. } = self.arrays.get(name)?;
        let kind = match components {
            1 => Kind::Number,
            3 => Kind::Vector,
            6 => Kind::Symmetric,
            9 => Kind::Tensor,
            _ => return None,
        };
        Some((unit, kind))
    }

    /// An array as it describes itself: its unit, what each point has, and the values of one point after the other.
    pub(in crate::observe) fn described(&self, name: &str) -> Result<(String, Kind, Vec<f64>), ReadError> {
        let none = || missing(&format!("array `{name}`")).at(&self.path);
        let (unit, kind) = self.description(name).ok_or_else(none)?;
        let values = match kind {
            Kind::Number => self.reals::<1>(name)?.into_flattened(),
            Kind::Vector | Kind::Rotation => self.reals::<3>(name)?.into_flattened(),
            Kind::Symmetric => self.reals::<6>(name)?.into_flattened(),
            Kind::Tensor => self.reals::<9>(name)?.into_flattened(),
        };
        Ok((unit.to_string(), kind, values))
    }

    /// An array with one whole number for each point.
    pub(in crate::observe) fn whole<T: Scalar>(&self, name: &str) -> Result<Vec<T>, ReadError> {
        let array = self.unpack::<T, 1>(name, self.arrays.get(name));
        Ok(array.map_err(|problem| problem.at(&self.path))?.into_flattened())
    }

    /// An array with `N` numbers for each point, whatever the file's precision.
    pub(in crate::observe) fn reals<const N: usize>(&self, name: &str) -> Result<Vec<[f64; N]>, ReadError> {
        self.widened(name, self.arrays.get(name)).map_err(|problem| problem.at(&self.path))
    }

    /// Where the points are.
    pub(in crate::observe) fn positions<const N: usize>(&self) -> Result<Vec<[f64; N]>, ReadError> {
        self.widened("points", self.positions.as_ref()).map_err(|problem| problem.at(&self.path))
    }

    fn widened<const N: usize>(
        &self,
        name: &str,
        place: Option<&ArrayPlace>,
    ) -> Result<Vec<[f64; N]>, ReadProblem> {
        if place.is_some_and(|place| place.kind == f32::NAME) {
            let short = self.unpack::<f32, N>(name, place)?;
            return Ok(short.into_iter().map(|values| values.map(f64::from)).collect());
        }
        self.unpack(name, place)
    }

    fn unpack<T: Scalar, const N: usize>(
        &self,
        name: &str,
        place: Option<&ArrayPlace>,
    ) -> Result<Vec<[T; N]>, ReadProblem> {
        let wanted = || missing(&format!("array `{name}` of {} with {N} components", T::NAME));
        let place = place.ok_or_else(wanted)?;
        if place.kind != T::NAME || place.components != N {
            return Err(wanted());
        }
        let values = self.blocks(name, (place, N * size_of::<T>()), T::read)?.concat();
        Ok(values.as_chunks().0.to_vec())
    }

    /// The unpacked blocks of an array that has so many bytes for each point, each as `read` makes of it.
    fn blocks<R: Send>(
        &self,
        name: &str,
        (place, each): (&ArrayPlace, usize),
        read: impl Fn(&[u8]) -> R + Sync,
    ) -> Result<Vec<R>, ReadProblem> {
        let cut = || missing(&format!("complete array `{name}`"));
        if place.offsets.len() != self.counts.len() {
            return Err(cut());
        }
        let mut read_all = Vec::new();
        let mut packed = Vec::new();
        let mut free = 0;
        for (offset, count) in place.offsets.iter().zip(&self.counts) {
            let start = self.appended.checked_add(*offset).ok_or_else(cut)?;
            let bytes = self.bytes.get(start..).ok_or_else(cut)?;
            let total = count.checked_mul(each).ok_or_else(cut)?;
            // Pieces that lie upon each other would take memory out of proportion to the file.
            if *offset < free {
                return Err(cut());
            }
            if self.compressed {
                let blocks = split(bytes, total).ok_or_else(cut)?;
                free = offset
                    + 8 * (3 + blocks.len())
                    + blocks.iter().map(|(block, _)| block.len()).sum::<usize>();
                packed.extend(blocks);
                continue;
            }
            let (size, bytes) = bytes.split_first_chunk().ok_or_else(cut)?;
            let whole = bytes.get(..total).filter(|_| u64::from_le_bytes(*size) == total as u64);
            read_all.push(read(whole.ok_or_else(cut)?));
            free = offset + size_of::<u64>() + total;
        }
        let unpacked: Option<Vec<R>> = packed
            .into_par_iter()
            .map(|(packed, size)| {
                let mut bytes = Vec::with_capacity(size);
                // A block that says too much is none of ours.
                ZlibDecoder::new(packed).take(size as u64 + 1).read_to_end(&mut bytes).ok()?;
                (bytes.len() == size).then(|| read(&bytes))
            })
            .collect();
        read_all.extend(unpacked.ok_or_else(cut)?);
        Ok(read_all)
    }

    /// Unpacks all that each point has, which holds it against its own checksums.
    ///
    /// # Errors
    /// Something is cut short or damaged.
    pub(in crate::observe) fn check(&self) -> Result<(), ReadError> {
        let of_points = self.positions.iter().map(|place| ("points", place));
        let mut all = of_points.chain(self.arrays.iter().map(|(name, place)| (name.as_str(), place)));
        all.try_for_each(|(name, place)| {
            let bits: Option<usize> = place.kind.trim_start_matches(char::is_alphabetic).parse().ok();
            let each = bits.and_then(|bits| place.components.checked_mul(bits / 8));
            let each = each.ok_or_else(|| missing(&format!("array `{name}` of numbers")))?;
            self.blocks(name, (place, each), |_| ()).map(drop)
        })
        .map_err(|problem| problem.at(&self.path))
    }
}

/// Bytes of a file that are read at a time until all of its header is there.
const HEAD: u64 = 1 << 16;
/// What stands before the mark at which appended data starts.
const TAG: &[u8] = b"<AppendedData encoding=\"raw\">";

/// Where the header of a file ends that begins with these bytes, and where the appended data starts.
fn appended(bytes: &[u8]) -> Option<(usize, usize)> {
    let end = bytes.windows(TAG.len()).position(|window| window == TAG)?;
    let mark = bytes[end..].iter().position(|&byte| byte == b'_')?;
    Some((end, end + mark + 1))
}

/// The packed blocks of an array of `total` bytes with the size of each when unpacked;
/// `None` if they are not all there.
fn split(bytes: &[u8], total: usize) -> Option<Vec<(&[u8], usize)>> {
    let word = |i: usize| {
        let bytes = bytes.get(8 * i..8 * i + 8)?;
        usize::try_from(u64::from_le_bytes(bytes.try_into().ok()?)).ok()
    };
    let count = total.div_ceil(BLOCK);
    if word(0)? != count || word(1)? != BLOCK {
        return None;
    }
    let mut start = 8 * (3 + count);
    (0..count)
        .map(|i| {
            let end = start.checked_add(word(3 + i)?)?;
            let packed = bytes.get(start..end)?;
            start = end;
            Some((packed, BLOCK.min(total - i * BLOCK)))
        })
        .collect()
}

fn expect(tag: &BytesStart, name: &str, value: &str) -> Result<(), ReadProblem> {
    let found: String = attribute(tag, name)?;
    if found == value { Ok(()) } else { Err(missing(&format!("{name}=\"{value}\""))) }
}

fn missing(what: &str) -> ReadProblem {
    ReadProblem::Layout(format!("no {what}"))
}
