//! Test server of a small scene, with clients for plain HTTP and, by `tungstenite`, for WebSockets.
#![allow(dead_code, reason = "each test file uses its part")]

use juggler_serve::{Limits, Running, Server, ServerOptions};
use juggler_session::Session;
use serde_json::Value;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket};

/// Timeout of every wait, even on a busy machine.
pub const PATIENCE: Duration = Duration::from_secs(30);

/// Running server.
pub struct Serving {
    pub address: SocketAddr,
    pub url: String,
    /// Value of the cookie header with the token; `None` if requests need no token.
    pub cookie: Option<String>,
    pub session: Session,
    pub log: Arc<Mutex<Vec<String>>>,
    _running: Running,
}

/// HTTP response.
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

/// Opens a session of a built-in scene with a small image.
pub fn small_session() -> Session {
    let options = juggler_session::SessionOptions { size: Some([64, 48]), threads: 1, ..Default::default() };
    Session::open("one-sphere", options)
}

/// Starts a server with default options, and so with a token, on a free loopback port.
pub fn serve() -> Serving {
    serve_with(ServerOptions::default())
}

/// Starts a server without a token, so that other rules decide about requests.
pub fn serve_open() -> Serving {
    serve_with(ServerOptions { token: false, ..ServerOptions::default() })
}

/// Starts a server with other options on a free port.
pub fn serve_with(options: ServerOptions) -> Serving {
    let mut address = options.address;
    address.set_port(0);
    let log = Arc::new(Mutex::new(Vec::new()));
    let lines = Arc::clone(&log);
    let session = small_session();
    let options = ServerOptions { address, ..options };
    let server =
        Server::bind(session.clone(), options, move |line| lines.lock().unwrap().push(line.to_owned())).unwrap();
    let (address, url) = (server.address(), server.url());
    let token = url.split_once("?token=").map(|(_, token)| token);
    let cookie = token.map(|token| format!("juggler_{}={token}", address.port()));
    Serving { address, cookie, session, log, _running: server.start().unwrap(), url }
}

/// Limits with short timeouts.
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

    /// Sends a request with these headers, each a whole line.
    pub fn request(&self, method: &str, path: &str, headers: &[&str]) -> Answer {
        let mut stream = self.connect();
        let lines: String = headers.iter().map(|line| format!("{line}\r\n")).collect();
        // The server may answer before it has read everything.
        let _ = write!(stream, "{method} {path} HTTP/1.1\r\nConnection: close\r\n{lines}\r\n");
        answer(&mut stream)
    }

    /// Sends a request with the cookie, as the page does.
    pub fn get(&self, path: &str) -> Answer {
        let cookie = self.cookie.iter().map(|cookie| format!("Cookie: {cookie}"));
        let lines: Vec<String> = cookie.chain([format!("Host: {}", self.host())]).collect();
        self.request("GET", path, &lines.iter().map(String::as_str).collect::<Vec<_>>())
    }

    /// Uploads the body of a drop, as the page does.
    pub fn upload(&self, body: &[u8]) -> Answer {
        let mut stream = self.begin_upload(&format!("Content-Length: {}", body.len()));
        // The server may answer before it has read everything.
        let _ = stream.write_all(body);
        answer(&mut stream)
    }

    /// Sends the head of an upload with a header that states the length of its body.
    pub fn begin_upload(&self, length: &str) -> TcpStream {
        let mut stream = self.connect();
        let cookie = self.cookie.iter().map(|cookie| format!("Cookie: {cookie}\r\n")).collect::<String>();
        let host = self.host();
        write!(
            stream,
            "POST /drop HTTP/1.1\r\nConnection: close\r\nHost: {host}\r\nOrigin: http://{host}\r\n{cookie}{length}\r\n\r\n"
        )
        .unwrap();
        stream
    }

    /// Returns whether the server still delivers the page.
    pub fn is_alive(&self) -> bool {
        self.get("/").status == 200
    }

    /// Opens a WebSocket with these headers in addition to the usual ones.
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

    /// Waits until a line of the log contains `part`.
    pub fn wait_for_line(&self, part: &str) {
        let has = || self.log.lock().unwrap().iter().any(|line| line.contains(part));
        wait_until(&format!("a line with `{part}` in {:?}", self.log), has);
    }
}

/// Reads until the server closes the connection.
pub fn answer(stream: &mut TcpStream) -> Answer {
    let mut bytes = Vec::new();
    let _ = stream.read_to_end(&mut bytes);
    let split = bytes.windows(4).position(|four| four == b"\r\n\r\n").unwrap_or(bytes.len());
    let head = String::from_utf8_lossy(&bytes[..split]).into_owned();
    let status = head.split(' ').nth(1).and_then(|number| number.parse().ok()).unwrap_or(0);
    Answer { status, head, body: bytes.get(split + 4..).unwrap_or_default().to_vec() }
}

/// Waits for a condition, at most [`PATIENCE`].
pub fn wait_until(what: &str, mut condition: impl FnMut() -> bool) {
    let start = Instant::now();
    while !condition() {
        assert!(start.elapsed() < PATIENCE, "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// WebSocket of a page.
pub struct Page {
    pub socket: WebSocket<TcpStream>,
}

/// Header of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Head {
    pub serial: u32,
    pub kind: u32,
    pub number: u64,
    pub revision: u64,
    pub size: [u32; 2],
    pub samples: f32,
}

/// Message to a page.
#[derive(Debug)]
pub enum Received {
    Text(String, Value),
    Frame(Head, Vec<u8>),
}

impl Page {
    pub fn send(&mut self, message: &str) {
        self.socket.send(Message::text(message)).unwrap();
    }

    /// Returns the next message; `None` once the socket is closed.
    pub fn receive(&mut self) -> Option<Received> {
        loop {
            match self.socket.read() {
                Ok(Message::Text(text)) => {
                    let message: Value = serde_json::from_str(&text).unwrap();
                    let (kind, value) = message.as_object().unwrap().iter().next().unwrap();
                    return Some(Received::Text(kind.clone(), value.clone()));
                }
                Ok(Message::Binary(bytes)) => return Some(frame(&bytes)),
                Ok(Message::Close(_)) | Err(_) => return None,
                Ok(_) => {}
            }
        }
    }

    /// Returns the next text message of a kind that fits, and acknowledges frames meanwhile.
    pub fn next_text(&mut self, kind: &str, mut fits: impl FnMut(&Value) -> bool) -> Value {
        let start = Instant::now();
        loop {
            assert!(start.elapsed() < PATIENCE, "no {kind}");
            match self.receive().expect("the socket was closed") {
                Received::Text(name, value) if name == kind && fits(&value) => return value,
                Received::Frame(head, _) => self.send(&format!("{{\"ack\": {}}}", head.serial)),
                Received::Text(..) => {}
            }
        }
    }

    /// Returns the next frame that fits, and acknowledges all frames.
    pub fn next_frame(&mut self, mut fits: impl FnMut(&Head) -> bool) -> (Head, Vec<u8>) {
        let start = Instant::now();
        loop {
            assert!(start.elapsed() < PATIENCE, "no picture");
            if let Received::Frame(head, image) = self.receive().expect("the socket was closed") {
                self.send(&format!("{{\"ack\": {}}}", head.serial));
                if fits(&head) {
                    return (head, image);
                }
            }
        }
    }
}

fn frame(bytes: &[u8]) -> Received {
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
    Received::Frame(head, bytes[juggler_serve::HEADER_BYTES..].to_vec())
}

impl Page {
    /// Answers pings for some time. Returns whether the socket is still open.
    pub fn receive_for(&mut self, time: Duration) -> bool {
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
