//! Models of a scene, with what a user can choose to see of them.

use juggler::scene::Scene;
use juggler::scene::model::NameOrIndex;

/// Maximum number of models that a panel lists.
const MAX_MODELS: usize = 8;

/// A model of the scene that has material variants or animation clips.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelStatus {
    /// JSON pointer of the model in the scene; `variant` and `animation` below it are the choices.
    pub pointer: String,
    /// Model file, as the scene names it.
    pub file: String,
    /// Names of the material variants.
    pub variants: Vec<String>,
    /// Chosen variant; `None` for the materials without a variant.
    pub variant: Option<String>,
    /// Names of the animation clips.
    pub clips: Vec<String>,
    /// Chosen clip; `None` for the rest pose.
    pub clip: Option<String>,
}

impl ModelStatus {
    /// Models of a scene.
    pub fn of_scene(scene: &Scene) -> Vec<Self> {
        let models = scene.model_summaries().into_iter().map(|found| {
            let summary = found.summary;
            let variant = found.model.variant.and_then(|variant| match variant {
                NameOrIndex::Name(name) => Some(name),
                NameOrIndex::Index(index) => summary.variants.get(index as usize).cloned(),
            });
            let clips: Vec<String> = summary.clips.into_iter().map(|clip| clip.name).collect();
            Self {
                pointer: found.path.pointer(),
                file: found.model.file,
                variant,
                clip: summary.clip.and_then(|clip| clips.get(clip).cloned()),
                variants: summary.variants,
                clips,
            }
        });
        models.filter(|model| !model.variants.is_empty() || !model.clips.is_empty()).take(MAX_MODELS).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::{BuildRequest, Edit, EditEffect, Status, Subject};
    use serde_json::{Value, json};

    const ROBOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/models/robot.glb");
    const VARIANT: &str = "/objects/0/model/variant";
    const CLIP: &str = "/objects/0/model/animation";

    fn status(subject: &Subject) -> Status {
        let mut status = Status::default();
        subject.write_status(&mut status);
        status
    }

    fn edited(mut subject: Subject, edit: &Edit) -> Subject {
        match subject.apply(edit).unwrap() {
            EditEffect::Build(build) => build.run().unwrap(),
            EditEffect::View | EditEffect::Nothing => subject,
        }
    }

    fn set(subject: Subject, path: &str, value: Value) -> Subject {
        edited(subject, &Edit::Set { path: path.to_owned(), value })
    }

    #[test]
    fn variants_and_clips_of_a_model_can_be_chosen() {
        let subject = BuildRequest::open(ROBOT, Some([16, 12])).run().unwrap();
        let first = status(&subject);
        let [robot] = first.models.as_slice() else { panic!("{:?}", first.models) };
        assert!(robot.pointer == "/objects/0/model" && robot.file.ends_with("robot.glb"), "{robot:?}");
        assert_eq!((robot.variants.clone(), &robot.variant), (vec!["Tangerine".into(), "Lagoon".into()], &None));
        assert_eq!((robot.clips.clone(), robot.clip.as_deref()), (vec!["Wave".into(), "Idle".into()], Some("Wave")));
        assert_eq!(first.frames, 60);

        let subject = set(set(subject, VARIANT, json!("Lagoon")), CLIP, json!("Idle"));
        let second = status(&subject);
        assert_eq!(
            (second.models[0].variant.as_deref(), second.models[0].clip.as_deref()),
            (Some("Lagoon"), Some("Idle"))
        );
        // The animation has the length of the clip.
        assert_eq!(second.frames, 120);
        let subject = edited(subject, &Edit::At(100.0));
        assert_eq!((status(&subject).frame, status(&subject).models), (100.0, second.models));

        let rest = status(&set(subject.clone(), CLIP, json!("none")));
        assert_eq!((rest.models[0].clip.as_deref(), rest.frames, rest.frame), (None, 0, 0.0));
        let plain = status(&set(subject, VARIANT, Value::Null));
        assert_eq!(plain.models[0].variant, None);
    }

    #[test]
    fn a_reset_keeps_the_choices_that_the_session_was_opened_with() {
        let given = vec![(VARIANT.to_owned(), json!("Lagoon"))];
        let subject = BuildRequest::open(ROBOT, Some([16, 12])).with_values(given).run().unwrap();
        let subject = set(subject, CLIP, json!("none"));
        let reset = status(&edited(subject, &Edit::Reset));
        assert_eq!(
            (reset.models[0].variant.as_deref(), reset.models[0].clip.as_deref()),
            (Some("Lagoon"), Some("Wave"))
        );
    }
}
