//! Schemes of the step: what a scene's keys choose, in every combination.

use std::sync::LazyLock;

/// A key of scene files by which a scheme is chosen.
#[derive(Debug, PartialEq, Eq)]
pub struct Key {
    /// The table that it stands in.
    pub table: &'static str,
    /// Its name.
    pub name: &'static str,
    /// Its words, that of scenes which name none first, and what each means.
    pub words: &'static [(&'static str, &'static str)],
}

/// What a scheme is made of. A further key, or a further word of one, is a line here.
pub static KEYS: &[Key] = &[
    Key {
        table: "space",
        name: "basis",
        words: &[
            ("gimp", "tent functions averaged over the particle's box"),
            ("linear", "tent functions at the particle's centre"),
            ("spline", "quadratic B-splines of the particle's centre"),
            ("cubic", "cubic B-splines of the particle's centre"),
        ],
    },
    Key {
        table: "time",
        name: "stress_update",
        words: &[
            ("modified-last", "stress from the particles' new velocities"),
            ("last", "stress from the velocities at the end of the step"),
            ("first", "stress from the velocities at the start of the step"),
        ],
    },
    Key {
        table: "time",
        name: "transfer",
        words: &[
            ("rflip", "particles take changes of velocity and of their rotation"),
            ("flip", "particles take changes of velocity alone"),
            ("apic", "particles take the velocity and its affine field"),
            ("xpic", "particles take the velocity itself, but for what the grid resolves"),
            ("pic", "particles take the velocity itself"),
        ],
    },
];

/// A word for each key.
#[derive(Debug, PartialEq, Eq)]
pub struct Scheme {
    /// The words, joined: `gimp-modified-last-rflip`.
    pub word: String,
    /// What they mean.
    pub meaning: String,
    /// Whether scenes get it that name no word.
    pub default: bool,
    /// The chosen words, in the order of the keys.
    chosen: Vec<&'static str>,
}

/// Every combination of the keys' words, the default first.
pub fn schemes() -> &'static [Scheme] {
    static SCHEMES: LazyLock<Vec<Scheme>> = LazyLock::new(|| combinations(KEYS));
    &SCHEMES
}

fn combinations(keys: &[Key]) -> Vec<Scheme> {
    let mut choices: Vec<Vec<(&'static str, &'static str)>> = vec![Vec::new()];
    for key in keys {
        let with =
            |begun: &Vec<_>| key.words.iter().map(|&word| [&begun[..], &[word]].concat()).collect::<Vec<_>>();
        choices = choices.iter().flat_map(with).collect();
    }
    let scheme = |(number, choice): (usize, Vec<_>)| {
        let (chosen, meanings): (Vec<_>, Vec<_>) = choice.into_iter().unzip();
        Scheme { word: chosen.join("-"), meaning: meanings.join("; "), default: number == 0, chosen }
    };
    choices.into_iter().enumerate().map(scheme).collect()
}

impl Scheme {
    /// The keys of one table, a line each: `basis = "gimp"`.
    pub fn keys(&self, table: &str) -> String {
        let chosen = KEYS.iter().zip(&self.chosen).filter(|(key, _)| key.table == table);
        chosen.map(|(key, word)| format!("{} = \"{word}\"\n", key.name)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip::scene::{Scene, parse};

    fn scene(space: &str, time: &str) -> Scene {
        let text = format!(
            "[space]
dimension = \"plane-strain\"
interior = \"grid\"
cell = 1
{space}
[time]
end = 1
{time}
[materials.rubber]
density = 1
neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }}
[[bodies]]
name = \"block\"
material = \"rubber\"
shape.box = {{ min = [0, 0], max = [1, 1] }}
"
        );
        parse("scheme", &text, &[]).expect("it is a scene").scene
    }

    #[test]
    fn scenes_take_every_scheme_and_get_the_first_if_they_name_none() {
        let seen = |scene: &Scene| {
            let (basis, time) = (scene.discretization.basis, &scene.time);
            format!("{basis:?} {time:?}")
        };
        let mut all: Vec<String> = Vec::new();
        for scheme in schemes() {
            let [space, time] = ["space", "time"].map(|table| scheme.keys(table));
            all.push(seen(&scene(&space, &time)));
        }
        assert_eq!(all[0], seen(&scene("", "")), "the default scheme");
        let count: usize = KEYS.iter().map(|key| key.words.len()).product();
        assert!(all.len() == count && (0..count).all(|i| !all[..i].contains(&all[i])), "{all:?}");
        assert_eq!(schemes().iter().filter(|scheme| scheme.default).count(), 1);
    }
}
