//! Writing points and their data.

use super::{BLOCK, Scalar, TIME};
use crate::column::Kind;
use crate::observe::file::{FileSum, OutputError, replace_summed};
use crate::scene::{Compression, Precision, SnapshotContent};
use flate2::write::ZlibEncoder;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

/// VTK's numbers of a cell that is a single point, and of a triangle.
const VTK_VERTEX: u8 = 1;
const VTK_TRIANGLE: u8 = 5;

/// What VTK calls a file's data: cells of any type, each with its own, or polygons.
#[derive(Clone, Copy, PartialEq, Eq)]
enum DataSet {
    UnstructuredGrid,
    PolyData,
}

/// A file of points, or of triangles between points (`.vtu`, or `.vtp` as polygons), encoded and ready to be written:
/// it borrows nothing, so that another thread may write it.
pub struct VtkFile {
    data_set: DataSet,
    precision: Precision,
    compression: Compression,
    fields: Vec<(&'static str, f64)>,
    /// At least one.
    pieces: Vec<Piece>,
}

/// Some of the points of a file, and the cells between them.
struct Piece {
    points: usize,
    /// Of cells.
    count: usize,
    geometry: Vec<Array>,
    cells: Vec<Array>,
    point_data: Vec<Array>,
}

/// How large a piece of a file is, and its arrays: all that the header says of it. All pieces have the same arrays.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::observe) struct PieceSize {
    points: usize,
    cells: usize,
    /// Bytes of each array, in the order of the file.
    arrays: Vec<u64>,
}

impl PieceSize {
    /// That of a piece of points, each a cell of its own, before its arrays are known.
    pub(in crate::observe) fn of_points(points: usize) -> Self {
        PieceSize { points, cells: points, arrays: Vec::new() }
    }
}

struct Array {
    name: Cow<'static, str>,
    /// Unit; empty where none is said.
    unit: String,
    kind: &'static str,
    components: &'static [&'static str],
    /// As it stands in the file: sizes of blocks, then blocks; without compression its size, then its numbers.
    bytes: Vec<u8>,
}

impl Array {
    fn new<T: Scalar>(
        name: &'static str,
        components: &'static [&'static str],
        (values, compression): (&[T], Compression),
    ) -> Self {
        let bytes = match compression {
            Compression::Zlib => compress(values),
            Compression::None => plain(values),
        };
        Array { name: name.into(), unit: String::new(), kind: T::NAME, components, bytes }
    }

    fn real(
        name: &'static str,
        components: &'static [&'static str],
        (values, precision, compression): (&[f64], Precision, Compression),
    ) -> Self {
        match precision {
            Precision::Double => Array::new(name, components, (values, compression)),
            Precision::Single => {
                let short: Vec<f32> = values.iter().map(|&value| value as f32).collect();
                Array::new(name, components, (&short, compression))
            }
        }
    }
}

/// An array before it has its own name.
const ANY: &str = "array";

/// Names of the components of what each point has.
fn components(kind: Kind) -> &'static [&'static str] {
    match kind {
        Kind::Number => NUMBER,
        Kind::Vector | Kind::Rotation => VECTOR,
        Kind::Symmetric => SYMMETRIC,
        Kind::Tensor => TENSOR,
    }
}

/// Names of the components of a number, of a vector, of a symmetric tensor and of a tensor, in VTK's order.
pub(in crate::observe) const NUMBER: &[&str] = &[""];
pub(in crate::observe) const VECTOR: &[&str] = &["X", "Y", "Z"];
const SYMMETRIC: &[&str] = &["XX", "YY", "ZZ", "XY", "YZ", "XZ"];
const TENSOR: &[&str] = &["XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"];

impl VtkFile {
    /// Points at a time [s], each a cell of its own, so that ParaView can threshold and select them one by one; of the
    /// content precision and compression count here.
    pub(in crate::observe) fn new(time: f64, positions: &[[f64; 3]], content: &SnapshotContent) -> Self {
        let numbers: Vec<i64> = (0..positions.len() as i64).collect();
        let mut file = VtkFile::of_cells(time, (positions, content), (&numbers, 1));
        file.typed(VTK_VERTEX);
        file
    }

    /// Triangles at a time [s], between points.
    pub(in crate::observe) fn of_triangles(
        time: f64,
        (positions, triangles): (&[[f64; 3]], &[[u32; 3]]),
        content: &SnapshotContent,
    ) -> Self {
        let corners: Vec<i64> = triangles.as_flattened().iter().map(|&corner| i64::from(corner)).collect();
        let mut file = VtkFile::of_cells(time, (positions, content), (&corners, 3));
        file.typed(VTK_TRIANGLE);
        file
    }

    /// The same as polygons (`.vtp`).
    pub(in crate::observe) fn of_polygons(
        time: f64,
        (positions, triangles): (&[[f64; 3]], &[[u32; 3]]),
        content: &SnapshotContent,
    ) -> Self {
        let corners: Vec<i64> = triangles.as_flattened().iter().map(|&corner| i64::from(corner)).collect();
        VtkFile::of_cells(time, (positions, content), (&corners, 3))
    }

    /// Says that all cells are of one type, which makes a grid of them.
    fn typed(&mut self, kind: u8) {
        self.data_set = DataSet::UnstructuredGrid;
        let compression = self.compression;
        let Piece { cells, count, .. } = self.last();
        cells.push(Array::new("types", NUMBER, (&vec![kind; *count], compression)));
    }

    /// Polygons of so many points each, by the numbers of these.
    fn of_cells(
        time: f64,
        (positions, content): (&[[f64; 3]], &SnapshotContent),
        (corners, each): (&[i64], usize),
    ) -> Self {
        let &SnapshotContent { precision, compression, .. } = content;
        let cells = corners.len() / each;
        let ends: Vec<i64> = (1..=cells).map(|cell| (cell * each) as i64).collect();
        VtkFile {
            data_set: DataSet::PolyData,
            precision,
            compression,
            fields: vec![(TIME, time)],
            pieces: vec![Piece {
                points: positions.len(),
                count: cells,
                geometry: vec![Array::real(
                    "points",
                    VECTOR,
                    (positions.as_flattened(), precision, compression),
                )],
                cells: vec![
                    Array::new("connectivity", NUMBER, (corners, compression)),
                    Array::new("offsets", NUMBER, (&ends, compression)),
                ],
                point_data: Vec::new(),
            }],
        }
    }

    /// The pieces of several files as one file, which all have the same arrays; one file at least.
    pub(in crate::observe) fn joined(files: impl Iterator<Item = VtkFile>) -> VtkFile {
        let joined = files.reduce(|mut file, other| {
            file.pieces.extend(other.pieces);
            file
        });
        joined.expect("there is a file")
    }

    /// The piece to which arrays are added.
    fn last(&mut self) -> &mut Piece {
        self.pieces.last_mut().expect("there is always one")
    }

    /// Adds a number that holds for the whole file.
    pub(in crate::observe) fn field(&mut self, name: &'static str, value: f64) {
        self.fields.push((name, value));
    }

    /// Adds an array with a whole number for each point.
    pub(in crate::observe) fn whole<T: Scalar>(&mut self, name: &'static str, values: &[T]) {
        let compression = self.compression;
        let Piece { points, point_data, .. } = self.last();
        assert_eq!(values.len(), *points, "`{name}` has a value for each point");
        point_data.push(Array::new(name, NUMBER, (values, compression)));
    }

    /// Adds an array with a value of so many components for each point, in the file's precision.
    pub(in crate::observe) fn real(
        &mut self,
        name: &'static str,
        components: &'static [&'static str],
        values: &[f64],
    ) {
        let (precision, compression) = (self.precision, self.compression);
        let Piece { points, point_data, .. } = self.last();
        assert_eq!(values.len(), *points * components.len(), "`{name}` has a value for each point");
        point_data.push(Array::real(name, components, (values, precision, compression)));
    }

    /// Adds an array that is described: its name, its unit and what each point has.
    pub(in crate::observe) fn described(&mut self, (name, unit): (&str, &str), kind: Kind, values: &[f64]) {
        self.real(ANY, components(kind), values);
        let array = self.last().point_data.last_mut().expect("it was just added");
        (array.name, array.unit) = (Cow::Owned(name.to_string()), unit.to_string());
    }

    /// Writes the file; it appears under its name once complete.
    ///
    /// # Errors
    /// The disk is full or refuses; then no file of this name appears.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        self.put(path).map(drop)
    }

    /// The same, with what went into the file.
    ///
    /// # Errors
    /// As [`VtkFile::write`].
    pub(in crate::observe) fn put(&self, path: &Path) -> Result<FileSum, OutputError> {
        replace_summed(path, |file| {
            file.write_all(self.header(&self.sizes()).as_bytes())?;
            let mut arrays = self.pieces.iter().flat_map(Piece::arrays);
            arrays.try_for_each(|array| file.write_all(&array.bytes))?;
            file.write_all(END)
        })
    }

    /// How large its pieces are.
    pub(in crate::observe) fn sizes(&self) -> Vec<PieceSize> {
        self.pieces.iter().map(Piece::size).collect()
    }

    /// The bytes of all arrays as they lie in the file; what is left is its header.
    pub(in crate::observe) fn take_bytes(&mut self) -> Vec<u8> {
        let arrays = self.pieces.iter_mut().flat_map(|piece| {
            let Piece { geometry, cells, point_data, .. } = piece;
            geometry.iter_mut().chain(cells).chain(point_data)
        });
        // Each array goes as soon as it is copied.
        arrays.fold(Vec::new(), |mut bytes, array| {
            bytes.extend_from_slice(&std::mem::take(&mut array.bytes));
            bytes
        })
    }

    /// Everything before the first byte of the appended data, of a file with arrays like its own in pieces of these
    /// sizes. How long it is does not depend on how long arrays are.
    pub(in crate::observe) fn header(&self, pieces: &[PieceSize]) -> String {
        let data_set = match self.data_set {
            DataSet::UnstructuredGrid => "UnstructuredGrid",
            DataSet::PolyData => "PolyData",
        };
        let mut xml = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"{data_set}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\""
        );
        xml += match self.compression {
            Compression::Zlib => " compressor=\"vtkZLibDataCompressor\">\n",
            Compression::None => ">\n",
        };
        xml += &format!("<{data_set}>\n<FieldData>\n");
        for (name, value) in &self.fields {
            xml += &format!(
                "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfTuples=\"1\" format=\"ascii\">{value:e}</DataArray>\n"
            );
        }
        xml += "</FieldData>\n";
        let mut offset = 0;
        pieces.iter().for_each(|piece| self.declare(piece, &mut offset, &mut xml));
        xml + &format!("</{data_set}>\n<AppendedData encoding=\"raw\">\n_")
    }

    /// What the header says of a piece whose arrays begin at an offset.
    fn declare(&self, size: &PieceSize, offset: &mut u64, xml: &mut String) {
        let &PieceSize { points, cells, ref arrays } = size;
        let (members, counts) = match self.data_set {
            DataSet::UnstructuredGrid => ("Cells", format!("NumberOfCells=\"{cells}\"")),
            DataSet::PolyData => {
                let others = "NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\"";
                ("Polys", format!("{others} NumberOfPolys=\"{cells}\""))
            }
        };
        *xml += &format!("<Piece NumberOfPoints=\"{points}\" {counts}>\n");
        let (like, mut lengths) = (&self.pieces[0], arrays.iter());
        for (tag, arrays) in
            [("Points", &like.geometry), (members, &like.cells), ("PointData", &like.point_data)]
        {
            *xml += &format!("<{tag}>\n");
            for array in arrays {
                array.declare(*offset, xml);
                *offset += lengths.next().copied().unwrap_or_default();
            }
            *xml += &format!("</{tag}>\n");
        }
        *xml += "</Piece>\n";
    }
}

/// Letters of an offset at most.
const MOST_OF_OFFSET: usize = "offset=\"\"".len() + 15;

/// What stands behind the appended data.
pub(in crate::observe) const END: &[u8] = b"\n</AppendedData>\n</VTKFile>\n";

impl Piece {
    fn arrays(&self) -> impl Iterator<Item = &Array> {
        self.geometry.iter().chain(&self.cells).chain(&self.point_data)
    }

    fn size(&self) -> PieceSize {
        let arrays = self.arrays().map(|array| array.bytes.len() as u64).collect();
        PieceSize { points: self.points, cells: self.count, arrays }
    }
}

impl Array {
    /// What the header says of it, as long whatever the offset is: with blanks behind it, since meshio looks for the
    /// number as it is.
    fn declare(&self, offset: u64, xml: &mut String) {
        let Array { name, unit, kind, components, .. } = self;
        let count = components.len();
        let mut line = || -> std::fmt::Result {
            write!(xml, "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{count}\"")?;
            if !unit.is_empty() {
                write!(xml, " Unit=\"{unit}\"")?;
            }
            if count > 1 {
                for (i, component) in components.iter().enumerate() {
                    write!(xml, " ComponentName{i}=\"{component}\"")?;
                }
            }
            let offset = format!("offset=\"{offset}\"");
            writeln!(xml, " format=\"appended\" {offset:<MOST_OF_OFFSET$}/>")
        };
        line().expect("a string takes all text");
    }
}

fn plain<T: Scalar>(values: &[T]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(size_of::<u64>() + size_of_val(values));
    u64::write(&[size_of_val(values) as u64], &mut bytes);
    T::write(values, &mut bytes);
    bytes
}

fn compress<T: Scalar>(values: &[T]) -> Vec<u8> {
    let blocks: Vec<Vec<u8>> = values
        .par_chunks(BLOCK / size_of::<T>())
        .map(|chunk| {
            let mut bytes = Vec::with_capacity(size_of_val(chunk));
            T::write(chunk, &mut bytes);
            block(&bytes, if T::NAME.starts_with("Float") { OF_REALS } else { OF_WHOLE })
        })
        .collect();
    let mut sizes = vec![blocks.len() as u64, BLOCK as u64, (size_of_val(values) % BLOCK) as u64];
    sizes.extend(blocks.iter().map(|block| block.len() as u64));
    let mut bytes = Vec::with_capacity(size_of_val(&sizes[..]) + blocks.iter().map(Vec::len).sum::<usize>());
    u64::write(&sizes, &mut bytes);
    blocks.iter().for_each(|block| bytes.extend_from_slice(block));
    bytes
}

/// How hard to look for what repeats: reals, which use all their bits, repeat next to nothing, however long one looks;
/// whole numbers do.
const OF_REALS: flate2::Compression = flate2::Compression::fast();
const OF_WHOLE: flate2::Compression = flate2::Compression::new(6);

fn block(bytes: &[u8], effort: flate2::Compression) -> Vec<u8> {
    let mut packed = ZlibEncoder::new(Vec::with_capacity(bytes.len()), effort);
    packed.write_all(bytes).and_then(|()| packed.finish()).expect("memory takes all bytes")
}
