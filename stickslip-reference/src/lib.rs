//! Bodies on grids of their own undeformed places.
//!
//! Such a body is a map from undeformed places X to places x, by quadratic B-splines N_I on a grid that lies over its
//! undeformed shape. The nodes carry places x_I and velocities v_I, and persist:
//!
//! ```text
//! x(X) = sum N_I(X) x_I        F = sum x_I (x) grad N_I        f_I = -sum V_p P grad N_I        M_I = sum m_p N_I
//! v_I += dt (f_I / M_I + g),   contact on v_I,   x_I += dt v_I
//! ```
//!
//! Particles are quadrature points: a part of the shape each, with its volume and its centroid, and weights that never
//! change ([`stickslip_mechanics::geometry::form`] has the grid). F follows from places and gathers no error; one
//! velocity does everything, so nothing is filtered; and what acts at a point of the surface acts on the nodes through
//! the functions of that point. Total Lagrangian MPM: de Vaucorbeil et al. (2020); nodes of little mass follow others
//! as in extended B-splines: Höllig et al. (2001).
//!
//! The rooms below are in reading order: each uses only rooms above it.

// Points of the surface.
pub mod surface;

// What the cells of a grid look like to several lanes.
pub mod cells;

// A body: its nodes.
pub mod interior;

// Where bodies touch, and what they do to each other there.
pub mod contact;
