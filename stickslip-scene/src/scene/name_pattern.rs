//! Names of bodies that stand for many: `*` is any letters.

use super::Scene;
use std::collections::HashMap;
use wildmatch::WildMatchPattern;

/// Whether a name stands for what matches it: `grain*`.
pub fn is_pattern(name: &str) -> bool {
    name.contains('*')
}

/// Names that are the one which is wanted, or match it.
#[derive(Clone, Debug)]
pub struct NamePattern<'a> {
    wanted: &'a str,
    /// Each `*` is any letters, or none; of the two signs that the library knows, the other is one that no name has.
    pattern: Option<WildMatchPattern<'*', '\0'>>,
}

impl<'a> NamePattern<'a> {
    /// Of a name or a pattern.
    pub fn new(wanted: &'a str) -> Self {
        NamePattern { wanted, pattern: is_pattern(wanted).then(|| WildMatchPattern::new(wanted)) }
    }

    /// Whether it stands for a name.
    pub fn matches(&self, name: &str) -> bool {
        self.wanted == name || self.pattern.as_ref().is_some_and(|pattern| pattern.matches(name))
    }
}

/// Which bodies the names in contact rules mean. Space and time follow the rules and the bodies, never their pairs.
#[derive(Clone, Debug, Default)]
pub struct RuleNames {
    /// Bodies that no rule tells from each other: the numbers of the names that mean them, ascending.
    classes: Vec<Vec<usize>>,
    /// Of each name, the classes that it means, ascending.
    meant: Vec<Vec<usize>>,
    /// Of each body, its class.
    class: Vec<usize>,
    /// The two names of each rule.
    sides: Vec<[usize; 2]>,
    /// The first rule that has two names.
    first: HashMap<[usize; 2], usize>,
}

/// The name that means every body.
const ANY: usize = 0;

impl RuleNames {
    /// Of a scene.
    pub fn new(scene: &Scene) -> Self {
        let mut numbers: HashMap<&str, usize> = HashMap::new();
        let (mut sides, mut first) = (Vec::new(), HashMap::new());
        for (index, rule) in scene.contact.iter().enumerate() {
            let [a, b] = rule.between.each_ref().map(|name| {
                let next = numbers.len() + 1;
                name.as_ref().map_or(ANY, |name| *numbers.entry(name).or_insert(next))
            });
            sides.push([a, b]);
            first.entry([a, b]).or_insert(index);
            first.entry([b, a]).or_insert(index);
        }
        let patterns = numbers.iter().filter(|(name, _)| is_pattern(name));
        let patterns: Vec<_> = patterns.map(|(name, number)| (NamePattern::new(name), number)).collect();
        let mut places: HashMap<Vec<usize>, usize> = HashMap::new();
        let class = scene.bodies.iter().map(|body| {
            let own = [&body.name, &scene.materials[body.material].name];
            let mut names = vec![ANY];
            names.extend(own.iter().filter_map(|name| numbers.get(name.as_str())));
            let meant = patterns.iter().filter(|(pattern, _)| own.iter().any(|name| pattern.matches(name)));
            names.extend(meant.map(|(_, number)| *number));
            names.sort_unstable();
            names.dedup();
            let next = places.len();
            *places.entry(names).or_insert(next)
        });
        let class = class.collect();
        let mut classes = vec![Vec::new(); places.len()];
        places.into_iter().for_each(|(names, place)| classes[place] = names);
        let mut meant = vec![Vec::new(); numbers.len() + 1];
        for (class, names) in classes.iter().enumerate() {
            names.iter().for_each(|&name| meant[name].push(class));
        }
        RuleNames { classes, meant, class, sides, first }
    }

    /// Of bodies between all of which the first rule holds.
    pub fn alike(bodies: usize) -> Self {
        let first = HashMap::from([([ANY; 2], 0)]);
        let (classes, meant) = (vec![vec![ANY]], vec![vec![0]]);
        RuleNames { classes, meant, class: vec![0; bodies], sides: vec![[ANY; 2]], first }
    }

    /// Number of classes of bodies that no rule tells from each other.
    pub fn classes(&self) -> usize {
        self.classes.len()
    }

    /// The class of a body.
    pub fn class(&self, body: usize) -> usize {
        self.class[body]
    }

    /// The classes that the first and the second name of a rule mean.
    pub fn sides(&self, rule: usize) -> [impl Iterator<Item = usize> + Clone; 2] {
        self.sides[rule].map(|name| self.meant[name].iter().copied())
    }

    /// The first rule between bodies of two classes; `None` where no rule matches.
    pub fn rule(&self, a: usize, b: usize) -> Option<usize> {
        let [a, b] = [a, b].map(|class| &self.classes[class]);
        let pairs = a.iter().flat_map(|&x| b.iter().map(move |&y| [x, y]));
        pairs.filter_map(|pair| self.first.get(&pair)).min().copied()
    }
}
