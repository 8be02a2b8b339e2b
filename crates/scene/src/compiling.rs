//! Compilation of a scene to a world, with all findings about it.

use crate::compile::{Assembly, Compiled, Files, Illuminance, NEVER_CANCELLED};
use crate::report::{Finding, Problems};
use crate::scene::merge_findings;
use crate::{Scene, SceneError};
use juggler_math::{BuildControl, BuildStage, Vec3};

impl Scene {
    /// Finds all errors and warnings of the scene without building the world.
    pub fn check(&self) -> Problems {
        let (_, wrong, more) = self.assembly(&NEVER_CANCELLED);
        self.report(merge_findings(merge_findings(self.schema_findings(), wrong), more))
    }

    /// Finds the problems as [`Scene::check`] does, and builds the world to find objects of which the
    /// order decides what is seen. Returns also the light with the largest unoccluded illuminance at
    /// the center of the scene.
    pub fn check_with_light(&self) -> (Problems, Option<Illuminance>) {
        let (assembly, wrong, more) = self.assembly(&NEVER_CANCELLED);
        let findings = merge_findings(merge_findings(self.schema_findings(), wrong), more);
        let illuminance = assembly.illuminance.clone();
        let order = if findings.iter().any(Finding::is_error) { Vec::new() } else { assembly.ambiguity_warnings() };
        (self.report(merge_findings(findings, order)), illuminance)
    }

    /// The points of the scene's objects that reach farthest in directions spread over the sphere, for
    /// cameras that see all objects ([`Framing`](juggler_camera::Framing)). They are the corners of a cube
    /// around the origin if nothing is bounded. Lights with a shape do not count.
    ///
    /// # Errors
    ///
    /// [`SceneError::Problems`] as [`Scene::compile`].
    pub fn extreme_points(&self) -> Result<Vec<Vec3>, SceneError> {
        let (assembly, wrong, more) = self.assembly(&NEVER_CANCELLED);
        self.warnings(wrong, more)?;
        Ok(assembly.extreme_points())
    }

    /// Builds the world.
    pub fn compile(&self) -> Result<Compiled, SceneError> {
        self.compile_with_control(&NEVER_CANCELLED)
    }

    /// [`Scene::compile`], which ends early if `control` is cancelled, and reports its progress to it.
    /// A cancelled compilation leaves nothing behind but the files that it has read.
    ///
    /// # Errors
    ///
    /// [`SceneError::Cancelled`] if `control` is cancelled; [`SceneError::Problems`] as
    /// [`Scene::compile`].
    pub fn compile_with_control(&self, control: &BuildControl) -> Result<Compiled, SceneError> {
        let (assembly, wrong, more) = self.assembly(control);
        // After cancellation the assembly is incomplete.
        control.check()?;
        let warnings = self.warnings(wrong, more)?;
        Ok(assembly.compile((*self.description.render).clone(), warnings, control)?)
    }

    /// Parts of the world, with the findings about motion and those of the compilation. Incomplete if
    /// `control` is cancelled.
    fn assembly(&self, control: &BuildControl) -> (Assembly, Vec<Finding>, Vec<Finding>) {
        control.begin(BuildStage::Preparing);
        let (tracks, wrong) = self.tracks_with_control(control);
        let (assembly, more) = match self.expanded_with_control(control) {
            None => Assembly::from_scene(&self.description, &tracks, Files { control, ..self.files() }),
            Some(expansion) => {
                let files = Files { control, ..self.files_of(&expansion) };
                let (assembly, more) = Assembly::from_scene(&expansion.description, &expansion.tracks, files);
                (assembly, merge_findings(expansion.findings.clone(), more))
            }
        };
        (assembly, wrong, more)
    }

    /// Returns the warnings, or an error if any finding is an error. `motion` are the findings
    /// about motion, `more` those of the compilation.
    pub(crate) fn warnings(&self, motion: Vec<Finding>, more: Vec<Finding>) -> Result<Problems, SceneError> {
        let findings = merge_findings(merge_findings(self.schema_findings(), motion), more);
        let is_broken = findings.iter().any(Finding::is_error);
        let problems = self.report(findings);
        if is_broken { Err(SceneError::Problems(problems)) } else { Ok(problems) }
    }
}
