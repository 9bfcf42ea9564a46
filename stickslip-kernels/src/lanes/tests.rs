use super::*;

fn samples() -> Vec<f64> {
    (0..4000).map(|i| 1e-3 * 1.005_f64.powi(i)).collect()
}

/// Everything that lanes compute, one after the other.
struct Everything<'a, T>(&'a [T]);

impl<T: Laned> Work for Everything<'_, T> {
    type Real = T;
    type Output = Vec<T>;

    #[inline(always)]
    fn run<M: Machine<T>>(self) -> Vec<T> {
        let mut found = Vec::new();
        let count = <M::Wide as Lanes>::COUNT;
        for chunk in self.0.chunks(count) {
            let x = M::Wide::from_fn(|lane| chunk[lane.min(chunk.len() - 1)]);
            let two = M::Wide::splat(T::of(2.0));
            let above = T::of(f64::from((x.at_least(two)).count_ones()));
            let results = [
                x.cbrt(),
                (x + two).sqrt(),
                -(x - two) / (x * two),
                x.min(two),
                x.max(two),
                (x - two).abs(),
                x.ln(),
                M::Wide::HALF - M::Wide::ONE,
                M::Wide::splat(above),
                x.add_neighbours(-two),
                x.times_plus(x, -(x * x)),
            ];
            for result in results {
                found.extend(&result.numbers().0[..chunk.len()]);
            }
        }
        found
    }
}

/// Places among the results: the cube root, which differs where a product and a sum are rounded once, what every
/// machine rounds alike, and what rounding once finds in a product.
const ROOT: usize = 0;
const EXACT: std::ops::Range<usize> = 1..10;
const LOST: usize = 10;

/// In the order of the samples, one list a result.
fn unfolded<T: Laned>(found: &[T], samples: usize) -> Vec<Vec<T>> {
    let mut results = vec![Vec::new(); 11];
    let mut rest = found;
    while results[8].len() < samples {
        let lanes = MOST_LANES.min(samples - results[8].len());
        for result in &mut results {
            result.extend(&rest[..lanes]);
            rest = &rest[lanes..];
        }
    }
    results
}

fn agree<T: Laned>() {
    let x: Vec<T> = samples().into_iter().map(T::of).collect();
    let first = unfolded(&T::run(Processor::Any, Everything(&x)), x.len());
    for processor in Processor::available() {
        let found = unfolded(&T::run(processor, Everything(&x)), x.len());
        assert!(found[EXACT] == first[EXACT], "{processor:?} differs from the portable lanes");
        for (i, &x) in x.iter().enumerate() {
            let off = (found[ROOT][i] / x.cbrt() - T::ONE).abs();
            assert!(off <= T::of(2.0) * T::EPSILON, "{processor:?}: cube root of {x:?} off by {off:?}");
            let lost = if processor.fuses() { x.fused(x, -(x * x)) } else { T::ZERO };
            assert_eq!(found[LOST][i], lost, "{processor:?}: {x:?}");
        }
    }
    for (i, &x) in x.iter().enumerate() {
        assert_eq!(first[1][i], (x + T::of(2.0)).sqrt());
        assert_eq!(first[3][i], if x < T::of(2.0) { x } else { T::of(2.0) });
        assert_eq!(first[5][i], (x - T::of(2.0)).abs());
    }
    for (i, pair) in x.chunks_exact(2).enumerate() {
        assert_eq!(first[9][2 * i..2 * i + 2], [pair[0] + pair[1], T::of(-4.0)]);
    }
    let above = first[8].chunks(MOST_LANES).map(|chunk| chunk[0].f64()).sum::<f64>();
    assert_eq!(above, x.iter().filter(|&&x| x >= T::of(2.0)).count() as f64);
}

#[test]
fn every_machine_gives_the_bits_of_ieee_754_in_double_precision() {
    agree::<f64>();
}

#[test]
fn every_machine_gives_the_bits_of_ieee_754_in_single_precision() {
    agree::<f32>();
}

/// Parts of a row, loaded and stored again between numbers that must stay.
struct PartialRow<T>(T);

impl<T: Laned> Work for PartialRow<T> {
    type Real = T;
    type Output = ();

    #[inline(always)]
    fn run<M: Machine<T>>(self) {
        parts_of::<M::Wide>();
        parts_of::<M::Quad>();
        sums_of::<M::Wide>();
        sums_of::<M::Quad>();
        fourths_of::<M::Wide>();
        fourths_of::<M::Quad>();
        selections_of::<M::Wide>();
        selections_of::<M::Quad>();
        let wide = M::Wide::from_fn(|lane| T::of(lane as f64));
        assert_eq!(M::halves(wide).numbers().0[..4], [4.0, 6.0, 8.0, 10.0].map(T::of));
        let order = [6, 0, 2, 4, 1, 3, 5, 7];
        assert_eq!(wide.permuted(order).numbers().0, order.map(|lane| T::of(lane as f64)));
    }
}

/// In one order on all machines.
#[inline(always)]
fn sums_of<V: Lanes>() {
    let of = |lane: usize| V::Real::of(1.0 / (lane as f64 + 3.0));
    let lanes = V::from_fn(of);
    let four = |first: usize| [0, 1, 2, 3].map(|lane| of(first + lane));
    let each = if V::COUNT == 8 { [0, 1, 2, 3].map(|lane| four(0)[lane] + four(4)[lane]) } else { four(0) };
    let sum = |[a, b, c, d]: [V::Real; 4]| (a + b) + (c + d);
    let expected = [sum(each), V::Real::ZERO, sum(each), -sum(each)];
    assert_eq!(V::sums([lanes, V::ZERO, lanes, -lanes]), expected);
}

#[inline(always)]
fn fourths_of<V: Lanes>() {
    let lanes = V::from_fn(|lane| V::Real::of(lane as f64));
    for n in 0..4 {
        let found = lanes.every_fourth(n).numbers();
        assert!((0..V::COUNT).all(|lane| found.0[lane] == V::Real::of((lane / 4 * 4 + n) as f64)), "{n}");
    }
}

#[inline(always)]
fn selections_of<V: Lanes>() {
    let of = |lane: usize| V::Real::of(lane as f64);
    let (lanes, others) = (V::from_fn(of), V::splat(of(55)));
    for bits in 0..1 << V::COUNT {
        let found = V::select(bits, lanes, others).numbers();
        let expected = |lane: usize| if bits >> lane & 1 == 1 { of(lane) } else { of(55) };
        assert!((0..V::COUNT).all(|lane| found.0[lane] == expected(lane)), "{bits:b}");
    }
}

#[inline(always)]
fn parts_of<V: Lanes>() {
    let of = |i: usize| V::Real::of(i as f64);
    let row: Vec<V::Real> = (0..MOST_LANES).map(|i| of(i + 1)).collect();
    for count in 0..=V::COUNT {
        let mut copy = [of(77); MOST_LANES + 1];
        // SAFETY: the row and the copy are as long as any lanes.
        let loaded = unsafe { V::load_part(row.as_ptr(), count, of(55)) };
        let expected = |lane: usize| if lane < count { row[lane] } else { of(55) };
        assert!((0..V::COUNT).all(|lane| loaded.numbers().0[lane] == expected(lane)), "{count}");
        // SAFETY: as above.
        let zeros = unsafe { V::load_first(row.as_ptr(), count) };
        for zeros in [zeros, loaded.first(count)] {
            let expected = |lane: usize| if lane < count { row[lane] } else { of(0) };
            assert!((0..V::COUNT).all(|lane| zeros.numbers().0[lane] == expected(lane)), "{count}");
        }
        // SAFETY: as above.
        unsafe { loaded.store_part(copy.as_mut_ptr(), count) };
        assert!(copy[..count] == row[..count] && copy[count..].iter().all(|&x| x == of(77)), "{count}");
    }
}

#[test]
fn parts_of_a_row_are_loaded_stored_and_selected_and_nothing_beside_them() {
    for processor in Processor::available() {
        f64::run(processor, PartialRow(0.0));
        f32::run(processor, PartialRow(0.0));
    }
}
