//! Libraries of materials of OBJ files: MTL ("Advanced Visualizer" manual, Wavefront Technologies
//! 1995), with the words for physically based materials that Clara.io added.

use crate::gltf::Warnings;
use juggler_math::message::{MAX_QUOTE, excerpt};
use juggler_mesh::text::{Scanner, real, without_byte_order_mark};
use std::collections::BTreeMap;

/// Maximum number of materials of a library.
pub const MAX_MATERIALS: usize = 65_536;
/// Maximum number of bytes of a name of a material or a file.
pub const MAX_NAME: usize = 1024;
/// Largest magnitude of a number.
const MAX_NUMBER: f32 = 1e6;

/// Material of a library. Properties that the library does not state are `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MtlMaterial {
    /// Name (`newmtl`), which may be empty.
    pub name: String,
    /// Line of `newmtl`, counted from 1.
    pub line: u64,
    /// Colors by their words in lower case: `ka`, `kd`, `ks`, `ke`, `tf`. Linear light.
    pub colors: BTreeMap<&'static str, [f32; 3]>,
    /// Numbers by their words in lower case: `ns`, `ni`, `d`, `tr`, `illum`, `pr`, `pm`, `ps`,
    /// `pc`, `pcr`, `aniso`, `anisor`.
    pub numbers: BTreeMap<&'static str, f32>,
    /// Textures by their words in lower case, such as `map_kd`; `map_bump` is `bump`.
    pub maps: BTreeMap<&'static str, MtlMap>,
}

/// Texture of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct MtlMap {
    /// Name of the file, as written.
    pub file: String,
    /// Line of the statement, counted from 1.
    pub line: u64,
    /// Offset of the texture coordinates (`-o`).
    pub offset: [f32; 2],
    /// Factors on the texture coordinates (`-s`).
    pub scale: [f32; 2],
    /// Base and gain (`-mm`): the value is base + gain · texture.
    pub range: [f32; 2],
    /// Whether the texture ends at its borders (`-clamp on`).
    pub is_clamped: bool,
    /// Channel (`-imfchan`): `r`, `g`, `b`, `m` (alpha), `l` (luminance) or `z`.
    pub channel: Option<char>,
    /// Strength of a bump or normal map (`-bm`).
    pub strength: f32,
}

impl Default for MtlMap {
    fn default() -> Self {
        Self {
            file: String::new(),
            line: 0,
            offset: [0.0; 2],
            scale: [1.0; 2],
            range: [0.0, 1.0],
            is_clamped: false,
            channel: None,
            strength: 1.0,
        }
    }
}

const COLORS: [&str; 5] = ["ka", "kd", "ks", "ke", "tf"];
const NUMBERS: [&str; 12] = ["ns", "ni", "d", "tr", "illum", "pr", "pm", "ps", "pc", "pcr", "aniso", "anisor"];
/// Words of textures, and the words that they are stored under.
const MAPS: [(&str, &str); 13] = [
    ("map_kd", "map_kd"),
    ("map_ks", "map_ks"),
    ("map_ke", "map_ke"),
    ("map_emissive", "map_ke"),
    ("map_d", "map_d"),
    ("map_opacity", "map_d"),
    ("map_pr", "map_pr"),
    ("map_pm", "map_pm"),
    ("map_ps", "map_ps"),
    ("bump", "bump"),
    ("map_bump", "bump"),
    ("norm", "norm"),
    ("map_norm", "norm"),
];
/// Words that are ignored without a warning, because they have no effect on the picture.
const SILENT: [&str; 2] = ["map_ka", "sharpness"];

/// Reads a library. `name` is its name in warnings.
///
/// # Errors
///
/// The library has too many materials, or a name is too long.
pub fn parse_mtl(name: &str, bytes: &[u8], warnings: &mut Warnings) -> Result<Vec<MtlMaterial>, String> {
    let mut materials = Vec::<MtlMaterial>::new();
    for (line, statement) in statements(without_byte_order_mark(bytes)) {
        let mut words = Scanner::new(statement.as_bytes());
        let word = String::from_utf8_lossy(words.word().unwrap_or_default()).to_ascii_lowercase();
        let rest = text_after(&words, &statement);
        let place = format!("{name}:{line}");
        if rest.len() > MAX_NAME * 2 {
            return Err(format!("{place}: the statement has {} bytes, the limit is {}", rest.len(), MAX_NAME * 2));
        }
        if word == "newmtl" {
            if materials.len() >= MAX_MATERIALS {
                return Err(format!("{place}: the library has more than {MAX_MATERIALS} materials, the limit"));
            }
            if rest.len() > MAX_NAME {
                return Err(format!("{place}: the name has {} bytes, the limit is {MAX_NAME}", rest.len()));
            }
            materials.push(MtlMaterial { name: rest.to_owned(), line, ..MtlMaterial::default() });
        } else if let Some(material) = materials.last_mut() {
            if let Err(text) = material.statement(&word, rest, line) {
                warnings.add(&place, text, 1);
            }
        } else {
            warnings.add(&place, "statements before the first `newmtl` are ignored", 1);
        }
    }
    Ok(materials)
}

/// Statements with their lines, counted from 1. A line that ends with `\` continues. Empty lines
/// and comments are left out.
fn statements(bytes: &[u8]) -> impl Iterator<Item = (u64, String)> {
    let mut next = Some(Scanner::new(bytes));
    std::iter::from_fn(move || {
        let mut lines = next.take()?;
        let number = lines.line();
        let mut statement = lines.rest_of_line().trim_ascii().to_vec();
        let mut has_next = lines.next_line();
        // A comment does not continue. The limit bounds the memory that a hostile text needs.
        let continues = !statement.starts_with(b"#");
        while continues && statement.ends_with(b"\\") && statement.len() < 1 << 16 {
            statement.pop();
            if !has_next {
                break;
            }
            statement.push(b' ');
            statement.extend(lines.rest_of_line().trim_ascii());
            has_next = lines.next_line();
        }
        next = has_next.then_some(lines);
        Some((number, String::from_utf8_lossy(statement.trim_ascii()).into_owned()))
    })
    .filter(|(_, statement)| !statement.is_empty() && !statement.starts_with('#'))
}

/// Text that follows the words read so far, without blanks around it.
fn text_after<'t>(words: &Scanner<'_>, text: &'t str) -> &'t str {
    text.get(words.position()..).unwrap_or_default().trim_ascii()
}

/// Next word as a finite number of bounded magnitude.
fn number(words: &mut Scanner<'_>) -> Option<f32> {
    let number = words.word().and_then(real).filter(|number| number.is_finite())?;
    Some(number.clamp(-MAX_NUMBER, MAX_NUMBER))
}

impl MtlMaterial {
    /// Reads a statement of the material.
    ///
    /// # Errors
    ///
    /// The statement is ignored, for this reason.
    fn statement(&mut self, word: &str, rest: &str, line: u64) -> Result<(), String> {
        let named = |known: &&&'static str| **known == word;
        if let Some(word) = COLORS.iter().find(named) {
            let color = color(rest).ok_or_else(|| format!("`{word}` has no color of three numbers; ignored"))?;
            self.colors.insert(word, color);
        } else if let Some(word) = NUMBERS.iter().find(named) {
            let value = rest.strip_prefix("-halo").unwrap_or(rest);
            let value = number(&mut Scanner::new(value.as_bytes()))
                .ok_or_else(|| format!("`{word}` has no number; ignored"))?;
            self.numbers.insert(word, value);
            if rest.starts_with("-halo") {
                return Err("the option `-halo` is ignored".to_owned());
            }
        } else if let Some((_, stored)) = MAPS.iter().find(|(known, _)| *known == word) {
            let (map, ignored) = MtlMap::parse(rest);
            if map.file.is_empty() {
                return Err(format!("`{word}` names no file; ignored"));
            }
            self.maps.insert(stored, MtlMap { line, ..map });
            if let Some(option) = ignored {
                return Err(format!("the option `{option}` of textures is ignored"));
            }
        } else if !SILENT.contains(&word) {
            return Err(format!("`{}` is ignored", excerpt(word, MAX_QUOTE)));
        }
        Ok(())
    }
}

/// Color of one or three numbers; one counts for all channels. `None` for spectra and CIE XYZ.
fn color(text: &str) -> Option<[f32; 3]> {
    let mut words = Scanner::new(text.as_bytes());
    let r = number(&mut words)?;
    if words.at_line_end() {
        return Some([r; 3]);
    }
    Some([r, number(&mut words)?, number(&mut words)?].map(|channel| channel.max(0.0)))
}

/// Options of textures that have no effect.
const IGNORED_OPTIONS: [&str; 7] = ["-blendu", "-blendv", "-cc", "-texres", "-boost", "-t", "-type"];

impl MtlMap {
    /// Reads options and the name of the file, which may contain blanks. Returns the last option
    /// that has no effect, too.
    fn parse(text: &str) -> (Self, Option<&'static str>) {
        let (mut map, mut ignored, mut words) = (Self::default(), None, Scanner::new(text.as_bytes()));
        loop {
            let mut after = words.clone();
            let Some(option) = after.word().filter(|word| map.option(word, &mut after).is_some()) else { break };
            ignored = IGNORED_OPTIONS.into_iter().find(|known| known.as_bytes() == option).or(ignored);
            words = after;
        }
        let mut name = text_after(&words, text);
        // Some programs write the strength behind the name.
        if let Some((before, strength)) = name.rsplit_once(" -bm ") {
            let mut words = Scanner::new(strength.as_bytes());
            if let Some(strength) = number(&mut words).filter(|_| words.at_line_end()) {
                (map.strength, name) = (strength, before.trim_ascii_end());
            }
        }
        let quoted = name.strip_prefix('"').and_then(|name| name.strip_suffix('"'));
        map.file = quoted.unwrap_or(name).to_owned();
        (map, ignored)
    }

    /// Reads the arguments of an option; `None` for a word that is no option, or if a number is
    /// missing.
    fn option(&mut self, option: &[u8], words: &mut Scanner<'_>) -> Option<()> {
        match option {
            b"-o" => numbers(words, &mut self.offset),
            b"-s" => numbers(words, &mut self.scale),
            b"-t" => numbers(words, &mut [0.0; 2]),
            b"-mm" => self.range = [number(words)?, number(words)?],
            b"-clamp" => self.is_clamped = words.word().is_some_and(|word| word.eq_ignore_ascii_case(b"on")),
            b"-imfchan" => {
                let word = String::from_utf8_lossy(words.word().unwrap_or_default());
                self.channel = word.chars().next().map(|channel| channel.to_ascii_lowercase());
            }
            b"-bm" => self.strength = number(words)?,
            b"-blendu" | b"-blendv" | b"-cc" | b"-texres" | b"-boost" | b"-type" => drop(words.word()),
            _ => return None,
        }
        Some(())
    }
}

/// Reads up to three numbers, of which the first two are kept. The name of the file, which follows,
/// may be a number too, so that the last word is never read.
fn numbers(words: &mut Scanner<'_>, kept: &mut [f32; 2]) {
    for index in 0..3 {
        let mut after = words.clone();
        let Some(value) = number(&mut after).filter(|_| !after.at_line_end()) else { break };
        if let Some(kept) = kept.get_mut(index) {
            *kept = value;
        }
        *words = after;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> (Vec<MtlMaterial>, Vec<String>) {
        let mut warnings = Warnings::default();
        let materials = parse_mtl("a.mtl", text.as_bytes(), &mut warnings).unwrap();
        (materials, warnings.list().iter().map(ToString::to_string).collect())
    }

    fn map(text: &str) -> MtlMap {
        let (materials, warnings) = parse(&format!("newmtl a\nmap_Kd {text}\n"));
        assert!(warnings.is_empty(), "{warnings:?}");
        materials[0].maps["map_kd"].clone()
    }

    #[test]
    fn every_word_is_read() {
        let text = "# a\nnewmtl  my red \t\r\nKa 1 1 1\nKd 0.5 0.25 0\nks .1\nKe 2 0 0\nTf 1 1 0.5\nNs 250\nNi 1.45\n\
            d 0.5\nTr 0.5\nillum 2\nPr .1\nPm .2\nPs .3\nPc .4\nPcr .5\naniso .6\nanisor .7\nmap_Kd a.png\n\
            map_bump b.png\nnorm c.png\nmap_Pr d.png\nmap_Pm e.png\nmap_Ps f.png\nmap_Ke g.png\nmap_d h.png\nmap_Ks i.png\n";
        let (materials, warnings) = parse(text);
        assert!(warnings.is_empty(), "{warnings:?}");
        let [material] = materials.as_slice() else { panic!("{materials:?}") };
        assert_eq!((material.name.as_str(), material.line), ("my red", 2));
        assert_eq!(material.colors["kd"], [0.5, 0.25, 0.0]);
        assert_eq!(material.colors["ks"], [0.1; 3]);
        assert_eq!((material.colors.len(), material.numbers.len(), material.maps.len()), (5, 12, 9));
        assert_eq!((material.numbers["anisor"], material.numbers["illum"]), (0.7, 2.0));
        assert_eq!((material.maps["bump"].file.as_str(), material.maps["bump"].line), ("b.png", 21));
    }

    #[test]
    fn options_precede_a_name_with_blanks() {
        let found = map("-o 0.5 -0.25 0 -s 2 3 1 -mm 0.1 0.8 -clamp on -imfchan g -bm 2 my dir\\wood 1.png");
        let expected = MtlMap {
            file: "my dir\\wood 1.png".to_owned(),
            line: 2,
            offset: [0.5, -0.25],
            scale: [2.0, 3.0],
            range: [0.1, 0.8],
            is_clamped: true,
            channel: Some('g'),
            strength: 2.0,
        };
        assert_eq!(found, expected);
        assert_eq!((map("-s 2 7").scale, map("-s 2 7").file.as_str()), ([2.0, 1.0], "7"));
        assert_eq!((map("a.png -bm 0.5").strength, map("a.png -bm 0.5").file.as_str()), (0.5, "a.png"));
        assert_eq!(map("\"a b.png\"").file, "a b.png");
        assert_eq!(map("-strange.png").file, "-strange.png");
    }

    #[test]
    fn ignored_statements_are_counted() {
        let (materials, warnings) = parse(
            "Kd 1 1 1\nnewmtl a\nfoo 1\nFOO 2\nKd spectral a.rfl\nKd x\nNs\nd -halo 0.5\nmap_Kd\nmap_Kd -boost 2 a.png\nmap_Ka b\n",
        );
        assert_eq!((materials[0].numbers["d"], materials[0].maps["map_kd"].file.as_str()), (0.5, "a.png"));
        assert_eq!(
            warnings,
            [
                "a.mtl:1: statements before the first `newmtl` are ignored",
                "a.mtl:3: `foo` is ignored (2 of them)",
                "a.mtl:5: `kd` has no color of three numbers; ignored (2 of them)",
                "a.mtl:7: `ns` has no number; ignored",
                "a.mtl:8: the option `-halo` is ignored",
                "a.mtl:9: `map_kd` names no file; ignored",
                "a.mtl:10: the option `-boost` of textures is ignored",
            ]
        );
    }

    #[test]
    fn hostile_libraries_are_refused_or_read() {
        let parse = |bytes: &[u8]| parse_mtl("a.mtl", bytes, &mut Warnings::default());
        let many = "newmtl a\n".repeat(MAX_MATERIALS + 1);
        assert!(parse(many.as_bytes()).unwrap_err().contains("more than 65536 materials"));
        let long = format!("newmtl {}", "x".repeat(MAX_NAME + 1));
        assert_eq!(parse(long.as_bytes()).unwrap_err(), "a.mtl:1: the name has 1025 bytes, the limit is 1024");
        assert!(parse(format!("newmtl a\nmap_Kd {}", "x".repeat(5000)).as_bytes()).is_err());
        let odd = "newmtl a\nKd nan 1 1\nNs inf\nKe 1e30 -5 0\nPr 1e99\nmap_Kd -s\nmap_Kd -mm 1\nmap_d -o -o -o\nd \\\n\\\n0.5";
        let material = parse(odd.as_bytes()).unwrap().remove(0);
        assert_eq!(material.colors["ke"], [1e6, 0.0, 0.0]);
        assert_eq!(material.numbers["d"], 0.5);
        assert!(!material.colors.contains_key("kd") && !material.numbers.contains_key("pr"));
        assert!(parse(&[0xff, 0, b'\\', b'\n', 0xfe, b'\r', b'\\']).unwrap().is_empty());
        assert!(parse("\\\n".repeat(100_000).as_bytes()).unwrap().is_empty());
    }
}
