//! Plane stress, particle by particle.

use crate::body::Body;
use crate::lanes::{Lanes, MOST_LANES, Numbers};
use crate::material::Motion;
use crate::tensor::{Matrix, Real, Symmetric, array};

/// Numbers of a motion.
const COUNT: usize = 26;

/// The motion with the thickness that every particle takes, one by one, and the stress and plastic strain after it; `None` if any has none.
#[inline(always)]
pub fn free_thickness<T: Real, V: Lanes<Real = T>, const D: usize>(
    body: &Body<T, D>,
    motion: Motion<V>,
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
        put(motion.plastic_strain);
    }
    one_thickness_after_another(body, &mut numbers, V::COUNT)?;
    // SAFETY: `numbers` are as long as any machine's lanes.
    let get = |k: usize| unsafe { V::load(numbers[k].0.as_ptr()) };
    let matrix = |first: usize| Matrix::from_fn(|i, j| get(first + 3 * i + j));
    let stress = Symmetric(array(V::ZERO, |k| get(18 + k)));
    Some(Motion {
        deformation: matrix(0),
        increment: matrix(9),
        stress,
        jacobian: get(24),
        plastic_strain: get(25),
    })
}

/// F, the increment, the stress, J and the plastic strain of every lane before and after its thickness is found.
#[inline(never)]
fn one_thickness_after_another<T: Real, const D: usize>(
    body: &Body<T, D>,
    numbers: &mut [Numbers<T>; COUNT],
    lanes: usize,
) -> Option<()> {
    for lane in 0..lanes {
        let get = |k: usize| numbers[k].0[lane];
        let motion = Motion {
            deformation: Matrix::from_fn(|i, j| get(3 * i + j)),
            increment: Matrix::from_fn(|i, j| get(9 + 3 * i + j)),
            stress: Symmetric(std::array::from_fn(|k| get(18 + k))),
            jacobian: get(24),
            plastic_strain: get(25),
        };
        let (motion, response) = body.respond(motion)?;
        for i in 0..3 {
            for j in 0..3 {
                numbers[3 * i + j].0[lane] = motion.deformation.0[i][j];
            }
        }
        for (k, x) in response.stress.0.into_iter().enumerate() {
            numbers[18 + k].0[lane] = x;
        }
        numbers[24].0[lane] = motion.jacobian;
        numbers[25].0[lane] = response.plastic_strain;
    }
    Some(())
}
