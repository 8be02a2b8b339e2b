//! Tests of the table: all its targets exist, and all its examples are valid.

use super::*;
use crate::schema::reference;

fn exists(target: &[&str]) -> bool {
    match target {
        [owner, name] => named(owner).into_iter().any(|rule| {
            let listed = rule.words.contains(name) || rule.kinds.iter().any(|(kind, _)| kind == name);
            listed || contents(rule).into_iter().any(|rule| has_field(rule, name))
        }),
        [family, kind, key] => named(family)
            .into_iter()
            .any(|rule| rule.kinds.iter().any(|(name, content)| name == kind && has_field(content.get(), key))),
        _ => false,
    }
}

#[test]
fn every_table_entry_names_an_existing_target_with_a_valid_example() {
    let lines = TABLE.lines().filter(|line| !line.starts_with('#') && !line.is_empty());
    assert_eq!(lines.count(), ENTRIES.len(), "every line is read");
    assert!(ENTRIES.iter().map(|entry| entry.words.len()).sum::<usize>() > 1000);
    let mut wrong = Vec::new();
    for entry in ENTRIES.iter() {
        let (_, owner) = entry.target.split_last().unwrap();
        let mut targets = entry.names().map(|name| [owner, &[name]].concat());
        assert!(targets.all(|target| exists(&target)), "nothing is called {:?}", entry.target);
        for owner in &entry.owners {
            let known = owner.split_once('.').map_or_else(
                || !named(owner).is_empty() || Rule::all().iter().any(|rule| owners(rule).contains(&(*owner).into())),
                |(family, kind)| is_kind_of(family, kind),
            );
            assert!(known, "nothing is called {owner}");
        }
        let example = entry.example.sample();
        wrong.extend((!entry.is_right(&example)).then_some(example));
    }
    assert!(wrong.is_empty(), "cannot be written: {wrong:#?}");
}

#[test]
fn each_word_occurs_once_per_place() {
    for (i, entry) in ENTRIES.iter().enumerate() {
        for other in &ENTRIES[..i] {
            let shared = entry.is_kind == other.is_kind && entry.owners.iter().any(|own| other.owners.contains(own));
            let twice = entry.plain_words.iter().find(|word| shared && other.plain_words.contains(word));
            // Pixel filters and texture filters are both called filters.
            assert!(twice.is_none() || entry.owners == ["filter"], "{twice:?} of {:?}", entry.owners);
        }
    }
}

/// The innermost owner takes precedence, and a key that the kind lacks is not suggested.
#[test]
fn foreign_words_are_suggested_by_context() {
    let light = |kind: &str| {
        let family = Rule::named("AnyLight").unwrap();
        family.kinds.iter().find(|(name, _)| *name == kind).unwrap().1.get()
    };
    let suggest_key = |word: &str, rule| suggest_key(word, rule, None);
    let suggest_kind = |word: &str, rule| suggest_kind(word, rule, None);
    let help = suggest_key("angle", light("spot")).unwrap();
    assert!(help.starts_with("`angle` is called `cutoff_degrees` here: write \"cutoff_degrees\": 30"), "{help}");
    assert!(suggest_key("angle", light("directional")).unwrap().contains("`angle_degrees`"));
    assert!(suggest_key("location", light("point")).unwrap().contains("`position`"));
    assert_eq!(suggest_key("location", light("directional")), None);
    assert_eq!(
        suggest_key("radius", light("directional")).is_some(),
        suggest_key("size", light("directional")).is_some()
    );
    let camera = Rule::named("Perspective").unwrap();
    assert!(suggest_key("FOV", camera).unwrap().starts_with("`FOV` is called `vertical_fov_degrees` here"));
    let lens = suggest_key("aperture", camera).unwrap();
    assert!(lens.starts_with("`aperture` is `lens_radius` of a `thin_lens` camera here"), "{lens}");
    let shape = Rule::named("AnyShape").unwrap();
    assert!(suggest_kind("BoxGeometry", shape).unwrap().contains("called `cuboid` here"));
    assert_eq!(kind_name("cube", shape), Some("cuboid"));
    assert_eq!(suggest_kind("teapot", shape), None);
    let material = Rule::named("AnyMaterial").unwrap();
    assert!(
        suggest_kind("glass", material)
            .unwrap()
            .contains("called `dielectric` here: write {\"dielectric\": {\"ior\": 1.5}}")
    );
}

#[test]
fn links_of_the_names_page_resolve() {
    let (page, reference) = (page(), reference());
    let anchor = |heading: &str| heading.trim().to_lowercase().replace(['`', ':'], "").replace(' ', "-");
    let headings = reference.lines().filter(|line| line.starts_with('#'));
    let anchors: Vec<String> = headings.map(|line| anchor(line.trim_start_matches('#'))).collect();
    let links: Vec<&str> = page.split("(scene-format.md#").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(links.len() > 100);
    for link in links {
        assert!(anchors.iter().any(|anchor| anchor == link), "nothing is at #{link}");
    }
}

/// Words that are valid at their place need no help and are not listed on the page.
#[test]
fn known_words_are_left_out_of_the_page() {
    let page = page();
    for entry in ENTRIES.iter().filter(|entry| entry.is_kind && entry.owners != ["filter"]) {
        let families: Vec<_> = entry.owners.iter().flat_map(|owner| named(owner)).collect();
        let listed = |word: &str| families.iter().any(|rule| rule.kinds.iter().any(|(kind, _)| *kind == word));
        for line in page.lines().filter(|line| line.contains(&format!("`{}` |", entry.example.sample()))) {
            let words = line.split('|').nth(1).unwrap_or_default();
            let known = entry.words.iter().find(|word| listed(word) && words.contains(&format!("`{word}`")));
            assert_eq!(known, None, "{line}");
        }
    }
}
