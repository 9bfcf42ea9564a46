//! VTK's files of points or triangles in XML (`.vtu`, `.vtp`), with appended raw data, in blocks compressed by zlib or
//! as it is.
//!
//! Layout of the data of one array, all little-endian (VTK file formats, "Appended data" and "Compression"):
//!
//! ```text
//! u64 blocks, u64 bytes of a full block, u64 bytes of a partial last block (0: none),
//! u64 compressed bytes of each block, the blocks
//! ```
//! Without compression it is a u64 of all bytes, and these. A file of many points has several pieces, the arrays of one
//! behind those of the other. Blocks are independent. Numbers have the format that the
//! file is made with; in double precision they keep all their bits, and reading gives exactly what was written.

mod read;
mod write;

pub(super) use read::PointArrays;
pub use write::VtkFile;
pub(super) use write::{END, NUMBER, PieceSize, VECTOR};

/// The name that ParaView has for a field with the time.
pub(super) const TIME: &str = "TimeValue";

/// Bytes of a full block before compression: a multiple of every number's size, small enough to stay in a core's cache.
const BLOCK: usize = 1 << 17;

/// A number that an array can hold.
pub trait Scalar: Copy + Send + Sync {
    /// VTK's name of the type.
    const NAME: &'static str;
    /// Appends the number's bytes, little-endian.
    fn write(values: &[Self], bytes: &mut Vec<u8>);
    /// The numbers in bytes, little-endian.
    fn read(bytes: &[u8]) -> Vec<Self>;
}

macro_rules! scalar {
    ($($t:ty: $name:literal),*) => {$(
        impl Scalar for $t {
            const NAME: &'static str = $name;
            fn write(values: &[Self], bytes: &mut Vec<u8>) {
                bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
            }
            fn read(bytes: &[u8]) -> Vec<Self> {
                let (numbers, _) = bytes.as_chunks();
                numbers.iter().map(|&number| <$t>::from_le_bytes(number)).collect()
            }
        }
    )*};
}
scalar!(f64: "Float64", f32: "Float32", i32: "Int32", u32: "UInt32", i64: "Int64", u64: "UInt64", u8: "UInt8");
