//! Translation of a glTF file to parts of a scene.

mod materials;
