//! Particles that leave a body's columns for another rank and come from there, as bytes.
//!
//! Those of some particles are their numbers, and then entry by entry what all of them have, little-endian.

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
        4 => bytes.extend_from_slice(&(x.f64() as f32).to_le_bytes()),
        _ => bytes.extend_from_slice(&x.f64().to_le_bytes()),
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

/// What other ranks see of particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// Where they are and were, and their shape and volume.
    Places,
    /// Mass and stress, too.
    Everything,
}

impl<T: Real, const D: usize> Particles<T, D> {
    /// Bytes of so many particles.
    pub fn message_bytes(&self, count: usize) -> usize {
        count * (size_of::<u32>() + self.entries() * size_of::<T>())
    }

    /// Bytes of so many guests.
    pub fn bytes_of_guests(&self, count: usize, shown: Shown) -> usize {
        count * (size_of::<u32>() + self.shown_to_others(shown).count() * size_of::<T>())
    }

    /// Writes particles behind a message.
    pub fn write_particles(&self, particles: &[u32], message: &mut Vec<u8>) {
        self.write_entries(particles, 0..self.entries(), message);
    }

    /// Writes particles behind a message as they are shown to others.
    pub fn write_guests(&self, particles: &[u32], shown: Shown, message: &mut Vec<u8>) {
        self.write_entries(particles, self.shown_to_others(shown), message);
    }

    /// The entries of particles that contact looks at.
    fn shown_to_others(&self, shown: Shown) -> impl Iterator<Item = usize> {
        type Start<const D: usize> = ColumnStart<D>;
        let of_motion = Start::<D>::VELOCITY..Start::<D>::MASS;
        let of_force = |entry: usize| {
            entry == Start::<D>::MASS || (Start::<D>::STRESS..Start::<D>::START).contains(&entry)
        };
        (0..ColumnStart::<D>::COUNT)
            .filter(move |&entry| !of_motion.contains(&entry))
            .filter(move |&entry| shown == Shown::Everything || !of_force(entry))
    }

    fn write_entries(&self, particles: &[u32], entries: impl Iterator<Item = usize>, message: &mut Vec<u8>) {
        let numbers = &self.numbers[self.first_number()..][..self.len];
        for &particle in particles {
            message.extend_from_slice(&numbers[particle as usize].to_le_bytes());
        }
        for entry in entries {
            let line = &self.columns[self.first() + entry * self.stride..][..self.len];
            particles.iter().for_each(|&particle| write_number(line[particle as usize], message));
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

    /// Puts particles behind those that are there, as more of them.
    pub fn take_in(&mut self, bytes: &[u8], count: usize) {
        self.guests = 0;
        self.read_entries(bytes, (self.len, count), 0..self.entries());
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

    /// Puts particles behind those that are there and their guests, as more guests.
    pub fn receive_guests(&mut self, bytes: &[u8], count: usize, shown: Shown) {
        let entries: Vec<usize> = self.shown_to_others(shown).collect();
        self.read_entries(bytes, (self.len + self.guests, count), entries.into_iter());
        self.guests += count;
    }

    /// Sends all guests away.
    pub fn dismiss_guests(&mut self) {
        self.guests = 0;
    }

    /// How many belong to another rank.
    pub fn guests(&self) -> usize {
        self.guests
    }

    /// Gives so many particles from a place on what their bytes say.
    fn read_entries(
        &mut self,
        bytes: &[u8],
        (place, count): (usize, usize),
        entries: impl Iterator<Item = usize>,
    ) {
        self.make_room(place + count);
        let (first, first_number) = (self.first(), self.first_number());
        let (numbers, mut rest) = bytes.split_at(count * size_of::<u32>());
        let places = self.numbers[first_number + place..].iter_mut();
        for (number, bytes) in places.zip(numbers.as_chunks().0) {
            *number = u32::from_le_bytes(*bytes);
        }
        for entry in entries {
            let (own, others) = rest.split_at(count * size_of::<T>());
            let line = &mut self.columns[first + entry * self.stride + place..][..count];
            line.iter_mut()
                .zip(own.chunks_exact(size_of::<T>()))
                .for_each(|(x, bytes)| *x = number_of(bytes));
            rest = others;
        }
    }

    /// Makes room for so many particles, those that are there at the same places.
    fn make_room(&mut self, count: usize) {
        if count > self.stride {
            self.give_room(Self::stride_of(count + count / 16));
        }
    }

    /// Gives back the memory of particles that are gone.
    pub fn fit(&mut self) {
        self.give_room(Self::stride_of(self.len + self.guests));
    }

    /// Gives columns this room, which is enough, in the memory that is there if it can grow or shrink.
    fn give_room(&mut self, stride: usize) {
        self.settle();
        let (there, columns, before) = (self.len + self.guests, Self::columns_of(self.own()), self.stride);
        let move_column = |columns: &mut Vec<T>, entry: usize| {
            columns.copy_within(entry * before..entry * before + there, entry * stride);
        };
        if stride > before {
            self.columns.reserve_exact(stride * columns - self.columns.len());
            self.columns.resize(stride * columns, T::ZERO);
            self.numbers.resize(2 * stride, 0);
            (0..self.entries()).rev().for_each(|entry| move_column(&mut self.columns, entry));
            ask_for_large(self.columns.as_ptr(), self.columns.len());
        } else {
            (0..self.entries()).for_each(|entry| move_column(&mut self.columns, entry));
            self.columns.truncate(stride * columns);
            self.numbers.truncate(2 * stride);
            self.columns.shrink_to_fit();
            self.numbers.shrink_to_fit();
        }
        self.stride = stride;
    }
}
