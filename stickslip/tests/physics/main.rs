//! What the engine owes to mechanics: one file a claim, each headed by its source, set-up,
//! expected value and tolerance.
//!
//! `cargo test --release -p stickslip --test physics -- --nocapture` prints what was measured.

mod trial;

mod body_at_rest;
mod brazilian_disk;
mod bulk_viscosity;
mod capstan;
mod chain;
mod colliding_disks;
mod columns;
mod contact_keys;
mod custom_law;
mod damping;
mod empty_space;
mod exact_surfaces;
mod failing_steps;
mod famous;
mod fracture;
mod free_body;
mod free_rigid;
mod friction;
mod glued_identity;
mod gravity;
mod heap;
mod heat;
mod images;
mod initial_stress;
mod jamming;
mod leaving;
mod load_works;
mod loads;
mod many_bodies;
mod meshes;
mod mirror;
mod nearly_incompressible;
mod paths;
mod periodic;
mod plane_stress;
mod plastic_flow;
mod point_clouds;
mod precision;
mod press_fit;
mod pulses;
mod ranks;
mod reactions;
mod reference;
mod relaxation;
mod resistance;
mod retries;
mod rigid_bodies;
mod rigid_contact;
mod sections;
mod servo_walls;
mod silo;
mod spinning_disk;
mod springs;
mod starts;
mod stretched;
mod struck_bar;
mod threads;
mod transfers;
mod unbounded_bodies;
mod vibration;
