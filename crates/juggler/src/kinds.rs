//! Selection of integrators, samplers, tone curves and the like by name.

use crate::Error;
use juggler_math::NamedKind;
use juggler_scene::suggest::did_you_mean_or_list;

/// Returns the names of all kinds of a closed set, in its order.
pub fn names<Kind: NamedKind>() -> impl Iterator<Item = &'static str> + Clone {
    Kind::ALL.iter().map(|kind| kind.name())
}

/// Returns the kind of a name; `what` names the set in messages, and the setting in the error. The
/// error suggests similar names.
pub fn by_name<Kind: NamedKind>(what: &str, name: &str) -> Result<Kind, Error> {
    Kind::from_name(name).ok_or_else(|| unknown_name(what, name, names::<Kind>()))
}

/// Checks that a name is known; `what` is as for [`by_name`]. The error suggests similar names.
pub fn check_name<'n>(what: &str, name: &str, known: impl Iterator<Item = &'n str> + Clone) -> Result<(), Error> {
    if known.clone().any(|one| one == name) {
        return Ok(());
    }
    Err(unknown_name(what, name, known))
}

fn unknown_name<'n>(what: &str, name: &str, known: impl Iterator<Item = &'n str> + Clone) -> Error {
    let (message, help) = (format!("there is no {what} `{name}`"), did_you_mean_or_list(name, known));
    Error::Settings { setting: what.to_owned(), message, help }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_camera::sampler::{AnySampler, SamplerKind};
    use juggler_imaging::{AnyCurve, ToneCurveKind};
    use juggler_integrator::{AnyIntegrator, IntegratorKind};
    use juggler_render::Scheduler;
    use serde::de::DeserializeOwned;

    /// Checks that the scene format has these kinds and no others, by their names and with their
    /// default parameters.
    fn check_kinds<Family, Kind>()
    where
        Family: From<Kind> + DeserializeOwned + schemars::JsonSchema + PartialEq + std::fmt::Debug,
        Kind: NamedKind + for<'f> From<&'f Family> + std::fmt::Debug,
    {
        for kind in Kind::ALL.iter().copied() {
            let family = Family::from(kind);
            assert_eq!(Family::deserialize(serde_json::json!({ kind.name(): {} })).unwrap(), family);
            assert_eq!((Kind::from(&family), by_name::<Kind>("kind", kind.name()).unwrap()), (kind, kind));
        }
        let schema = schemars::schema_for!(Family);
        let listed = schema.get("oneOf").and_then(|kinds| kinds.as_array()).into_iter().flatten();
        assert!(listed.filter_map(|kind| kind.pointer("/required/0")?.as_str()).eq(names::<Kind>()));
    }

    #[test]
    fn kinds_are_those_of_the_scene_format() {
        check_kinds::<AnyIntegrator, IntegratorKind>();
        check_kinds::<AnySampler, SamplerKind>();
        check_kinds::<AnyCurve, ToneCurveKind>();
        assert!(names::<IntegratorKind>().any(|name| name == "ambient_occlusion"));
    }

    #[test]
    fn schedulers_have_different_names() {
        for scheduler in Scheduler::ALL {
            assert_eq!(Scheduler::from_name(scheduler.name()), Some(*scheduler));
        }
    }

    #[test]
    fn misspelled_kinds_get_suggestions() {
        let message = |name| by_name::<IntegratorKind>("integrator", name).unwrap_err().to_string();
        assert_eq!(message("clasic"), "there is no integrator `clasic`; did you mean `classic`?");
        assert!(message("unheard of").contains("known: "), "{}", message("unheard of"));
    }
}
