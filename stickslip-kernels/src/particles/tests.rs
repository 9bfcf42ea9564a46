use super::*;
use proptest::prelude::*;

/// As many tensors as a Prony series of two terms has.
const HISTORY: &[History] = &[
    History::new("strain", "", Kind::Symmetric),
    History { start: 2.0, ..History::new("other_strain", "", Kind::Symmetric) },
    History::new("energy", "J/m^3", Kind::Number),
];

fn own(history: &'static [History]) -> OwnColumns {
    OwnColumns { history, ..OwnColumns::default() }
}

/// Orders by steps that share no factor with the count, one after the other.
fn sorted_again_and_again<const D: usize>(count: usize, history: &'static [History]) {
    let number = |i: usize, k: usize| (31 * i + k) as f64;
    let particle = |i: usize| Particle {
        position: Vector::from_fn(|k| number(i, k)),
        velocity: Vector::from_fn(|k| number(i, 3 + k)),
        spin: Vector::from_fn(|k| if D == 3 || k == 2 { number(i, 6 + k) } else { 0.0 }),
        mass: number(i, 9),
        volume: number(i, 10),
        half_width: number(i, 11),
        deformation: Matrix::IDENTITY * number(i, 12),
        stress: Symmetric::isotropic(number(i, 13)),
        number: i as u32,
    };
    let mut particles = Particles::<f64, D>::from_fn(count, own(history), particle);
    let entries = history_entries(history, D);
    for i in 0..count {
        // SAFETY: the particle exists and is nobody else's.
        let mut memory = unsafe { particles.open().history_of(i) };
        (0..entries).for_each(|entry| memory.keep(entry, number(i, 14 + entry)));
    }
    let mut expected: Vec<u32> = (0..count as u32).collect();
    for step in [1, 7, 11, 13] {
        let order: Vec<u32> = (0..count).map(|i| (i * step % count) as u32).collect();
        particles.permute(&order);
        expected = order.iter().map(|&i| expected[i as usize]).collect();
        assert_eq!(particles.numbers(), expected);
        if step == 7 {
            // Moved back, they are what they were.
            let before: Vec<_> = particles.iter().collect();
            particles.settle();
            assert!(!particles.later && particles.iter().eq(before.iter().copied()));
        }
        for (found, &i) in particles.iter().zip(&expected) {
            assert_eq!(found, particle(i as usize));
        }
        for (place, &i) in expected.iter().enumerate() {
            // SAFETY: as above.
            let memory = unsafe { particles.view().history_of(place) };
            assert!((0..entries).all(|entry| memory.recall(entry) == number(i as usize, 14 + entry)));
        }
    }
}

/// In space 30 numbers and room for one more; each particle's number twice.
#[test]
fn the_bytes_of_particles_are_those_that_they_hold() {
    let held = |count: usize, history: &'static [History]| {
        let particles = Particles::<f64, 3>::from_fn(count, own(history), |_| Particle {
            position: Vector::ZERO,
            velocity: Vector::ZERO,
            spin: Vector::ZERO,
            mass: 0.0,
            volume: 0.0,
            half_width: 0.0,
            deformation: Matrix::IDENTITY,
            stress: Symmetric::ZERO,
            number: 0,
        });
        size_of_val(&particles.columns[..]) + size_of_val(&particles.numbers[..])
    };
    for (count, history) in [(0, &[][..]), (1, HISTORY), (1000, &[]), (100_000, HISTORY)] {
        assert_eq!(Particles::<f64, 3>::bytes_of(count, own(history)), held(count, history), "{count}");
    }
    let each = Particles::<f64, 3>::bytes_of(1_000_000, OwnColumns::default()) as f64 / 1e6;
    assert!((each / (31.0 * 8.0 + 2.0 * 4.0) - 1.0).abs() < 1e-3, "{each}");
}

#[test]
fn particles_are_sorted_whole() {
    sorted_again_and_again::<2>(3 * PART + 5, &[]);
    sorted_again_and_again::<2>(100, HISTORY);
    sorted_again_and_again::<3>(100, HISTORY);
    sorted_again_and_again::<3>(0, &[]);
}

/// Known as long as they are, whatever is done to them; one other mass or box, and each has its own.
#[test]
fn particles_are_alike_until_one_is_not() {
    let of = |mass: f64, half_width: f64| Particle {
        position: Vector::ZERO,
        velocity: Vector::ZERO,
        spin: Vector::ZERO,
        mass,
        volume: 1.0,
        half_width,
        deformation: Matrix::IDENTITY,
        stress: Symmetric::ZERO,
        number: 0,
    };
    let alike = Some([2.0, 0.5]);
    let mut particles = Particles::<f64, 2>::from_fn(5, own(&[]), |_| of(2.0, 0.5));
    assert_eq!(particles.view().alike(), alike);
    particles.permute(&[4, 2, 0, 1, 3]);
    particles.settle();
    particles.remove(&[1]);
    particles.set(2, &of(2.0, 0.5));
    assert_eq!((particles.len(), particles.view().alike()), (4, alike));
    let before = particles.clone();
    for other in [of(3.0, 0.5), of(2.0, 0.25)] {
        particles.set(3, &other);
        assert_eq!(particles.open().alike(), None);
        particles.compare();
        assert_eq!(particles.open().alike(), None);
        particles.become_copy_of(&before);
        assert_eq!(particles.open().alike(), alike);
    }
    particles.line_mut(ColumnStart::<2>::MASS)[0] = 4.0;
    assert_eq!(particles.view().alike(), None);
    particles.line_mut(ColumnStart::<2>::MASS).fill(4.0);
    particles.compare();
    assert_eq!(particles.view().alike(), Some([4.0, 0.5]));
}

#[test]
fn those_who_stay_keep_their_order() {
    for later in [false, true] {
        let of = |i: usize| Particle {
            position: Vector::from_fn(|k| (10 * i + k) as f64),
            velocity: Vector::ZERO,
            spin: Vector::ZERO,
            mass: i as f64,
            volume: 1.0,
            half_width: 1.0,
            deformation: Matrix::IDENTITY,
            stress: Symmetric::ZERO,
            number: i as u32,
        };
        let mut particles = Particles::<f64, 2>::from_fn(9, own(HISTORY), of);
        let (mut order, mut expected): (Vec<u32>, Vec<usize>) = ((0..9).collect(), (0..9).collect());
        if later {
            order.reverse();
            expected.reverse();
            particles.permute(&order);
        }
        for gone in [&[0, 3, 4, 8][..], &[], &[1], &[3]] {
            particles.remove(gone);
            for &place in gone.iter().rev() {
                expected.remove(place as usize);
            }
            assert!(particles.iter().eq(expected.iter().map(|&i| of(i))), "{gone:?}");
            assert_eq!(by_number(particles.numbers()).len(), expected.len());
        }
        // They can be sorted on.
        particles.permute(&[2, 0, 1]);
        assert!(particles.iter().eq([2, 0, 1].iter().map(|&i| of(expected[i]))));
        particles.remove(&[0, 1, 2]);
        assert!(particles.is_empty());
        particles.permute(&[]);
        particles.settle();
    }
    assert_eq!(by_number(&[7, 2, 9, 3]), [1, 3, 0, 2]);
    assert_eq!(by_number(&[2, 0, 1]), [1, 2, 0]);
}

#[test]
fn others_are_taken_up_where_particles_are() {
    let of = |count: usize, x: f64| {
        Particles::<f64, 2>::from_fn(count, own(HISTORY), |i| Particle {
            position: Vector::from_fn(|k| x + (i + k) as f64),
            velocity: Vector::ZERO,
            spin: Vector::ZERO,
            mass: x,
            volume: x,
            half_width: x,
            deformation: Matrix::IDENTITY,
            stress: Symmetric::ZERO,
            number: i as u32,
        })
    };
    let mut particles = of(50, 1.0);
    let place = particles.column_place("mass").unwrap();
    let order: Vec<u32> = (0..50).rev().collect();
    particles.permute(&order);
    assert_ne!(particles.column_place("mass").unwrap(), place);
    particles.become_others(of(50, 2.0));
    assert!(particles.iter().eq(of(50, 2.0).iter()));
    assert_eq!(particles.column_place("mass").unwrap(), place);
    particles.become_others(of(51, 3.0));
    assert!(particles.iter().eq(of(51, 3.0).iter()));
}

#[test]
fn columns_lie_one_behind_the_other() {
    let at = [
        ColumnStart::<3>::POSITION,
        ColumnStart::<3>::VELOCITY,
        ColumnStart::<3>::SPIN,
        ColumnStart::<3>::MASS,
    ];
    assert_eq!(at, [0, 3, 6, 9]);
    let at = [
        ColumnStart::<3>::VOLUME,
        ColumnStart::<3>::HALF_WIDTH,
        ColumnStart::<3>::DEFORMATION,
        ColumnStart::<3>::STRESS,
    ];
    assert_eq!(at, [10, 11, 12, 21]);
    assert_eq!([ColumnStart::<3>::START, ColumnStart::<3>::HISTORY], [27, 30]);
    assert_eq!(
        [ColumnStart::<2>::SPIN, ColumnStart::<2>::MASS, ColumnStart::<2>::STRESS, ColumnStart::<2>::HISTORY],
        [4, 5, 13, 19]
    );
    for (k, &[row, column]) in deformation_entries(2).iter().enumerate() {
        assert_eq!(Kind::Tensor.place(2, k), 3 * row + column);
    }
}

#[test]
fn history_begins_as_its_law_says() {
    let particle = |_| Particle {
        position: Vector::ZERO,
        velocity: Vector::ZERO,
        spin: Vector::ZERO,
        mass: 0.0,
        volume: 0.0,
        half_width: 0.0,
        deformation: Matrix::IDENTITY,
        stress: Symmetric::ZERO,
        number: 0,
    };
    let particles = Particles::<f64, 2>::from_fn(3, own(HISTORY), particle);
    // SAFETY: the particle exists and is nobody else's.
    let memory = unsafe { particles.view().history_of(2) };
    let found: Vec<f64> = (0..9).map(|entry| memory.recall(entry)).collect();
    assert_eq!(found, [0.0, 0.0, 0.0, 0.0, 2.0, 2.0, 2.0, 0.0, 0.0]);
}

proptest! {
    /// Particles that go and come, some as guests, are afterwards who they should be, wherever they lie.
    #[test]
    fn particles_go_and_come(
        count in 1..40_usize,
        goes in prop::collection::vec(prop::collection::vec(any::<prop::sample::Index>(), 0..12), 1..6),
        guests in 0..5_usize,
    ) {
        let of = |number: u32| Particle::<f64, 2> {
            position: Vector::from_fn(|k| f64::from(number) + k as f64),
            velocity: Vector::ZERO,
            spin: Vector::ZERO,
            mass: 1.0,
            volume: 2.0,
            half_width: if number % 7 == 6 { 0.25 } else { 0.5 },
            deformation: Matrix::IDENTITY,
            stress: Symmetric::isotropic(f64::from(number)),
            number,
        };
        let mut here = Particles::<f64, 2>::from_fn(count, own(HISTORY), |i| of(i as u32));
        let mut there = Particles::<f64, 2>::from_fn(0, own(HISTORY), |_| of(0));
        let (mut left, mut gone): (Vec<u32>, Vec<u32>) = ((0..count as u32).collect(), Vec::new());
        for go in goes {
            let mut places: Vec<u32> =
                if here.is_empty() { Vec::new() } else { go.iter().map(|i| i.index(here.len()) as u32).collect() };
            places.sort_unstable();
            places.dedup();
            let numbers: Vec<u32> = places.iter().map(|&place| here.numbers()[place as usize]).collect();
            let mut bytes = Vec::new();
            here.write_particles(&places, &mut bytes);
            prop_assert_eq!(bytes.len(), here.message_bytes(places.len()));
            here.take_out(&places);
            there.take_in(&bytes, places.len());
            left.retain(|number| !numbers.contains(number));
            gone.extend(numbers);
            if there.len() > 1 {
                let order: Vec<u32> = (0..there.len() as u32).rev().collect();
                there.permute(&order);
            }
            let mut visiting = Vec::new();
            let visitors: Vec<u32> = (0..here.len().min(guests) as u32).collect();
            here.write_guests(&visitors, Shown::Everything, &mut visiting);
            prop_assert_eq!(visiting.len(), here.bytes_of_guests(visitors.len(), Shown::Everything));
            there.receive_guests(&visiting, visitors.len(), Shown::Everything);
            for (particles, wanted) in [(&here, &left), (&there, &gone)] {
                let mut numbers = particles.numbers().to_vec();
                numbers.sort_unstable();
                let mut wanted = wanted.clone();
                wanted.sort_unstable();
                prop_assert_eq!(numbers, wanted);
                for particle in particles.iter() {
                    prop_assert_eq!(particle, of(particle.number));
                }
                let same = |[mass, half_width]: [f64; 2]| {
                    mass == 1.0 && particles.iter().all(|particle| particle.half_width == half_width)
                };
                prop_assert!(particles.view().alike().is_none_or(same));
            }
            for guest in 0..there.guests() {
                // Nobody asks how they move.
                let guest_there = there.get(there.len() + guest);
                let seen = Particle { velocity: Vector::ZERO, spin: Vector::ZERO, ..guest_there };
                prop_assert_eq!(seen, here.get(guest));
            }
        }
    }
}
