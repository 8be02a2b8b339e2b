//! Connections: how many there may be, and how long each may take.

use crate::access::Peer;
use crate::hub::Hub;
use crate::server::Limits;
use axum::{Extension, Router};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

/// Bytes of a request's head.
const HEAD_BYTES: usize = 32 << 10;
/// What a connection too many is told.
const FULL: &[u8] =
    b"HTTP/1.1 503 Service Unavailable\r\ncontent-length: 20\r\nconnection: close\r\n\r\ntoo many connections";
/// Waiting after an error of the listener, such as too many open files.
const PAUSE: Duration = Duration::from_millis(100);

/// Takes connections for ever.
pub async fn run(listener: TcpListener, router: Router, hub: Arc<Hub>, limits: Limits) {
    let places = Arc::new(Semaphore::new(limits.connections));
    loop {
        let (stream, remote) = match listener.accept().await {
            Ok(accepted) => accepted,
            Err(error) => {
                hub.refusals.say("a connection", &error.to_string());
                tokio::time::sleep(PAUSE).await;
                continue;
            }
        };
        let Ok(place) = Arc::clone(&places).try_acquire_owned() else {
            hub.refusals.say(remote, "too many connections");
            let _ = stream.try_write(FULL);
            continue;
        };
        let Ok(local) = stream.local_addr() else { continue };
        let router = router.clone().layer(Extension(Peer { remote, local }));
        let hub = Arc::clone(&hub);
        tokio::spawn(async move {
            if let Err(why) = answer(stream, router, limits, place).await {
                hub.refusals.say(remote, &why);
            }
        });
    }
}

/// One connection, until it ends or becomes a WebSocket, which has a place of its own and this one too.
async fn answer(stream: TcpStream, router: Router, limits: Limits, place: OwnedSemaphorePermit) -> Result<(), String> {
    // Small messages go at once: they are what one waits for.
    stream.set_nodelay(true).map_err(|error| error.to_string())?;
    // Browsers open connections ahead of need: one that says nothing is closed without a word.
    if tokio::time::timeout(limits.head, stream.readable()).await.is_err() {
        return Ok(());
    }
    let place = Place { seat: Arc::new(place), served: Arc::default() };
    let served = Arc::clone(&place.served);
    let service = TowerToHyperService::new(router.layer(Extension(place)));
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(limits.head)
        .max_buf_size(HEAD_BYTES)
        .serve_connection(TokioIo::new(stream), service)
        .with_upgrades();
    match tokio::time::timeout(limits.connection, connection).await {
        Ok(Err(error)) if error.is_timeout() && !served.load(Relaxed) => Err("the request's head took too long".into()),
        Ok(Err(error)) if error.is_parse() || error.is_parse_too_large() => Err(format!("no HTTP: {error}")),
        // Others went away, which they may.
        Ok(Ok(()) | Err(_)) => Ok(()),
        Err(_) => Err("the connection lasted too long".into()),
    }
}

/// A connection's place among those that may be there; a WebSocket holds it on.
#[derive(Clone)]
pub struct Place {
    #[expect(dead_code, reason = "held, not read")]
    seat: Arc<OwnedSemaphorePermit>,
    /// Whether a request came: what is kept open after it is no attack.
    pub served: Arc<AtomicBool>,
}
