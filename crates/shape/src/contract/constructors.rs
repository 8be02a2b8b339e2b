//! `new` sets the same fields as JSON.

use crate::attribute::{AttributeData, MeshAttribute};
use crate::*;
use juggler_math::vec3;

#[test]
fn constructors_equal_json() {
    let shapes: [(AnyShape, &str); 6] = [
        (Sphere::new(2.0).into(), r#"{"sphere": {"radius": 2}}"#),
        (Disk::new(2.0).into(), r#"{"disk": {"radius": 2}}"#),
        (Rectangle::new([2.0, 3.0]).into(), r#"{"rectangle": {"size": [2, 3]}}"#),
        (Cuboid::new([0.0; 3], vec3(1.0, 2.0, 3.0)).into(), r#"{"cuboid": {"min": [0, 0, 0], "max": [1, 2, 3]}}"#),
        (Cylinder::new(2.0, -3.0, 4.0).into(), r#"{"cylinder": {"radius": 2, "y_min": -3, "y_max": 4}}"#),
        (Tube::new(2.0).into(), r#"{"tube": {"radius": 2}}"#),
    ];
    for (built, json) in shapes {
        assert_eq!(built, serde_json::from_str(json).unwrap());
    }
    let morph = serde_json::from_str(r#"{"positions": [[1, 2, 3]], "weight": 0.5}"#).unwrap();
    assert_eq!(MorphTarget::new([vec3(1.0, 2.0, 3.0)], 0.5), morph);
    assert_eq!(
        MorphTarget::from_file("smile.ply", 0.5),
        serde_json::from_str(r#"{"file": "smile.ply", "weight": 0.5}"#).unwrap()
    );
    assert_eq!(
        MeshAttribute::new(2, AttributeData::U8(vec![3, 4])),
        serde_json::from_str(r#"{"channels": 2, "data": {"u8": [3, 4]}}"#).unwrap()
    );
}
