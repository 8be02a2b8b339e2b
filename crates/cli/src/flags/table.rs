//! The table of flags, and its rows.

use super::targets::Targets;

/// Heading of flags for what a picture shows and how it is sampled.
const PICTURE: &str = "Picture";
/// Heading of flags for files.
const OUTPUT: &str = "Output";
/// Heading of flags for partial renders.
const PARTIAL_RENDERS: &str = "Partial renders";
/// Heading of flags for model files.
const MODELS: &str = "Models";
/// Heading of flags for light, backdrop and camera.
const STAGE: &str = "Light and camera";
/// Heading of flags for threads and memory.
const MACHINE: &str = "Machine";
/// Heading of all other flags.
pub const OPTIONS: &str = "Options";

const NOT_LINEAR: &str = "is for PNG, JPEG and WebP pictures and for movies; {format} files store linear radiance";
const NOT_ONE_FRAME: &str = "is for pictures; this {format} movie has several frames";
const NOT_SUMS: &str = "is for pictures; a partial render stores sums of samples";
const MOVIES_ONLY: &str = "is for movies: {movies}";
const MAKES_PARTIAL_RENDER: &str =
    "makes a partial render, for `juggler merge`: give an output with the extension .jfilm";

/// All flags, by the headings of the help.
pub const FLAGS: &[Flag] = &[
    flag("output", OUTPUT).tip("-o FILE, or --output FILE, sets the output file", &["--out", "--outfile", "--output-file", "-O"]),
    flag("resume", OUTPUT).idle(&[(Targets::PicturesWithoutMetadata, "is for PNG, EXR and HDR pictures, which store how they were made; {format} files do not"), (Targets::PartialRenders, "is for pictures; `--checkpoint` resumes a partial render"), (Targets::Movies, "is for pictures; a movie always resumes with its frames")])
        .tip("--resume keeps the pictures that are done", &["--skip-existing", "--no-clobber", "--skip"]),
    flag("format", OUTPUT),
    flag("bits", OUTPUT).idle(&[(Targets::PartialRenders, NOT_SUMS), (Targets::Movies, NOT_ONE_FRAME)]),
    flag("quality", OUTPUT).idle(&[(Targets::PicturesWithoutQuality, "is for JPEG and MP4 files; {format} files have none"), (Targets::PartialRenders, "is for JPEG and MP4 files; a partial render has none"), (Targets::MoviesWithoutQuality, "is for JPEG and MP4 files; {format} has none")]),
    flag("fps", OUTPUT).idle(&[(Targets::AllButMovies, MOVIES_ONLY)]),
    flag("plays", OUTPUT).idle(&[(Targets::AllButMovies, MOVIES_ONLY), (Targets::MoviesWithoutPlays, "is for .webp, .apng and .gif; the player decides how often an {format} plays")]),
    flag("tone", OUTPUT).idle(&[(Targets::LinearPictures, NOT_LINEAR)])
        .tip("--tone CURVE sets the tone curve", &["--gamma", "--tonemap", "--tonemapper", "--tone-mapping"]),
    flag("exposure", OUTPUT).idle(&[(Targets::LinearPictures, NOT_LINEAR)])
        .tip("--exposure STOPS makes the picture brighter or darker", &["--ev", "--gain"]),
    flag("white-balance", OUTPUT).idle(&[(Targets::LinearPictures, NOT_LINEAR)]),
    flag("primaries", OUTPUT),
    flag("dither", OUTPUT).only("on").idle(&[(Targets::PicturesWithoutDither, "is for 8-bit pictures without a display look; this {format} file is never dithered"), (Targets::Movies, "is for pictures; frames of a movie are never dithered")]),
    flag("look", OUTPUT).idle(&[(Targets::PicturesWithoutLook, "is for PNG, JPEG and WebP pictures; a {format} file stores linear radiance"), (Targets::PartialRenders, NOT_SUMS)]),
    flag("transparent", OUTPUT).idle(&[(Targets::PicturesWithoutAlpha, "is for PNG, WebP and EXR pictures without a display look; this {format} file cannot be transparent"), (Targets::MoviesWithoutAlpha, "is for .webp, .apng and .gif movies; {format} cannot be transparent")])
        .tip("--transparent hides the background and writes alpha", &["--alpha", "--rgba", "--transparent-background", "--film-transparent", "--no-background", "+ua"]),
    flag("aov", OUTPUT).idle(&[(Targets::Movies, "is for pictures, also numbered ones (-o 'frame_####.exr'), not for movies")])
        .tip("--aov LIST selects the AOVs to write", &["--passes", "--layers", "--channels"]),
    flag("denoise", OUTPUT),
    flag("aov-output", OUTPUT).idle(&[(Targets::PartialRenders, "is for pictures; give it to `juggler merge` instead")]),
    flag("stats", OUTPUT),
    flag("progress", OUTPUT).tip("--progress bar shows the progress, --stats FILE writes statistics", &["-v", "--verbose"]),
    flag("quiet", OUTPUT),

    flag("size", PICTURE).tip("--size WxH sets width and height, such as --size 640x360",
        &["--width", "--height", "-W", "-H", "--resolution", "--res", "--dimensions", "--geometry"]),
    flag("samples", PICTURE)
        .tip("--samples N sets the samples per pixel", &["-s", "--spp", "--sample", "--sample-count", "--num-samples"]),
    flag("integrator", PICTURE),
    flag("max-depth", PICTURE)
        .tip("--max-depth N allows N - 1 bounces: 2 is direct light", &["--bounces", "--max-bounces", "--depth", "--path-depth"]),
    flag("camera", PICTURE).tip("--camera NAME chooses one of the scene's cameras", &["--cam"]),
    flag("frame", PICTURE).idle(&[(Targets::Movies, NOT_ONE_FRAME)]),
    flag("at", PICTURE).idle(&[(Targets::Movies, NOT_ONE_FRAME)]),
    flag("shutter", PICTURE),
    flag("seed", PICTURE),
    flag("noise", PICTURE)
        .tip("--noise LEVEL stops the render at this relative error", &["--threshold", "--noise-threshold", "--error"]),
    flag("time", PICTURE).tip("--time SECONDS stops the render after this time", &["--timeout", "--time-limit", "--seconds"]),
    flag("samples-from", PICTURE),
    flag("frames", PICTURE)
        .tip("--frames A..B renders several frames", &["--start", "--end", "-f", "-a", "--frame-range", "--animation"]),
    flag("crop", PICTURE).tip("--crop X,Y,W,H renders a rectangle of the picture", &["--region", "--window", "--cropwindow"]),

    flag("checkpoint", PARTIAL_RENDERS)
        .tip("--checkpoint FILE saves progress; the same command resumes from it", &["--continue"]),
    flag("checkpoint-every", PARTIAL_RENDERS),
    // A shard of several pictures consists of whole pictures.
    flag("shard", PARTIAL_RENDERS).idle(&[(Targets::SinglePictures, "makes a partial render, for `juggler merge`: give an output with the extension .jfilm; with --frames, it selects frames")]),
    flag("sample-range", PARTIAL_RENDERS).idle(&[(Targets::AllButPartialRenders, MAKES_PARTIAL_RENDER)]),

    flag("variant", MODELS),
    flag("animation", MODELS),
    flag("model-scene", MODELS),
    flag("lenient", MODELS),

    flag("environment", STAGE).tip("--environment FILE lights a model with a picture", &["--env", "--hdri", "--hdr", "--ibl", "--envmap", "--skybox"]),
    flag("background", STAGE).tip("--background COLOR shows a color where nothing is", &["--bg", "--backdrop", "--background-color"]),
    flag("floor", STAGE).tip("--floor stands a model on a floor, --floor shadow on one of which only shadows show", &["--ground", "--plane", "--shadow", "--shadow-catcher"]),
    flag("turntable", STAGE).tip("--turntable FRAMES turns a model once", &["--spin", "--orbit", "--turn"]),
    flag("view", STAGE),
    flag("eye", STAGE).tip("--eye X,Y,Z sets the position of the camera", &["--from", "--position", "--camera-position", "--origin"]),
    flag("look-at", STAGE).tip("--look-at X,Y,Z sets the point that the camera looks at", &["--target", "--to", "--lookat"]),
    flag("fov", STAGE).tip("--fov DEGREES sets the vertical field of view", &["--field-of-view", "--vfov", "--angle"]),
    flag("fit", STAGE).tip("--fit FRACTION sets how much of the picture the objects fill", &["--fill", "--zoom", "--margin", "--padding"]),

    flag("threads", MACHINE).tip("--threads N sets the number of threads", &["-t", "-j", "--jobs", "--nthreads", "--num-threads"]),
    flag("max-memory", MACHINE),

    flag("gain", OPTIONS),
    flag("fireflies", OPTIONS),
    flag("brightest", OPTIONS),
    flag("tree-depth", OPTIONS),
    flag("branches", OPTIONS),
    flag("tolerance", OPTIONS),
    flag("flip", OPTIONS),
    flag("significance", OPTIONS),
    flag("difference", OPTIONS),
    flag("json", OPTIONS),
    flag("unpack", OPTIONS),
    flag("force", OPTIONS).tip("--force replaces an existing scene", &["--overwrite", "-y"]),
    flag("folder", OPTIONS),
    flag("addr", OPTIONS),
    flag("allow-remote", OPTIONS),
    flag("no-token", OPTIONS),
];

/// Everything about a flag but its value and its text in the help.
#[derive(Debug)]
pub struct Flag {
    /// Long name, without dashes.
    pub name: &'static str,
    /// Heading in the help.
    pub heading: &'static str,
    /// The value with which the flag acts on certain targets only; `None` for all values.
    pub value: Option<&'static str>,
    /// Targets on which the flag cannot act, with the reasons.
    pub idle: &'static [(Targets, &'static str)],
    /// Suggestion for the names of the flag in other programs, with these names.
    pub tip: Option<(&'static str, &'static [&'static str])>,
}

const fn flag(name: &'static str, heading: &'static str) -> Flag {
    Flag { name, heading, value: None, idle: &[], tip: None }
}

impl Flag {
    const fn only(self, value: &'static str) -> Self {
        Self { value: Some(value), ..self }
    }

    const fn idle(self, idle: &'static [(Targets, &'static str)]) -> Self {
        Self { idle, ..self }
    }

    const fn tip(self, tip: &'static str, others: &'static [&'static str]) -> Self {
        Self { tip: Some((tip, others)), ..self }
    }
}
