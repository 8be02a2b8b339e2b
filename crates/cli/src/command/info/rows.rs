//! Rows of the output, and boxes in them.

use juggler::math::Aabb;

/// Row of the output: key and value.
pub fn row(key: &str, value: &str) -> String {
    format!("{key:12} {value}")
}

/// `[0, 0, 0] to [1, 1, 1]`.
pub fn bounds_text(bounds: &Aabb) -> String {
    match corners(bounds) {
        Some([min, max]) => format!("[{}, {}, {}] to [{}, {}, {}]", min[0], min[1], min[2], max[0], max[1], max[2]),
        None => "no bounded shape".into(),
    }
}

/// Lower and upper corner of a finite box.
pub fn corners(bounds: &Aabb) -> Option<[[f32; 3]; 2]> {
    bounds.is_finite().then(|| [bounds.min.to_array(), bounds.max.to_array()])
}
