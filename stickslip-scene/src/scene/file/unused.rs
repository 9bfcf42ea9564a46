//! Parameters, materials and shapes that nothing in the file uses.

use super::named_shapes::NamedShapes;
use crate::scene::Scene;
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::source::Told;
use std::collections::HashSet;

/// Keys whose text is prose or a name: a parameter is in it only in braces.
const PROSE: [&str; 4] = ["title", "about", "name", "label"];

/// Names that are listed; beyond, how many more.
const LISTED: usize = 8;

/// What nothing uses, told once of all: what has been misspelt elsewhere, or was left over.
pub fn keys(root: &DocumentNode, (scene, shapes): (&Scene, &NamedShapes)) -> Option<Told> {
    let table = |name: &str| root.children().iter().find(|child| child.name() == name);
    let listed = |name: &str| table(name).map_or(&[][..], DocumentNode::children);
    let mut words = HashSet::new();
    words_of(root, &mut words);
    let filled: HashSet<&str> =
        scene.bodies.iter().map(|body| scene.materials[body.material].name.as_str()).collect();
    let parameters = listed("parameters").iter().filter(|node| !words.contains(node.name()));
    let materials = listed("materials").iter().filter(|node| !filled.contains(node.name()));
    let shapes = listed("shapes").iter().filter(|node| !shapes.uses(node.name()));
    let unused: Vec<String> = parameters.chain(materials).chain(shapes).map(DocumentNode::key).collect();
    let (first, others) = unused.split_first()?;
    let named: Vec<String> = others.iter().take(LISTED).map(|key| format!("`{key}`")).collect();
    let more = match others.len().saturating_sub(LISTED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let others = if named.is_empty() { String::new() } else { format!(", nor {}{more}", named.join(", ")) };
    Some((first.to_string(), format!("nothing in the scene uses it{others}")))
}

/// Every word of every text of the file.
fn words_of<'a>(node: &'a DocumentNode, words: &mut HashSet<&'a str>) {
    match &node.value {
        Value::Text(text) => {
            let parts: Vec<&str> = match PROSE.contains(&node.name()) {
                true => text.split('{').skip(1).map(|part| part.split('}').next().unwrap_or("")).collect(),
                false => vec![text],
            };
            for part in parts {
                words.extend(part.split(|letter: char| !(letter.is_alphanumeric() || letter == '_')));
            }
        }
        Value::List(children) | Value::Table(children) => {
            children.iter().for_each(|child| words_of(child, words));
        }
        Value::Number(_) | Value::Other(_) => {}
    }
}
