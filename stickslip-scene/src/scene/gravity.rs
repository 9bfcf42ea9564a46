//! The acceleration of every body.

use super::Expression;
use serde::Serialize;

/// Acceleration of every body over time, along each axis [m/s^2].
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Gravity(pub [Expression; 3]);

/// Moments at which [`Gravity::strongest`] looks.
const SAMPLES: usize = 1000;

impl Default for Gravity {
    fn default() -> Self {
        [0.0; 3].into()
    }
}

impl From<[f64; 3]> for Gravity {
    /// The same at all times.
    fn from(components: [f64; 3]) -> Self {
        Gravity(components.map(Expression::Constant))
    }
}

impl Gravity {
    /// Its value at time `t` [s].
    pub fn at(&self, t: f64) -> [f64; 3] {
        [0, 1, 2].map(|i| self.0[i].at(t))
    }

    /// Its mean over a step of `dt` from `time` on [s].
    pub fn over_step(&self, time: f64, dt: f64) -> [f64; 3] {
        [0, 1, 2].map(|i| self.0[i].over_step(time, dt))
    }

    /// Its value, if that never changes.
    pub fn constant(&self) -> Option<[f64; 3]> {
        self.0.iter().all(|part| part.constant().is_some()).then(|| self.at(0.0))
    }

    /// Whether there is none at any time.
    pub fn is_none(&self) -> bool {
        self.constant() == Some([0.0; 3])
    }

    /// Its largest value until `end` [s], looked for at a thousand moments and at all rows of tables.
    pub fn strongest(&self, end: f64) -> [f64; 3] {
        let square = |value: &[f64; 3]| value.iter().map(|x| x * x).sum::<f64>();
        let samples = if self.constant().is_some() { 0 } else { SAMPLES };
        let tables = self.0.iter().filter_map(|part| match part {
            Expression::Table(table) => Some(table.rows()),
            _ => None,
        });
        let rows = tables.flatten().map(|[time, _]| *time).filter(|time| (0.0..=end).contains(time));
        let moments = (0..=samples).map(|i| end * i as f64 / SAMPLES as f64);
        let moments = moments.chain(rows).map(|time| self.at(time));
        moments.max_by(|a, b| square(a).total_cmp(&square(b))).unwrap_or_default()
    }

    /// Whether it stays what it is: within the step of `dt` from `time` on, and until `end` [s].
    pub fn is_still(&self, time: f64, dt: f64, end: f64) -> bool {
        self.0.iter().all(|part| match part {
            Expression::Constant(_) => true,
            Expression::Table(table) => table.end() <= time,
            Expression::Formula(_) | Expression::Rate(_) => {
                part.at(time) == part.at(time + dt) && part.at(time) == part.at(end)
            }
            // Nobody knows what it says later.
            Expression::Outside(_) => false,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::TimeTable;

    #[test]
    fn it_is_constant_or_grows() {
        let still = Gravity::from([0.0, -9.81, 0.0]);
        assert_eq!((still.constant(), still.strongest(1.0)), (Some([0.0, -9.81, 0.0]), [0.0, -9.81, 0.0]));
        assert!(still.is_still(0.0, 1.0, 2.0) && !still.is_none() && Gravity::default().is_none());
        let table = TimeTable::new(vec![[0.0, 0.0], [1.0, -8.0], [2.0, -4.0]]).expect("times ascend");
        let grows = Gravity([0.0, 1.0, 2.0].map(|i| match i {
            1.0 => Expression::Table(table.clone()),
            _ => Expression::Constant(0.0),
        }));
        assert_eq!((grows.constant(), grows.at(0.5)[1], grows.strongest(2.0)[1]), (None, -4.0, -8.0));
        assert!(!grows.is_still(1.5, 0.1, 3.0) && grows.is_still(2.0, 0.1, 3.0) && !grows.is_none());
    }
}
