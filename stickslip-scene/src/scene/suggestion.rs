//! The word that a misspelt word was meant to be.

/// Words of other programs and of the blackboard, and what they are here.
const ELSEWHERE: &[(&str, &str)] = &[
    ("duration", "end"),
    ("t_end", "end"),
    ("dt", "max_step"),
    ("cfl", "courant"),
    ("every", "tables"),
    ("mu", "friction"),
    ("rho", "density"),
    ("e", "young_modulus"),
    ("nu", "poisson_ratio"),
    ("elastic", "neo_hookean"),
    ("linear_elastic", "hypoelastic"),
    ("plastic", "von_mises"),
];

/// The candidate nearest to `word`, if one is near enough to be what was meant.
///
/// Near enough: its word elsewhere, the same but for upper and lower case, about a third of the letters wrong (Damerau
/// and Levenshtein), or the one the beginning of the other.
pub(super) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let plain = word.to_lowercase();
    let candidates: Vec<&str> = candidates.into_iter().collect();
    let mut here = ELSEWHERE.iter().filter(|(elsewhere, _)| *elsewhere == plain);
    if let Some(meant) = here.find_map(|(_, here)| candidates.iter().find(|known| *known == here)) {
        return Some(*meant);
    }
    let distance = |candidate: &str| {
        let candidate = candidate.to_lowercase();
        let edits = strsim::damerau_levenshtein(&plain, &candidate);
        let longer = plain.chars().count().max(candidate.chars().count());
        let beginning = plain.len().min(candidate.len()) >= 3
            && (plain.starts_with(&candidate) || candidate.starts_with(&plain));
        let slips = if longer < 3 { 0 } else { (longer + 1) / 3 };
        (edits <= slips || beginning).then_some(edits)
    };
    let near = candidates.into_iter().filter_map(|candidate| Some((distance(candidate)?, candidate)));
    let likeness = |candidate: &str| strsim::jaro_winkler(&plain, &candidate.to_lowercase());
    near.min_by(|(a_edits, a), (b_edits, b)| {
        a_edits.cmp(b_edits).then_with(|| likeness(b).total_cmp(&likeness(a)))
    })
    .map(|(_, candidate)| candidate)
}

/// `did you mean `x`?`, if a candidate is near enough.
pub(super) fn did_you_mean<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    nearest(word, candidates).map(|meant| format!("did you mean `{meant}`?"))
}

/// `"a", "b" or "c"`
pub(super) fn listed<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    let words: Vec<&str> = words.into_iter().collect();
    match words.split_last() {
        Some((last, [])) => last.to_string(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn among_equals_the_beginning_decides() {
        assert_eq!(nearest("MPs", ["Ms", "ms", "MPa"]), Some("MPa"));
    }

    #[test]
    fn slips_are_recognised_and_other_words_are_not() {
        let keys = ["radius", "center", "bulk_modulus", "3d", "plane-strain"];
        for (word, meant) in [
            ("raduis", Some("radius")),
            ("Radius", Some("radius")),
            ("bulk", Some("bulk_modulus")),
            ("plain-strane", Some("plane-strain")),
            ("centre", Some("center")),
            ("2d", None),
            ("colour", None),
        ] {
            assert_eq!(nearest(word, keys), meant, "{word}");
        }
    }

    #[test]
    fn words_of_other_programs_lead_to_those_of_scene_files() {
        let keys = ["end", "courant", "friction", "neo_hookean", "hypoelastic"];
        let of = |word| nearest(word, keys);
        assert_eq!(["duration", "mu", "CFL"].map(of), [Some("end"), Some("friction"), Some("courant")]);
        assert_eq!(["elastic", "linear_elastic"].map(of), [Some("neo_hookean"), Some("hypoelastic")]);
        assert_eq!(nearest("mu", ["density"]), None, "not where there is none of them");
    }

    #[test]
    fn words_are_listed_as_one_says_them() {
        assert_eq!(listed(["a"]), "a");
        assert_eq!(listed(["a", "b", "c"]), "a, b or c");
    }
}
