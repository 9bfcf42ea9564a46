//! Why laws miss targets, where several benchmarks have it in common.

use crate::benchmark::Reason;

/// Each body has its own normal.
pub const OWN_NORMALS: Reason = Reason {
    laws: &["traction", "kinematic"],
    text: "Each body takes its own normal, the gradient of its own mass, and decides by itself, as the paper has \
it. The two are not opposite (eq. 16 of the paper does not hold), which breaks momentum, and at the rim of a patch \
they lean by up to 45 degrees, where surfaces that should slide hook into each other. With normal = \"common\" \
momentum is kept.",
};

/// Contact where two bodies share a node.
pub const AT_A_DISTANCE: Reason = Reason {
    laws: &["traction", "kinematic"],
    text: "Bodies touch as soon as they share a node, over a cell too early, and as early or late as the grid lies: \
the patch is wider than it is by about the root of cell times radius.",
};

/// A rebound is not what approach was.
pub const RELEASE: Reason = Reason {
    laws: &["kinematic", "regression"],
    text: "The law lets go as soon as bodies part, though they are still compressed: their strain energy is not \
given back through the contact, and energy comes from nowhere.",
};

/// The extrapolated distance is not that of surfaces.
pub const EXTRAPOLATED: Reason = Reason {
    laws: &["separation"],
    text: "The distance of the bodies' extrapolated positions is that of their surfaces only on average: bodies \
hold each other half a cell early, and beside the patch, where faces run at an angle to the grid.",
};

/// The volume around a node sees stairs.
pub const STAIRS: Reason = Reason {
    laws: &["gap"],
    text: "The law sees the room that particles leave around a node. Faces at an angle to the grid are stairs of \
particles: where two gaps face each other it finds none to touch, where two edges do it finds them hooked.",
};

/// The plane between particles follows their stairs.
pub const PLANE_OF_PARTICLES: Reason = Reason {
    laws: &["regression"],
    text: "The plane that regression lays between the particles near a node follows their stairs, and at edges and \
round contacts the few particles there tilt it.",
};
