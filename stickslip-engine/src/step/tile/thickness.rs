//! Plane stress, particle by particle.

use super::members::HistoryOfGroup;
use crate::body::Body;
use crate::lanes::{Lanes, MOST_LANES, Numbers};
use crate::material::{Keep, Motion, Recall};
use crate::tensor::{Matrix, Real, Symmetric, array};

/// Numbers of a motion.
const COUNT: usize = 25;

/// The motion with the thickness that every particle takes, one by one, and the stress and history after it;
/// `None` if any has none.
#[inline(always)]
pub fn free_thickness<T: Real, V: Lanes<Real = T>, const D: usize, const WHOLE: bool>(
    body: &Body<T, D>,
    (motion, dt): (Motion<V>, T),
    history: &mut HistoryOfGroup<'_, '_, T, D, WHOLE>,
) -> Option<Motion<V>> {
    let mut numbers = [Numbers([T::ZERO; MOST_LANES]); COUNT];
    {
        let mut next = numbers.iter_mut();
        let mut put = |x: V| next.next().map(|place| *place = x.numbers());
        for row in motion.deformation.0.iter().chain(&motion.increment.0) {
            for &x in row {
                put(x);
            }
        }
        for x in motion.stress.0 {
            put(x);
        }
        put(motion.jacobian);
    }
    for entry in 0..history.entries() {
        let before: V = history.recall(entry);
        history.keep(entry, before);
    }
    one_thickness_after_another(body, (&mut numbers, dt), (history, V::COUNT))?;
    // SAFETY: `numbers` are as long as any machine's lanes.
    let get = |k: usize| unsafe { V::load(numbers[k].0.as_ptr()) };
    let matrix = |first: usize| Matrix::from_fn(|i, j| get(first + 3 * i + j));
    let stress = Symmetric(array(V::ZERO, |k| get(18 + k)));
    Some(Motion { deformation: matrix(0), increment: matrix(9), stress, jacobian: get(24), dt: motion.dt })
}

/// F, the increment, the stress and J of every lane, and its history, before and after its thickness is found.
#[inline(never)]
fn one_thickness_after_another<T: Real, const D: usize, const WHOLE: bool>(
    body: &Body<T, D>,
    (numbers, dt): (&mut [Numbers<T>; COUNT], T),
    (history, lanes): (&mut HistoryOfGroup<'_, '_, T, D, WHOLE>, usize),
) -> Option<()> {
    for lane in 0..lanes {
        let get = |k: usize| numbers[k].0[lane];
        let motion = Motion {
            deformation: Matrix::from_fn(|i, j| get(3 * i + j)),
            increment: Matrix::from_fn(|i, j| get(9 + 3 * i + j)),
            stress: Symmetric(std::array::from_fn(|k| get(18 + k))),
            jacobian: get(24),
            dt,
        };
        let (motion, stress) = body.respond(motion, &mut HistoryOfLane { history, lane })?;
        for i in 0..3 {
            for j in 0..3 {
                numbers[3 * i + j].0[lane] = motion.deformation.0[i][j];
            }
        }
        for (k, x) in stress.0.into_iter().enumerate() {
            numbers[18 + k].0[lane] = x;
        }
        numbers[24].0[lane] = motion.jacobian;
    }
    Some(())
}

/// The history of one particle of a group.
struct HistoryOfLane<'a, 'b, 'c, T, const D: usize, const WHOLE: bool> {
    history: &'a mut HistoryOfGroup<'b, 'c, T, D, WHOLE>,
    lane: usize,
}

impl<T: Real, const D: usize, const WHOLE: bool> Recall<T> for HistoryOfLane<'_, '_, '_, T, D, WHOLE> {
    const DIMENSION: usize = D;
    fn recall(&self, entry: usize) -> T {
        // SAFETY: all entries were kept before, as many lanes as there are.
        unsafe { *self.history.kept(entry).add(self.lane) }
    }
}

impl<T: Real, const D: usize, const WHOLE: bool> Keep<T> for HistoryOfLane<'_, '_, '_, T, D, WHOLE> {
    fn keep(&mut self, entry: usize, value: T) {
        // SAFETY: there is room for any machine's lanes.
        unsafe { *self.history.lanes(entry).add(self.lane) = value };
    }
}
