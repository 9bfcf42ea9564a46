//! Sums without round-off, which do not depend on the order of what is added.
//!
//! A sum of `f64` numbers that is rounded after each addition depends on the order of the numbers. What is booked of
//! bodies shall not depend on where particles lie in memory, nor on who sums which part of them: so it is added up in
//! whole numbers, and rounded once (Kulisch 2013, Computer Arithmetic and Validity; the digits are those of Neal 2015,
//! arXiv:1505.05571).

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Bits of a digit. Digits are kept in 64 bits, so that thousands of numbers are added before any is carried.
const DIGIT: u32 = 32;

/// Digits from the smallest number that there is to 2^64 times the largest.
const DIGITS: usize = 70;

/// Numbers that are added before digits are carried: each adds less than 2^53 to a digit.
const CARRY: u32 = 1 << 9;

/// Bits of the fraction of a number.
const FRACTION: u32 = f64::MANTISSA_DIGITS - 1;

/// A sum of numbers as a whole multiple of the smallest one, 2^-1074.
///
/// ```text
/// sum = 2^-1074 sum_k digit_k 2^(32 k)
/// ```
#[derive(Clone, Debug)]
pub struct ExactSum {
    digits: [i64; DIGITS],
    /// How many numbers were added since digits were last carried.
    added: u32,
    /// Sum of what is not finite.
    beyond: f64,
}

impl Default for ExactSum {
    /// Nothing.
    fn default() -> Self {
        ExactSum { digits: [0; DIGITS], added: 0, beyond: 0.0 }
    }
}

impl ExactSum {
    /// Adds a number.
    #[inline]
    pub fn add(&mut self, x: f64) {
        let bits = x.to_bits();
        let exponent = (bits >> FRACTION) as u32 & 0x7ff;
        let fraction = bits & ((1 << FRACTION) - 1);
        if exponent == 0x7ff {
            self.beyond += x;
            return;
        }
        // Numbers below the smallest normal one have no leading bit, and the exponent of that.
        let whole = if exponent == 0 { fraction } else { fraction | 1 << FRACTION };
        let place = exponent.max(1) - 1;
        let (digit, shift) = ((place / DIGIT) as usize, place % DIGIT);
        let low = (whole << shift & ((1 << DIGIT) - 1)) as i64;
        let high = (whole >> (DIGIT - shift)) as i64;
        // x or -x without a branch: signs change at random.
        let sign = bits as i64 >> 63;
        self.digits[digit] += (low ^ sign) - sign;
        self.digits[digit + 1] += (high ^ sign) - sign;
        self.added += 1;
        if self.added == CARRY {
            self.carry();
        }
    }

    /// Merges sums that belong together with others, one by one.
    pub fn merge_each(sums: &mut [ExactSum], others: &[ExactSum]) {
        sums.iter_mut().zip(others).for_each(|(sum, other)| sum.merge(other));
    }

    /// Adds another sum.
    pub fn merge(&mut self, other: &ExactSum) {
        let mut other = other.clone();
        other.carry();
        self.carry();
        self.digits.iter_mut().zip(other.digits).for_each(|(digit, other)| *digit += other);
        self.added = 1;
        self.beyond += other.beyond;
    }

    /// Writes the sum behind bytes: whether it is negative and whether there is something that is not finite, the first
    /// digit that is not zero and how many follow, and these.
    pub fn write_to(&mut self, bytes: &mut Vec<u8>) {
        self.carry();
        let mut sum = self.clone();
        let negative = sum.digits[DIGITS - 1] < 0;
        if negative {
            sum.negate();
        }
        let is_there = |digit: &i64| *digit != 0;
        let first = sum.digits.iter().position(is_there).unwrap_or(DIGITS);
        let end = sum.digits.iter().rposition(is_there).map_or(first, |last| last + 1);
        bytes.extend([
            u8::from(negative) | u8::from(sum.beyond != 0.0) << 1,
            first as u8,
            (end - first) as u8,
        ]);
        sum.digits[first..end].iter().for_each(|digit| bytes.extend(digit.to_le_bytes()));
        if sum.beyond != 0.0 {
            bytes.extend(sum.beyond.to_le_bytes());
        }
    }

    /// The sum at the front of bytes, which [`ExactSum::write_to`] wrote, and what is behind it.
    pub fn read_from(bytes: &[u8]) -> Option<(Self, &[u8])> {
        let (&[flags, first, count], mut rest) = bytes.split_first_chunk()?;
        let mut sum = ExactSum::default();
        for digit in sum.digits.get_mut(usize::from(first)..)?.get_mut(..usize::from(count))? {
            let (bytes, behind) = rest.split_first_chunk()?;
            (*digit, rest) = (i64::from_le_bytes(*bytes), behind);
        }
        if flags & 2 != 0 {
            let (bytes, behind) = rest.split_first_chunk()?;
            (sum.beyond, rest) = (f64::from_le_bytes(*bytes), behind);
        }
        if flags & 1 != 0 {
            sum.negate();
        }
        sum.added = 1;
        Some((sum, rest))
    }

    /// Turns the sign.
    fn negate(&mut self) {
        self.digits.iter_mut().for_each(|digit| *digit = -*digit);
        self.carry();
    }

    /// Leaves less than 2^32 in each digit, none of them negative but the last.
    fn carry(&mut self) {
        for k in 0..DIGITS - 1 {
            let carried = self.digits[k] >> DIGIT;
            self.digits[k] -= carried << DIGIT;
            self.digits[k + 1] += carried;
        }
        self.added = 0;
    }

    /// The sum, rounded to the nearest number; where that is below the smallest normal one, perhaps once more.
    pub fn value(&self) -> f64 {
        if self.beyond != 0.0 {
            return self.beyond;
        }
        let mut sum = self.clone();
        sum.carry();
        let negative = sum.digits[DIGITS - 1] < 0;
        if negative {
            sum.negate();
        }
        let Some(top) = sum.digits.iter().rposition(|&digit| digit != 0) else { return 0.0 };
        // Four digits hold all bits of a number and those that decide how it is rounded; whether any is behind them
        // stands in the last.
        let first = top.saturating_sub(3);
        let leading = (first..=top).rev().fold(0_u128, |all, k| all << DIGIT | sum.digits[k] as u128);
        let behind = sum.digits[..first].iter().any(|&digit| digit != 0);
        let rounded = (leading | u128::from(behind)) as f64;
        // In two steps: 2^-1074 times a power that is too large for one number.
        let power = DIGIT as i32 * first as i32 - 1074;
        let magnitude = rounded * 2_f64.powi(power / 2) * 2_f64.powi(power - power / 2);
        if negative { -magnitude } else { magnitude }
    }
}

/// As what [`ExactSum::write_to`] writes.
impl Serialize for ExactSum {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut bytes = Vec::new();
        self.clone().write_to(&mut bytes);
        serde_bytes::serialize(&bytes, serializer)
    }
}

impl<'de> Deserialize<'de> for ExactSum {
    fn deserialize<X: Deserializer<'de>>(deserializer: X) -> Result<Self, X::Error> {
        let bytes: Vec<u8> = serde_bytes::deserialize(deserializer)?;
        let read = ExactSum::read_from(&bytes);
        read.map(|(sum, _)| sum).ok_or_else(|| serde::de::Error::custom("it is cut off"))
    }
}

/// The sum of some numbers, rounded once.
impl std::iter::Sum<f64> for ExactSum {
    fn sum<I: Iterator<Item = f64>>(numbers: I) -> Self {
        let mut sum = ExactSum::default();
        numbers.for_each(|x| sum.add(x));
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sum(numbers: &[f64]) -> f64 {
        numbers.iter().copied().sum::<ExactSum>().value()
    }

    #[test]
    fn what_rounding_would_lose_is_there() {
        assert_eq!(sum(&[]), 0.0);
        assert_eq!(sum(&[1e300, 1.0, -1e300]), 1.0);
        assert_eq!(sum(&[1e16, 1.0, 1.0, -1e16]), 2.0);
        assert_eq!(sum(&[0.1; 10]), 1.0);
        assert_eq!(sum(&[f64::MAX, f64::MAX, -f64::MAX]), f64::MAX);
        assert_eq!(sum(&[f64::MAX, f64::MAX]), f64::INFINITY);
        assert_eq!(sum(&[f64::from_bits(1), f64::from_bits(2)]), f64::from_bits(3));
        assert_eq!(sum(&[f64::INFINITY, 1.0]), f64::INFINITY);
        assert!(sum(&[f64::INFINITY, f64::NEG_INFINITY]).is_nan() && sum(&[f64::NAN, 1.0]).is_nan());
    }

    /// A tie goes to the even number, and the least bit far behind decides it.
    #[test]
    fn it_is_rounded_to_the_nearest() {
        let half = f64::EPSILON / 2.0;
        assert_eq!(sum(&[1.0, half]), 1.0);
        assert_eq!(sum(&[1.0, half, 1e-300]), 1.0 + f64::EPSILON);
        assert_eq!(sum(&[-1.0, -half, -1e-300]), -1.0 - f64::EPSILON);
        assert_eq!(sum(&[1.0, f64::EPSILON, half]), 1.0 + 2.0 * f64::EPSILON);
    }

    /// More numbers than are added between two carries, all of the largest fraction.
    #[test]
    fn many_numbers_do_not_run_over() {
        let x = f64::from_bits(0x3fff_ffff_ffff_ffff);
        for count in [511, 512, 513, 100_000] {
            assert_eq!(sum(&vec![x; count]), x * count as f64);
            assert_eq!(sum(&vec![-x; count]), -x * count as f64);
        }
    }

    proptest! {
        /// Any order and any parts give the same bits, and small whole numbers their sum.
        #[test]
        fn neither_order_nor_parts_matter(
            numbers in prop::collection::vec(any::<f64>().prop_filter("a number", |x| x.is_finite()), 1..60),
            by in any::<prop::sample::Index>(),
            parts in 1..9_usize,
        ) {
            let whole = sum(&numbers);
            let mut turned = numbers.clone();
            turned.rotate_left(by.index(numbers.len()));
            turned.reverse();
            prop_assert_eq!(sum(&turned).to_bits(), whole.to_bits());
            let mut merged = ExactSum::default();
            for part in numbers.chunks(parts).rev() {
                let (mut part, mut bytes): (ExactSum, _) = (part.iter().copied().sum(), Vec::new());
                part.write_to(&mut bytes);
                let (read, rest) = ExactSum::read_from(&bytes).expect("it was written");
                prop_assert!(rest.is_empty() && ExactSum::read_from(&bytes[..bytes.len() - 1]).is_none());
                merged.merge(&read);
            }
            prop_assert_eq!(merged.value().to_bits(), whole.to_bits());
            let (most, plain) = numbers.iter().fold((0.0_f64, 0.0), |(most, sum), x| (most.max(x.abs()), sum + x));
            prop_assert!(!plain.is_finite() || (whole - plain).abs() <= 1e-12 * most);
        }

        #[test]
        fn whole_numbers_add_up(numbers in prop::collection::vec(-(1_i64 << 52)..1 << 52, 0..2000)) {
            let exact: i128 = numbers.iter().map(|&x| i128::from(x)).sum();
            let found = sum(&numbers.iter().map(|&x| x as f64).collect::<Vec<_>>());
            prop_assert_eq!(found, exact as f64);
        }
    }
}
