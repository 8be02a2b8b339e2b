//! How the worker gets worlds: they are built on its threads while the picture of before stays.

use crate::Stage;
use crate::build::{Build, Mistake};
use crate::subject::Subject;
use crate::worker::Worker;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A world that takes longer is told of.
pub const QUICK: Duration = Duration::from_millis(100);

/// A world that is being built.
#[derive(Clone, Copy)]
pub struct Building {
    /// Since when.
    pub began: Instant,
    /// What for.
    pub why: Why,
}

/// Why a world is built.
#[derive(Clone, Copy, PartialEq)]
pub enum Why {
    /// Another scene is asked for.
    Other,
    /// The files may have changed.
    Files,
    /// Something of the scene is another, or the frame.
    Parts,
}

impl Worker {
    /// Begins with a world; one that is being built is overtaken.
    pub fn build(&mut self, build: Build, why: Why) {
        let shared = Arc::clone(&self.shared);
        let number = {
            let mut desk = shared.desk();
            desk.built = None;
            desk.awaited += 1;
            desk.awaited
        };
        self.building = Some(Building { began: Instant::now(), why });
        if why == Why::Other {
            self.status.stage = Stage::Loading;
            self.publish(None);
        }
        self.pool.spawn(move || {
            // A panic here would end the program.
            let result = catch_unwind(AssertUnwindSafe(|| build.run())).unwrap_or_else(|_| {
                Err(Mistake {
                    text: "error: the scene cannot be built: the program has a fault".into(),
                    files: Vec::new(),
                })
            });
            shared.tell(|desk| {
                // One that was overtaken may end last.
                if desk.awaited == number {
                    desk.built = Some(result);
                }
            });
        });
    }

    /// Takes a world that was built.
    pub fn take_built(&mut self) {
        let Some(building) = self.building else { return };
        let built = self.shared.desk().built.take();
        let Some(built) = built else {
            if building.began.elapsed() >= QUICK && self.status.stage != Stage::Loading {
                self.status.stage = Stage::Loading;
                self.publish(None);
            }
            return;
        };
        self.building = None;
        match built {
            Ok(subject) => self.take_subject(subject, building),
            Err(mistake) => self.take_mistake(mistake, building),
        }
    }

    fn take_subject(&mut self, subject: Subject, building: Building) {
        self.status.error = None;
        if building.why != Why::Parts {
            self.broken = None;
            self.watch(&subject.files());
        }
        if building.why == Why::Other {
            (self.region, self.playing) = (None, None);
            self.pace.forget();
        }
        let before = self.subject.replace(Arc::new(subject));
        if let Some(before) = before {
            self.take_view(before.picture());
        } else {
            self.moved = true;
        }
        self.describe();
    }

    fn take_mistake(&mut self, mistake: Mistake, building: Building) {
        if building.why != Why::Parts {
            self.broken = Some(mistake.text.clone());
            let mut files = self.subject.as_ref().map_or_else(Vec::new, |subject| subject.files());
            files.extend(mistake.files);
            self.watch(&files);
        }
        (self.status.error, self.playing) = (Some(mistake.text), None);
        self.describe();
        // The film goes on, or is finished already.
        match self.status.stage {
            _ if self.subject.is_none() => self.status.stage = Stage::Finished,
            Stage::Loading => self.status.stage = Stage::Moving,
            _ => {}
        }
        self.publish(None);
    }

    fn watch(&mut self, files: &[PathBuf]) {
        if let Some(watch) = &mut self.watch {
            watch.set(files);
        }
    }
}
