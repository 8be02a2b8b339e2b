//! Background builds: the worker's threads build a world while the previous image stays on display.

use crate::build::{BuildError, BuildRequest};
use crate::status::Stage;
use crate::subject::Subject;
use crate::worker_state::{BuildReason, RunningBuild, Worker};
use juggler::BuildControl;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Builds that take longer are reported as loading.
pub const LOADING_DELAY: Duration = Duration::from_millis(100);

impl Worker {
    /// Starts a build and cancels a running one, whose result is discarded.
    pub fn build(&mut self, build: BuildRequest, reason: BuildReason) {
        let shared = Arc::clone(&self.shared);
        let number = {
            let mut mailbox = shared.mailbox();
            mailbox.built = None;
            mailbox.build_number += 1;
            mailbox.build_number
        };
        let build = BuildRequest { max_memory: self.options.max_memory, ..build };
        let control = Arc::new(BuildControl::default());
        self.building = Some(RunningBuild { began: Instant::now(), reason, control: Arc::clone(&control) });
        if reason == BuildReason::OtherScene {
            self.status.stage = Stage::Loading;
            self.publish(None);
        }
        self.threads.pool.spawn(move || {
            // An uncaught panic in the pool would abort the program.
            let result = catch_unwind(AssertUnwindSafe(|| build.run_with_control(&control))).unwrap_or_else(|_| {
                Err(BuildError {
                    text: "error: cannot build the scene: this is a bug of Juggler".into(),
                    files: Vec::new(),
                })
            });
            shared.update(|mailbox| {
                // A discarded build may end after the latest one.
                if mailbox.build_number == number {
                    mailbox.built = Some(result);
                }
            });
        });
    }

    /// Adopts the result of a build that has ended.
    pub fn adopt_build(&mut self) {
        let Some(building) = &self.building else { return };
        let built = self.shared.mailbox().built.take();
        let Some(built) = built else {
            if building.began.elapsed() >= LOADING_DELAY && self.status.stage != Stage::Loading {
                self.status.stage = Stage::Loading;
                self.publish(None);
            }
            return;
        };
        let Some(building) = self.building.take() else { return };
        match built {
            Ok(subject) => self.adopt_subject(subject, building.reason),
            Err(error) => self.report_build_error(error, building.reason),
        }
    }

    fn adopt_subject(&mut self, subject: Subject, reason: BuildReason) {
        self.status.error = None;
        if reason != BuildReason::Edit {
            self.source.error = None;
            self.watch(&subject.files());
        }
        if reason == BuildReason::OtherScene {
            (self.samples.region, self.playback) = (None, None);
            self.pending.rate.forget();
        }
        let before = self.subject.replace(Arc::new(subject));
        if let Some(before) = before {
            self.adopt_view(before.picture());
        } else {
            self.pending.needs_preview = true;
        }
        self.update_status();
    }

    fn report_build_error(&mut self, error: BuildError, reason: BuildReason) {
        if reason != BuildReason::Edit {
            self.source.error = Some(error.text.clone());
            let mut files = self.subject.as_ref().map_or_else(Vec::new, |subject| subject.files());
            files.extend(error.files);
            self.watch(&files);
        }
        (self.status.error, self.playback) = (Some(error.text), None);
        self.update_status();
        // The film continues, or is finished already.
        match self.status.stage {
            _ if self.subject.is_none() => self.status.stage = Stage::Finished,
            Stage::Loading => self.status.stage = Stage::Moving,
            _ => {}
        }
        self.publish(None);
    }

    fn watch(&mut self, files: &[PathBuf]) {
        if let Some(watch) = &mut self.source.watch {
            watch.set(files);
        }
    }
}
