//! More than a hundred invalid animations: each gives an error with its place, none a panic or a
//! hang.

use juggler_scene::{Problems, Scene, SceneError};
use std::collections::BTreeSet;
use std::time::Instant;

/// Largest time of all invalid scenes together, in times of a large valid one.
const MOST: u32 = 400;

/// A scene whose radius is `wrong`; the functions below do the same for other kinds of values.
fn radius(wrong: &str) -> String {
    scene("", &format!(r#"{{"shape": {{"sphere": {{"radius": {wrong}}}}}}}"#))
}

fn translate(wrong: &str) -> String {
    scene("", &format!(r#"{{"shape": "sphere", "transform": [{{"translate": {wrong}}}]}}"#))
}

fn step(wrong: &str) -> String {
    scene("", &format!(r#"{{"shape": "sphere", "transform": [{wrong}]}}"#))
}

fn top(wrong: &str) -> String {
    scene(wrong, r#"{"shape": "sphere"}"#)
}

fn scene(more: &str, object: &str) -> String {
    let comma = if more.is_empty() { "" } else { "," };
    format!("{{\"version\": 1,\n {more}{comma}\n \"objects\": [\n  {object}\n ]}}")
}

/// A scene with a track of these settings in place of a number.
fn track(settings: &str) -> String {
    radius(&format!("{{\"animate\": {{{settings}}}}}"))
}

/// A scene with a track of these keys.
fn keys(keys: &str) -> String {
    track(&format!("\"keys\": [{keys}]"))
}

fn slerp(keys: &str) -> String {
    step(&format!(r#"{{"orient": {{"animate": {{"keys": [{keys}], "interpolation": "slerp"}}}}}}"#))
}

/// A scene with an object that moves along a path.
fn along(paths: &str, settings: &str) -> String {
    let object = format!(r#"{{"shape": "sphere", "transform": [{{"translate": {{"along": {{{settings}}}}}}}]}}"#);
    scene(&format!("\"paths\": {{{paths}}}"), &object)
}

/// A scene in which only the path is wrong.
fn path(path: &str) -> String {
    along(&format!("\"way\": {path}"), r#""path": "way", "at": 0.5"#)
}

fn joint(settings: &str) -> String {
    translate(&format!("{{\"joint\": {{{settings}}}}}"))
}

fn variables(variables: &str) -> String {
    scene(&format!("\"variables\": {{{variables}}}"), r#"{"shape": {"sphere": {"radius": "=a"}}}"#)
}

/// Nested value forms.
fn nested(depth: usize) -> String {
    let open = r#"{"animate": {"keys": [[0, 1]], "at": "#.repeat(depth);
    radius(&format!("{open}0{}", "}}".repeat(depth)))
}

const BONES: &str = r#""from": [0, 0, 0], "to": [0, 4, 0], "lengths": [3, 2]"#;

/// Invalid scenes with the expected part of their messages.
fn wrong() -> Vec<(String, &'static str)> {
    let tables = [
        wrong_settings(),
        wrong_keys(),
        wrong_values(),
        wrong_paths(),
        wrong_joints(),
        wrong_variables(),
        wrong_steps(),
        wrong_sizes(),
    ];
    tables.into_iter().flatten().collect()
}

fn wrong_settings() -> Vec<(String, &'static str)> {
    vec![
        (track(""), "`keys` is missing"),
        (track(r#""kyes": [[0, 1]]"#), "did you mean `keys`"),
        (track(r#""keys": [[0, 1]], "repat": "loop""#), "did you mean `repeat`"),
        (track(r#""keys": [[0, 1]], "speed": 2"#), "unknown key `speed`"),
        (track(r#""keys": [[0, 1]], "repeat": "lop""#), "did you mean `loop`"),
        (track(r#""keys": [[0, 1]], "repeat": "ping-pong""#), "did you mean `ping_pong`"),
        (track(r#""keys": [[0, 1]], "repeat": 3"#), "expected a repeat"),
        (track(r#""keys": [[0, 1]], "repeat": true"#), "expected a repeat"),
        (track(r#""keys": [[0, 1]], "interpolation": "liner""#), "did you mean `linear`"),
        (track(r#""keys": [[0, 1]], "interpolation": "cubic""#), "unknown interpolation `cubic`"),
        (track(r#""keys": [[0, 1]], "interpolation": {"smooth": {}}"#), "expected an interpolation"),
        (track(r#""keys": [[0, 1]], "interpolation": null"#), "expected an interpolation"),
        (track(r#""keys": [[0, 1]], "ease": "inn""#), "did you mean `in`"),
        (track(r#""keys": [[0, 1]], "ease": "bounce""#), "unknown easing `bounce`"),
        (track(r#""keys": [[0, 1]], "ease": [0.1, 0.2, 0.3]"#), "expected 4 numbers"),
        (track(r#""keys": [[0, 1]], "ease": [0, 0, "x", 1]"#), "expected a number"),
        (track(r#""keys": [[0, 1]], "ease": [-0.5, 0, 1, 1]"#), "between 0 and 1"),
        (track(r#""keys": [[0, 1]], "ease": [0, 0, 7, 1]"#), "between 0 and 1"),
        (track(r#""keys": [[0, 1]], "ease": {"in": 2}"#), "expected"),
        (track(r#""keys": [[0, 1]], "at": "seconds""#), "begins with `=`"),
        (track(r#""keys": [[0, 1]], "at": [1]"#), "expected a number"),
        (track(r#""keys": [[0, 1]], "at": "=secnds""#), "did you mean `seconds`"),
        (track(r#""keys": [[0, 1]], "at": "=1/0""#), "infinite"),
        (track(r#""keys": [[0, 1]], "at": "=sqrt(-1)""#), "no value"),
        (track(r#""keys": [[0, 1]], "at": "=(((""#), "missing"),
        (radius(r#"{"animate": []}"#), "expected an object"),
        (radius(r#"{"animate": null}"#), "expected an object"),
        (radius(r#"{"animate": "keys"}"#), "expected an object"),
        (radius(r#"{"animate": {"keys": [[0, 1]]}, "ease": "in"}"#), "an object with a single key"),
        (radius(r#"{"animate": {"keys": [[0, 1]]}, "along": {"path": "a", "at": 0}}"#), "an object with a single key"),
        (radius(r#"{"anmate": {"keys": [[0, 1]]}}"#), "did you mean `animate`"),
    ]
}

fn wrong_keys() -> Vec<(String, &'static str)> {
    vec![
        (keys(""), "at least 1"),
        (track(r#""keys": {}"#), "expected an array"),
        (track(r#""keys": 5"#), "expected an array"),
        (track(r#""keys": "=frame""#), "expected an array"),
        (keys("1, 2"), "expected an array"),
        (keys("[]"), "at least 2"),
        (keys("[0]"), "at least 2"),
        (keys("[0, 1], [1]"), "at least 2"),
        (keys(r#"[0, 1, "in", "out"]"#), "at most 3"),
        (keys(r#"{"time": 0, "value": 1}"#), "expected an array"),
        (keys(r#"["zero", 1]"#), "must begin with its time"),
        (keys("[null, 1]"), "must begin with its time"),
        (keys("[[0], 1]"), "must begin with its time"),
        (keys(r#"["=frme", 1]"#), "did you mean `frame`"),
        (keys("[1, 1], [0, 2]"), "must be in order of time"),
        (keys("[0, 1], [2, 2], [1, 3]"), "must be in order of time"),
        (keys("[0, 1], [0, 2]"), "two keys have the time 0"),
        (keys(r#"["=1", 1], [1, 2]"#), "two keys have the time 1"),
        (keys("[0, 1], [1e999, 2]"), "is too large"),
        (keys(r#"[0, 1, "inout"], [1, 2]"#), "did you mean `in_out`"),
        (keys("[0, 1, 7], [1, 2]"), "expected"),
        (keys("[0, 1, [0, 0, 0, 0, 0]], [1, 2]"), "expected 4 numbers"),
        (keys("[0, 1, [2, 0, 0, 0]], [1, 2]"), "between 0 and 1"),
        (keys("[0, 1], [1, 2, null]"), "expected"),
    ]
}

fn wrong_values() -> Vec<(String, &'static str)> {
    vec![
        (keys(r#"[0, "a"], [1, "b"]"#), "can be interpolated"),
        (keys("[0, true], [1, false]"), "write \"interpolation\": \"step\""),
        (keys("[0, null]"), "can be interpolated"),
        (keys(r#"[0, {"sphere": {}}], [1, {"sphere": {}}]"#), "can be interpolated"),
        (keys("[0, []], [1, []]"), "without numbers"),
        (keys(r##"[0, "#12345g"]"##), "is not a color"),
        (keys("[0, 1], [1, [1, 2]]"), "but the value of the first key is a number"),
        (keys("[0, [1, 2]], [1, [1, 2, 3]]"), "an array of 3, but the value of the first key is an array of 2"),
        (keys("[0, [[1, 2]]], [1, [[1, 2, 3]]]"), "but the value of the first key is an array of 1 arrays (of 2)"),
        (keys(r##"[0, "#ffffff"], [1, 1]"##), "the value of the first key is a color"),
        (keys(r##"[0, [1, 2]], [1, "#ffffff"]"##), "a color"),
        (keys(r#"[0, "=nothing"]"#), "nothing is called `nothing`"),
        (keys(r#"[0, "=1/0"], [1, 2]"#), "infinite"),
        (keys("[0, -1], [1, -2]"), "`radius` must be greater than 0"),
        (keys("[0, [1, 2]], [1, [3, 4]]"), "expected a number, found an array"),
        (keys(r#"[0, "a"]"#).replace("\"keys\"", "\"interpolation\": \"step\", \"keys\""), "expected a number"),
        (
            keys("[0, 1e300], [1e-300, -1e300]")
                .replace("\"keys\"", "\"at\": 5e-301, \"interpolation\": \"smooth\", \"keys\""),
            "",
        ),
        (translate(r#"{"animate": {"keys": [[0, [1, 2]]]}}"#), "expected 3 numbers"),
        (
            top(r#""background": {"animate": {"keys": [[0, "redd"]], "interpolation": "step"}}"#),
            "unknown kind of background",
        ),
        (slerp("[0, [0, 0, 1]]"), "a rotation is a quaternion"),
        (slerp("[0, [0, 0, 0, 0]]"), "must not be zero"),
        (slerp("[0, 5]"), "a rotation is a quaternion"),
        (slerp(r#"[0, [0, 0, "z", 1]]"#), "a rotation is a quaternion"),
        (slerp(r#"[0, {"axis": [0, 0, 0], "degrees": 9}]"#), "must not be zero"),
        (slerp(r#"[0, {"axis": [0, 1, 0]}]"#), "a rotation is a quaternion"),
        (slerp(r#"[0, {"axis": [0, 1], "degrees": 1}]"#), "a rotation is a quaternion"),
        (slerp(r#"[0, {"axis": [0, 1, 0], "degrees": 1, "radians": 1}]"#), "a rotation is a quaternion"),
        (slerp(r#"[0, "north"]"#), "a rotation is a quaternion"),
    ]
}

fn wrong_paths() -> Vec<(String, &'static str)> {
    vec![
        (along(r#""way": {"points": [[0, 0, 0]]}"#, r#""path": "wya", "at": 0"#), "did you mean `way`"),
        (along("", r#""path": "way", "at": 0"#), "the scene has no `paths`"),
        (along(r#""way": {"points": [[0, 0, 0]]}"#, r#""path": "way""#), "`at` is missing"),
        (along(r#""way": {"points": [[0, 0, 0]]}"#, r#""at": 0"#), "`path` is missing"),
        (along(r#""way": {"points": [[0, 0, 0]]}"#, r#""path": "way", "att": 0"#), "did you mean `at`"),
        (along(r#""way": {"points": [[0, 0, 0]]}"#, r#""path": 3, "at": 0"#), "expected a string"),
        (along(r#""way": {"points": [[0, 0, 0]]}"#, r#""path": "way", "at": "=frme""#), "did you mean `frame`"),
        (along(r#""way": {"points": [[0, 0, 0]]}"#, r#""path": "way", "at": [0, 1]"#), "expected a number"),
        (translate(r#"{"along": "way"}"#), "expected an object"),
        (radius(r#"{"along": {"path": "way", "at": 0}}"#), "no path is called `way`"),
        (path("{}"), "`points` is missing"),
        (path("[]"), "expected an object"),
        (path("null"), "expected an object"),
        (path(r#"{"points": []}"#), "at least 1"),
        (path(r#"{"points": 7}"#), "expected an array"),
        (path(r#"{"points": [[0, 0]]}"#), "expected 3 numbers"),
        (path(r#"{"points": [0, 1, 2]}"#), "expected an array of 3 numbers"),
        (path(r#"{"points": [[0, "a", 0]]}"#), "expected a number"),
        (path(r#"{"points": [[0, 1e39, 0]]}"#), "between -3.4e38 and 3.4e38"),
        (path(r#"{"points": [[0, 0, 0]], "closed": "yes"}"#), "expected true or false"),
        (path(r#"{"points": [[0, 0, 0]], "close": true}"#), "did you mean `closed`"),
        (path(r#"{"points": ["=start", [1, 0, 0]]}"#), "nothing is called `start`"),
        (path(r#"{"points": [{"along": {"path": "way", "at": 0}}, [1, 0, 0]]}"#), "depends on itself"),
        (top(r#""paths": []"#), "expected an object"),
        (
            top(
                r#""paths": {"a": {"points": [{"along": {"path": "b", "at": 0}}]}, "b": {"points": [{"along": {"path": "a", "at": 0}}]}}"#,
            ),
            "depends on itself",
        ),
        (top(r#""path": {"a": {"points": [[0, 0, 0]]}}"#), "did you mean `paths`"),
    ]
}

fn wrong_joints() -> Vec<(String, &'static str)> {
    vec![
        (joint(BONES), "`plane_normal` is missing"),
        (joint(&format!("{BONES}, \"plane_normal\": [0, 0]")), "expected 3 numbers"),
        (joint(&format!("{BONES}, \"plane_normal\": [0, 0, 0]")), "must not be zero"),
        (joint(&format!("{BONES}, \"plane_normal\": [0, 1, 0]")), "parallel to the line from `from` to `to`"),
        (joint(&format!("{BONES}, \"plane_normal\": [0, 0, 1], \"keep_length\": true")), "did you mean `keep_lengths`"),
        (joint(&format!("{BONES}, \"plane_normal\": [0, 0, 1], \"keep_lengths\": 1")), "expected true or false"),
        (joint(&BONES.replace('4', "9").replace("[3, 2]", "[3, 2], \"plane_normal\": [0, 0, 1]")), "out of reach"),
        (joint(&BONES.replace('4', "0.5").replace("[3, 2]", "[3, 2], \"plane_normal\": [0, 0, 1]")), "cannot bend"),
        (joint(&BONES.replace('4', "0").replace("[3, 2]", "[3, 2], \"plane_normal\": [0, 0, 1]")), "the same point"),
        (joint(&BONES.replace("[3, 2]", "[3, 0], \"plane_normal\": [0, 0, 1]")), "greater than 0"),
        (joint(&BONES.replace("[3, 2]", "[-3, 2], \"plane_normal\": [0, 0, 1]")), "greater than 0"),
        (joint(&BONES.replace("[3, 2]", "3, \"plane_normal\": [0, 0, 1]")), "expected an array of 2 numbers"),
        (
            joint(&BONES.replace("[0, 0, 0]", "\"=hand\"").replace("[3, 2]", "[3, 2], \"plane_normal\": [0, 0, 1]")),
            "nothing is called `hand`",
        ),
        (translate(r#"{"joint": [0, 0, 0]}"#), "expected an object"),
        (
            joint(r#""from": [0, 0, 0], "to": [0, 1e150, 0], "lengths": [1e200, 1e200], "plane_normal": [0, 0, 1]"#),
            "too large",
        ),
    ]
}

fn wrong_variables() -> Vec<(String, &'static str)> {
    vec![
        (variables(r#""a": []"#), "1 to 4 numbers"),
        (variables(r#""a": [1, 2, 3, 4, 5]"#), "1 to 4 numbers"),
        (variables(r#""a": [1, "b"]"#), "nothing is called `b`"),
        (variables(r#""a": [1, [2]]"#), "found an array"),
        (variables(r#""a": true"#), "found true or false"),
        (variables(r#""a": null"#), "found null"),
        (variables(r#""a": {"x": 1}"#), "found an object"),
        (variables(r#""a": ["v"], "v": [1, 2]"#), "further down"),
        (variables(r#""a": "v.x", "v": [1, 2]"#), "further down"),
        (variables(r#""a": "a + 1""#), "nothing is called `a`"),
        (variables(r#""v": [1, 2], "a": "v + 1""#), "write v.x or v.y"),
        (variables(r#""v": [1, 2], "a": "v.z""#), "write v.x or v.y"),
        (variables(r#""v": [1, 2], "a": ["v", 1]"#), "expected a single number"),
        (variables(r#""a": 1, "b": "a.x""#), "without components"),
        (variables(r#""a": [1, 2]"#), "expected a number, found an array"),
        (variables(r#""a.x": 1, "a": 1"#), "is not a valid name of a variable"),
        (variables(r#""seconds": [1, 2], "a": 1"#), "is predefined in expressions"),
        (variables(r#""a": {"animate": {"keys": [[0, "x"]], "interpolation": "step"}}"#), "found a string"),
        (variables(r#""a": {"animate": {"keys": [[0, [1, 2, 3, 4, 5]]]}}"#), "1 to 4 numbers"),
        (variables(r#""a": {"animate": {"keys": [[0, [[1]]]]}}"#), "found an array"),
        (variables(r#""a": {"animate": {"keys": [[0, 1]], "at": "=b"}}, "b": 1"#), "further down"),
        (variables(r#""a": {"along": {"path": "none", "at": 0}}"#), "no path is called `none`"),
        (variables(r#""a": {"joint": {}}"#), "are missing"),
        (variables(r#""a": {"animate": {"keys": [[0, 1]]}, "b": 1}"#), "an object with a single key"),
        (variables(r#""a": [{"along": {"path": "none", "at": 0}}, 1]"#), "no path is called `none`"),
    ]
}

fn wrong_steps() -> Vec<(String, &'static str)> {
    vec![
        (step(r#"{"orient": [0, 0, 0, 0]}"#), "must not be zero"),
        (step(r#"{"orient": [0, 0, 1]}"#), "expected 4 numbers"),
        (step(r#"{"orient": {"axis": [0, 1, 0], "degrees": 9}}"#), "expected an array of 4 numbers"),
        (step(r#"{"look_at": {}}"#), "`to` is missing"),
        (step(r#"{"look_at": [0, 0, 1]}"#), "expected an object"),
        (step(r#"{"look_at": {"to": [0, 0, 0]}}"#), "must not be the same point"),
        (step(r#"{"look_at": {"to": [0, 0, 1], "up": [0, 0, 0]}}"#), "`up` must not be zero"),
        (step(r#"{"look_at": {"to": [0, 0, 1], "forward": [0, 0, 0]}}"#), "`forward` must not be zero"),
        (step(r#"{"look_at": {"form": [0, 0, 0], "to": [0, 0, 1]}}"#), "did you mean `from`"),
        (step(r#"{"lookat": {"to": [0, 0, 1]}}"#), "did you mean `look_at`"),
        (scene("", r#"{"shape": "sphere", "visible": "no"}"#), "expected true or false or a number"),
        (scene("", r#"{"shape": "sphere", "visible": "=frme"}"#), "did you mean `frame`"),
        (scene("", r#"{"shape": "sphere", "visible": []}"#), "expected true or false or a number"),
        (scene("", r#"{"shape": "sphere", "visibel": false}"#), "did you mean `visible`"),
    ]
}

fn wrong_sizes() -> Vec<(String, &'static str)> {
    let many = |count: usize, one: &dyn Fn(usize) -> String| (0..count).map(one).collect::<Vec<_>>().join(",");
    vec![
        (nested(17), "deeper than the limit of 16"),
        (nested(25), "deeper than the limit of 16"),
        (nested(400), "deeper than the limit of 64"),
        (keys(&many(100_001, &|i| format!("[{i}, 1]"))), "at most 100000"),
        (keys(&many(20_000, &|i| format!("[{}, 1]", 20_000 - i))), "must be in order of time"),
        (keys(&many(20_000, &|i| format!("[{i}, \"=x{i}\"]"))), "nothing is called"),
        (path(&format!("{{\"points\": [{}]}}", many(10_001, &|i| format!("[{i}, 0, 0]")))), "at most 10000"),
        (track(&format!(r#""keys": [[0, 1]], "at": "={}""#, "1+".repeat(4000))), "at most 4096"),
        (track(&format!(r#""keys": [[0, 1]], "at": "={}""#, "(".repeat(2000))), "nested deeper than 64"),
        (translate(&format!("[{}]", many(2000, &|_| r#"{"animate": {}}"#.into()))), "`keys` is missing"),
        (variables(&many(3000, &|i| format!("\"v{i}\": [\"v{}\"]", i + 1))), "further down"),
    ]
}

/// Problems of a scene at two frames; `None` if it compiles.
fn problems(text: &str) -> Option<Problems> {
    let at = |frame: f64| {
        let scene = Scene::from_json(text, "wrong.json")?.at_frame(frame)?;
        scene.compile().map(|_| ())
    };
    match at(0.0).and_then(|()| at(7.5)) {
        Ok(()) => None,
        Err(SceneError::Problems(problems)) => Some(problems),
        Err(other) => panic!("{other}"),
    }
}

/// Describes what is wrong with the report about an invalid scene.
fn failure(text: &str, expected: &str) -> Option<String> {
    let shown: String = text.chars().take(300).collect();
    let Some(problems) = problems(text) else { return Some(format!("nothing is wrong with {shown}")) };
    let all = problems.to_string();
    let is_reported = all.contains(expected) && all.contains(" --> wrong.json:") && problems.errors() > 0;
    let placed = problems.list().iter().all(|problem| problem.place.is_some() && !problem.message.is_empty());
    let short: String = all.chars().take(1500).collect();
    let fine = is_reported && placed && problems.list().len() <= 400;
    (!fine).then(|| format!("expected {expected:?} for {shown}\n{short}"))
}

#[test]
fn every_wrong_animation_is_reported_with_reason_and_place() {
    let table = wrong();
    let distinct: BTreeSet<&String> = table.iter().map(|(text, _)| text).collect();
    assert!(distinct.len() == table.len() && table.len() >= 150, "{} scenes", table.len());
    let start = Instant::now();
    let failures: Vec<String> = table.iter().filter_map(|(text, expected)| failure(text, expected)).collect();
    let elapsed = start.elapsed();
    assert!(failures.is_empty(), "{} of {}\n{}", failures.len(), table.len(), failures.join("\n\n"));
    // A bound that holds on slow machines too: the time of a large scene without mistakes.
    let start = Instant::now();
    let large = keys(&(0..20_000).map(|i| format!("[{i}, {}]", 1 + i % 7)).collect::<Vec<_>>().join(","));
    assert!(problems(&large).is_none());
    let usual = start.elapsed();
    eprintln!("wrong {elapsed:?}, large {usual:?}");
    assert!(elapsed < MOST * usual, "{elapsed:?}, a large scene without mistakes takes {usual:?}");
}

/// Each error gives one message.
#[test]
fn each_animation_error_gives_few_messages() {
    let tables =
        [(wrong_settings(), 2), (wrong_keys(), 2), (wrong_paths(), 3), (wrong_joints(), 1), (wrong_variables(), 1)];
    let mut many = String::new();
    for (text, most) in
        tables.into_iter().flat_map(|(table, most)| table.into_iter().map(move |(text, _)| (text, most)))
    {
        if let Some(problems) = problems(&text).filter(|problems| problems.errors() > most) {
            many.push_str(&format!("{text}\n{problems}\n"));
        }
    }
    assert!(many.is_empty(), "{many}");
}

#[test]
fn several_mistakes_come_at_once() {
    let text = r#"{"version": 1, "paths": {"way": {"points": [[0, 0]]}},
 "variables": {"a": [1, "nothing"], "b": "a.x + 1"},
 "objects": [
  {"shape": {"sphere": {"radius": {"animate": {"keys": [[0, 1], [0, 2]], "repaet": "loop", "ease": [9, 0, 0, 0]}}}}},
  {"shape": "sphere", "transform": [{"translate": {"along": {"path": "wya", "at": 0}}}, {"translate": ["=b", 0, 0]}]},
  {"shape": "sphere", "visible": {"animate": {"keys": [[0, true], [1, "x"]]}}}]}"#;
    let problems = problems(text).unwrap();
    let messages: Vec<&str> = problems.list().iter().map(|problem| problem.message.as_str()).collect();
    assert_eq!(problems.errors(), 7, "{messages:#?}");
}
