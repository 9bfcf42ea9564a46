//! `[space]`: dimensions, cells, particles and domain.

use super::Context;
use super::quantity::{Length, QuantityInput};
use super::read::table;
use super::text::{Choice, Count, Word};
use super::vector::VectorInput;
use crate::scene::error::Fault;
use crate::scene::{
    self, BasisKind, Compression, Dimension, Discretization, Face, Interior, Leaving, Precision,
};

table! {
    /// Dimensions, cells, particles and domain.
    Space {
        /// Plane strain, plane stress or three dimensions.
        dimension: Word<Dimension>,
        /// Side of a grid cell [m].
        cell: QuantityInput<Length>,
        /// Particles along each side of a cell, 1 to 8: 2 means 4 in the plane, 8 in space.
        #[schemars(extend("default" = Discretization::new(1.0).particles_per_side))]
        particles_per_side: Option<Count>,
        /// Shape functions between particles and grid.
        #[schemars(extend("default" = BasisKind::default()))]
        basis: Option<Word<BasisKind>>,
        /// Where bodies that deform are computed; they may say so themselves.
        #[schemars(extend("default" = "auto"))]
        interior: Option<Word<SceneInterior>>,
        /// Number format of particles and grid.
        #[schemars(extend("default" = Precision::default()))]
        precision: Option<Word<Precision>>,
        /// A box that holds all material; by default space is unbounded.
        domain: Option<Domain>,
    }
}

table! {
    /// A box that holds all material.
    Domain {
        /// Lower corner [m].
        min: VectorInput<Length>,
        /// Upper corner [m].
        max: VectorInput<Length>,
        /// What the lower face across x does.
        #[schemars(extend("default" = Face::default()))]
        x_min: Option<Word<Face>>,
        /// What the upper face across x does.
        #[schemars(extend("default" = Face::default()))]
        x_max: Option<Word<Face>>,
        /// What the lower face across y does.
        #[schemars(extend("default" = Face::default()))]
        y_min: Option<Word<Face>>,
        /// What the upper face across y does.
        #[schemars(extend("default" = Face::default()))]
        y_max: Option<Word<Face>>,
        /// What the lower face across z does; three dimensions only.
        #[schemars(extend("default" = Face::default()))]
        z_min: Option<Word<Face>>,
        /// What the upper face across z does; three dimensions only.
        #[schemars(extend("default" = Face::default()))]
        z_max: Option<Word<Face>>,
        /// What becomes of a particle that leaves it.
        #[schemars(extend("default" = Leaving::default()))]
        leaving: Option<Word<Leaving>>,
    }
}

impl Choice for Dimension {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("plane-strain", Dimension::PlaneStrain, "Two dimensions, no strain out of the plane."),
        ("plane-stress", Dimension::PlaneStress, "Two dimensions, no stress out of the plane: a thin plate."),
        ("2d", Dimension::PlaneStrain, "Another word for `plane-strain`."),
        ("3d", Dimension::Space, "Three dimensions."),
    ];
}

impl Choice for BasisKind {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("gimp", BasisKind::Gimp, "Tent functions averaged over the particle's box (uniform GIMP)."),
        ("linear", BasisKind::Linear, "Tent functions at the particle's centre."),
        ("spline", BasisKind::Spline, "Quadratic B-splines of the particle's centre: smooth slopes."),
        ("cubic", BasisKind::Cubic, "Cubic B-splines of the particle's centre: slopes without kinks."),
    ];
    const ELSEWHERE: &'static [(&'static str, &'static str)] = &[(
        "cpdi",
        "here: no domains that deform; bodies that stay whole stretch, turn and bend without them on grids of their \
         own, interior = \"reference\", the default of elastic ones: leave `basis` out",
    )];
}

impl Choice for Interior {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("grid", Interior::Grid, "On the grid that all bodies share, by the material point method."),
        (
            "reference",
            Interior::Reference,
            "On a grid of its own undeformed places, by quadratic B-splines: for elastic and moderately plastic bodies \
             that stay in one piece.",
        ),
    ];
}

/// Where the bodies of a scene are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneInterior {
    /// All there.
    All(Interior),
    /// By what they are made of.
    Auto,
}

impl Choice for SceneInterior {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("grid", SceneInterior::All(Interior::Grid), <Interior as Choice>::WORDS[0].2),
        ("reference", SceneInterior::All(Interior::Reference), <Interior as Choice>::WORDS[1].2),
        (
            "auto",
            SceneInterior::Auto,
            "Elastic bodies on grids of their own, others on the common grid; all there where something asks for it.",
        ),
    ];
}

impl Choice for Precision {
    const WORDS: &'static [(&'static str, Self, &'static str)] =
        &[("double", Precision::Double, "64-bit numbers."), ("single", Precision::Single, "32-bit numbers.")];
}

impl Choice for Compression {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("zlib", Compression::Zlib, "In blocks, by zlib."),
        ("none", Compression::None, "Not at all: files of 1.4 to 3 times the size."),
    ];
}

impl Choice for Face {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("open", Face::Open, "Nothing; what leaves through it stops the run, or is removed: see `leaving`."),
        ("symmetry", Face::Symmetry, "A mirror: no velocity through it, no resistance along it."),
        ("fixed", Face::Fixed, "Material sticks to it: no velocity at all."),
        (
            "periodic",
            Face::Periodic,
            "What leaves through it comes in through the other face across its axis, which is periodic, too.",
        ),
    ];
}

impl Choice for Leaving {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("stop", Leaving::Stop, "It stops the run."),
        (
            "remove",
            Leaving::Remove,
            "It is taken out, with its mass, momentum and energy booked; of a rigid body it stops the run.",
        ),
    ];
}

impl Space {
    /// Number format.
    pub fn precision(&self, context: &Context) -> Result<Precision, Fault> {
        self.precision.as_ref().map_or(Ok(Precision::default()), |word| word.value(context))
    }

    /// Cells, particles and shape functions.
    pub fn discretization(&self, context: &Context) -> Result<Discretization, Fault> {
        let mut chosen = Discretization::new(self.cell.positive(context)?);
        if let Some(count) = &self.particles_per_side {
            chosen.particles_per_side = count.value(context, 1..=8)?;
        }
        if let Some(word) = &self.basis {
            chosen.basis = word.value(context)?;
        }
        if let Some(SceneInterior::All(interior)) = self.scene_interior(context)? {
            chosen.interior = interior;
        }
        Ok(chosen)
    }

    fn scene_interior(&self, context: &Context) -> Result<Option<SceneInterior>, Fault> {
        self.interior.as_ref().map(|word| word.value(context)).transpose()
    }

    /// Whether it is left open where bodies are computed that do not say so.
    pub fn leaves_interior_open(&self, context: &Context) -> Result<bool, Fault> {
        Ok(matches!(self.scene_interior(context)?, None | Some(SceneInterior::Auto)))
    }

    /// The box of all material, if there is one.
    pub fn domain(&self, context: &Context) -> Result<Option<scene::Domain>, Fault> {
        self.domain.as_ref().map(|domain| domain.resolve(context)).transpose()
    }
}

impl Domain {
    fn resolve(&self, context: &Context) -> Result<scene::Domain, Fault> {
        let (min, max) = corners(&self.min, &self.max, context)?;
        let mut domain = scene::Domain::new(min, max);
        if let Some(word) = &self.leaving {
            domain.leaving = word.value(context)?;
        }
        let written = [[&self.x_min, &self.x_max], [&self.y_min, &self.y_max], [&self.z_min, &self.z_max]];
        for (axis, pair) in written.iter().enumerate() {
            for (side, word) in pair.iter().enumerate() {
                let Some(word) = word else { continue };
                if axis == 2 && context.dimension.is_plane() {
                    return Err(word
                        .node()
                        .fault("x_min, x_max, y_min and y_max only, as the scene is plane"));
                }
                domain.faces[axis][side] = word.value(context)?;
            }
        }
        Ok(domain)
    }
}

/// Two corners of a box, the lower below the upper along each axis.
pub fn corners(
    min: &VectorInput<Length>,
    max: &VectorInput<Length>,
    context: &Context,
) -> Result<([f64; 3], [f64; 3]), Fault> {
    let (lower, upper) = (min.value(context)?, max.value(context)?);
    match (0..context.dimension.axes()).find(|axis| lower[*axis] >= upper[*axis]) {
        None => Ok((lower, upper)),
        Some(axis) => {
            let allowed = format!("more than {} m, the {} of min", lower[axis], ["x", "y", "z"][axis]);
            Err(max.part(axis).refused(upper[axis], allowed))
        }
    }
}
