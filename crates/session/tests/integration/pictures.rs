//! The final image of a session equals the one that `juggler render` writes.
use juggler::render::{Control, Scheduler};
use juggler::scene::Scene;
use juggler::{Error, Picture, Settings};
use juggler_session::{Edit, Fly, Orbit, Session, SessionOptions, Setting, Stage, Status};
use std::sync::Arc;
use std::time::{Duration, Instant};

const SIZE: [u32; 2] = [70, 50];

fn offline(name: &str) -> String {
    let settings = Settings { size: Some(SIZE), ..Settings::default() };
    let picture = Picture::new(&Scene::built_in(name).unwrap(), &settings).unwrap();
    picture.render(Scheduler::default(), &Control::default(), |_| Ok::<(), Error>(())).unwrap().hash
}

fn options(threads: usize) -> SessionOptions {
    SessionOptions { size: Some(SIZE), threads, ..SessionOptions::default() }
}

fn finished(session: &Session, revision: u64) -> Arc<Status> {
    let end = Instant::now() + Duration::from_secs(60);
    while Instant::now() < end {
        let status = session.status();
        if status.stage == Stage::Finished && status.revision >= revision {
            return status;
        }
        session.wait(u64::MAX, status.number, Duration::from_millis(200));
    }
    panic!("never finished: {:?}", session.status());
}

#[test]
fn the_hash_is_that_of_an_offline_render() {
    for (name, threads) in [("first-render", 1), ("juggler", 2), ("depth-of-field", 2), ("scalablitz-pool", 1)] {
        let session = Session::open(name, options(threads));
        let status = finished(&session, 0);
        assert_eq!((status.hash.clone(), status.error.clone()), (Some(offline(name)), None), "{name}");
        assert_eq!(status.samples, status.samples_wanted as f32);
        let frame = session.frame().unwrap();
        assert_eq!([frame.width, frame.height], SIZE);
    }
}

#[test]
fn random_edits_that_are_undone_restore_the_hash() {
    let session = Session::open("juggler", options(2));
    finished(&session, 0);
    for i in 0..40 {
        session.edit(Edit::Fly(Fly { yaw_degrees: 3.0, forward: 0.5, ..Fly::default() }));
        session.edit(Edit::Orbit(Orbit { yaw_degrees: 20.0, pitch_degrees: 9.0, closer: 1.01 }));
        session.edit(Edit::Setting(Setting::Exposure(0.1 * i as f32)));
        std::thread::sleep(Duration::from_millis(i));
    }
    session.edit(Edit::Setting(Setting::Samples(3)));
    let revision = session.edit(Edit::Reset);
    let status = finished(&session, revision);
    assert_eq!(status.hash, Some(offline("juggler")));
}
