//! Keys in the JSON schema: all of them, and those that a path in a scene file means.

use serde_json::Value;
use std::collections::BTreeSet;

/// The place of every key in the schema, as a JSON pointer.
pub fn keys(schema: &Value) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    gather(schema, String::new(), &mut found);
    found
}

fn gather(value: &Value, pointer: String, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(parts) => {
            if let Some(Value::Object(keys)) = parts.get("properties") {
                found.extend(keys.keys().map(|key| format!("{pointer}/properties/{key}")));
            }
            parts.iter().for_each(|(name, part)| gather(part, format!("{pointer}/{name}"), found));
        }
        Value::Array(parts) => {
            parts.iter().enumerate().for_each(|(i, part)| gather(part, format!("{pointer}/{i}"), found));
        }
        _ => {}
    }
}

/// Where the last key of a path such as `bodies[0].shape.ball.radius` stands.
pub fn pointers(schema: &Value, path: &str) -> Vec<String> {
    let mut here = vec![String::new()];
    for word in path.split('.') {
        let (name, numbers) = word.split_at(word.find('[').unwrap_or(word.len()));
        let tables = here.iter().flat_map(|pointer| choices(schema, pointer));
        here = tables
            .filter_map(|pointer| {
                let table = schema.pointer(&pointer)?;
                match table.get("properties").and_then(|keys| keys.get(name)) {
                    Some(_) => Some(format!("{pointer}/properties/{name}")),
                    None => table
                        .get("additionalProperties")
                        .filter(|rest| rest.is_object())
                        .map(|_| format!("{pointer}/additionalProperties")),
                }
            })
            .collect();
        for _ in numbers.matches('[') {
            let lists = here.iter().flat_map(|pointer| choices(schema, pointer));
            here = lists
                .filter(|pointer| schema.pointer(pointer).is_some_and(|list| list.get("items").is_some()))
                .map(|pointer| format!("{pointer}/items"))
                .collect();
        }
    }
    here
}

/// What a schema may be: itself, what it refers to, and its alternatives.
fn choices(schema: &Value, pointer: &str) -> Vec<String> {
    let Some(value) = schema.pointer(pointer) else { return Vec::new() };
    if let Some(reference) = value.get("$ref").and_then(Value::as_str) {
        return choices(schema, reference.trim_start_matches('#'));
    }
    let of = |word: &str| {
        let count = value.get(word).and_then(Value::as_array).map_or(0, Vec::len);
        (0..count).flat_map(|i| choices(schema, &format!("{pointer}/{word}/{i}"))).collect::<Vec<_>>()
    };
    let mut all = vec![pointer.to_string()];
    all.extend(of("anyOf"));
    all.extend(of("oneOf"));
    all
}
