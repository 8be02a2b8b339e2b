//! Words of other programs for which scene files have no name: flags of the command line, and
//! features that are missing.

use super::{noun, plain};
use crate::validate::rule::Rule;
use std::fmt::Write;

/// Keys of the scene or of `render`, and their flags of `juggler render`.
const FLAGS: [(&str, &str); 2] =
    [("denoise, denoiser, denoising, use_denoising", "--denoise"), ("threads, num_threads", "--threads")];

/// Families, kinds that they do not have, and what they are.
const MISSING: [(&str, &str, &str); 1] = [(
    "camera",
    "panorama, panoramic, equirectangular, equirect, spherical, environment, 360, latlong, fisheye, omnidirectional",
    "panoramic cameras are not in this version",
)];

fn contains(words: &str, word: &str) -> bool {
    words.split(", ").any(|known| plain(known) == plain(word))
}

impl Rule {
    /// Flag of `juggler render` for the key `word` of the scene or of `render`.
    pub fn flag_for(&self, word: &str) -> Option<String> {
        let is_root = || Rule::root().is_some_and(|root| std::ptr::eq(root, self));
        let (_, flag) = FLAGS.iter().find(|(words, _)| contains(words, word))?;
        let is_here = self.name == Some("Render") || is_root();
        is_here.then(|| format!("`{word}` is a flag of the command line here: `juggler render {flag}`"))
    }

    /// Explains that this family does not have the kind `word`, and lists its kinds.
    pub fn missing_kind(&self, word: &str) -> Option<String> {
        let own = self.name.map(noun)?;
        let (_, _, what) = MISSING.iter().find(|(noun, words, _)| *noun == own && contains(words, word))?;
        let kinds = super::wording::list(self.kinds.iter().map(|(kind, _)| *kind), "and");
        Some(format!("{what}; kinds: {kinds}"))
    }

    /// Section of the page `docs/names.md`.
    pub fn absent_names_section() -> String {
        let mut text =
            "\n## Names that scene files do not have\n\n| name | used as | instead |\n|---|---|---|\n".to_owned();
        let code = |words: &str| format!("`{}`", words.replace(", ", "`, `"));
        for (words, flag) in FLAGS {
            let _ = writeln!(text, "| {} | key of `render` | the flag `juggler render {flag}` |", code(words));
        }
        for (noun, words, what) in MISSING {
            let _ = writeln!(text, "| {} | kind of {noun} | {what} |", code(words));
        }
        text
    }
}
