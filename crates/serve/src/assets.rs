//! Files of the page, embedded in the program.

/// File of the page.
pub struct Asset {
    /// Path of its URL.
    pub path: &'static str,
    /// Media type.
    pub media_type: &'static str,
    /// Content.
    pub text: &'static str,
}

macro_rules! asset {
    ($path:literal, $file:literal, $media_type:literal) => {
        Asset { path: $path, media_type: $media_type, text: include_str!(concat!("../page/", $file)) }
    };
}

/// All files of the page.
pub const ASSETS: &[Asset] = &[
    asset!("/", "index.html", "text/html; charset=utf-8"),
    asset!("/page.css", "page.css", "text/css; charset=utf-8"),
    asset!("/icon.svg", "icon.svg", "image/svg+xml"),
    asset!("/page.js", "page.js", "text/javascript; charset=utf-8"),
    asset!("/connection.js", "connection.js", "text/javascript; charset=utf-8"),
    asset!("/picture.js", "picture.js", "text/javascript; charset=utf-8"),
    asset!("/camera.js", "camera.js", "text/javascript; charset=utf-8"),
    asset!("/pointer.js", "pointer.js", "text/javascript; charset=utf-8"),
    asset!("/keys.js", "keys.js", "text/javascript; charset=utf-8"),
    asset!("/lights.js", "lights.js", "text/javascript; charset=utf-8"),
    asset!("/models.js", "models.js", "text/javascript; charset=utf-8"),
    asset!("/panel.js", "panel.js", "text/javascript; charset=utf-8"),
    asset!("/files.js", "files.js", "text/javascript; charset=utf-8"),
    asset!("/upload.js", "upload.js", "text/javascript; charset=utf-8"),
    asset!("/scenes.js", "scenes.js", "text/javascript; charset=utf-8"),
    asset!("/notices.js", "notices.js", "text/javascript; charset=utf-8"),
];
