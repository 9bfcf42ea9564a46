//! Faces of the domain that hold a body: a half model is the whole one, folded.
//!
//! A mirror stands on a layer of nodes. Those behind it are images: they move as their originals do, but across the
//! mirror the other way, and give these their mass and the forces on them; nodes on the mirror do not leave it. Behind
//! a fixed face images go the other way along every axis, so that nothing on the face moves.
//!
//! ```text
//! x_s = sum e (S x_m + d)        f_m += e S f_s        S = diag(+-1), d: from S X_m to the image of X_m
//! ```

use super::{Followers, Form};
use crate::geometry::{Bounds, Mirror};
use crate::tensor::Vector;
use serde::Serialize;

/// A face that holds what of a body lies on it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HeldFace {
    /// Where it is along its axis [m].
    pub at: f64,
    /// Whether it holds a body along all axes, as a fixed face does, or across itself alone, as a mirror.
    pub is_fixed: bool,
}

/// The faces that hold a body: along each axis the lower and the upper one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct HeldFaces(pub [[Option<HeldFace>; 2]; 3]);

/// How near to a face a point of the surface lies on it [cells].
const ON: f64 = 1e-6;

impl HeldFaces {
    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.as_flattened().iter().all(Option::is_none)
    }

    /// The faces with their axes and sides.
    pub fn iter(&self) -> impl Iterator<Item = (usize, usize, HeldFace)> {
        let all = (0..3).flat_map(|axis| [0, 1].map(|side| (axis, side)));
        all.filter_map(|(axis, side)| Some((axis, side, self.0[axis][side]?)))
    }

    /// The body goes straight on behind each of them.
    pub fn mirrors(&self) -> Vec<Mirror> {
        let mirror = |(axis, side, face): (usize, usize, HeldFace)| Mirror {
            axis,
            position: face.at,
            inward: if side == 0 { 1.0 } else { -1.0 },
        };
        self.iter().map(mirror).collect()
    }

    /// Whether a point of a surface with this normal lies on one of them, for cells of this side [m].
    pub fn hold(&self, (place, normal): ([f64; 3], [f64; 3]), cell: f64) -> bool {
        self.iter().any(|(axis, side, face)| {
            let outward = if side == 0 { -1.0 } else { 1.0 };
            (place[axis] - face.at).abs() < ON * cell && normal[axis] * outward > 1.0 - ON
        })
    }

    /// What of a box around a body lies before the faces.
    pub fn cut(&self, mut bounds: Bounds) -> Bounds {
        for (axis, side, face) in self.iter() {
            match side {
                0 => bounds.min[axis] = bounds.min[axis].max(face.at),
                _ => bounds.max[axis] = bounds.max[axis].min(face.at),
            }
        }
        bounds
    }

    /// How many images of the whole a body is along an axis, itself included: without end between two faces.
    pub fn images(&self, axis: usize) -> f64 {
        [1.0, 2.0, f64::INFINITY][self.0[axis].iter().flatten().count()]
    }
}

/// Numbers of a node along the axes, or of its original if it lies behind faces, and how it was turned over.
#[derive(Clone, Copy, Debug)]
pub(super) struct Original<const D: usize> {
    pub at: [isize; D],
    pub turned: Turned,
}

/// What faces do to a vector.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turned {
    /// Axes along which it changes its sign, a bit each.
    axes: u8,
    /// The faces, a bit each: twice the axis, and one for the upper one.
    pub faces: u8,
}

impl Turned {
    /// The vector after it.
    #[inline]
    pub fn of<const D: usize>(self, vector: Vector<f64, D>) -> Vector<f64, D> {
        Vector::from_fn(|k| if self.axes >> k & 1 == 1 { -vector[k] } else { vector[k] })
    }

    fn by<const D: usize>(self, (axis, side, face): (usize, usize, HeldFace)) -> Self {
        Turned { axes: self.axes ^ across::<D>(axis, face), faces: self.faces | 1 << (2 * axis + side) }
    }

    /// One after the other.
    pub(super) fn and(self, other: Turned) -> Self {
        Turned { axes: self.axes ^ other.axes, faces: self.faces | other.faces }
    }
}

/// Axes along which a face holds what is on it, a bit each.
fn across<const D: usize>(axis: usize, face: HeldFace) -> u8 {
    if face.is_fixed { (1 << D) - 1 } else { 1 << axis }
}

/// What faces hold of a body's nodes.
#[derive(Clone, Debug, Default)]
pub struct Held<const D: usize> {
    /// Of each share of the followers, how the master is turned over.
    pub(super) turned: Vec<Turned>,
    /// Of each follower, sum e d [m].
    pub(super) shifts: Vec<Vector<f64, D>>,
    /// Nodes on faces.
    nodes: Vec<HeldNode>,
    /// Shares of followers in masters that are turned over.
    pub(super) images: Vec<Image<D>>,
    /// Volume that moves one way with each node, along each axis: that of its images goes the other way across them.
    net: Vec<Vector<f64, D>>,
}

/// A node on faces, or one with images.
#[derive(Clone, Copy, Debug)]
struct HeldNode {
    node: u32,
    /// Axes along which it is held, a bit each.
    axes: u8,
    faces: u8,
}

/// A share of a follower in a master that is turned over.
#[derive(Clone, Copy, Debug)]
pub struct Image<const D: usize> {
    /// The follower.
    pub node: u32,
    /// The master.
    pub master: u32,
    /// Its share e [-].
    pub share: f64,
    /// How it is turned over.
    pub turned: Turned,
    /// d [m].
    pub shift: Vector<f64, D>,
    /// Volume that moves with it [m^3, m^2].
    pub volume: f64,
}

/// What moves with a node, or with an image of one.
#[derive(Clone, Copy, Debug)]
pub struct Carried<const D: usize> {
    /// The node.
    pub node: usize,
    /// Its volume [m^3, m^2].
    pub volume: f64,
    /// How it is turned over.
    pub turned: Turned,
    /// d [m].
    pub shift: Vector<f64, D>,
}

/// Impulse on a body by what holds it at a place [N s, m].
#[derive(Clone, Copy, Debug)]
pub struct Reaction<const D: usize> {
    /// The faces, a bit each: twice the axis, and one for the upper one.
    pub faces: u8,
    /// Impulse on the body [N s].
    pub impulse: Vector<f64, D>,
    /// Where [m].
    pub at: Vector<f64, D>,
}

impl<const D: usize> Form<D> {
    /// Where node layers of the faces are along an axis.
    fn layer(&self, axis: usize, side: usize) -> isize {
        if side == 0 { 1 } else { self.counts[axis] as isize - 2 }
    }

    /// The original of a node.
    pub(super) fn original(&self, mut at: [isize; D]) -> Original<D> {
        let mut turned = Turned::default();
        for face in self.faces.iter() {
            let (axis, side, _) = face;
            let layer = self.layer(axis, side);
            let is_behind = if side == 0 { at[axis] < layer } else { at[axis] > layer };
            if is_behind {
                at[axis] = 2 * layer - at[axis];
                turned = turned.by::<D>(face);
            }
        }
        Original { at, turned }
    }

    /// The faces on whose layers a node lies, and the axes along which they hold it.
    fn holding(&self, at: [isize; D]) -> (u8, u8) {
        let on = self.faces.iter().filter(|&(axis, side, _)| at[axis] == self.layer(axis, side));
        on.fold((0, 0), |(axes, faces), (axis, side, face)| {
            (axes | across::<D>(axis, face), faces | 1 << (2 * axis + side))
        })
    }

    /// Volumes of the whole that nodes move, from those of the half [m^3, m^2]: none of nodes behind faces.
    pub(super) fn whole_volumes(&self, own: &[f64]) -> Vec<f64> {
        if self.faces.is_empty() {
            return own.to_vec();
        }
        let mut whole = vec![0.0; own.len()];
        for (node, volume) in own.iter().enumerate() {
            let Original { at, .. } = self.original(self.numbers(node).map(|n| n as isize));
            let images = (1 << self.holding(at).1.count_ones()) as f64;
            whole[self.node(at.map(|n| n as usize))] += images * volume;
        }
        whole
    }

    /// Takes note of the nodes that faces hold, once volumes are what they stay.
    pub(super) fn hold_nodes(&mut self) {
        let Some(mut held) = self.held.take() else { return };
        let mut nodes = vec![(0, 0); self.nodes()];
        for node in (0..self.nodes()).filter(|&node| self.node_volumes[node] > 0.0) {
            nodes[node] = self.holding(self.numbers(node).map(|n| n as isize));
        }
        held.images.iter().for_each(|image| nodes[image.master as usize].1 |= image.turned.faces);
        let some = nodes.into_iter().zip(0..).filter(|((axes, faces), _)| axes | faces != 0);
        held.nodes = some.map(|((axes, faces), node)| HeldNode { node, axes, faces }).collect();
        let mut net: Vec<_> = self.node_volumes.iter().map(|&volume| Vector([volume; D])).collect();
        for image in &held.images {
            let ones = Vector([image.volume; D]);
            net[image.master as usize] += image.turned.of(ones) - ones;
        }
        held.hold(&mut net);
        held.net = net;
        self.held = Some(held);
    }

    /// Zero along the axes along which faces hold nodes.
    pub fn hold(&self, values: &mut [Vector<f64, D>]) {
        if let Some(held) = &self.held {
            held.hold(values);
        }
    }

    /// Volume that is pulled one way with a node along each axis, as by gravity [m^3, m^2].
    #[inline]
    pub fn net_volume(&self, node: usize) -> Vector<f64, D> {
        self.held.as_ref().map_or_else(|| Vector([self.node_volumes[node]; D]), |held| held.net[node])
    }

    /// All that moves with nodes, of half a model that half alone.
    pub fn carried(&self) -> impl Iterator<Item = Carried<D>> {
        let images = self.held.iter().flat_map(|held| &held.images);
        let own = self.held.as_ref().map(|held| held.own_volumes(&self.node_volumes));
        let volume = move |node: usize, whole: f64| own.as_ref().map_or(whole, |own| own[node]);
        let (turned, shift) = (Turned::default(), Vector::ZERO);
        let nodes = self.node_volumes.iter().enumerate().filter(|(_, whole)| **whole > 0.0);
        nodes.map(move |(node, &whole)| Carried { node, volume: volume(node, whole), turned, shift }).chain(
            images.map(|image| Carried {
                node: image.master as usize,
                volume: image.volume,
                turned: image.turned,
                shift: image.shift,
            }),
        )
    }

    /// Impulses by which faces held a body in a step of `dt` [s], in which its nodes changed their velocities by these
    /// [m/s], from the forces on them before followers gave theirs to their masters [N].
    ///
    /// ```text
    /// r = m dv - (f + m g) dt        of a node by itself, and of each image of it
    /// ```
    /// `inertia` is that of supports on the nodes [kg], or nothing.
    pub fn reactions(
        &self,
        (places, changes): (&[Vector<f64, D>], &[Vector<f64, D>]),
        (forces, inertia): (&[Vector<f64, D>], &[Vector<f64, D>]),
        (density, gravity): (f64, Vector<f64, D>),
        dt: f64,
    ) -> Vec<Reaction<D>> {
        let Some(held) = &self.held else { return Vec::new() };
        let mut direct = forces.to_vec();
        let volumes = held.own_volumes(&self.node_volumes);
        let mut entry = held.turned.iter();
        for (node, masters, shares) in self.followers.iter() {
            for ((&master, &share), turned) in masters.iter().zip(shares).zip(&mut entry) {
                if *turned == Turned::default() {
                    direct[master as usize] += forces[node] * share;
                }
            }
        }
        let of = |mass: f64, change: Vector<f64, D>, force: Vector<f64, D>| {
            change * mass - (force + gravity * mass) * dt
        };
        let mut reactions = Vec::new();
        for &HeldNode { node, faces, .. } in &held.nodes {
            let node = node as usize;
            let support =
                inertia.get(node).map_or(Vector::ZERO, |own| Vector::from_fn(|k| own[k] * changes[node][k]));
            let impulse = of(density * volumes[node], changes[node], direct[node]) + support;
            reactions.push(Reaction { faces, impulse, at: places[node] });
        }
        for image in &held.images {
            let master = image.master as usize;
            let force = forces[image.node as usize] * image.share;
            let impulse = of(density * image.volume, image.turned.of(changes[master]), force);
            let at = image.turned.of(places[master]) + image.shift;
            reactions.push(Reaction { faces: image.turned.faces, impulse, at });
        }
        reactions
    }
}

impl<const D: usize> Held<D> {
    /// Volumes that move with nodes themselves, of those with their images [m^3, m^2].
    fn own_volumes(&self, all: &[f64]) -> Vec<f64> {
        let mut own = all.to_vec();
        self.images.iter().for_each(|image| own[image.master as usize] -= image.volume);
        own
    }

    fn hold(&self, values: &mut [Vector<f64, D>]) {
        for HeldNode { node, axes, .. } in &self.nodes {
            let value = &mut values[*node as usize];
            (0..D).filter(|k| axes >> k & 1 == 1).for_each(|k| value[k] = 0.0);
        }
    }

    /// a_s = sum e S a_m
    pub(super) fn follow(&self, followers: &Followers, values: &mut [Vector<f64, D>]) {
        let mut entry = self.turned.iter();
        for (node, masters, shares) in followers.iter() {
            let all = masters.iter().zip(shares).zip(&mut entry);
            values[node] = all.fold(Vector::ZERO, |sum, ((&m, &share), turned)| {
                sum + turned.of(values[m as usize]) * share
            });
        }
    }

    /// f_m += e S f_s, and nothing is left along the axes along which nodes are held.
    pub(super) fn gather(&self, followers: &Followers, values: &mut [Vector<f64, D>]) {
        let mut entry = self.turned.iter();
        for (node, masters, shares) in followers.iter() {
            let own = std::mem::replace(&mut values[node], Vector::ZERO);
            for ((&master, &share), turned) in masters.iter().zip(shares).zip(&mut entry) {
                values[master as usize] += turned.of(own) * share;
            }
        }
        self.hold(values);
    }
}
