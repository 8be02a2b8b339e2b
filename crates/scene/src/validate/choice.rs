//! Values that may be written in several ways: a colour or the name of a texture, a material or its name.

use super::names::Family;
use super::rule::{Rule, Way};
use super::{MAX_WARNINGS, Plain, Walk, inline, words};
use crate::document::{Node, Value as Written};
use crate::path::Trail;
use crate::report::Finding;
use juggler_math::Rgb;

impl Walk<'_> {
    pub(super) fn choice(&mut self, node: &Node, at: &Trail<'_>, rule: &'static Rule) -> Option<Plain> {
        let way = match &node.value {
            Written::String(text) => way_of_text(text, &rule.ways),
            _ => rule.ways.iter().find(|way| fits(node, &way.rule)),
        };
        let Some(way) = way else {
            return self.mismatch(node, at, &words::allowed(self.schema, rule));
        };
        match &node.value {
            Written::Array(channels) if way.owner == Some("Color") && channels.len() != 3 => {
                let message = format!("a colour is [red, green, blue], this array has {} elements", channels.len());
                return self.report(node, at, Finding::error(message));
            }
            Written::Array(channels) if way.owner == Some("Color") => self.check_range(node, at, channels),
            Written::String(text) if way.rule.types.string => match way.owner.map(words::family) {
                Some("Input") => self.refer(Family::Texture, node, text, at),
                Some("MaterialRef") => self.refer(Family::Material, node, text, at),
                _ => {}
            },
            _ => {}
        }
        if inline::is_texture(way) { self.texture(node, at, way) } else { self.value(node, at, way.rule.get()) }
    }
}

impl Walk<'_> {
    /// Warns of a color that looks like the levels of a picture, 0 to 255.
    fn check_range(&mut self, node: &Node, at: &Trail<'_>, channels: &[Node]) {
        let key = at.last_key().unwrap_or_default();
        let Some(levels) = levels(channels).filter(|levels| levels.iter().any(|level| *level >= least_level(key)))
        else {
            return;
        };
        if self.warnings.len() < MAX_WARNINGS {
            let [r, g, b] = levels;
            let message =
                format!("[{r}, {g}, {b}] is very bright: colors are linear, from 0 to 1 for what surfaces reflect");
            let help = format!("did you mean \"#{r:02x}{g:02x}{b:02x}\"?");
            self.warnings.push(Finding::warning(message).help(help).at(at).on(node.place));
        }
    }
}

/// Three whole numbers from 0 to 255.
fn levels(channels: &[Node]) -> Option<[u8; 3]> {
    let level = |node: &Node| match &node.value {
        Written::Number(number) => number.as_u64().and_then(|level| u8::try_from(level).ok()),
        _ => None,
    };
    let [r, g, b] = channels else { return None };
    Some([level(r)?, level(g)?, level(b)?])
}

/// The least level that a color of this key is warned of: light may be far brighter than what
/// surfaces reflect.
fn least_level(key: &str) -> u8 {
    match key {
        "radiance" | "emission" | "emissive" | "scattering" | "absorption" | "eta" | "k" => u8::MAX,
        "color" | "background" | "horizon" | "zenith" | "nadir" | "top" | "bottom" => 100,
        _ => 16,
    }
}

/// Whether a value of this JSON type may stand there.
fn fits(node: &Node, rule: &Rule) -> bool {
    match &node.value {
        Written::Null => rule.types.null,
        Written::Bool(_) => rule.types.boolean,
        Written::Number(_) => rule.allows_number(),
        Written::Array(_) => rule.types.array,
        Written::Object(_) => rule.types.object || !rule.kinds.is_empty(),
        Written::String(_) | Written::Wrong => false,
    }
}

/// A text is a colour when it begins with `#`, else a name, else a kind by its name, else whatever allows texts.
fn way_of_text<'w>(text: &str, ways: &'w [Way]) -> Option<&'w Way> {
    let is_text = |way: &&Way| way.rule.types.string && !way.rule.color;
    let color = ways.iter().find(|way| way.rule.color);
    if Rgb::from_hex(text).is_some() || text.starts_with('#') && color.is_some() {
        return color.or_else(|| ways.iter().find(is_text));
    }
    ways.iter().find(is_text).or_else(|| ways.iter().find(|way| way.rule.is_family())).or(color)
}
