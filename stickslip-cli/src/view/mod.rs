//! The viewer: a page for a browser, and what it asks for while it is looked at.
//!
//! The page is the same whether it is served from a port of this machine or is one file to be sent: it asks for
//! [`Route`]s, and a [`Library`] has the answers. [`serve`] gives them one by one, [`single_file`] writes
//! them all down.

mod exposed;
mod index;
mod library;
mod open_frame;
mod page;
mod places;
mod quantity;
mod quarters;
mod request;
mod route;
mod server;
mod single_file;
mod skins;
mod tables;

pub use library::Library;
pub use server::{answer, serve};
pub use single_file::{Estimate, write};
pub use skins::scene;
