//! Suggestions for misspelled names.

/// Known name nearest to `name` by edit distance, ignoring case. `None` if more than a third of the
/// characters, and more than one, differ, or if `name` is longer than 64 bytes.
pub fn closest<'n>(name: &str, known: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    if name.len() > 64 {
        return None;
    }
    let slips = |other: &str| strsim::damerau_levenshtein(&name.to_lowercase(), &other.to_lowercase());
    let nearest = known.into_iter().filter(|k| k.len() <= 64).map(|k| (slips(k), k)).min_by_key(|(slips, _)| *slips)?;
    let allowed = (name.chars().count().max(nearest.1.chars().count()) / 3).max(1);
    (nearest.0 <= allowed).then_some(nearest.1)
}

/// Question that suggests `name`.
pub fn did_you_mean(name: &str) -> String {
    format!("did you mean `{name}`?")
}

/// Question that suggests the nearest known name, or else a list of the first 20 known names;
/// `None` if there are none.
pub fn did_you_mean_or_list<'n>(name: &str, known: impl IntoIterator<Item = &'n str> + Clone) -> Option<String> {
    if let Some(name) = closest(name, known.clone()) {
        return Some(did_you_mean(name));
    }
    let known: Vec<&str> = known.into_iter().collect();
    let shown = known.iter().take(20).map(|k| format!("`{k}`")).collect::<Vec<_>>().join(", ");
    let more = known.len().saturating_sub(20);
    (!known.is_empty()).then(|| match more {
        0 => format!("known: {shown}"),
        more => format!("known: {shown} and {more} more"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misspelled_names_get_suggestions_and_unrelated_names_get_none() {
        let known = ["radius", "center", "sphere"];
        assert_eq!(closest("raduis", known), Some("radius"));
        assert_eq!(closest("Radius", known), Some("radius"));
        assert_eq!(closest("spere", known), Some("sphere"));
        assert_eq!(closest("torus", known), None);
        assert_eq!(closest("x", ["y"]), Some("y"));
        assert_eq!(closest("radius", []), None);
    }
}
