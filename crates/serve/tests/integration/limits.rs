//! Resource limits, one test each: the excess is refused, and the server continues.
use crate::common::{PATIENCE, answer, serve, serve_open, serve_with, short_limits, wait_until};
use juggler_serve::{Limits, ServerOptions};
use std::io::{Read, Write};
use std::time::{Duration, Instant};

#[test]
fn two_hundred_connections_are_too_many() {
    let serving = serve_open();
    let mut streams: Vec<_> = (0..200).map(|_| serving.connect()).collect();
    serving.wait_for_line("too many connections");
    // The last 100 connections exceed the limit and are closed, where possible after a status of
    // 503.
    let refused = streams.iter_mut().rev().take(100).filter_map(|stream| {
        let mut text = String::new();
        let _ = stream.read_to_string(&mut text);
        (text.is_empty() || text.starts_with("HTTP/1.1 503")).then_some(())
    });
    assert_eq!(refused.count(), 100);
    let mut first = streams.remove(0);
    write!(first, "GET / HTTP/1.1\r\nConnection: close\r\nHost: {}\r\n\r\n", serving.host()).unwrap();
    assert_eq!(answer(&mut first).status, 200);
    drop((first, streams));
    wait_until("places are free again", || serving.is_alive());
}

#[test]
fn seventeen_pages_are_too_many() {
    let serving = serve();
    let mut pages: Vec<_> = (0..16).map(|_| serving.page()).collect();
    assert_eq!(serving.try_page().err(), Some(503));
    serving.wait_for_line("too many pages");
    pages.pop();
    wait_until("a place is free again", || serving.try_page().is_ok());
    assert!(serving.is_alive());
}

#[test]
fn incomplete_requests_time_out() {
    let serving = serve_with(ServerOptions { limits: short_limits(), ..ServerOptions::default() });
    let begun = ["", "GET / HT", "GET / HTTP/1.1\r\nHost: "];
    let mut streams: Vec<_> = begun
        .iter()
        .map(|text| {
            let mut stream = serving.connect();
            stream.write_all(text.as_bytes()).unwrap();
            stream
        })
        .collect();
    // This client sends byte by byte.
    let mut dripping = serving.connect();
    let start = Instant::now();
    for byte in b"GET / HTTP/1.1\r\nHost: localhost\r\nX: ".iter().cycle() {
        if dripping.write_all(&[*byte]).is_err() {
            break;
        }
        assert!(start.elapsed() < PATIENCE, "a dripping request is waited for");
        std::thread::sleep(Duration::from_millis(20));
    }
    for stream in &mut streams {
        let mut rest = Vec::new();
        let _ = stream.read_to_end(&mut rest);
        assert!(start.elapsed() < PATIENCE, "half a request is waited for");
    }
    serving.wait_for_line("took too long");
    assert!(serving.is_alive());
}

#[test]
fn idle_connections_are_closed() {
    let serving = serve_with(ServerOptions { limits: short_limits(), token: false, ..ServerOptions::default() });
    let mut stream = serving.connect();
    write!(stream, "GET /icon.svg HTTP/1.1\r\nHost: {}\r\n\r\n", serving.host()).unwrap();
    let start = Instant::now();
    let answer = answer(&mut stream);
    assert_eq!(answer.status, 200);
    assert!(start.elapsed() < PATIENCE, "it was not closed");
}

#[test]
fn a_large_message_ends_the_page_that_sent_it() {
    let serving = serve();
    let mut page = serving.page();
    page.send(&format!("{{\"edit\": {{\"scene\": \"{}\"}}}}", "a".repeat(60_000)));
    page.next_text("refused", |_| true);
    let large = tungstenite::Message::text("a".repeat(65 << 10));
    let _ = page.socket.send(large);
    while page.receive().is_some() {}
    serving.wait_for_line("too l");
    assert!(serving.is_alive());
    serving.page().next_text("status", |_| true);
}

#[test]
fn a_silent_page_is_let_go() {
    let limits = Limits { silence: Duration::from_millis(600), ..Limits::default() };
    let serving = serve_with(ServerOptions { limits, ..ServerOptions::default() });
    let silent = serving.page();
    serving.wait_for_line("silent for too long");
    // A page that answers pings stays connected.
    let mut page = serving.page();
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(2) {
        assert!(page.receive_for(Duration::from_millis(50)), "it was let go");
    }
    drop(silent);
}

#[test]
fn long_request_headers_are_rejected() {
    let serving = serve_open();
    let answer =
        serving.request("GET", "/", &[&format!("Host: {}", serving.host()), &format!("X: {}", "a".repeat(100_000))]);
    assert!(answer.status == 431 || answer.status == 0, "{answer:?}");
    let many: String = (0..2000).map(|index| format!("X{index}: a\r\n")).collect();
    let answer = serving.request("GET", "/", &[&format!("Host: {}", serving.host()), many.trim_end()]);
    assert!(answer.status == 431 || answer.status == 0, "{answer:?}");
    assert!(serving.is_alive());
}

#[test]
fn bytes_that_are_no_web_socket_end_their_connection() {
    let serving = serve_open();
    for turn in 0..50 {
        let mut stream = serving.connect();
        let host = serving.host();
        write!(
            stream,
            "GET /socket HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nUpgrade: websocket\r\n\
            Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
        )
        .unwrap();
        let bytes: Vec<u8> =
            (0..4000_u32).map(|index| (index.wrapping_mul(2_654_435_761) >> 24) as u8 ^ turn).collect();
        let _ = stream.write_all(&bytes);
        let _ = stream.shutdown(std::net::Shutdown::Write);
        let _ = stream.read_to_end(&mut Vec::new());
    }
    assert!(serving.is_alive());
}
