//! Suggestions for misspelled names.

/// Maximum length of names that are compared, in bytes.
const MAX_LENGTH: usize = 64;

/// Known name nearest to `name` by edit distance, ignoring case. `None` if more than a third of the
/// characters, and more than one, differ, or if `name` is longer than 64 bytes.
pub fn closest<'n>(name: &str, known: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    closest_counted(name, known).0
}

/// [`closest`], and the number of edit distances that it computed.
fn closest_counted<'n>(name: &str, known: impl IntoIterator<Item = &'n str>) -> (Option<&'n str>, usize) {
    if name.len() > MAX_LENGTH {
        return (None, 0);
    }
    let (name, mut computed) = (name.to_lowercase(), 0);
    let counts = CharacterCounts::of(&name);
    let mut nearest: Option<(usize, &str)> = None;
    for other in known.into_iter().filter(|other| other.len() <= MAX_LENGTH) {
        let lower = other.to_lowercase();
        let best = nearest.map_or(usize::MAX, |(distance, _)| distance);
        if counts.minimum_distance(&CharacterCounts::of(&lower)) >= best {
            continue;
        }
        computed += 1;
        let distance = strsim::osa_distance(&name, &lower);
        if distance < best {
            nearest = Some((distance, other));
        }
    }
    let allowed = |other: &str| (name.chars().count().max(other.chars().count()) / 3).max(1);
    (nearest.filter(|(distance, other)| *distance <= allowed(other)).map(|(_, other)| other), computed)
}

/// Number of characters of a name in each of 64 classes, which bounds edit distances from below:
/// an edit adds at most one character to a class and removes at most one.
struct CharacterCounts([u16; 64]);

impl CharacterCounts {
    fn of(name: &str) -> Self {
        let mut counts = [0_u16; 64];
        for character in name.chars() {
            let class = character as usize % counts.len();
            counts[class] = counts[class].saturating_add(1);
        }
        Self(counts)
    }

    /// Least possible edit distance of two names.
    fn minimum_distance(&self, other: &Self) -> usize {
        let excess = |a: &Self, b: &Self| -> usize {
            a.0.iter().zip(&b.0).map(|(a, b)| usize::from(a.saturating_sub(*b))).sum()
        };
        excess(self, other).max(excess(other, self))
    }
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
    list_of_known(known)
}

/// List of the first 20 known names; `None` if there are none.
pub fn list_of_known<'n>(known: impl IntoIterator<Item = &'n str>) -> Option<String> {
    let mut known = known.into_iter().fuse();
    let shown = known.by_ref().take(20).map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    let more = known.count();
    (!shown.is_empty()).then(|| match more {
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

    #[test]
    fn lists_of_names_end_after_twenty() {
        let names: Vec<String> = (0..23).map(|i| format!("n{i}")).collect();
        let list = |count: usize| list_of_known(names.iter().take(count).map(String::as_str));
        assert_eq!(list(0), None);
        assert_eq!(list(2).as_deref(), Some("known: `n0`, `n1`"));
        assert!(list(20).unwrap().ends_with("`n19`"));
        assert!(list(23).unwrap().ends_with("`n19` and 3 more"));
    }

    /// Few edit distances are computed among many names, with the result of computing all of them.
    #[test]
    fn names_that_cannot_be_nearest_are_skipped() {
        let names: Vec<String> = (0..4000).map(|i| format!("mat{i}")).collect();
        let known = || names.iter().map(String::as_str);
        let mut total = 0;
        for i in (0..4000).step_by(80) {
            let (found, computed) = closest_counted(&format!("mta{i}"), known());
            total += computed;
            let nearest = known().min_by_key(|name| strsim::osa_distance(&format!("mta{i}"), name));
            assert_eq!(found, nearest, "mta{i}");
        }
        assert!(total < 10_000, "{total} of 200,000");
        // A character of several bytes is one edit.
        assert_eq!(closest("straße", ["strawe"]), Some("strawe"));
    }
}
