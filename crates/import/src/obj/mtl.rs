//! Libraries of materials of OBJ files: MTL ("Advanced Visualizer" manual, Wavefront Technologies
//! 1995), with the words for physically based materials that Clara.io added.

use crate::gltf::Warnings;
use juggler_math::message::{MAX_QUOTE, excerpt};
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
    let text = String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes));
    let mut materials = Vec::<MtlMaterial>::new();
    for (line, statement) in statements(&text) {
        let (word, rest) = split_word(&statement);
        let word = word.to_ascii_lowercase();
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
fn statements(text: &str) -> impl Iterator<Item = (u64, String)> {
    let mut lines = text.split('\n').flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r')).zip(1_u64..);
    std::iter::from_fn(move || {
        let (first, number) = lines.next()?;
        let mut statement = first.trim_end().to_owned();
        // A comment does not continue. The limit bounds the memory that a hostile text needs.
        let continues = !first.trim_start().starts_with('#');
        while continues && statement.ends_with('\\') && statement.len() < 1 << 16 {
            statement.pop();
            let Some((next, _)) = lines.next() else { break };
            statement.push(' ');
            statement.push_str(next.trim());
        }
        Some((number, statement.trim().to_owned()))
    })
    .filter(|(_, statement)| !statement.is_empty() && !statement.starts_with('#'))
}

/// First word of a text, and the rest without blanks around it.
fn split_word(text: &str) -> (&str, &str) {
    let text = text.trim();
    text.split_once(char::is_whitespace).map_or((text, ""), |(word, rest)| (word, rest.trim()))
}

/// Finite number of bounded magnitude at the beginning of a text, and the rest.
fn number(text: &str) -> Option<(f32, &str)> {
    let (word, rest) = split_word(text);
    let number = word.parse::<f32>().ok().filter(|number| number.is_finite())?;
    Some((number.clamp(-MAX_NUMBER, MAX_NUMBER), rest))
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
            let (value, _) = number(value).ok_or_else(|| format!("`{word}` has no number; ignored"))?;
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
    let (r, rest) = number(text)?;
    let Some((g, rest)) = number(rest) else { return rest.is_empty().then_some([r; 3]) };
    let (b, _) = number(rest)?;
    Some([r, g, b].map(|channel| channel.max(0.0)))
}

impl MtlMap {
    /// Reads options and the name of the file, which may contain blanks. Returns the last option
    /// that has no effect, too.
    fn parse(text: &str) -> (Self, Option<&str>) {
        let (mut map, mut ignored, mut text) = (Self::default(), None, text.trim());
        while text.starts_with('-') {
            let (option, rest) = split_word(text);
            let Some(after) = map.option(option, rest) else { break };
            if matches!(option, "-blendu" | "-blendv" | "-cc" | "-texres" | "-boost" | "-t" | "-type") {
                ignored = Some(option);
            }
            text = after;
        }
        // Some programs write the strength behind the name.
        if let Some((before, strength)) = text.rsplit_once(" -bm ")
            && let Some((strength, "")) = number(strength)
        {
            (map.strength, text) = (strength, before.trim_end());
        }
        let quoted = text.strip_prefix('"').and_then(|text| text.strip_suffix('"'));
        map.file = quoted.unwrap_or(text).to_owned();
        (map, ignored)
    }

    /// Reads the arguments of an option. Returns the text after them; `None` for an unknown option.
    fn option<'t>(&mut self, option: &str, rest: &'t str) -> Option<&'t str> {
        let skip = |text: &'t str| split_word(text).1;
        Some(match option {
            "-o" => numbers(rest, &mut self.offset),
            "-s" => numbers(rest, &mut self.scale),
            "-t" => numbers(rest, &mut [0.0; 2]),
            "-mm" => {
                let (base, rest) = number(rest)?;
                let (gain, rest) = number(rest)?;
                self.range = [base, gain];
                rest
            }
            "-clamp" => {
                self.is_clamped = split_word(rest).0.eq_ignore_ascii_case("on");
                skip(rest)
            }
            "-imfchan" => {
                self.channel = split_word(rest).0.chars().next().map(|channel| channel.to_ascii_lowercase());
                skip(rest)
            }
            "-bm" => {
                let (strength, rest) = number(rest)?;
                self.strength = strength;
                rest
            }
            "-blendu" | "-blendv" | "-cc" | "-texres" | "-boost" | "-type" => skip(rest),
            _ => return None,
        })
    }
}

/// Reads up to three numbers, of which the first two are kept. The name of the file, which follows,
/// may be a number too, so that the last word is never read.
fn numbers<'t>(mut text: &'t str, kept: &mut [f32; 2]) -> &'t str {
    for index in 0..3 {
        let Some((value, rest)) = number(text).filter(|(_, rest)| !rest.is_empty()) else { break };
        if let Some(kept) = kept.get_mut(index) {
            *kept = value;
        }
        text = rest;
    }
    text
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
