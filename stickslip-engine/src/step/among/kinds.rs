//! What ranks know of bodies of which they have nothing: what all of a kind have in common.

use crate::body::{Body, BodyHere};
use crate::geometry::{MirroredShape, Shape};
use crate::scene::Scene;
use crate::step::build::{heated_bodies, whole};
use crate::tensor::Real;
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Its material, whether it begins with a stress, and whether it is heated.
type Kind = (usize, bool, bool);

/// The kinds of deformable bodies of a scene.
pub struct Kinds<T, const D: usize> {
    /// The scene, which names the bodies and draws their shapes.
    pub scene: Arc<Scene>,
    heated: HashSet<usize>,
    known: HashMap<Kind, Arc<BodyHere<T, D>>>,
}

impl<T: Real, const D: usize> Kinds<T, D> {
    /// None so far.
    pub fn new(scene: Arc<Scene>) -> Self {
        Kinds { heated: heated_bodies(&scene), scene, known: HashMap::new() }
    }

    /// What is known of a body without what belongs to it alone; `make` gives it whole, if none of its kind was made.
    pub fn of<E>(
        &mut self,
        number: usize,
        make: impl FnOnce() -> Result<BodyHere<T, D>, E>,
    ) -> Result<Body<T, D>, E> {
        let kind = self.kind(number);
        let known = match self.known.entry(kind) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(place) => {
                let mut body = make()?;
                body.particles.truncate(0);
                body.particles.fit();
                let nowhere = MirroredShape::new(&Shape::Union(Vec::new()), Vec::new(), D);
                place.insert(Arc::new(BodyHere { name: String::new(), whole: nowhere, ..body }))
            }
        };
        Ok(Body::Elsewhere(known.clone()))
    }

    fn kind(&self, number: usize) -> Kind {
        let body = &self.scene.bodies[number];
        (body.material, body.stress.is_some(), self.heated.contains(&number))
    }

    /// Gives a body all that belongs to it, since something of it comes here.
    pub fn bring(&self, body: &mut Body<T, D>, number: usize) {
        if let Body::Elsewhere(kind) = body {
            let name = self.scene.bodies[number].name.clone();
            let whole = whole::<D>(&self.scene, number);
            *body = BodyHere { name, whole, ..BodyHere::clone(kind) }.into();
        }
    }

    /// Keeps no more of a body of which nothing is here than what is known of its kind.
    pub fn let_go(&self, body: &mut Body<T, D>, number: usize) {
        let has_something = body.is_rigid() || body.particles.len() + body.particles.guests() > 0;
        let kind = self.known.get(&self.kind(number)).filter(|_| !has_something);
        if let (Body::Here(_), Some(kind)) = (&*body, kind) {
            *body = Body::Elsewhere(kind.clone());
        }
    }
}
