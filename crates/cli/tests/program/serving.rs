//! `juggler serve` from outside.
#![cfg(all(unix, feature = "serve"))]

use crate::harness::Folder;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Starts a server and returns its process and its address.
fn start(folder: &Folder, line: &str) -> (Child, String) {
    let mut child = folder.command(line).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut first = String::new();
    BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut first).unwrap();
    let url = first.trim().strip_prefix("juggler serves at http://").unwrap().to_owned();
    (child, url)
}

fn end(mut child: Child, signal: &str) -> (Option<i32>, String) {
    let start = Instant::now();
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
    let mut errors = String::new();
    child.stderr.take().unwrap().read_to_string(&mut errors).unwrap();
    let status = child.wait().unwrap().code();
    assert!(start.elapsed() < Duration::from_secs(5), "it took too long to stop");
    (status, errors)
}

/// Response to a request.
fn get(host: &str, path: &str) -> String {
    let mut stream = TcpStream::connect(host).unwrap();
    write!(stream, "GET /{path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    answer
}

#[test]
fn serve_prints_its_url_and_ends_by_a_signal() {
    for (signal, status) in [("-INT", 130), ("-TERM", 143)] {
        let folder = Folder::new();
        let (child, url) = start(&folder, "serve ball.json --addr 127.0.0.1:0 --threads 1");
        let (host, path) = url.split_once('/').unwrap();
        assert_eq!(path.strip_prefix("?token=").unwrap().len(), 32, "{url}");
        let page = get(host, path);
        assert!(page.starts_with("HTTP/1.1 200") && page.contains("<title>juggler</title>"), "{page}");
        assert!(get(host, "").starts_with("HTTP/1.1 403"), "without the token");
        let (ended, said) = end(child, signal);
        assert_eq!(ended, Some(status));
        assert!(said.starts_with("refused: ") && said.ends_with("\ninterrupted\n"), "{said}");
        assert!(folder.files().is_empty());
    }
}

#[test]
fn other_machines_need_a_flag_and_a_token() {
    let folder = Folder::new();
    let message = folder.bad("serve ball.json --addr 0.0.0.0:0", 2);
    assert!(message.contains("--allow-remote") && message.contains("ssh"), "{message}");
    let (child, url) = start(&folder, "serve ball.json --addr 0.0.0.0:0 --allow-remote --threads 1");
    assert!(url.split_once("/?token=").unwrap().1.len() == 32, "{url}");
    let _ = end(child, "-TERM");
}

#[test]
fn token_may_be_disabled_only_on_loopback() {
    let folder = Folder::new();
    let (child, url) = start(&folder, "serve ball.json --addr 127.0.0.1:0 --no-token --threads 1");
    let host = url.strip_suffix('/').unwrap();
    assert!(get(host, "").starts_with("HTTP/1.1 200"), "{url}");
    assert_eq!(end(child, "-TERM"), (Some(143), "interrupted\n".to_owned()));
    let message = folder.bad("serve ball.json --addr 0.0.0.0:0 --allow-remote --no-token", 2);
    assert!(message.contains("--no-token") && message.contains("--allow-remote"), "{message}");
}

#[test]
fn unservable_scenes_and_busy_ports_are_reported() {
    let folder = Folder::new();
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let message = folder.bad(&format!("serve ball.json --addr {}", taken.local_addr().unwrap()), 3);
    assert!(message.contains("in use"), "{message}");
    assert!(folder.bad("serve bal.json --addr 127.0.0.1:0", 3).contains("ball.json"));
    assert!(folder.bad("serve no-such-scene --addr 127.0.0.1:0", 2).contains("no-such-scene"));
    assert!(folder.bad("serve - --addr 127.0.0.1:0", 2).contains("standard input"));
    assert!(folder.bad("serve ball.json --addr nonsense", 2).contains("127.0.0.1:8080"));
}

/// Peak memory of a process in bytes.
#[cfg(target_os = "linux")]
fn peak(child: &Child) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    line.trim().strip_suffix(" kB").unwrap().parse::<u64>().unwrap() << 10
}

#[cfg(target_os = "linux")]
#[test]
fn dropped_files_are_in_memory_once_and_within_a_limit() {
    const MEBI: u64 = 1 << 20;
    let folder = Folder::new();
    let (child, url) = start(&folder, "serve ball.json --addr 127.0.0.1:0 --no-token --threads 1 --max-memory 800M");
    let host = url.strip_suffix('/').unwrap();
    let upload = |mebibytes: u64| {
        let head = format!(r#"{{"name": "a.obj", "files": [["a.obj", {}]]}}"#, mebibytes * MEBI);
        let mut stream = TcpStream::connect(host).unwrap();
        let length = 4 + head.len() as u64 + mebibytes * MEBI;
        write!(stream, "POST /drop HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\n").unwrap();
        write!(stream, "Connection: close\r\nContent-Length: {length}\r\n\r\n").unwrap();
        let piece = vec![b' '; 1 << 20];
        let mut send = |bytes: &[u8]| stream.write_all(bytes).is_ok();
        // The server may answer before it has read everything.
        let _ =
            send(&(head.len() as u32).to_le_bytes()) && send(head.as_bytes()) && (0..mebibytes).all(|_| send(&piece));
        let mut answer = String::new();
        let _ = stream.read_to_string(&mut answer);
        answer
    };
    get(host, "");
    let before = peak(&child);
    let answer = upload(300);
    assert!(answer.starts_with("HTTP/1.1 200") && answer.ends_with("\r\n1"), "{answer}");
    let grown = peak(&child) - before;
    assert!((300 * MEBI..350 * MEBI).contains(&grown), "{} MiB", grown / MEBI);
    assert!(!upload(401).starts_with("HTTP/1.1 200"), "half of the limit is for files");
    assert_eq!(end(child, "-TERM").0, Some(143));
}
