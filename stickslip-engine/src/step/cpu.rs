//! Passes over tiles on threads, with the same bits for any number of them.
//!
//! Small bodies scatter each on one thread, tile after tile. Tiles of one colour of large bodies scatter side by side,
//! colours one after the other, and a tile's particles in the order of their numbers: no sum depends on which thread
//! comes first, nor on where particles lie in memory.

use super::Engine;
use super::among::Among;
use crate::grid::{Disjoint, Field, NodeSums, Window, add_corner, window_side};
use crate::lanes::Laned;
use crate::particles::Columns;
use crate::pass::{Found, Pass, Verbs, Visit};
use crate::threads::each_range;
use crate::transfer::Share;
use std::sync::{Mutex, PoisonError};

/// What threads work with, kept from pass to pass.
pub struct Threads<T, const D: usize> {
    /// A window for each thread.
    windows: Vec<Mutex<Box<Window<T, D>>>>,
    /// Columns of the bodies that are here.
    columns: Vec<Columns<T, D>>,
}

impl<T, const D: usize> Default for Threads<T, D> {
    fn default() -> Self {
        Threads { windows: Vec::new(), columns: Vec::new() }
    }
}

/// Tiles that a thread takes at a time.
const TILES: usize = 2;

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Takes every particle through a pass; those of rigid bodies only scatter.
    pub(super) fn pass(&mut self, pass: &Pass<T, D>) -> Found<T> {
        let threads = rayon::current_num_threads();
        self.workspace
            .threads
            .windows
            .resize_with(threads.max(self.workspace.threads.windows.len()), Mutex::default);
        self.workspace.threads.columns.clear();
        let bodies = &mut self.state.bodies;
        let opened = self.workspace.active.here().iter().map(|&body| {
            let body = &mut bodies[body as usize];
            match body.here_mut() {
                Some(body) => body.particles.open(),
                None => body.particles.view(),
            }
        });
        self.workspace.threads.columns.extend(opened);
        let mut among = self.among.take();
        let kernels = self.kernels;
        let width = window_side(kernels.width);
        let side = width.pow(D as u32);
        let mut kept_windows = match (&mut among, pass.verbs.scatter) {
            (Some(among), Some(_)) => among.take_room(self.workspace.active.border.as_deref(), side),
            _ => Vec::new(),
        };
        let windows = Disjoint::new(&mut kept_windows);
        let Field { nodes, filtered, means, .. } = &mut self.workspace.field;
        let nodes = Disjoint::new(nodes);
        let left = Disjoint::new(&mut self.workspace.left);
        let damped = Disjoint::new(&mut self.workspace.damped);
        let moved = Disjoint::new(&mut self.workspace.moved);
        let (active, bodies, room, path) =
            (&self.workspace.active, &self.state.bodies, &self.workspace.threads, self.settings.path);
        // Fed with the fastest signal of the tiles before it in its list, which spares it the roots of slower ones.
        // It changes no bit of what is found.
        let border = active.border.as_deref().filter(|_| pass.verbs.scatter.is_some());
        let visit = |index: u32, window: &mut Window<T, D>, signal: T, keeps: bool| -> Found<T> {
            let tile = &active.tiles[index as usize];
            let body = &bodies[tile.body];
            let averages = pass.verbs.scatter.is_some_and(Share::is_averaged);
            let (place, waiting) = border.map_or((None, 0), |border| border.of_tile[index as usize]);
            // SAFETY: every tile has a place of its own.
            let kept = place.map(|place| unsafe { windows.part(place as usize * side, side) });
            if let (Some(kept), false) = (&kept, keeps) {
                // What it gives is there already.
                for corner in (0..1 << D).filter(|corner| waiting >> corner & 1 == 0) {
                    let slot = (tile.slots[corner as usize], corner);
                    // SAFETY: only this tile writes to its slots.
                    unsafe { add_corner(kept, &nodes, slot, width) };
                }
                return Found { signal, ..Found::NOTHING };
            }
            if averages && !body.averages_volume() {
                kept.into_iter().for_each(|kept| kept.fill(NodeSums::default()));
                return Found { signal, ..Found::NOTHING };
            }
            let for_rigid = Verbs { scatter: pass.verbs.scatter, ..Verbs::default() };
            let pass = &Pass { verbs: if body.is_rigid() { for_rigid } else { pass.verbs }, ..*pass };
            let mut visit = Visit {
                pass,
                tile,
                matter: &body.matter,
                numbers: body.particles.numbers(),
                columns: room.columns[tile.place],
                order: active.order_of(tile.body),
                cells: active.cells_of(tile),
                nodes: &nodes,
                filtered,
                means: if body.averages_volume() && !averages { means } else { &[] },
                window,
                kept,
                next: active.tiles.get(index as usize + 1),
                left: 0,
                moved: 0,
                damped: 0.0,
                found: Found { signal, ..Found::NOTHING },
            };
            // SAFETY: every particle belongs to one tile, and every tile to one call. Nobody writes to the field in a
            // pass without scatter and while windows are kept, and else only this tile to its slots:
            // portions and tiles of one colour share none.
            unsafe { (kernels.visit)(path, &mut visit) };
            // SAFETY: every tile has a place of its own.
            unsafe {
                *left.get(index as usize) |= visit.left;
                *moved.get(index as usize) += visit.moved;
                *damped.get(index as usize) = visit.damped;
            }
            visit.found
        };
        let several = |tiles: &mut dyn Iterator<Item = u32>, keep: bool| -> Found<T> {
            let thread = rayon::current_thread_index().unwrap_or(0);
            let mut window = room.windows[thread].lock().unwrap_or_else(PoisonError::into_inner);
            tiles.fold(Found::NOTHING, |found, tile| found.and(visit(tile, &mut window, found.signal, keep)))
        };
        let all = Mutex::new(Found::NOTHING);
        let several = |tiles: &mut dyn Iterator<Item = u32>, keep: bool| {
            let found = several(tiles, keep);
            let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
            // The first fault and the fastest signal, whoever comes first.
            *all = all.and(found);
        };
        let scatter = || {
            each_range(active.portions.len(), 1, &|portions| {
                for portion in &active.portions[portions] {
                    several(&mut active.small[portion.clone()].iter().copied(), false);
                }
            });
            for color in &active.colors {
                each_range(color.len(), TILES, &|range| several(&mut color[range].iter().copied(), false));
            }
        };
        let mut came = Vec::new();
        match (&among, border, pass.verbs.scatter) {
            (_, _, None) => {
                let all = active.tiles.len();
                each_range(all, TILES, &|range| several(&mut range.map(|tile| tile as u32), false));
            }
            (Some(among), Some(border), Some(share)) => {
                // What others wait for comes first, and is under way while the rest is done.
                let kept = &border.kept;
                each_range(kept.len(), TILES, &|range| several(&mut kept[range].iter().copied(), true));
                let (shown, side) = ((&windows, share), width);
                // SAFETY: all tiles that are kept have been visited.
                let messages = unsafe { Among::windows_for_others::<D>(border, shown, side) };
                let from: Vec<usize> = border.incoming.iter().map(|traffic| traffic.rank).collect();
                came = among.ranks.exchange_during(messages, &from, &mut || scatter());
            }
            _ => scatter(),
        }
        let found = all.into_inner().unwrap_or_else(PoisonError::into_inner);
        if let (Some(among), Some(border), Some(share)) = (&mut among, border, pass.verbs.scatter) {
            let came_here = (border, kept_windows, came);
            among.add_windows(came_here, (&nodes, share), width);
        }
        self.among = among;
        found
    }
}
