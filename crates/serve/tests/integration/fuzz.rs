//! Invalid messages are refused and do not accumulate memory. The test runs alone in its process,
//! whose memory it measures.
use crate::common::{Page, serve};
use tungstenite::Message;

/// Pseudorandom numbers, the same in each run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed ^ (mixed >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    fn pick<'t>(&mut self, from: &[&'t str]) -> &'t str {
        from[self.below(from.len())]
    }
}

const WORDS: [&str; 24] = [
    "edit", "ack", "probe", "steer", "here", "scene", "fly", "orbit", "zoom", "focus", "frame", "camera", "look",
    "set", "setting", "size", "threads", "at", "play", "show", "region", "reset", "path", "value",
];
const NUMBERS: [&str; 10] =
    ["0", "-1", "1e308", "1e999", "-1e-320", "18446744073709551616", "4294967296", "0.1", "NaN", "16777217"];

fn json(numbers: &mut Numbers, depth: usize) -> String {
    match numbers.below(if depth > 5 { 3 } else { 6 }) {
        0 => numbers.pick(&NUMBERS).into(),
        1 => format!("\"{}\"", numbers.pick(&WORDS)),
        2 => numbers.pick(&["true", "false", "null"]).into(),
        3 => format!("[{},{}]", json(numbers, depth + 1), json(numbers, depth + 1)),
        _ => format!("{{\"{}\":{}}}", numbers.pick(&WORDS), json(numbers, depth + 1)),
    }
}

fn nonsense(numbers: &mut Numbers) -> Message {
    match numbers.below(6) {
        0 => Message::binary((0..numbers.below(2000)).map(|_| numbers.next() as u8).collect::<Vec<_>>()),
        1 => Message::text(
            (0..numbers.below(500)).filter_map(|_| char::from_u32(numbers.below(0x11_0000) as u32)).collect::<String>(),
        ),
        2 => Message::text(
            ["[", "{\"edit\":", "{\"edit\":{\"look\":["][numbers.below(3)].repeat(1 + numbers.below(3000)),
        ),
        3 => Message::text(format!("{{\"edit\":{{\"look\":{}1{}}}}}", "[".repeat(100), "]".repeat(100))),
        4 => Message::text(format!("{{\"ack\":{}}}", numbers.next() as u32)),
        _ => Message::text(json(numbers, 0)),
    }
}

/// Sends invalid messages and reads the answers meanwhile.
fn pester(page: &mut Page, numbers: &mut Numbers, messages: usize) {
    for index in 0..messages {
        page.socket.send(nonsense(numbers)).unwrap();
        if index % 4 == 3 {
            // Wait for an answer, so that the measurement excludes socket buffers.
            page.send("{\"probe\": [1, 1]}");
            page.next_text("probe", |_| true);
        }
    }
}

#[cfg(target_os = "linux")]
fn resident_kilobytes() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

#[cfg(not(target_os = "linux"))]
fn resident_kilobytes() -> u64 {
    0
}

#[test]
fn random_messages_are_rejected_without_memory_growth() {
    let serving = serve();
    let mut numbers = Numbers(7);
    let mut page = serving.page();
    pester(&mut page, &mut numbers, 1000);
    let before = resident_kilobytes();
    for _ in 0..4 {
        page = serving.page();
        pester(&mut page, &mut numbers, 1500);
    }
    let after = resident_kilobytes();
    assert!(after < before + 24_000, "memory grew from {before} to {after} kB");
    serving.wait_for_line("a message is invalid");
    assert!(serving.log.lock().unwrap().len() < 2000, "the log is flooded");
    assert!(serving.is_alive());
    page.send("{\"steer\": true}");
    page.send("{\"edit\": \"reset\"}");
    page.next_text("status", |status| status["error"].is_null() && status["scene"] != "");
}
