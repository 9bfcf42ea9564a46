//! Numbers that colour can stand for: each column of a snapshot, its components and what is told by all of them.

use crate::picture::determinant;
use serde::Serialize;
use stickslip::column::Kind;
use stickslip::observe::{FileColumn, ParticleFile, ReadError};

/// A number that each particle of a snapshot has.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quantity {
    /// By which the page asks for it: the column, and behind a point the component.
    pub id: String,
    /// Words for the reader.
    pub label: String,
    /// SI unit; empty for a number without one.
    pub unit: String,
    /// The value that is special (zero, or a volume that did not change), if there is one for sure.
    pub middle: Option<f64>,
    /// The column that it follows from.
    #[serde(skip)]
    column: FileColumn,
    #[serde(skip)]
    measure: Measure,
}

/// How the numbers of a particle in a column become one.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Measure {
    /// One of them.
    Component(usize),
    /// Root of the sum of their squares.
    Norm,
    /// Determinant of a tensor.
    Determinant,
}

const VECTOR: [&str; 3] = ["x", "y", "z"];
const SYMMETRIC: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];
const TENSOR: [&str; 9] = ["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"];

/// All quantities of a file, in the order of its columns.
pub fn quantities(file: &ParticleFile) -> Vec<Quantity> {
    file.columns().flat_map(|column| of_column(&column)).collect()
}

/// The quantities of a column.
fn of_column(column: &FileColumn) -> Vec<Quantity> {
    let words = column.name.replace('_', " ").replace("von mises", "von Mises stress");
    let quantity = |suffix: &str, label: String, measure| Quantity {
        id: if suffix.is_empty() { column.name.clone() } else { format!("{}.{suffix}", column.name) },
        label,
        unit: column.unit.clone(),
        middle: None,
        column: column.clone(),
        measure,
    };
    let components = |names: &[&str]| -> Vec<Quantity> {
        let component =
            |(k, name): (usize, &&str)| quantity(name, format!("{words} {name}"), Measure::Component(k));
        names.iter().enumerate().map(component).collect()
    };
    let whole = |label: String| quantity("", label, Measure::Norm);
    match column.kind {
        Kind::Number => vec![quantity("", words, Measure::Component(0))],
        Kind::Vector | Kind::Rotation => {
            let label =
                if column.name == "velocity" { "speed".to_owned() } else { format!("{words}, magnitude") };
            [vec![whole(label)], components(&VECTOR)].concat()
        }
        Kind::Symmetric => [components(&SYMMETRIC), vec![whole(format!("{words}, norm"))]].concat(),
        Kind::Tensor if column.name == "deformation" => {
            let mut volume = quantity("volume_ratio", "volume ratio J".to_owned(), Measure::Determinant);
            volume.middle = Some(1.0);
            [vec![volume], components(&TENSOR)].concat()
        }
        Kind::Tensor => components(&TENSOR),
    }
}

impl Quantity {
    /// Its value at every particle of a file, in the order of the file.
    ///
    /// # Errors
    /// The file has no such column, or is cut short.
    pub fn values(&self, file: &ParticleFile) -> Result<Vec<f32>, ReadError> {
        let components = self.column.kind.components();
        let held = file.column(self.column.clone())?;
        Ok(held.values.chunks_exact(components).map(|numbers| self.measure.of(numbers) as f32).collect())
    }
}

impl Measure {
    fn of(self, numbers: &[f64]) -> f64 {
        match (self, <&[f64; 9]>::try_from(numbers)) {
            (Measure::Component(k), _) => numbers[k],
            (Measure::Determinant, Ok(tensor)) => determinant(tensor),
            (Measure::Determinant | Measure::Norm, _) => numbers.iter().map(|c| c * c).sum::<f64>().sqrt(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_gives_its_components_and_what_they_amount_to() {
        let column = |name: &str, kind| FileColumn { name: name.to_owned(), unit: "Pa".to_owned(), kind };
        let ids = |name: &str, kind| {
            let found = of_column(&column(name, kind));
            found.into_iter().map(|quantity| quantity.id).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(ids("pressure", Kind::Number), "pressure");
        assert_eq!(ids("velocity", Kind::Vector), "velocity velocity.x velocity.y velocity.z");
        assert_eq!(
            ids("stress", Kind::Symmetric),
            "stress.xx stress.yy stress.zz stress.xy stress.yz stress.xz stress"
        );
        let volume = &of_column(&column("deformation", Kind::Tensor))[0];
        assert_eq!((&volume.column.name[..], volume.middle), ("deformation", Some(1.0)));
        assert_eq!(volume.measure.of(&[2.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.5]), 3.0);
        assert_eq!(Measure::Norm.of(&[3.0, 4.0, 0.0]), 5.0);
    }
}
