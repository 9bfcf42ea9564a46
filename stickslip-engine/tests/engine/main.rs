//! The engine as others see it: what needs a simulation of a scene. Here and not beside what is tested, so that the
//! engine is compiled once.

mod flying;
mod footprint;
mod naive;
mod shared;
