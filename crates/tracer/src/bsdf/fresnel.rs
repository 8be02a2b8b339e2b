//! Reflection and refraction at a smooth border.
