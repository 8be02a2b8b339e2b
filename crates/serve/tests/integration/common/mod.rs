//! A server over a small scene, and what talks to it: plain HTTP by hand, WebSockets by `tungstenite`.
#![allow(dead_code, reason = "each test file uses its part")]

use juggler_serve::{Limits, Options, Running, Server};
use juggler_session::Session;
use serde_json::Value;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket};

/// Nothing takes longer, on a busy machine.
pub const PATIENCE: Duration = Duration::from_secs(30);

/// A server at work.
pub struct Serving {
    pub address: SocketAddr,
    pub url: String,
    /// The cookie that stands for the token, as a header's value; none where requests need no token.
    pub cookie: Option<String>,
    pub session: Session,
    pub log: Arc<Mutex<Vec<String>>>,
    _running: Running,
}

/// An answer.
#[derive(Debug)]
pub struct Answer {
    pub status: u16,
    pub head: String,
    pub body: Vec<u8>,
}

impl Answer {
    pub fn header(&self, name: &str) -> Option<&str> {
        let lines = self.head.lines().skip(1).filter_map(|line| line.split_once(": "));
        lines.filter(|(key, _)| key.eq_ignore_ascii_case(name)).map(|(_, value)| value).next()
    }

    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }
}

/// Opens a small picture of a built-in scene.
pub fn small_session() -> Session {
    let options = juggler_session::Options { size: Some([64, 48]), threads: 1, ..Default::default() };
    Session::open("one-sphere", options)
}

/// On a free port of this machine, as it is by default: with a token.
pub fn serve() -> Serving {
    serve_with(Options::default())
}

/// Without a token, so that requests are let in or refused for other reasons.
pub fn serve_open() -> Serving {
    serve_with(Options { token: false, ..Options::default() })
}

/// With other options; the port is free anyway.
pub fn serve_with(options: Options) -> Serving {
    let mut address = options.address;
    address.set_port(0);
    let log = Arc::new(Mutex::new(Vec::new()));
    let lines = Arc::clone(&log);
    let session = small_session();
    let options = Options { address, ..options };
    let server =
        Server::bind(session.clone(), options, move |line| lines.lock().unwrap().push(line.to_owned())).unwrap();
    let (address, url) = (server.address(), server.url());
    let token = url.split_once("?token=").map(|(_, token)| token);
    let cookie = token.map(|token| format!("juggler_{}={token}", address.port()));
    Serving { address, cookie, session, log, _running: server.start().unwrap(), url }
}

/// Limits that tests need not wait for.
pub fn short_limits() -> Limits {
    Limits { head: Duration::from_millis(300), ..Limits::default() }
}

impl Serving {
    pub fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.address.port())).unwrap();
        stream.set_nodelay(true).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream.set_write_timeout(Some(PATIENCE)).unwrap();
        stream
    }

    pub fn host(&self) -> String {
        format!("127.0.0.1:{}", self.address.port())
    }

    /// Sends a request as it is; headers are whole lines.
    pub fn ask(&self, method: &str, path: &str, headers: &[&str]) -> Answer {
        let mut stream = self.connect();
        let lines: String = headers.iter().map(|line| format!("{line}\r\n")).collect();
        // The other side may have read enough before all is sent.
        let _ = write!(stream, "{method} {path} HTTP/1.1\r\nConnection: close\r\n{lines}\r\n");
        answer(&mut stream)
    }

    /// Asks as the page does, which has the cookie.
    pub fn get(&self, path: &str) -> Answer {
        let cookie = self.cookie.iter().map(|cookie| format!("Cookie: {cookie}"));
        let lines: Vec<String> = cookie.chain([format!("Host: {}", self.host())]).collect();
        self.ask("GET", path, &lines.iter().map(String::as_str).collect::<Vec<_>>())
    }

    /// Whether the page is still given out.
    pub fn is_alive(&self) -> bool {
        self.get("/").status == 200
    }

    /// Tries to open a page's socket with these headers besides the usual ones.
    pub fn open(&self, path: &str, headers: &[(&'static str, &str)]) -> Result<Page, u16> {
        let mut request = format!("ws://{}{path}", self.host()).into_client_request().unwrap();
        for (name, value) in headers {
            request.headers_mut().insert(*name, value.parse().unwrap());
        }
        match tungstenite::client(request, self.connect()) {
            Ok((socket, _)) => Ok(Page { socket }),
            Err(tungstenite::HandshakeError::Failure(tungstenite::Error::Http(response))) => {
                Err(response.status().as_u16())
            }
            Err(error) => panic!("{error}"),
        }
    }

    pub fn page(&self) -> Page {
        self.try_page().unwrap()
    }

    pub fn try_page(&self) -> Result<Page, u16> {
        let origin = format!("http://{}", self.host());
        let cookie = self.cookie.iter().map(|cookie| ("Cookie", cookie.as_str()));
        self.open("/socket", &cookie.chain([("Origin", origin.as_str())]).collect::<Vec<_>>())
    }

    /// Waits until the log has a line with this in it.
    pub fn wait_for_line(&self, part: &str) {
        let has = || self.log.lock().unwrap().iter().any(|line| line.contains(part));
        wait_until(&format!("a line with `{part}` in {:?}", self.log), has);
    }
}

/// Reads until the other side closes.
pub fn answer(stream: &mut TcpStream) -> Answer {
    let mut bytes = Vec::new();
    let _ = stream.read_to_end(&mut bytes);
    let split = bytes.windows(4).position(|four| four == b"\r\n\r\n").unwrap_or(bytes.len());
    let head = String::from_utf8_lossy(&bytes[..split]).into_owned();
    let status = head.split(' ').nth(1).and_then(|number| number.parse().ok()).unwrap_or(0);
    Answer { status, head, body: bytes.get(split + 4..).unwrap_or_default().to_vec() }
}

/// Waits, but not for ever.
pub fn wait_until(what: &str, mut condition: impl FnMut() -> bool) {
    let start = Instant::now();
    while !condition() {
        assert!(start.elapsed() < PATIENCE, "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// A page's socket.
pub struct Page {
    pub socket: WebSocket<TcpStream>,
}

/// A frame's head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Head {
    pub serial: u32,
    pub kind: u32,
    pub number: u64,
    pub revision: u64,
    pub size: [u32; 2],
    pub samples: f32,
}

/// What a page hears.
#[derive(Debug)]
pub enum Heard {
    Text(String, Value),
    Frame(Head, Vec<u8>),
}

impl Page {
    pub fn say(&mut self, message: &str) {
        self.socket.send(Message::text(message)).unwrap();
    }

    /// The next message; nothing when the socket was closed.
    pub fn hear(&mut self) -> Option<Heard> {
        loop {
            match self.socket.read() {
                Ok(Message::Text(text)) => {
                    let message: Value = serde_json::from_str(&text).unwrap();
                    let (kind, value) = message.as_object().unwrap().iter().next().unwrap();
                    return Some(Heard::Text(kind.clone(), value.clone()));
                }
                Ok(Message::Binary(bytes)) => return Some(frame(&bytes)),
                Ok(Message::Close(_)) | Err(_) => return None,
                Ok(_) => {}
            }
        }
    }

    /// The next text of this kind that fits; pictures are acknowledged on the way.
    pub fn told(&mut self, kind: &str, mut fits: impl FnMut(&Value) -> bool) -> Value {
        let start = Instant::now();
        loop {
            assert!(start.elapsed() < PATIENCE, "no {kind}");
            match self.hear().expect("the socket was closed") {
                Heard::Text(name, value) if name == kind && fits(&value) => return value,
                Heard::Frame(head, _) => self.say(&format!("{{\"ack\": {}}}", head.serial)),
                Heard::Text(..) => {}
            }
        }
    }

    /// The next picture that fits; all are acknowledged.
    pub fn shown(&mut self, mut fits: impl FnMut(&Head) -> bool) -> (Head, Vec<u8>) {
        let start = Instant::now();
        loop {
            assert!(start.elapsed() < PATIENCE, "no picture");
            if let Heard::Frame(head, image) = self.hear().expect("the socket was closed") {
                self.say(&format!("{{\"ack\": {}}}", head.serial));
                if fits(&head) {
                    return (head, image);
                }
            }
        }
    }
}

fn frame(bytes: &[u8]) -> Heard {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let long = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
    let head = Head {
        serial: word(0),
        kind: word(4),
        number: long(8),
        revision: long(16),
        size: [word(24), word(28)],
        samples: f32::from_bits(word(32)),
    };
    Heard::Frame(head, bytes[juggler_serve::HEADER_BYTES..].to_vec())
}

impl Page {
    /// Answers what is asked for so long; whether the socket is still open.
    pub fn hear_for(&mut self, time: Duration) -> bool {
        let start = Instant::now();
        self.socket.get_ref().set_read_timeout(Some(Duration::from_millis(20))).unwrap();
        while start.elapsed() < time {
            match self.socket.read() {
                Err(tungstenite::Error::Io(error))
                    if matches!(error.kind(), std::io::ErrorKind::WouldBlock | std::io::ErrorKind::TimedOut) => {}
                Ok(Message::Close(_)) | Err(_) => return false,
                Ok(_) => {
                    let _ = self.socket.flush();
                }
            }
        }
        true
    }
}
