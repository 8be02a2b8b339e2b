//! Several scenes of one command: a plan for each, whose files are named after the scene.

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::output::STANDARD_OUTPUT;
use crate::plan::Plan;
use crate::source;
use juggler::imaging::{AnimationFormat, ImageFormat};
use std::collections::BTreeMap;
use std::path::Path;

/// Placeholder in names of files that becomes the name of the scene.
const NAME: &str = "{}";
/// Extension of scene files.
const SCENE: &str = "json";
/// Default format of pictures.
const FORMAT: &str = "png";

/// Plans of one command.
#[derive(Debug)]
pub enum Plans {
    /// One scene.
    One(Box<Plan>),
    /// Several scenes, or those of a folder.
    Series {
        /// A plan for each scene.
        plans: Vec<Plan>,
        /// Folder of the outputs, if `--output` names one.
        folder: Option<String>,
    },
}

impl Plans {
    /// Derives the plans from the arguments.
    ///
    /// # Errors
    ///
    /// As [`Plan::new`]; also if a folder cannot be read or has no scenes, if flags name one file for
    /// several scenes, or if several scenes have the same name.
    pub fn new(mut args: RenderArgs) -> Result<Self, Failure> {
        let more = std::mem::take(&mut args.more_scenes);
        if more.is_empty() && !Path::new(&args.scene).is_dir() {
            return Ok(Self::One(Box::new(Plan::new(args)?)));
        }
        if let Some(output) = more.iter().find(|name| is_output(name)) {
            return Err(Failure::Invalid(format!("`{output}` is no scene; `-o {output}` names the output")));
        }
        let scenes: Vec<String> = std::iter::once(&args.scene)
            .chain(&more)
            .map(|name| scenes_of(name))
            .collect::<Result<Vec<_>, _>>()?
            .concat();
        let (pattern, folder) = output_pattern(&args)?;
        let plan = |scene: &String| Plan::new(args_of(&args, scene, &pattern)?);
        let plans: Vec<Plan> = scenes.iter().map(plan).collect::<Result<_, _>>()?;
        check_names(&scenes, &pattern)?;
        Ok(Self::Series { plans, folder })
    }
}

/// Whether a name is that of a picture or movie that the program writes.
fn is_output(name: &str) -> bool {
    let path = Path::new(name);
    !path.is_dir() && (ImageFormat::from_path(path).is_ok() || AnimationFormat::from_path(path).is_some())
}

/// The scene files of a folder by name; any other name is itself a scene.
fn scenes_of(name: &str) -> Result<Vec<String>, Failure> {
    let path = Path::new(name);
    if !path.is_dir() {
        return Ok(vec![name.to_owned()]);
    }
    let failed = |error| Failure::file("read", name, &error);
    let is_scene = |path: &Path| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(SCENE));
    let mut scenes = Vec::new();
    for entry in std::fs::read_dir(path).map_err(failed)? {
        let file = entry.map_err(failed)?.path();
        if is_scene(&file) && file.is_file() {
            scenes.push(file.to_string_lossy().into_owned());
        }
    }
    if scenes.is_empty() {
        return Err(Failure::Invalid(format!("`{name}` is a folder without scenes: their names end in .{SCENE}")));
    }
    scenes.sort();
    Ok(scenes)
}

/// Pattern of the outputs, and their folder if `--output` names one.
fn output_pattern(args: &RenderArgs) -> Result<(String, Option<String>), Failure> {
    let file = format!("{NAME}.{}", args.format.as_deref().unwrap_or(FORMAT));
    let Some(output) = args.output.as_deref() else { return Ok((file, None)) };
    if output == STANDARD_OUTPUT {
        return Err(Failure::Invalid("several scenes need files: standard output holds one picture".into()));
    }
    if output.contains(NAME) {
        return Ok((output.to_owned(), None));
    }
    let path = Path::new(output);
    if path.extension().is_some() && !path.is_dir() && !output.ends_with('/') {
        return Err(Failure::Invalid(format!(
            "`{output}` is one file for several scenes: give a folder (-o pictures), or a name with {NAME} for the \
             name of the scene (-o '{NAME}.png')"
        )));
    }
    Ok((path.join(file).to_string_lossy().into_owned(), Some(output.to_owned())))
}

/// Arguments of one of several scenes.
fn args_of(args: &RenderArgs, scene: &str, pattern: &str) -> Result<RenderArgs, Failure> {
    let stem = source::stem(scene);
    let named = |flag: &str, file: &Option<String>| match file {
        Some(file) if !file.contains(NAME) => Err(Failure::Invalid(format!(
            "{flag} {file} is one file for several scenes: {NAME} in its name becomes the name of the scene"
        ))),
        file => Ok(file.as_deref().map(|file| file.replace(NAME, stem))),
    };
    if args.aov_output.is_some() {
        return Err(Failure::Invalid("--aov-output is for one scene; otherwise, AOVs are beside the pictures".into()));
    }
    Ok(RenderArgs {
        scene: scene.to_owned(),
        output: Some(pattern.replace(NAME, stem)),
        stats: named("--stats", &args.stats)?,
        checkpoint: named("--checkpoint", &args.checkpoint)?,
        samples_from: named("--samples-from", &args.samples_from)?,
        ..args.clone()
    })
}

/// Checks that no two scenes have the same name, and so the same output.
fn check_names(scenes: &[String], pattern: &str) -> Result<(), Failure> {
    let mut known = BTreeMap::new();
    for scene in scenes {
        let output = pattern.replace(NAME, source::stem(scene));
        if let Some(other) = known.insert(output.clone(), scene) {
            return Err(Failure::Invalid(format!(
                "the scenes `{other}` and `{scene}` have the same output `{output}`: rename one, or render it by itself"
            )));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plans(line: &str) -> Result<Vec<Plan>, Failure> {
        match Plans::new(RenderArgs::from_words(line.split(' ')).unwrap())? {
            Plans::One(plan) => Ok(vec![*plan]),
            Plans::Series { plans, .. } => Ok(plans),
        }
    }

    fn outputs(line: &str) -> Vec<String> {
        plans(line).unwrap().into_iter().map(|plan| plan.output).collect()
    }

    fn refused(line: &str) -> String {
        match plans(line) {
            Err(Failure::Invalid(message)) => message,
            other => panic!("{line}: {other:?}"),
        }
    }

    #[test]
    fn outputs_are_named_after_the_scenes() {
        assert_eq!(outputs("a"), ["a.png"]);
        assert_eq!(outputs("x/a.json b.json chess"), ["a.png", "b.png", "chess.png"]);
        assert_eq!(outputs("a b --format exr"), ["a.exr", "b.exr"]);
        assert_eq!(outputs("a b -o pictures"), ["pictures/a.png", "pictures/b.png"]);
        assert_eq!(outputs("a b -o pictures.d/ --format jpg"), ["pictures.d/a.jpg", "pictures.d/b.jpg"]);
        assert_eq!(outputs("a b -o x/{}/{}_big.exr"), ["x/a/a_big.exr", "x/b/b_big.exr"]);
        assert_eq!(outputs("a b --frames 0..2 -o {}.gif").len(), 2);
        let plans = plans("a b -o {}.png --stats {}.json --checkpoint c/{}.jfilm").unwrap();
        let files = |plan: &Plan| plan.frame_outputs(1, 1.0).unwrap().pop().map(|out| (out.stats, out.checkpoint));
        assert_eq!(files(&plans[1]), Some((Some("b.json".into()), Some("c/b.jfilm".into()))));
    }

    #[test]
    fn files_for_several_scenes_and_equal_names_are_refused() {
        assert!(refused("a b -o c.png").contains("`c.png` is one file for several scenes"));
        assert!(refused("a b -o -").contains("several scenes need files"));
        for flag in ["--stats s.json", "--stats -", "--checkpoint c.jfilm", "--samples-from a.png"] {
            let message = refused(&format!("a b {flag}"));
            assert!(message.starts_with(&format!("{flag} is one file for several scenes")), "{message}");
        }
        assert!(refused("a b --aov depth --aov-output c.exr").contains("--aov-output is for one scene"));
        let message = refused("x/a.json b y/a.json");
        assert!(message.contains("`x/a.json` and `y/a.json` have the same output `a.png`"), "{message}");
        assert!(refused("a.json a.png").contains("`-o a.png` names the output"));
        assert!(refused("a b.mp4").contains("`-o b.mp4` names the output"));
    }

    #[test]
    fn folders_stand_for_their_scenes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().to_str().unwrap();
        assert!(refused(path).contains("without scenes"));
        for name in ["b.json", "a.JSON", "c.txt", "readme.md", "z.png"] {
            std::fs::write(folder.path().join(name), "{}").unwrap();
        }
        std::fs::create_dir(folder.path().join("inner.json")).unwrap();
        assert_eq!(outputs(path), ["a.png", "b.png"]);
        assert_eq!(outputs(&format!("{path} chess -o out")), ["out/a.png", "out/b.png", "out/chess.png"]);
        let Plans::Series { folder, .. } = Plans::new(RenderArgs::from_words([path, "-o", "out"]).unwrap()).unwrap()
        else {
            panic!("one scene")
        };
        assert_eq!(folder.as_deref(), Some("out"));
    }
}
