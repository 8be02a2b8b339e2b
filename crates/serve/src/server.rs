//! The handles that programs hold.

use crate::accept;
use crate::access::{Access, Token};
use crate::hub::Hub;
use crate::refusals::Refusals;
use crate::routes;
use juggler_session::Session;
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::time::Duration;
use tokio::runtime::{Builder, Runtime};

/// Threads that serve; they only hand on what others made.
const THREADS: usize = 2;
/// Threads that encode pictures and render thumbnails.
const ENCODERS: usize = 4;

/// What a server is opened with.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Where it listens; port 0 takes a free one.
    pub address: SocketAddr,
    /// Whether the address may be one that other machines reach.
    pub allow_remote: bool,
    /// Whether every request needs the token that [`Server::url`] contains. `true` by default. `false` opens a loopback
    /// server to every user and program of this machine; a server that other machines reach has a token in any case.
    pub token: bool,
    /// The scene file that pages may go back to, besides built-in scenes, as the session was opened with it.
    pub scene: Option<String>,
    /// How much of anything there may be.
    pub limits: Limits,
}

impl Default for Options {
    fn default() -> Self {
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, 8080));
        Self { address, allow_remote: false, token: true, scene: None, limits: Limits::default() }
    }
}

/// How much of anything there may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Connections of any kind; those beyond are answered 503 and closed.
    pub connections: usize,
    /// WebSockets among them.
    pub sockets: usize,
    /// Bytes of a message of a page.
    pub message_bytes: usize,
    /// How long the head of a request may take.
    pub head: Duration,
    /// How long a plain connection may last.
    pub connection: Duration,
    /// How long a page may be silent; it is asked for a sign of life three times as often.
    pub silence: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            connections: 64,
            sockets: 16,
            message_bytes: 64 << 10,
            head: Duration::from_secs(10),
            connection: Duration::from_secs(600),
            silence: Duration::from_secs(90),
        }
    }
}

/// Why there is no server.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// Nobody asked for a server that others reach.
    #[error(
        "{0} can be reached from other machines: an ssh tunnel to 127.0.0.1 is safer; `--allow-remote` serves there"
    )]
    Remote(SocketAddr),
    /// The port is taken.
    #[error("{0} is in use by another program: `--addr 127.0.0.1:0` takes a free port")]
    Busy(SocketAddr),
    /// The address cannot be listened at.
    #[error("cannot listen at {address}: {source}")]
    Listen {
        /// Which.
        address: SocketAddr,
        /// Why.
        source: io::Error,
    },
    /// The system gives no threads or no random numbers.
    #[error("cannot serve: {0}")]
    System(io::Error),
}

/// A server that listens, but does not answer yet.
pub struct Server {
    listener: TcpListener,
    address: SocketAddr,
    token: Option<Token>,
    session: Session,
    options: Options,
    refusals: Refusals,
}

impl Server {
    /// Listens. `log` gets one line for each thing that is refused, not too many of them, from any thread.
    pub fn bind(
        session: Session,
        options: Options,
        log: impl Fn(&str) + Send + Sync + 'static,
    ) -> Result<Self, ServeError> {
        let asked = options.address;
        let remote = !asked.ip().is_loopback();
        if remote && !options.allow_remote {
            return Err(ServeError::Remote(asked));
        }
        let listener = TcpListener::bind(asked).map_err(|source| match source.kind() {
            io::ErrorKind::AddrInUse => ServeError::Busy(asked),
            _ => ServeError::Listen { address: asked, source },
        })?;
        listener.set_nonblocking(true).map_err(ServeError::System)?;
        let address = listener.local_addr().map_err(ServeError::System)?;
        let token = (remote || options.token).then(Token::random).transpose().map_err(ServeError::System)?;
        Ok(Self { listener, address, token, session, options, refusals: Refusals::new(log) })
    }

    /// Where it listens; the port is the one it got.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// What to open in a browser; with the token, where requests need one. An address that means all of this machine's is
    /// shown as it is: the reader knows by which name the machine is reached.
    pub fn url(&self) -> String {
        match &self.token {
            Some(token) => format!("http://{}/?token={}", self.address, token.text()),
            None => format!("http://{}/", self.address),
        }
    }

    /// Serves from now on.
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
        let hub = Arc::new(Hub::new(self.session, self.options, access, self.refusals));
        let router = routes::router(Arc::clone(&hub));
        runtime.spawn(accept::run(listener, router, hub, limits));
        Ok(Running { runtime: Some(runtime) })
    }
}

/// A server at work; it ends when this is dropped. The session goes on.
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
