//! Opens a scene, moves the camera, waits for the finished image and saves it:
//! `cargo run --release -p juggler-session --example around -- SCENE PICTURE.png`
#![allow(clippy::print_stdout, reason = "that is its purpose")]

use juggler_session::{Edit, Fly, Session, SessionOptions, Stage};
use std::time::Duration;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [scene, picture] = words.as_slice() else { return Err("usage: around SCENE PICTURE".into()) };
    let session = Session::open(scene, SessionOptions { size: Some([320, 240]), ..SessionOptions::default() });
    let revision = session.edit(Edit::Fly(Fly { yaw_degrees: 10.0, ..Fly::default() }));
    loop {
        let status = session.status();
        println!("{:?}: {} of {} samples", status.stage, status.samples, status.samples_wanted);
        if status.stage == Stage::Finished && status.revision >= revision {
            break;
        }
        session.wait(u64::MAX, status.number, Duration::from_secs(1));
    }
    Ok(session.save(picture.as_ref())?)
}
