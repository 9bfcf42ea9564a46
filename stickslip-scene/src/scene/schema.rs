//! The JSON schema of scene files, generated from the tables that read them.

use super::file::File;
use schemars::Schema;
use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use serde_json::{Value, json};

/// The JSON schema of scene files, for editors: each key with its type, its choices and its description.
pub fn schema() -> Value {
    let settings = SchemaSettings::draft2020_12().with_transform(RecursiveTransform(as_toml));
    let mut schema = settings.into_generator().into_root_schema_for::<File>();
    schema.insert("title".to_string(), "Stickslip scene".into());
    schema.to_value()
}

/// Takes out `null`, which TOML does not have, and joins the lines of descriptions.
fn as_toml(schema: &mut Schema) {
    if let Some(Value::String(description)) = schema.get_mut("description") {
        *description = description.replace('\n', " ");
    }
    if let Some(Value::Array(types)) = schema.get_mut("type") {
        types.retain(|kind| kind != "null");
        if let [only] = &types[..] {
            let only = only.clone();
            schema.insert("type".to_string(), only);
        }
    }
    if let Some(Value::Array(choices)) = schema.get_mut("anyOf") {
        choices.retain(|choice| *choice != json!({ "type": "null" }));
        if let [Value::Object(only)] = &choices[..] {
            let only = only.clone();
            schema.remove("anyOf");
            for (key, value) in only {
                schema.insert(key, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::LAWS;

    /// Does the value satisfy the schema? Knows the keywords that [`schema`] uses, and no others.
    fn satisfies(value: &Value, schema: &Value, root: &Value) -> bool {
        let Some(rules) = schema.as_object() else {
            return schema.as_bool().expect("true, false or an object");
        };
        let each = |list: &Value| list.as_array().expect("a list of schemas").clone();
        let count = |list: &Value| each(list).iter().filter(|rule| satisfies(value, rule, root)).count();
        rules.iter().all(|(keyword, rule)| match keyword.as_str() {
            "description" | "title" | "examples" | "default" | "$schema" | "$defs" => true,
            "$ref" => {
                let path = rule.as_str().expect("a path").trim_start_matches('#');
                satisfies(value, root.pointer(path).expect("references resolve"), root)
            }
            "type" => [rule.clone()].iter().chain(rule.as_array().into_iter().flatten()).any(|kind| {
                match kind.as_str() {
                    Some("object") => value.is_object(),
                    Some("array") => value.is_array(),
                    Some("string") => value.is_string(),
                    // JSON has no infinity: it arrives as null
                    Some("number") => value.is_number() || value.is_null(),
                    Some("integer") => value.is_i64(),
                    _ => false,
                }
            }),
            "const" => value == rule,
            "pattern" => value
                .as_str()
                .is_none_or(|text| text.contains(rule.as_str().unwrap().trim_start_matches('\\'))),
            "anyOf" => count(rule) > 0,
            "oneOf" => count(rule) == 1,
            "required" => value.as_object().is_none_or(|table| {
                rule.as_array().unwrap().iter().all(|key| table.contains_key(key.as_str().unwrap()))
            }),
            "minItems" => value.as_array().is_none_or(|list| list.len() as u64 >= rule.as_u64().unwrap()),
            "maxItems" => value.as_array().is_none_or(|list| list.len() as u64 <= rule.as_u64().unwrap()),
            "minProperties" => {
                value.as_object().is_none_or(|table| table.len() as u64 >= rule.as_u64().unwrap())
            }
            "items" => {
                value.as_array().is_none_or(|list| list.iter().all(|item| satisfies(item, rule, root)))
            }
            "properties" => value.as_object().is_none_or(|table| {
                table.iter().all(|(key, item)| rule.get(key).is_none_or(|rule| satisfies(item, rule, root)))
            }),
            "additionalProperties" => value.as_object().is_none_or(|table| {
                table.iter().all(|(key, item)| {
                    rules.get("properties").is_some_and(|known| known.get(key).is_some())
                        || satisfies(item, rule, root)
                })
            }),
            other => panic!("the schema uses `{other}`"),
        })
    }

    fn is_valid(text: &str) -> bool {
        let value: toml::Value = toml::from_str(text).expect("the scene is TOML");
        let schema = schema();
        satisfies(&serde_json::to_value(value).expect("TOML is JSON but for dates"), &schema, &schema)
    }

    #[test]
    fn examples_satisfy_the_schema_and_mistakes_do_not() {
        for text in [
            include_str!("../../tests/scenes/rolling.toml"),
            include_str!("../../tests/scenes/wedge.toml"),
            include_str!("../../tests/scenes/minimal.toml"),
        ] {
            assert!(is_valid(text), "{text}");
            for (from, to) in [
                ("dimension", "dimensions"),
                ("shape.", "shap."),
                ("density", "weight"),
                ("end = ", "end = []#"),
            ] {
                assert!(text.contains(from) && !is_valid(&text.replacen(from, to, 1)), "{from} {text}");
            }
        }
    }

    #[test]
    fn every_law_and_constant_is_in_the_schema() {
        let schema = schema();
        let table = schema.pointer("/$defs/Materials/additionalProperties/properties").unwrap();
        for law in LAWS {
            let constants = &table[law.name]["properties"];
            assert!(law.constants.iter().all(|constant| constants[constant.name]["description"].is_string()));
        }
    }

    #[test]
    fn every_key_has_a_description() {
        fn check(schema: &Value) {
            if let Some(Value::Object(keys)) = schema.get("properties") {
                for (key, rule) in keys {
                    let described = rule["description"].is_string() || schema["description"].is_string();
                    assert!(described, "{key}: {rule}"); // of a shape, the choice has the description
                }
            }
            match schema {
                Value::Object(rules) => rules.values().for_each(check),
                Value::Array(rules) => rules.iter().for_each(check),
                _ => {}
            }
        }
        check(&schema());
        assert!(!schema().to_string().contains("null"));
    }
}
