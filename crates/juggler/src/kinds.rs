//! Selection of integrators, samplers, tone curves and the like by name, with default parameters.

use crate::Error;
use juggler_scene::suggest::did_you_mean_or_list;
use schemars::JsonSchema;
use serde::de::DeserializeOwned;

/// Returns the names of a family's types, as the schema of the scene format lists them.
pub fn names<Family: JsonSchema>() -> Vec<String> {
    let schema = schemars::schema_for!(Family);
    let kinds = schema.get("oneOf").and_then(|kinds| kinds.as_array()).into_iter().flatten();
    kinds.filter_map(|kind| kind.pointer("/required/0")?.as_str().map(str::to_owned)).collect()
}

/// Creates a type of a family by name; `what` names the family in messages.
pub fn by_name<Family: JsonSchema + DeserializeOwned>(what: &str, name: &str) -> Result<Family, Error> {
    check_name(what, name, names::<Family>().iter().map(String::as_str))?;
    let kind = serde_json::json!({ name: {} });
    Family::deserialize(&kind).map_err(|error| Error::Settings(format!("{what} `{name}`: {error}")))
}

/// Checks that a name is known. The error suggests similar names.
pub fn check_name<'n>(what: &str, name: &str, known: impl Iterator<Item = &'n str> + Clone) -> Result<(), Error> {
    if known.clone().any(|one| one == name) {
        return Ok(());
    }
    let help = did_you_mean_or_list(name, known).map(|help| format!("; {help}")).unwrap_or_default();
    Err(Error::Settings(format!("there is no {what} `{name}`{help}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_imaging::AnyCurve;
    use juggler_integrator::AnyIntegrator;

    #[test]
    fn every_listed_name_gives_its_kind() {
        let integrators = names::<AnyIntegrator>();
        assert!(integrators.contains(&"classic".to_owned()) && integrators.contains(&"ambient_occlusion".to_owned()));
        for name in integrators {
            assert_eq!(by_name::<AnyIntegrator>("integrator", &name).unwrap().name(), name);
        }
        for name in names::<AnyCurve>() {
            by_name::<AnyCurve>("tone curve", &name).unwrap();
        }
    }

    #[test]
    fn misspelled_kinds_get_suggestions() {
        let message = |name| by_name::<AnyIntegrator>("integrator", name).unwrap_err().to_string();
        assert_eq!(message("clasic"), "there is no integrator `clasic`; did you mean `classic`?");
        assert!(message("unheard of").contains("known: "), "{}", message("unheard of"));
    }
}
