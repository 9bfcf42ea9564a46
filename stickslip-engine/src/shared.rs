//! A simulation that several ranks share, as the first of them sees it.
//!
//! The first rank has a [`Simulation`] like any other: [`lead`] gives it. The others [`follow`]: whatever the first one
//! asks of its simulation, it tells them, and all of them do it together. So a run, its outputs and its checks are
//! written once, for a simulation, and only the first rank has them. A snapshot, a column or the nodes of the grid it
//! holds for as long as it looks; all else of particles it sees some at a time. What takes all particles and needs not
//! be in one place, such as a file of them, each rank does with its own: its [`Program`] knows how.

use crate::column::ColumnDescription;
use crate::contact::ContactSums;
use crate::door::{
    BodyState, ColumnRef, ContactPatch, ContactPoint, ContactSum, GridSnapshot, JointState, Ledger,
    LoadState, NoColumn, NotTakenUp, ParticleSnapshot, ParticleView, RankShare, RelaxationState,
    RemovedParticles, RestoreError, SavedBody, SavedColumn, SavedShare, SavedState, Simulation, StepError,
    StepLimit, TracedParticle, View, WallState, WriteError, WrittenValues,
};
use crate::lanes::Processor;
use crate::particles::by_number;
use crate::ranks::{Ranks, Threads, added, all_of, bytes_of, combined, read, told_first};
use crate::rigid::Pose;
use crate::scene::{Problem, Scene, StartVelocities};
use crate::step::{self, Find, ParticleLoop, Shareable};
use rayon::ThreadPoolBuilder;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_bytes::ByteBuf;
use std::ops::Range;
use std::sync::Arc;

/// What the program of a rank can do, whose engine knows neither files nor their forms. All ranks do it at once, and
/// may talk to each other while they do.
#[derive(Clone, Copy)]
pub struct Program {
    /// Does what the first one asks with what this rank has, and says how that went.
    pub act: fn(&dyn Simulation, &dyn Ranks, &[u8]) -> Vec<u8>,
    /// Finds this rank's share of the particles of a saved state by what the first one asks, in any way that gives each
    /// to one rank, and shows it, some at a time; or says what is wrong with it.
    pub find: Finding,
}

/// See [`Program::find`].
pub type Finding = fn(&dyn Ranks, &[u8], &mut dyn FnMut(Vec<SavedShare>)) -> Result<(), String>;

/// The simulation of a scene, which other ranks share; they [`follow`] until it is dropped.
///
/// # Errors
/// What [`crate::check::problems`] finds, and what ranks cannot share yet: the others find the same.
pub fn lead(
    scene: Arc<Scene>,
    path: ParticleLoop,
    (ranks, program): (Arc<dyn Ranks>, Program),
) -> Result<Box<dyn Simulation>, Problem> {
    Ok(Box::new(Leader(Part::new(scene, path, (ranks, program))?)))
}

/// Does what the first rank asks of the simulation of this scene, until it drops it.
///
/// # Errors
/// What [`lead`] finds.
pub fn follow(
    scene: Arc<Scene>,
    path: ParticleLoop,
    (ranks, program): (Arc<dyn Ranks>, Program),
) -> Result<(), Problem> {
    let mut part = Part::new(scene, path, (ranks, program))?;
    while part.obey() {}
    Ok(())
}

/// What the first of so many ranks makes of the simulation of a scene: threads of this process, each with a pool of one
/// thread. For tests and measurements; one process with as many threads is faster.
pub fn among_threads<X: Send>(
    scene: &Scene,
    (count, program): (usize, Program),
    act: impl FnOnce(Result<Box<dyn Simulation>, Problem>) -> X + Send,
) -> X {
    let path = ParticleLoop::Lanes(Processor::best());
    let scene = Arc::new(scene.clone());
    // A pool for each: who waits for another rank keeps a thread of its pool.
    let pool = || ThreadPoolBuilder::new().num_threads(1).build().expect("the system gives a thread");
    std::thread::scope(|scope| {
        let mut ranks = Threads::start(count.max(1)).into_iter();
        let first = ranks.next().expect("there is one");
        for other in ranks {
            // What is wrong with the scene, the first one says.
            let scene = scene.clone();
            scope.spawn(move || pool().install(|| follow(scene, path, (Arc::new(other), program))));
        }
        pool().install(|| act(lead(scene, path, (Arc::new(first), program))))
    })
}

/// Particles that the first rank is shown at a time, of all ranks together.
const SHOWN_AT_A_TIME: usize = 1 << 16;
/// Particles of a body of which it sees the bytes of an entry at a time; of several bodies those of all entries.
pub const BYTES_OF_AT_A_TIME: usize = 1 << 17;
/// A body among several counts as so many particles more.
const OF_A_BODY: usize = 16;

/// What the first rank asks of all, itself included.
#[derive(Serialize, Deserialize)]
enum Call {
    Step(f64),
    StepUnseen(f64),
    Show,
    Rebuild,
    Hold,
    TakeBack,
    Settle,
    StableStep,
    StepLimit,
    Particles,
    Bodies,
    Ledger,
    Loads,
    ContactSums,
    Patches,
    Snapshot,
    Visit(usize),
    Fastest(usize, [f64; 3]),
    Column(usize, String),
    VisitColumn(usize, String),
    TraceEach(Vec<(usize, Vec<u32>)>),
    Grid,
    Shares,
    SaveRest,
    VisitBytes(Range<usize>),
    Ask(Vec<u8>),
    /// A state without particles follows.
    RestoreOnRanks(Vec<u8>),
    /// A state without particles follows, which may be that of a snapshot.
    BeginOnRanks(Vec<u8>, StartVelocities, bool),
    /// A state without particles follows, then particles, unless the first one could not take it up.
    BeginAnew,
    End,
}

/// One rank's part of a simulation. All ranks make the same calls of it in the same order, and the first gets what they
/// give together.
struct Part {
    own: Box<dyn Shareable>,
    scene: Arc<Scene>,
    path: ParticleLoop,
    ranks: Arc<dyn Ranks>,
    program: Program,
}

/// The first rank's.
struct Leader(Part);

impl Part {
    fn new(
        scene: Arc<Scene>,
        path: ParticleLoop,
        (ranks, program): (Arc<dyn Ranks>, Program),
    ) -> Result<Self, Problem> {
        let own = step::build_share(&scene, path, ranks.clone())?;
        Ok(Part { own, scene, path, ranks, program })
    }

    /// What each rank says, by rank, for the first.
    fn gathered<X: Serialize + DeserializeOwned>(&self, said: &X) -> Vec<X> {
        told_first(&*self.ranks, said)
    }

    /// Does what the first rank asks; false if that was the last.
    fn obey(&mut self) -> bool {
        match read(&self.ranks.hear_first(&[])) {
            // A step that fails does so on all ranks, and the first tells the user.
            Call::Step(longest) => drop(self.own.step(longest)),
            Call::StepUnseen(longest) => drop(self.own.step_unseen(longest)),
            Call::Show => self.own.show(),
            Call::Rebuild => self.own.rebuild_workspace(),
            Call::Hold => self.own.hold(),
            Call::TakeBack => drop(self.own.take_back()),
            Call::Settle => self.own.settle(),
            Call::StableStep => drop(self.own.stable_step()),
            Call::StepLimit => drop(self.own.step_limit()),
            Call::Particles => drop(self.particles()),
            Call::Bodies => drop(self.own.bodies()),
            Call::Ledger => drop(self.own.ledger()),
            Call::Loads => drop(self.own.loads()),
            Call::ContactSums => drop(self.contact_sums()),
            Call::Patches => drop(self.patches()),
            Call::Snapshot => drop(self.snapshot()),
            Call::Visit(body) => self.visit(body, &mut |_| ()),
            Call::Fastest(body, against) => drop(self.fastest(body, against)),
            Call::Column(body, name) => drop(self.column(body, &name)),
            Call::VisitColumn(body, name) => drop(self.visit_column(body, &name, &mut |_, _| ())),
            Call::TraceEach(wanted) => drop(self.trace_each(&wanted)),
            Call::Grid => drop(self.grid_snapshot()),
            Call::Shares => drop(self.shares()),
            Call::SaveRest => drop(self.save_rest()),
            Call::VisitBytes(bodies) => drop(self.visit_bytes(bodies, &mut |_, _| ())),
            Call::Ask(asked) => drop(self.ask(&asked)),
            Call::RestoreOnRanks(asked) => {
                let rest = read(&self.ranks.hear_first(&[]));
                drop(self.restore_on_ranks(&rest, &asked));
            }
            Call::BeginOnRanks(asked, velocities, of_snapshot) => {
                let rest = read::<SavedState>(&self.ranks.hear_first(&[]));
                let rest = SavedState { of_snapshot, ..rest };
                drop(self.begin_on_ranks((&rest, velocities), &asked, &mut |_, _| ()));
            }
            Call::BeginAnew => drop(self.begin_anew(None)),
            Call::End => return false,
        }
        true
    }

    fn particles(&self) -> usize {
        self.gathered(&self.own.particles()).iter().sum()
    }

    fn contact_sums(&self) -> Vec<ContactSum> {
        let mut all = self.gathered(&self.own.contact_sums()).concat();
        all.sort_unstable_by_key(|sum| sum.bodies);
        all
    }

    fn patches(&self) -> Vec<ContactPatch> {
        let mut all = self.gathered(&self.own.patches()).concat();
        all.sort_unstable_by_key(|patch| (patch.body_a, patch.body_b));
        all
    }

    fn snapshot(&self) -> ParticleSnapshot {
        ParticleSnapshot::merged(self.gathered(&self.own.snapshot()))
    }

    /// Takes what each rank has, of which this one has so many, some at a time and all ranks at once.
    fn in_turns(&self, own: usize, take: &mut dyn FnMut(Range<usize>)) {
        let most = combined(&*self.ranks, &own, usize::max);
        let at_a_time = (SHOWN_AT_A_TIME / self.ranks.count()).max(1);
        for first in (0..most).step_by(at_a_time) {
            take(first.min(own)..(first + at_a_time).min(own));
        }
    }

    fn visit(&self, body: usize, look: &mut dyn FnMut(&ParticleView)) {
        let mut own = Vec::new();
        self.own.visit(body, &mut |particle| own.push(*particle));
        self.in_turns(own.len(), &mut |some| {
            self.gathered(&own[some].to_vec()).iter().flatten().for_each(&mut *look);
        });
    }

    fn visit_column(
        &self,
        body: usize,
        name: &str,
        look: &mut dyn FnMut(u32, &[f64]),
    ) -> Result<(), NoColumn> {
        let components = self.own.column(body, name)?.description.kind.components();
        let (mut numbers, mut values) = (Vec::new(), Vec::new());
        self.own.visit_column(body, name, &mut |number, row| {
            numbers.push(number);
            values.extend_from_slice(row);
        })?;
        let rows: Vec<&[f64]> = values.chunks_exact(components).collect();
        self.in_turns(numbers.len(), &mut |some| {
            let own = (numbers[some.clone()].to_vec(), rows[some].concat());
            for (numbers, values) in self.gathered::<(Vec<u32>, Vec<f64>)>(&own) {
                numbers.iter().zip(values.chunks_exact(components)).for_each(|(&n, row)| look(n, row));
            }
        });
        Ok(())
    }

    fn fastest(&self, body: usize, against: [f64; 3]) -> Option<ParticleView> {
        let square = |particle: &ParticleView| -> f64 {
            (0..3).map(|i| (particle.velocity[i] - against[i]).powi(2)).sum()
        };
        let all = self.gathered(&self.own.fastest(body, against));
        all.into_iter().flatten().max_by(|a, b| square(a).total_cmp(&square(b)).then(b.number.cmp(&a.number)))
    }

    /// The numbers of a body's particles, and their components in space one particle after the other.
    fn column(&self, body: usize, name: &str) -> Result<(ColumnDescription, Vec<u32>, Vec<f64>), NoColumn> {
        let column = self.own.column(body, name)?;
        let (count, numbers) = (column.description.kind.components(), column.numbers().to_vec());
        let values = column.values();
        let all = self.gathered(&(numbers, values));
        let numbers: Vec<u32> = all.iter().flat_map(|(numbers, _)| numbers).copied().collect();
        let values: Vec<f64> = all.iter().flat_map(|(_, values)| values).copied().collect();
        debug_assert_eq!(values.len(), count * numbers.len());
        Ok((column.description, numbers, values))
    }

    fn trace_each(&self, wanted: &[(usize, Vec<u32>)]) -> Vec<Vec<TracedParticle>> {
        let mut all = vec![Vec::new(); wanted.len()];
        for own in self.gathered(&self.own.trace_each(wanted)) {
            all.iter_mut().zip(own).for_each(|(all, own)| all.extend(own));
        }
        all.iter_mut().for_each(|all| all.sort_unstable_by_key(|particle| particle.number));
        all
    }

    fn grid_snapshot(&self) -> GridSnapshot {
        GridSnapshot::merged(self.gathered(&self.own.grid_snapshot()))
    }

    fn shares(&self) -> Vec<RankShare> {
        self.gathered(&self.own.shares()).concat()
    }

    fn save_rest(&self) -> Option<SavedState> {
        let own = self.own.save_rest()?;
        let sums = self.ranks.tell_first(&bytes_of(&own.contact_sums));
        let contact_sums = ContactSums::merged(all_of(sums));
        Some(SavedState { contact_sums, ..own })
    }

    fn visit_bytes(&self, bodies: Range<usize>, look: &mut dyn FnMut(usize, &[u8])) -> bool {
        let columns: ColumnsOf = &|body, take| self.own.save_columns(body, take);
        SharedColumns { ranks: &*self.ranks, counts: self.own.counts_of_all(), columns }
            .visit_bytes(bodies, look)
    }

    /// What the program of each rank says of what all are asked, by rank, for the first.
    fn ask(&self, asked: &[u8]) -> Vec<Vec<u8>> {
        let said = (self.program.act)(&*self.own, &*self.ranks, asked);
        self.ranks.tell_first(&said)
    }

    fn restore_on_ranks(&mut self, rest: &SavedState, asked: &[u8]) -> Result<(), NotTakenUp> {
        let (ranks, find) = (self.ranks.clone(), self.program.find);
        self.take_up(rest, &mut |show| find(&*ranks, asked, show))
    }

    fn begin_on_ranks(
        &mut self,
        from: (&SavedState, StartVelocities),
        asked: &[u8],
        look: &mut dyn FnMut(usize, &[u8]),
    ) -> Result<(), NotTakenUp> {
        let (ranks, find) = (self.ranks.clone(), self.program.find);
        let find: Find = &mut |show| find(&*ranks, asked, show);
        let look = &mut |bodies: &mut [SavedBody]| visit_found(&*ranks, bodies, look);
        self.own.begin_share((&self.scene, ranks.clone()), from, (find, look))
    }

    /// Takes up a state, of which `find` gives this rank some particles. What it has now goes before they come.
    fn take_up(&mut self, rest: &SavedState, find: Find) -> Result<(), NotTakenUp> {
        let empty = step::build_empty(&self.scene, self.path, &*self.ranks);
        self.own = empty.map_err(|problem| RestoreError::new(problem.to_string()))?;
        self.own.take_up_share((&self.scene, self.ranks.clone()), rest, find)
    }

    /// Begins with a state that is taken up as a whole before it is shared: by the first rank, which has `begin`.
    fn begin_anew(&mut self, begin: Option<Begin>) -> Result<(), RestoreError> {
        let whole = begin.map(|begin| {
            let whole = step::build_on(&self.scene, self.path);
            let mut whole = whole.map_err(|problem| RestoreError::new(problem.to_string()))?;
            begin(&mut *whole)?;
            Ok(whole)
        });
        let rest = whole.as_ref().map(|whole: &Result<Box<dyn Simulation>, RestoreError>| {
            whole.as_ref().map(|whole| whole.save_rest().expect("it is whole")).map_err(RestoreError::clone)
        });
        let said = rest.map_or_else(Vec::new, |rest| bytes_of(&rest));
        let rest = read::<Result<SavedState, RestoreError>>(&self.ranks.hear_first(&said))?;
        let (ranks, mut whole) = (self.ranks.clone(), whole.and_then(Result::ok));
        let taken = self.take_up(&rest, &mut |show| {
            deal(&*ranks, whole.take(), show);
            Ok(())
        });
        taken.map_err(|problem| match problem {
            NotTakenUp::Unfound(problem) => RestoreError::new(problem),
            NotTakenUp::Other(problem) => problem,
        })
    }
}

/// Shows a body's columns one by one with the numbers of its particles, and says whether it has a state as data.
type ColumnsOf<'a> = &'a dyn Fn(usize, &mut dyn FnMut(&[u32], SavedColumn)) -> bool;

/// Columns of the particles of bodies, of which all ranks have some.
struct SharedColumns<'a> {
    ranks: &'a dyn Ranks,
    /// How many particles each body has on all ranks.
    counts: Vec<usize>,
    /// Those of this rank, of a large body all even if it has no particles.
    columns: ColumnsOf<'a>,
}

/// Shows the first rank the bytes of the particles that all have found of bodies of another run.
pub fn visit_found(ranks: &dyn Ranks, bodies: &mut [SavedBody], look: &mut dyn FnMut(usize, &[u8])) {
    let counts: Vec<usize> = bodies.iter().map(|body| body.numbers.len()).collect();
    let counts = combined(ranks, &counts, added);
    for (body, _) in
        bodies.iter_mut().zip(&counts).filter(|(_, count)| **count + OF_A_BODY > BYTES_OF_AT_A_TIME)
    {
        let own: Vec<SavedColumn> = body.columns.iter().map(SavedColumn::emptied).collect();
        let names = combined(ranks, &own, |one, other| if one.is_empty() { other } else { one });
        if body.numbers.is_empty() {
            body.columns = names;
        }
    }
    let bodies = &*bodies;
    let columns: ColumnsOf = &|body, take| {
        let SavedBody { numbers, columns, .. } = &bodies[body];
        columns.iter().for_each(|column| take(numbers, column.clone()));
        true
    };
    SharedColumns { ranks, counts, columns }.visit_bytes(0..bodies.len(), look);
}

impl SharedColumns<'_> {
    /// As [`Simulation::visit_bytes`]: of several small bodies at a time, and of a large one by itself.
    fn visit_bytes(&self, bodies: Range<usize>, look: &mut dyn FnMut(usize, &[u8])) -> bool {
        let (mut first, mut has_state) = (bodies.start, true);
        while first < bodies.end {
            let mut sum = 0;
            let fit = (first..bodies.end).take_while(|&body| {
                sum += self.counts[body] + OF_A_BODY;
                sum <= BYTES_OF_AT_A_TIME
            });
            let several = first..first + fit.count();
            has_state &= match several.is_empty() {
                true => self.visit_bytes_of_one(first, &mut |bytes| look(first, bytes)),
                false => self.visit_bytes_of_several(several.clone(), look),
            };
            first = several.end.max(first + 1);
        }
        has_state
    }

    /// The same of bodies that find room in one place.
    fn visit_bytes_of_several(&self, bodies: Range<usize>, look: &mut dyn FnMut(usize, &[u8])) -> bool {
        let (mut has_state, mut own, mut names) = (true, Vec::new(), Vec::new());
        for body in bodies.clone() {
            let mut share = SavedShare { body, numbers: Vec::new(), columns: Vec::new() };
            has_state &= (self.columns)(body, &mut |numbers, column| {
                if share.columns.is_empty() {
                    share.numbers = numbers.to_vec();
                }
                share.columns.push(column);
            });
            names.push(share.columns.iter().map(SavedColumn::emptied).collect::<Vec<_>>());
            own.extend(Some(share).filter(|share| !share.numbers.is_empty()));
        }
        let all: Vec<Vec<SavedShare>> = told_first(self.ranks, &own);
        let mut all: Vec<_> = all.into_iter().map(|shares| shares.into_iter().peekable()).collect();
        // Only the first rank is told.
        let told = if all.is_empty() { 0..0 } else { bodies };
        for (body, names) in told.zip(names) {
            let of_body = all.iter_mut().filter_map(|shares| shares.next_if(|share| share.body == body));
            let shares: Vec<SavedShare> = of_body.collect();
            let (numbers, columns) = SavedShare::joined(shares).expect("all ranks have the same columns");
            let order = by_number(&numbers);
            for column in if numbers.is_empty() { names } else { columns } {
                look(body, column.name.as_bytes());
                column.sorted_lines(&order).for_each(|line| look(body, &line));
            }
        }
        has_state
    }

    /// The same of one body, of particles with some numbers at a time.
    fn visit_bytes_of_one(&self, body: usize, look: &mut dyn FnMut(&[u8])) -> bool {
        // Places by number, the numbers, and the ranges of these in which any rank has some.
        let mut order: Option<[Vec<u32>; 3]> = None;
        let range_of = |number: u32| number / BYTES_OF_AT_A_TIME as u32;
        (self.columns)(body, &mut |numbers, column| {
            let [order, sorted, ranges] = order.get_or_insert_with(|| {
                let mut order = by_number(numbers);
                // What was found may have a number twice.
                order.sort_by_key(|&place| numbers[place as usize]);
                let sorted: Vec<u32> = order.iter().map(|&place| numbers[place as usize]).collect();
                let mut own: Vec<u32> = sorted.iter().map(|&number| range_of(number)).collect();
                own.dedup();
                let ranges = combined(self.ranks, &own, |mut all: Vec<u32>, others| {
                    all.extend(others);
                    all.sort_unstable();
                    all.dedup();
                    all
                });
                [order, sorted, ranges]
            });
            let (width, mut lines) = (column.width, column.sorted_lines(order));
            look(column.name.as_bytes());
            // As many entries on all ranks, also where one has no particles.
            let own = column.bytes.len().checked_div(width * sorted.len()).unwrap_or_default();
            for _ in 0..combined(self.ranks, &own, usize::max) {
                let line = lines.next().unwrap_or_default();
                for range in &*ranges {
                    let first = sorted.partition_point(|&number| range_of(number) < *range);
                    let some = first..sorted.partition_point(|&number| range_of(number) <= *range);
                    let bytes = &line[some.start * width..some.end * width];
                    let own = (sorted[some].to_vec(), ByteBuf::from(bytes));
                    let all = told_first(self.ranks, &own);
                    let mut rows: Vec<(u32, &[u8])> = all
                        .iter()
                        .flat_map(|(numbers, bytes)| numbers.iter().copied().zip(bytes.chunks_exact(width)))
                        .collect();
                    rows.sort_unstable_by_key(|(number, _)| *number);
                    look(&rows.into_iter().flat_map(|(_, bytes)| bytes).copied().collect::<Vec<u8>>());
                }
            }
        })
    }
}

/// Takes up a state as a whole.
type Begin<'a> = Box<dyn FnOnce(&mut dyn Simulation) -> Result<(), RestoreError> + 'a>;

/// Deals out the particles of a whole that the first rank has, some to each at a time, whoever will own them.
fn deal(ranks: &dyn Ranks, whole: Option<Box<dyn Simulation>>, show: &mut dyn FnMut(Vec<SavedShare>)) {
    let Some(whole) = whole else {
        while read(&ranks.hear_first(&[])) {
            ranks.exchange(Vec::new()).iter().for_each(|(_, shares)| show(read(shares)));
        }
        return;
    };
    let mut dealt = Vec::new();
    let mut deal = |dealt: &mut Vec<Vec<SavedShare>>| {
        ranks.hear_first(&bytes_of(&true));
        let others = dealt.drain(1..).zip(1..).map(|(shares, rank)| (rank, bytes_of(&shares)));
        ranks.exchange(others.collect());
        show(dealt.swap_remove(0));
    };
    whole.save_shares((SHOWN_AT_A_TIME / ranks.count()).max(256), &mut |shares| {
        dealt.push(shares);
        if dealt.len() == ranks.count() {
            deal(&mut dealt);
        }
    });
    if !dealt.is_empty() {
        deal(&mut dealt);
    }
    ranks.hear_first(&bytes_of(&false));
}

impl Leader {
    /// Tells the others what all are to do.
    fn tell(&self, call: &Call) -> &Part {
        self.0.ranks.hear_first(&bytes_of(call));
        &self.0
    }

    fn tell_mut(&mut self, call: &Call) -> &mut Part {
        self.tell(call);
        &mut self.0
    }
}

impl Drop for Leader {
    /// The others follow no longer; those of a rank that panics may not hear it.
    fn drop(&mut self) {
        if !std::thread::panicking() {
            self.tell(&Call::End);
        }
    }
}

impl View for Leader {
    fn time(&self) -> f64 {
        self.0.own.time()
    }

    fn steps(&self) -> u64 {
        self.0.own.steps()
    }

    fn particles(&self) -> usize {
        self.tell(&Call::Particles).particles()
    }

    fn stable_step(&self) -> f64 {
        self.tell(&Call::StableStep).own.stable_step()
    }

    fn step_limit(&self) -> Option<StepLimit> {
        self.tell(&Call::StepLimit).own.step_limit()
    }

    fn bodies(&self) -> Vec<BodyState> {
        self.tell(&Call::Bodies).own.bodies()
    }

    fn poses(&self) -> Vec<Option<Pose>> {
        self.0.own.poses()
    }

    fn ledger(&self) -> Ledger {
        self.tell(&Call::Ledger).own.ledger()
    }

    fn relaxation(&self) -> Option<RelaxationState> {
        self.0.own.relaxation()
    }

    fn contact_sums(&self) -> Vec<ContactSum> {
        self.tell(&Call::ContactSums).contact_sums()
    }

    fn loads(&self) -> Vec<LoadState> {
        self.tell(&Call::Loads).own.loads()
    }

    fn joints(&self) -> Vec<JointState> {
        self.0.own.joints()
    }

    fn walls(&self) -> Vec<WallState> {
        self.0.own.walls()
    }

    fn patches(&self) -> Vec<ContactPatch> {
        self.tell(&Call::Patches).patches()
    }

    fn contact_points(&self) -> Vec<ContactPoint> {
        self.0.own.contact_points()
    }

    fn removed(&self) -> Vec<RemovedParticles> {
        self.0.own.removed()
    }

    fn written(&self) -> Vec<WrittenValues> {
        self.0.own.written()
    }

    fn snapshot(&self) -> ParticleSnapshot {
        self.tell(&Call::Snapshot).snapshot()
    }

    fn visit(&self, body: usize, look: &mut dyn FnMut(&ParticleView)) {
        self.tell(&Call::Visit(body)).visit(body, look);
    }

    fn fastest(&self, body: usize, against: [f64; 3]) -> Option<ParticleView> {
        self.tell(&Call::Fastest(body, against)).fastest(body, against)
    }

    fn columns(&self, body: usize) -> Vec<ColumnDescription> {
        self.0.own.columns(body)
    }

    fn column(&self, body: usize, name: &str) -> Result<ColumnRef<'_>, NoColumn> {
        let found = self.tell(&Call::Column(body, name.to_string())).column(body, name);
        let (description, numbers, values) = found?;
        let count = description.kind.components();
        Ok(ColumnRef::new(description, numbers, move |row, k| values[row * count + k]))
    }

    fn visit_column(
        &self,
        body: usize,
        name: &str,
        look: &mut dyn FnMut(u32, &[f64]),
    ) -> Result<(), NoColumn> {
        self.tell(&Call::VisitColumn(body, name.to_string())).visit_column(body, name, look)
    }

    fn trace(&self, body: usize, numbers: &[u32]) -> Vec<TracedParticle> {
        self.trace_each(&[(body, numbers.to_vec())]).swap_remove(0)
    }

    fn trace_each(&self, wanted: &[(usize, Vec<u32>)]) -> Vec<Vec<TracedParticle>> {
        self.tell(&Call::TraceEach(wanted.to_vec())).trace_each(wanted)
    }

    fn grid_snapshot(&self) -> GridSnapshot {
        self.tell(&Call::Grid).grid_snapshot()
    }

    fn timings(&self) -> Vec<(&'static str, f64)> {
        self.0.own.timings()
    }

    fn shares(&self) -> Vec<RankShare> {
        self.tell(&Call::Shares).shares()
    }

    fn ask_ranks(&self, asked: &dyn Fn() -> Vec<u8>) -> Option<Vec<Vec<u8>>> {
        let asked = asked();
        Some(self.tell(&Call::Ask(asked.clone())).ask(&asked))
    }
}

impl Simulation for Leader {
    fn step(&mut self, longest: f64) -> Result<f64, StepError> {
        self.tell_mut(&Call::Step(longest)).own.step(longest)
    }

    fn step_unseen(&mut self, longest: f64) -> Result<f64, StepError> {
        self.tell_mut(&Call::StepUnseen(longest)).own.step_unseen(longest)
    }

    fn show(&mut self) {
        self.tell_mut(&Call::Show).own.show();
    }

    fn rebuild_workspace(&mut self) {
        self.tell_mut(&Call::Rebuild).own.rebuild_workspace();
    }

    fn hold(&mut self) {
        self.tell_mut(&Call::Hold).own.hold();
    }

    fn take_back(&mut self) -> bool {
        self.tell_mut(&Call::TakeBack).own.take_back()
    }

    fn settle(&mut self) {
        self.tell_mut(&Call::Settle).own.settle();
    }

    fn write(&mut self, _: usize, _: &str, _: &[f64]) -> Result<(), WriteError> {
        Err(WriteError::Shared)
    }

    fn save_rest(&self) -> Option<SavedState> {
        self.tell(&Call::SaveRest).save_rest()
    }

    fn visit_bytes(&self, bodies: Range<usize>, look: &mut dyn FnMut(usize, &[u8])) -> bool {
        self.tell(&Call::VisitBytes(bodies.clone())).visit_bytes(bodies, look)
    }

    fn begin_from(&mut self, state: &SavedState, velocities: StartVelocities) -> Result<(), RestoreError> {
        let begin: Begin = Box::new(|whole| whole.begin_from(state, velocities));
        self.tell_mut(&Call::BeginAnew).begin_anew(Some(begin))
    }

    fn restore(&mut self, state: SavedState) -> Result<(), RestoreError> {
        let begin: Begin = Box::new(|whole| whole.restore(state));
        self.tell_mut(&Call::BeginAnew).begin_anew(Some(begin))
    }

    fn begin_on_ranks(
        &mut self,
        (rest, velocities): (&SavedState, StartVelocities),
        asked: &[u8],
        look: &mut dyn FnMut(usize, &[u8]),
    ) -> Option<Result<(), NotTakenUp>> {
        let part = self.tell_mut(&Call::BeginOnRanks(asked.to_vec(), velocities, rest.of_snapshot));
        part.ranks.hear_first(&bytes_of(rest));
        Some(part.begin_on_ranks((rest, velocities), asked, look))
    }

    fn restore_on_ranks(&mut self, rest: &SavedState, asked: &[u8]) -> Option<Result<(), NotTakenUp>> {
        let part = self.tell_mut(&Call::RestoreOnRanks(asked.to_vec()));
        part.ranks.hear_first(&bytes_of(rest));
        Some(part.restore_on_ranks(rest, asked))
    }
}
