//! Connections: their maximum number and duration.

use crate::access::Peer;
use crate::server::Limits;
use crate::state::ServerState;
use axum::{Extension, Router};
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

/// Maximum size of a request head, in bytes.
const HEAD_BYTES: usize = 32 << 10;
/// Answer to connections beyond the limit.
const FULL: &[u8] =
    b"HTTP/1.1 503 Service Unavailable\r\ncontent-length: 20\r\nconnection: close\r\n\r\ntoo many connections";
/// Pause after an error of the listener, such as too many open files.
const PAUSE: Duration = Duration::from_millis(100);

/// Accepts connections forever.
pub async fn run(listener: TcpListener, router: Router, state: Arc<ServerState>, limits: Limits) {
    let permits = Arc::new(Semaphore::new(limits.connections));
    loop {
        let (stream, remote) = match listener.accept().await {
            Ok(accepted) => accepted,
            Err(error) => {
                state.refusals.log("a connection", &error.to_string());
                tokio::time::sleep(PAUSE).await;
                continue;
            }
        };
        let Ok(permit) = Arc::clone(&permits).try_acquire_owned() else {
            state.refusals.log(remote, "too many connections");
            let _ = stream.try_write(FULL);
            continue;
        };
        let Ok(local) = stream.local_addr() else { continue };
        let router = router.clone().layer(Extension(Peer { remote, local }));
        let state = Arc::clone(&state);
        tokio::spawn(async move {
            if let Err(why) = answer(stream, router, limits, permit).await {
                state.refusals.log(remote, &why);
            }
        });
    }
}

/// Serves one connection until it ends or becomes a WebSocket. A WebSocket keeps this permit and
/// needs one of its own.
async fn answer(stream: TcpStream, router: Router, limits: Limits, permit: OwnedSemaphorePermit) -> Result<(), String> {
    // Send small messages without delay, since people wait for them.
    stream.set_nodelay(true).map_err(|error| error.to_string())?;
    // Browsers open connections in advance, so close unused ones without logging them.
    if tokio::time::timeout(limits.head, stream.readable()).await.is_err() {
        return Ok(());
    }
    let permit = ConnectionPermit { permit: Arc::new(permit), served: Arc::default() };
    let served = Arc::clone(&permit.served);
    let service = TowerToHyperService::new(router.layer(Extension(permit)));
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(limits.head)
        .max_buf_size(HEAD_BYTES)
        .serve_connection(TokioIo::new(stream), service)
        .with_upgrades();
    match tokio::time::timeout(limits.connection, connection).await {
        Ok(Err(error)) if error.is_timeout() && !served.load(Relaxed) => {
            Err("the header of a request took too long".into())
        }
        Ok(Err(error)) if error.is_parse() || error.is_parse_too_large() => Err(format!("not HTTP: {error}")),
        // The client closed the connection.
        Ok(Ok(()) | Err(_)) => Ok(()),
        Err(_) => Err("the connection lasted too long".into()),
    }
}

/// Permit of a connection, which a WebSocket keeps.
#[derive(Clone)]
pub struct ConnectionPermit {
    #[expect(dead_code, reason = "held, not read")]
    permit: Arc<OwnedSemaphorePermit>,
    /// Whether a request has arrived; idle time after it is no attack.
    pub served: Arc<AtomicBool>,
}
