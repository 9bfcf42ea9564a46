//! What is built into the program: `deny.toml` at the root says which licences, sources and crates may be, and this
//! holds it against what the lock file has, for every system and without a network.

use semver::{Version, VersionReq};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

struct Crate {
    id: String,
    name: String,
    version: Version,
    license: Option<String>,
    source: Option<String>,
    /// Ids of those that it needs.
    needs: Vec<String>,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

/// The crates that are built on one system or another.
fn crates() -> Vec<Crate> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version=1", "--locked", "--all-features"])
        .current_dir(root())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let text = |value: &Value| value.as_str().map(str::to_owned);
    let list = |value: &Value| value.as_array().unwrap().clone();
    let nodes: BTreeMap<String, Vec<String>> = list(&found["resolve"]["nodes"])
        .iter()
        .map(|node| {
            let needs = list(&node["dependencies"]).iter().filter_map(text).collect();
            (text(&node["id"]).unwrap(), needs)
        })
        .collect();
    let of = |package: &Value| {
        let id = text(&package["id"]).unwrap();
        Some(Crate {
            needs: nodes.get(&id)?.clone(),
            id,
            name: text(&package["name"]).unwrap(),
            version: text(&package["version"]).unwrap().parse().unwrap(),
            license: text(&package["license"]),
            source: text(&package["source"]),
        })
    };
    list(&found["packages"]).iter().filter_map(of).collect()
}

fn policy() -> toml::Table {
    std::fs::read_to_string(root().join("deny.toml")).unwrap().parse().unwrap()
}

fn texts(value: &toml::Value) -> Vec<String> {
    value.as_array().unwrap().iter().map(|text| text.as_str().unwrap().to_owned()).collect()
}

/// Whether a crate is meant by `name`, `name@1.2.3` or `name:<1.2`.
fn is_meant(one: &Crate, spec: &str) -> bool {
    let (name, version) = match (spec.split_once('@'), spec.split_once(':')) {
        (Some((name, version)), _) => (name, format!("={version}")),
        (None, Some((name, range))) => (name, range.to_owned()),
        (None, None) => (spec, "*".to_owned()),
    };
    let range = VersionReq::parse(&version).unwrap_or_else(|error| panic!("{spec}: {error}"));
    one.name == name && range.matches(&one.version)
}

/// What of the crates the policy does not allow.
fn objections(crates: &[Crate], policy: &toml::Table) -> Vec<String> {
    let allowed = texts(&policy["licenses"]["allow"]);
    let allowed: Vec<spdx::Licensee> =
        allowed.iter().map(|one| spdx::Licensee::parse(one).unwrap()).collect();
    // One registry for all, cargo's own.
    let mut sources = crates.iter().filter_map(|one| one.source.as_deref());
    let registry = sources.find(|source| source.starts_with("registry+"));
    let bans = &policy["bans"];
    let spec = |entry: &toml::Value| entry["crate"].as_str().unwrap().to_owned();
    let skipped: Vec<String> = bans["skip"].as_array().unwrap().iter().map(spec).collect();
    let mut found = Vec::new();
    let mut names: BTreeMap<&str, BTreeSet<&Version>> = BTreeMap::new();
    for one in crates {
        let called = format!("{} {}", one.name, one.version);
        let Some(source) = &one.source else { continue };
        if Some(source.as_str()) != registry {
            found.push(format!("{called} comes from {source}"));
        }
        let license = one.license.as_deref().unwrap_or("nothing");
        let free = spdx::Expression::parse_mode(license, spdx::ParseMode::LAX).is_ok_and(|expression| {
            expression.evaluate(|needed| allowed.iter().any(|licensee| licensee.satisfies(needed)))
        });
        if !free {
            found.push(format!("{called} has the licence {license}"));
        }
        for ban in bans["deny"].as_array().unwrap().iter().filter(|ban| is_meant(one, &spec(ban))) {
            let wrappers = ban.get("wrappers").map(texts).unwrap_or_default();
            let mut users = crates.iter().filter(|user| user.needs.contains(&one.id));
            if wrappers.is_empty() || users.any(|user| !wrappers.contains(&user.name)) {
                found.push(format!("{called} is denied: {}", ban["reason"].as_str().unwrap_or_default()));
            }
        }
        if !skipped.iter().any(|spec| is_meant(one, spec)) {
            names.entry(&one.name).or_default().insert(&one.version);
        }
    }
    let twice = names.into_iter().filter(|(_, versions)| versions.len() > 1);
    found.extend(twice.map(|(name, versions)| {
        let versions: Vec<String> = versions.iter().map(ToString::to_string).collect();
        format!("{name} is there in the versions {}", versions.join(" and "))
    }));
    found
}

#[test]
fn all_dependencies_are_allowed() {
    let crates = crates();
    assert!(crates.len() > 100, "{}", crates.len());
    assert_eq!(objections(&crates, &policy()), [""; 0]);
    for skipped in policy()["bans"]["skip"].as_array().unwrap() {
        let spec = skipped["crate"].as_str().unwrap();
        assert!(crates.iter().any(|one| is_meant(one, spec)), "`{spec}` is skipped, and is not there");
    }
}

#[test]
fn what_is_not_allowed_is_told() {
    let registry = "registry+https://example.org/index";
    let one = |name: &str, version: &str, license: &str, source: &str| Crate {
        id: format!("{name}{version}"),
        name: name.into(),
        version: version.parse().unwrap(),
        license: Some(license.into()),
        source: Some(source.into()),
        needs: Vec::new(),
    };
    let user = Crate { needs: vec!["cc1.2.0".into()], ..one("user", "1.0.0", "MIT/Apache-2.0", registry) };
    for (crates, expected) in [
        (vec![one("a", "1.0.0", "GPL-3.0", registry)], "a 1.0.0 has the licence GPL-3.0"),
        (vec![one("a", "1.0.0", "MIT AND GPL-3.0", registry)], "a 1.0.0 has the licence"),
        (vec![one("a", "1.0.0", "MIT", "git+https://example.org/a")], "a 1.0.0 comes from git+"),
        (vec![one("smallvec", "1.6.0", "MIT", registry)], "smallvec 1.6.0 is denied: RUSTSEC-2021-0003"),
        (
            vec![one("a", "1.0.0", "MIT", registry), one("a", "2.0.0", "MIT", registry)],
            "versions 1.0.0 and 2.0.0",
        ),
        (vec![one("cc", "1.2.0", "MIT", registry), user], "cc 1.2.0 is denied"),
    ] {
        let found = objections(&crates, &policy());
        assert!(found.len() == 1 && found[0].contains(expected), "{expected}: {found:?}");
    }
    assert_eq!(objections(&[one("a", "1.0.0", "GPL-3.0 OR MIT", registry)], &policy()), [""; 0]);
}
