//! Server handles for programs.

use crate::accept;
use crate::access::{Access, Token};
use crate::refusal_log::RefusalLog;
use crate::routes;
use crate::state::ServerState;
use juggler_session::Session;
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::time::Duration;
use tokio::runtime::{Builder, Runtime};

/// Number of server threads, which only forward data.
const THREADS: usize = 2;
/// Maximum number of threads that encode images.
const ENCODERS: usize = 4;

/// Options with which a server is opened.
#[derive(Clone, Debug, PartialEq)]
pub struct ServerOptions {
    /// Address to listen at; port 0 selects a free one.
    pub address: SocketAddr,
    /// Whether the address may be reachable from other machines.
    pub allow_remote: bool,
    /// Whether every request needs the token that [`Server::url`] contains; `true` by default.
    /// `false` opens a loopback server to every user and program of this machine. A server that
    /// other machines can reach always has a token.
    pub token: bool,
    /// Scene file that pages may open besides built-in scenes, named as when the session was
    /// opened.
    pub scene: Option<String>,
    /// Resource limits.
    pub limits: Limits,
}

impl Default for ServerOptions {
    fn default() -> Self {
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, 8080));
        Self { address, allow_remote: false, token: true, scene: None, limits: Limits::default() }
    }
}

/// Resource limits of a server.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Maximum number of connections, 64 by default; further ones are answered with status 503 and
    /// closed.
    pub connections: usize,
    /// Maximum number of WebSockets among them, 16 by default.
    pub sockets: usize,
    /// Maximum size of a page's message, in bytes; 64 KiB by default.
    pub message_bytes: usize,
    /// Maximum size of the files that are dropped on a page at once, in bytes; 1 GiB by default.
    /// They stay in memory.
    pub dropped_bytes: u64,
    /// Maximum size of all files that pages upload at the same time or that wait to be opened, in
    /// bytes; 2 GiB by default.
    pub dropped_total_bytes: u64,
    /// Time without a byte after which an upload ends, 10 seconds by default.
    pub upload_silence: Duration,
    /// Maximum time to receive the head of a request, 10 seconds by default.
    pub head: Duration,
    /// Maximum duration of a connection that is no WebSocket, 10 minutes by default.
    pub connection: Duration,
    /// Time without messages after which a page is disconnected, 90 seconds by default. The server
    /// sends a ping after each third of it.
    pub silence: Duration,
}

impl Limits {
    /// The same limits, with at most half of `bytes`, the memory of the program, for dropped files: the
    /// scene that is made of them needs memory, too.
    #[must_use]
    pub fn with_memory(self, bytes: u64) -> Self {
        let dropped_total_bytes = self.dropped_total_bytes.min(bytes / 2);
        Self { dropped_bytes: self.dropped_bytes.min(dropped_total_bytes), dropped_total_bytes, ..self }
    }
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            connections: 64,
            sockets: 16,
            message_bytes: 64 << 10,
            dropped_bytes: 1 << 30,
            dropped_total_bytes: 2 << 30,
            upload_silence: Duration::from_secs(10),
            head: Duration::from_secs(10),
            connection: Duration::from_secs(600),
            silence: Duration::from_secs(90),
        }
    }
}

/// Error of starting a server.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ServeError {
    /// The address is reachable from other machines, which the options do not allow.
    #[error(
        "{0} can be reached from other machines: an ssh tunnel to 127.0.0.1 is safer; `--allow-remote` serves there"
    )]
    Remote(SocketAddr),
    /// The port is in use.
    #[error("{0} is in use by another program: `--addr 127.0.0.1:0` takes a free port")]
    Busy(SocketAddr),
    /// The server cannot listen at the address.
    #[error("cannot listen at {address}: {source}")]
    Listen {
        /// Requested address.
        address: SocketAddr,
        /// Cause.
        source: io::Error,
    },
    /// The system provides no threads or random numbers.
    #[error("cannot serve: {0}")]
    System(io::Error),
}

/// Server that listens but does not answer yet.
pub struct Server {
    listener: TcpListener,
    address: SocketAddr,
    token: Option<Token>,
    session: Session,
    options: ServerOptions,
    refusals: RefusalLog,
}

impl Server {
    /// Opens the port. `log` receives one line per refusal, with a rate limit, from any thread.
    /// Fails if the port is not available, or the address is remote and not allowed.
    pub fn bind(
        session: Session,
        options: ServerOptions,
        log: impl Fn(&str) + Send + Sync + 'static,
    ) -> Result<Self, ServeError> {
        let requested = options.address;
        let remote = !requested.ip().is_loopback();
        if remote && !options.allow_remote {
            return Err(ServeError::Remote(requested));
        }
        let listener = TcpListener::bind(requested).map_err(|source| match source.kind() {
            io::ErrorKind::AddrInUse => ServeError::Busy(requested),
            _ => ServeError::Listen { address: requested, source },
        })?;
        listener.set_nonblocking(true).map_err(ServeError::System)?;
        let address = listener.local_addr().map_err(ServeError::System)?;
        let token = (remote || options.token).then(Token::random).transpose().map_err(ServeError::System)?;
        Ok(Self { listener, address, token, session, options, refusals: RefusalLog::new(log) })
    }

    /// Returns the address with the actual port.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Returns the URL to open in a browser, with the token if requests need one. An unspecified
    /// address is shown as it is, since the reader knows the machine's name.
    pub fn url(&self) -> String {
        match &self.token {
            Some(token) => format!("http://{}/?token={}", self.address, token.text()),
            None => format!("http://{}/", self.address),
        }
    }

    /// Starts to serve.
    pub fn start(self) -> Result<Running, ServeError> {
        let runtime = Builder::new_multi_thread()
            .worker_threads(THREADS)
            .max_blocking_threads(ENCODERS)
            .thread_name("juggler-serve")
            .enable_all()
            .build()
            .map_err(ServeError::System)?;
        let guard = runtime.enter();
        let listener = tokio::net::TcpListener::from_std(self.listener).map_err(ServeError::System)?;
        drop(guard);
        let access = Access::new(self.address.port(), self.token);
        let limits = self.options.limits;
        let state = Arc::new(ServerState::new(self.session, self.options, access, self.refusals));
        let router = routes::router(Arc::clone(&state));
        runtime.spawn(accept::run(listener, router, state, limits));
        Ok(Running { runtime: Some(runtime) })
    }
}

/// Running server. Dropping it ends the server but not the session.
pub struct Running {
    runtime: Option<Runtime>,
}

impl Drop for Running {
    fn drop(&mut self) {
        if let Some(runtime) = self.runtime.take() {
            runtime.shutdown_background();
        }
    }
}
