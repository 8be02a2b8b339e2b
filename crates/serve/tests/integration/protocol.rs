//! Answers to edits that cannot be made: which are refused, which appear in the status, and how.
use crate::common::serve;

/// Edits with the reason of their refusal, or with the error that the status shows.
const ANSWERS: &[(&str, Result<&str, &str>)] = &[
    (r#"{"setting": {"integrator": "clasic"}}"#, Ok("error: there is no integrator `clasic`; did you mean `classic`?")),
    (r#"{"setting": {"sampler": "sobl"}}"#, Ok("error: there is no sampler `sobl`; did you mean `sobol`?")),
    (r#"{"setting": {"tone": "agx2"}}"#, Ok("error: there is no tone curve `agx2`; did you mean `agx`?")),
    (
        r#"{"setting": {"scheduler": "row-queues"}}"#,
        Ok("error: there is no scheduler `row-queues`; did you mean `row-queue`?"),
    ),
    (
        r#"{"setting": {"scheduler": "none"}}"#,
        Ok("error: there is no scheduler `none`; known: `work-stealing`, `row-queue`, `static-rows`"),
    ),
    (
        r#"{"look": {"perspectiv": {}}}"#,
        Ok("error: camera: unknown variant `perspectiv`, expected one of `perspective`, `thin_lens`, `orthographic`"),
    ),
    (
        r#"{"look": {"perspective": {"eye": [0, 1]}}}"#,
        Ok("error: camera: invalid length 2, expected a sequence of 3 f32 values"),
    ),
    (
        r#"{"look": {"perspective": {"vertical_fov_degrees": 400}}}"#,
        Ok(
            "error: `vertical_fov_degrees` must be less than 180, is 400\n |\n = at: camera.perspective.vertical_fov_degrees",
        ),
    ),
    (r#"{"look": 3}"#, Ok("error: camera: invalid type: integer `3`, expected string or map")),
    (r#"{"look": {"perspective": {"file": 3}}}"#, Err("pages may not name files")),
    (r#"{"look": {"perspective": {"eye": "here"}}}"#, Err("pages may set numbers and colors, no other strings")),
    (r#"{"look": "perspective"}"#, Err("pages may set numbers and colors, no other strings")),
    (r#"{"setting": {"integrator": 3}}"#, Err("a message is invalid at column 37")),
    (r#"{"swim": {}}"#, Err("a message is invalid at column 16")),
    (r#"{"fly": {"down": 1}}"#, Err("a message is invalid at column 24")),
    (r#"{"files": {}}"#, Err("a message is invalid at column 17")),
];

#[test]
fn edits_that_cannot_be_made_are_answered_as_before() {
    let serving = serve();
    let mut page = serving.page();
    page.next_text("status", |status| status["stage"] == "finished");
    let long = format!(r#"{{"setting": {{"tone": "{}"}}}}"#, "a".repeat(101));
    let answers = ANSWERS.iter().copied().chain([(long.as_str(), Err("a name has at most 100 characters"))]);
    let mut revision = 0;
    let mut wrong = Vec::new();
    for (edit, expected) in answers {
        page.send(&format!(r#"{{"edit": {edit}}}"#));
        let answer = match expected {
            Ok(_) => {
                revision += 1;
                page.next_text("status", |status| status["revision"] == revision)["error"].clone()
            }
            Err(_) => page.next_text("refused", |_| true),
        };
        let (Ok(text) | Err(text)) = expected;
        if answer != text {
            wrong.push(format!("{edit}\n{answer}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
