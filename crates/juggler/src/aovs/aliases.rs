//! AOV names of other programs: Blender passes, Arnold AOVs, V-Ray render elements, RenderMan.

use super::Aov;
use crate::Error;

/// Names of other programs, in lower case with `_` between words, and the equivalent AOVs. The
/// rendered image itself is no AOV.
const FOREIGN: &[(&[&str], &[Aov])] = &[
    (&["beauty", "rgb", "rgba", "combined", "image", "color", "c", "ci", "vraycolor"], &[]),
    (&["cryptomatte", "crypto"], &[Aov::CryptoObject, Aov::CryptoMaterial]),
    (&["cryptoobject", "crypto_asset", "cryptoasset", "crypto_object_00"], &[Aov::CryptoObject]),
    (&["cryptomaterial", "crypto_mat"], &[Aov::CryptoMaterial]),
    (&["z", "zdepth", "z_depth", "depth_z", "zbuffer", "vrayzdepth"], &[Aov::PlanarDepth]),
    (&["distance"], &[Aov::Depth]),
    (&["n", "normals", "shading_normal", "ns", "denoising_normal", "vraynormals", "nn"], &[Aov::Normal]),
    (&["ng", "geometry_normal", "true_normal"], &[Aov::GeometricNormal]),
    (&["p", "pref", "world_position", "point", "points", "position_world"], &[Aov::Position]),
    (
        &[
            "diffuse_albedo",
            "diffcol",
            "diffuse_color",
            "diffuse_filter",
            "difffilter",
            "base_color",
            "basecolor",
            "denoising_albedo",
            "vraydiffusefilter",
        ],
        &[Aov::Albedo],
    ),
    (&["texcoord", "uvs", "st", "uv_map", "texture_coordinates"], &[Aov::Uv]),
    (&["vector", "speed"], &[Aov::Motion, Aov::MotionBack]),
    (&["motionvector", "motion_vector", "motion_vectors", "velocity", "vrayvelocity", "flow"], &[Aov::Motion]),
    (&["emit", "emissive", "self_illumination", "selfillumination", "le", "vrayselfillumination"], &[Aov::Emission]),
    (&["direct_lighting", "direct_light", "lighting", "vraylighting"], &[Aov::Direct]),
    (&["gi", "global_illumination", "indirect_lighting", "indirect_light"], &[Aov::Indirect]),
    (&["lightgroups", "light_group", "lightgroup", "light_select", "light_mix", "lightmix"], &[Aov::LightGroups]),
    (&["object", "objectid", "object_index", "indexob", "id", "idobject"], &[Aov::ObjectId]),
    (&["material", "materialid", "material_index", "indexma", "shader_id", "mtlid"], &[Aov::MaterialId]),
    (&["instance", "instanceid", "nodeid", "node_id", "shape_id"], &[Aov::InstanceId]),
    (&["opacity", "a", "coverage", "mask"], &[Aov::Alpha]),
    (
        &["sample_count", "samplecount", "samplerate", "sample_rate", "debug_sample_count", "aa_samples"],
        &[Aov::Samples],
    ),
    (&["noise", "noise_level", "variance_beauty"], &[Aov::Variance]),
];

impl Aov {
    /// Parses a comma-separated list of AOV names, including those of other programs in any case,
    /// or `all`. Names of the rendered image itself, such as `beauty`, add nothing.
    pub fn list(text: &str) -> Result<Vec<Self>, Error> {
        if text == "all" {
            return Ok(Self::ALL.to_vec());
        }
        let mut list = Vec::new();
        for name in text.split(',').map(str::trim) {
            for aov in Self::by_any_name(name)? {
                if !list.contains(&aov) {
                    list.push(aov);
                }
            }
        }
        Ok(list)
    }

    /// Returns the AOVs of one name.
    fn by_any_name(name: &str) -> Result<Vec<Self>, Error> {
        let plain = name.to_lowercase().replace([' ', '-', '.'], "_");
        if let Some(own) = Self::ALL.into_iter().find(|aov| aov.name() == plain) {
            return Ok(vec![own]);
        }
        if let Some((_, same)) = FOREIGN.iter().find(|(names, _)| names.contains(&plain.as_str())) {
            return Ok(same.to_vec());
        }
        Self::by_name(name).map(|aov| vec![aov])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_other_programs_are_understood() {
        for (list, same) in [
            ("cryptomatte", vec![Aov::CryptoObject, Aov::CryptoMaterial]),
            ("Z,N,P", vec![Aov::PlanarDepth, Aov::Normal, Aov::Position]),
            ("beauty, diffuse_albedo", vec![Aov::Albedo]),
            ("RGBA", vec![]),
            ("DiffCol,Object Index,Vector", vec![Aov::Albedo, Aov::ObjectId, Aov::Motion, Aov::MotionBack]),
            ("depth,Distance,Depth", vec![Aov::Depth]),
            ("z,zdepth,Z_Depth,Z Depth,planar-depth", vec![Aov::PlanarDepth]),
        ] {
            assert_eq!(Aov::list(list).unwrap(), same, "{list}");
        }
        assert_eq!(Aov::list("all").unwrap(), Aov::ALL);
        let message = Aov::list("depth,depht").unwrap_err().to_string();
        assert_eq!(message, "there is no AOV `depht`; did you mean `depth`?");
        assert!(Aov::list("").is_err());
    }

    #[test]
    fn each_name_means_one_aov() {
        let mut names: Vec<&str> = FOREIGN.iter().flat_map(|(names, _)| names.iter().copied()).collect();
        names.extend(Aov::ALL.iter().map(|aov| aov.name()));
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
        assert!(names.iter().all(|name| *name == name.to_lowercase() && !name.contains(['-', ' '])));
    }
}
