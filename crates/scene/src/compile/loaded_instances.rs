//! Instances of a file or an asset.

use crate::description::Instances;
use juggler_mesh::MeshLimits;

/// Instances of a file, with warnings about what it contains.
#[derive(Debug)]
pub struct LoadedInstances {
    pub instances: Instances,
    pub warnings: Vec<String>,
}

impl LoadedInstances {
    /// Instances of the bytes of a PLY file of this name.
    pub fn parse(bytes: &[u8], limits: &MeshLimits, name: &str) -> Result<Self, String> {
        let points = juggler_mesh::parse_points(bytes, limits);
        let mut points = points.map_err(|error| format!("cannot read `{name}`: {error}"))?;
        let warnings = std::mem::take(&mut points.warnings);
        Ok(Self { instances: Instances::from_points(points), warnings })
    }

    /// Instances of an asset of this name.
    pub fn of_asset(instances: &Instances, name: &str) -> Result<Self, String> {
        if instances.file.is_some() {
            return Err(format!("the instances of the asset `{name}` must not name a `file`"));
        }
        Ok(Self { instances: instances.clone(), warnings: Vec::new() })
    }
}
