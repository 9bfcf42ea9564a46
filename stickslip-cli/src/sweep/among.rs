//! A family of runs shared out among processes: the first gives each of them numbers of runs as it has room for them,
//! and hears what becomes of these.

use super::{Crew, Member, News, Plan, members};
use serde::{Deserialize, Serialize};
use std::num::NonZero;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender};
use std::thread::{available_parallelism, sleep};
use std::time::Duration;
use stickslip::observe::SceneSource;
use stickslip::ranks::{Ranks, all_of, bytes_of, read, told_first};
use stickslip::scene::{FileRead, Loaded, first_other};

/// Wall time between two talks of the processes.
const BETWEEN_TALKS: Duration = Duration::from_millis(20);

/// What a process needs to know of a family to have a part in it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Family {
    /// What is run.
    pub plan: Plan,
    /// Folder of the sweep, absolute.
    pub folder: PathBuf,
    /// The scene file, absolute, and its text as the first process has read it.
    pub scene: (PathBuf, String),
    /// The files that its scenes name, as the first process has read them.
    pub files: Vec<FileRead>,
    /// How many runs are to be made.
    pub runs: usize,
    /// Runs at a time and threads of each process, where the user gives them.
    pub limits: [Option<usize>; 2],
    /// Wall time between the checkpoints of a run; without one there are none.
    pub checkpoint_every: Option<Duration>,
}

impl Family {
    /// The crew of one of so many processes, of which so many are on the same processors: with as many runs at a time
    /// and as many threads as the user gives, or as there are processors for it. It writes into `folder`.
    pub fn crew(&self, folder: PathBuf, [processes, neighbours]: [usize; 2], stop: Arc<AtomicBool>) -> Crew {
        let [jobs, threads] = self.limits;
        let processors = available_parallelism().map_or(1, NonZero::get) / neighbours;
        let threads = threads.unwrap_or(processors).max(1);
        let share = self.runs.div_ceil(processes).max(1);
        let jobs = jobs.unwrap_or(threads).clamp(1, share);
        let (scene, checkpoint_every) = (self.scene.0.clone(), self.checkpoint_every);
        let (threads, columns) = ((threads / jobs).max(1), self.plan.columns.clone());
        Crew { jobs, threads, folder, scene, columns, checkpoint_every, stop }
    }
}

/// What the first process has the others do.
#[derive(Serialize, Deserialize)]
struct Orders {
    /// Numbers of runs, by rank.
    begin: Vec<Vec<usize>>,
    /// Whether runs are to end after their next step.
    stop: bool,
    /// Whether that was all.
    over: bool,
}

/// Of the first process: what is still to be given out, and to whom.
struct Desk<'a> {
    wanted: std::slice::Iter<'a, usize>,
    /// How many more runs each process has room for, by rank.
    room: Vec<usize>,
    /// Runs that have been given out and have not ended.
    out: usize,
}

impl Desk<'_> {
    fn hear(&mut self, rank: usize, news: &News) {
        if !matches!(news, News::Progress(..)) {
            self.room[rank] += 1;
            self.out -= 1;
        }
    }

    /// Gives runs to the processes with the most room.
    fn orders(&mut self, stop: bool) -> Orders {
        let mut begin = vec![Vec::new(); self.room.len()];
        if stop {
            self.wanted = [].iter();
        }
        loop {
            // Of those with as much room, the first.
            let roomiest = self.room.iter().enumerate().rev().max_by_key(|(_, room)| **room);
            let Some((rank, _)) = roomiest.filter(|(_, room)| **room > 0) else { break };
            let Some(&number) = self.wanted.next() else { break };
            begin[rank].push(number);
            self.room[rank] -= 1;
            self.out += 1;
        }
        Orders { begin, stop, over: self.out == 0 }
    }
}

/// Has the wanted runs made by all processes, of which this is the first, and tells `listen` what happens.
pub fn lead(
    ranks: &dyn Ranks,
    (crew, wanted): (&Crew, &[usize]),
    scene_of: &(dyn Fn(usize) -> Result<Arc<(Member, Loaded)>, String> + Sync),
    mut listen: impl FnMut(News),
) {
    let room = told_first(ranks, &crew.jobs);
    let mut desk = Desk { wanted: wanted.iter(), room, out: 0 };
    crew.work(scene_of, |begin, news| {
        loop {
            for (rank, said) in
                all_of::<Vec<News>>(ranks.tell_first(&said_since(news))).into_iter().enumerate()
            {
                for news in said {
                    desk.hear(rank, &news);
                    listen(news);
                }
            }
            let orders = desk.orders(crew.stop.load(Ordering::Relaxed));
            ranks.hear_first(&bytes_of(&orders));
            if follow_orders(orders, ranks.rank(), &begin) {
                break;
            }
        }
    });
}

/// Makes the runs that the first process gives this one.
#[cfg_attr(not(feature = "mpi"), expect(dead_code, reason = "only processes follow"))]
pub fn follow(ranks: &dyn Ranks, family: &Family, neighbours: usize) {
    let family_members = members(&family.plan.variations);
    let (path, text) = &family.scene;
    let crew = family.crew(family.folder.clone(), [ranks.count(), neighbours], Arc::default());
    ranks.tell_first(&bytes_of(&crew.jobs));
    let scene_of = |number: usize| {
        let member: &Member = &family_members[number];
        let (path, set) = (path.clone(), member.settings.clone());
        let source = SceneSource { path, set, until: None, text: Some(text.clone()) };
        let loaded = source.recorded().expect("it has its text");
        let loaded = loaded.map_err(|error| error.to_string())?;
        match first_other(&family.files, &loaded.files) {
            Some(problem) => Err(format!("rank {} {problem}", ranks.rank())),
            None => Ok(Arc::new((member.clone(), loaded))),
        }
    };
    crew.work(&scene_of, |begin, news| {
        loop {
            ranks.tell_first(&said_since(news));
            let orders: Orders = read(&ranks.hear_first(&[]));
            crew.stop.store(orders.stop, Ordering::Relaxed);
            if follow_orders(orders, ranks.rank(), &begin) {
                break;
            }
        }
    });
}

/// What the runs of this process have said since the last talk; of how far each has come, the last.
fn said_since(news: &Receiver<News>) -> Vec<u8> {
    sleep(BETWEEN_TALKS);
    let mut said: Vec<News> = Vec::new();
    for one in news.try_iter() {
        if let News::Progress(number, _) = one {
            said.retain(|earlier| !matches!(earlier, News::Progress(other, _) if *other == number));
        }
        said.push(one);
    }
    bytes_of(&said)
}

/// Begins what is for this process; whether that was all.
fn follow_orders(mut orders: Orders, rank: usize, begin: &Sender<usize>) -> bool {
    for number in orders.begin.swap_remove(rank) {
        begin.send(number).expect("threads take all numbers");
    }
    orders.over
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_go_where_there_is_room_until_all_have_ended() {
        let wanted = [4, 5, 6, 7];
        let mut desk = Desk { wanted: wanted.iter(), room: vec![1, 2], out: 0 };
        let first = desk.orders(false);
        assert_eq!((first.begin, first.over), (vec![vec![5], vec![4, 6]], false));
        desk.hear(1, &News::Progress(4, 0.5));
        assert_eq!(desk.orders(false).begin, [[0; 0], [0; 0]], "nobody has room");
        desk.hear(1, &News::Ended(4, Box::default()));
        assert_eq!(desk.orders(false).begin, [vec![], vec![7]]);
        desk.hear(0, &News::Ended(5, Box::default()));
        desk.hear(1, &News::Ended(6, Box::default()));
        assert!(!desk.orders(false).over);
        desk.hear(1, &News::Left(7));
        assert!(desk.orders(false).over);
    }

    #[test]
    fn who_stops_gives_out_nothing_more() {
        let mut desk = Desk { wanted: [0, 1].iter(), room: vec![1, 0], out: 0 };
        assert_eq!(desk.orders(false).begin[0], [0]);
        desk.hear(0, &News::Ended(0, Box::default()));
        let orders = desk.orders(true);
        assert!(orders.begin.iter().all(Vec::is_empty) && orders.stop && orders.over);
    }
}
