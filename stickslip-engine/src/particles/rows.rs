//! Particles that leave a body's columns for another rank and come from there, as rows of bytes.
//!
//! A row is the particle's number and all entries of its columns, little-endian, one behind the other.

use super::{ColumnStart, Particles};
use crate::pages::ask_for_large;
use crate::tensor::Real;

/// Which of so many rows fill the holes that others leave, whose places ascend, so that those that stay lie at the
/// front: from where, and to where.
pub fn fill_holes(count: usize, gone: &[u32]) -> Vec<[u32; 2]> {
    let stay = count - gone.len();
    let (holes, behind) = gone.split_at(gone.partition_point(|&place| (place as usize) < stay));
    let from = (stay as u32..count as u32).filter(|place| behind.binary_search(place).is_err());
    from.zip(holes).map(|(from, &to)| [from, to]).collect()
}

/// Writes a number in its own precision behind bytes, little-endian.
pub fn write_number<T: Real>(x: T, bytes: &mut Vec<u8>) {
    match size_of::<T>() {
        4 => bytes.extend((x.f64() as f32).to_le_bytes()),
        _ => bytes.extend(x.f64().to_le_bytes()),
    }
}

/// A number of four or eight bytes, little-endian; zero of any other number of them.
pub fn number_of<T: Real>(bytes: &[u8]) -> T {
    match *bytes {
        [a, b, c, d] => T::of(f64::from(f32::from_le_bytes([a, b, c, d]))),
        [a, b, c, d, e, f, g, h] => T::of(f64::from_le_bytes([a, b, c, d, e, f, g, h])),
        _ => T::ZERO,
    }
}

impl<T: Real, const D: usize> Particles<T, D> {
    /// Bytes of a row.
    pub fn row_bytes(&self) -> usize {
        size_of::<u32>() + self.entries() * size_of::<T>()
    }

    /// Writes the rows of particles behind a message.
    pub fn write_rows(&self, particles: impl Iterator<Item = u32>, message: &mut Vec<u8>) {
        let (first, first_number) = (self.first(), self.first_number());
        for particle in particles {
            let particle = particle as usize;
            assert!(particle < self.len, "a particle of the body");
            message.extend(self.numbers[first_number + particle].to_le_bytes());
            for entry in 0..self.entries() {
                write_number(self.columns[first + entry * self.stride + particle], message);
            }
        }
    }

    /// Takes out particles by their places, which must ascend; others from the end take their places, as
    /// [`fill_holes`] says.
    pub fn take_out(&mut self, gone: &[u32]) -> Vec<[u32; 2]> {
        let moves = fill_holes(self.len, gone);
        let (first, first_number, stride) = (self.first(), self.first_number(), self.stride);
        for line in (0..self.entries()).map(|entry| first + entry * stride) {
            moves.iter().for_each(|&[from, to]| {
                self.columns[line + to as usize] = self.columns[line + from as usize]
            });
        }
        for &[from, to] in &moves {
            self.numbers[first_number + to as usize] = self.numbers[first_number + from as usize];
        }
        self.len -= gone.len();
        self.guests = 0;
        moves
    }

    /// Puts rows behind the particles, as more of them.
    pub fn take_in(&mut self, rows: &[u8]) {
        let count = rows.len() / self.row_bytes();
        self.guests = 0;
        self.read_rows(rows, self.len);
        let before = self.len;
        self.len += count;
        let same = |column: usize, value: T| self.line(column)[before..].iter().all(|x| *x == value);
        let alike = |[mass, half_width]: &[T; 2]| {
            same(ColumnStart::<D>::MASS, *mass) && same(ColumnStart::<D>::HALF_WIDTH, *half_width)
        };
        self.alike = self.alike.filter(alike);
        if before == 0 {
            // Of none nothing was known.
            self.compare();
        }
    }

    /// Puts rows behind the particles and their guests, as more guests.
    pub fn receive_guests(&mut self, rows: &[u8]) {
        self.read_rows(rows, self.len + self.guests);
        self.guests += rows.len() / self.row_bytes();
    }

    /// Sends all guests away.
    pub fn dismiss_guests(&mut self) {
        self.guests = 0;
    }

    /// How many belong to another rank.
    pub fn guests(&self) -> usize {
        self.guests
    }

    /// Writes rows to places from `place` on.
    fn read_rows(&mut self, rows: &[u8], place: usize) {
        let bytes = self.row_bytes();
        self.make_room(place + rows.len() / bytes);
        let (first, first_number) = (self.first(), self.first_number());
        for (row, place) in rows.chunks_exact(bytes).zip(place..) {
            let (number, entries) = row.split_first_chunk::<4>().expect("a row begins with a number");
            self.numbers[first_number + place] = u32::from_le_bytes(*number);
            for (entry, bytes) in entries.chunks_exact(size_of::<T>()).enumerate() {
                self.columns[first + entry * self.stride + place] = number_of(bytes);
            }
        }
    }

    /// Makes room for so many particles, those that are there at the same places.
    fn make_room(&mut self, count: usize) {
        if count > self.stride {
            self.move_to(Self::stride_of(count + count / 4));
        }
    }

    /// Gives back the memory of particles that are gone.
    pub fn fit(&mut self) {
        self.move_to(Self::stride_of(self.len + self.guests));
    }

    /// Moves to other memory, with this room for a column.
    fn move_to(&mut self, stride: usize) {
        let mut columns = vec![T::ZERO; stride * Self::columns_of(self.own())];
        ask_for_large(columns.as_ptr(), columns.len());
        let mut numbers = vec![0; 2 * stride];
        let (there, first, first_number) = (self.len + self.guests, self.first(), self.first_number());
        for entry in 0..self.entries() {
            let line = &self.columns[first + entry * self.stride..][..there];
            columns[entry * stride..][..there].copy_from_slice(line);
        }
        numbers[..there].copy_from_slice(&self.numbers[first_number..][..there]);
        (self.columns, self.numbers, self.stride, self.later) = (columns, numbers, stride, false);
    }
}
