//! The bodies of a scene, of which copies of the scene have no copies until one of them changes them.

use super::Body;
use serde::{Serialize, Serializer};
use std::ops::{Deref, DerefMut};
use std::slice::Iter;
use std::sync::Arc;

/// Bodies in their order, a vector to all who use it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyList(Arc<Vec<Body>>);

impl From<Vec<Body>> for BodyList {
    fn from(bodies: Vec<Body>) -> Self {
        BodyList(Arc::new(bodies))
    }
}

impl Deref for BodyList {
    type Target = Vec<Body>;

    fn deref(&self) -> &Vec<Body> {
        &self.0
    }
}

impl DerefMut for BodyList {
    fn deref_mut(&mut self) -> &mut Vec<Body> {
        Arc::make_mut(&mut self.0)
    }
}

impl<'a> IntoIterator for &'a BodyList {
    type Item = &'a Body;
    type IntoIter = Iter<'a, Body>;

    fn into_iter(self) -> Iter<'a, Body> {
        self.0.iter()
    }
}

impl Serialize for BodyList {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.as_slice().serialize(serializer)
    }
}
