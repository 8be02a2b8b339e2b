//! Routes of the server. Plain requests change nothing; all changes arrive through the WebSocket.
//! Uploaded files wait until a page opens them through its WebSocket.

use crate::accept::ConnectionPermit;
use crate::access::{Authorization, Peer};
use crate::assets::ASSETS;
use crate::dropped;
use crate::server::Limits;
use crate::socket;
use crate::state::ServerState;
use axum::body::{Body, HttpBody};
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::ws::rejection::WebSocketUpgradeRejection;
use axum::extract::{Path, Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Extension, Router};
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;

/// Headers of every response: no foreign resources, no caching, no embedding in other pages.
const HEADERS: [(HeaderName, &str); 6] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'self'; img-src 'self' blob:; object-src 'none'; base-uri 'none'; form-action 'none'; \
         frame-ancestors 'none'",
    ),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::X_FRAME_OPTIONS, "DENY"),
    (header::CACHE_CONTROL, "no-store"),
    (header::REFERRER_POLICY, "no-referrer"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
];

/// Returns all routes, protected by the rules of [`crate::access`].
pub fn router(state: Arc<ServerState>) -> Router {
    let mut router = Router::new()
        .route("/catalogue.json", get(catalog))
        .route("/thumbnail/{name}", get(thumbnail))
        .route("/save/{name}", get(save))
        .route("/drop", post(keep_dropped))
        .route("/socket", get(open_socket));
    for asset in ASSETS {
        router = router.route(asset.path, get(|| async { ([(header::CONTENT_TYPE, asset.media_type)], asset.text) }));
    }
    let nothing = (StatusCode::NOT_FOUND, "there is no such page\n");
    router
        .fallback(move || async move { nothing })
        .layer(from_fn_with_state(Arc::clone(&state), guard))
        .with_state(state)
}

/// Checks access, and adds the common headers to the response.
async fn guard(
    State(state): State<Arc<ServerState>>,
    Extension(peer): Extension<Peer>,
    Extension(permit): Extension<ConnectionPermit>,
    request: Request,
    next: Next,
) -> Response {
    permit.served.store(true, Relaxed);
    let (parts, body) = request.into_parts();
    let authorization = state.access.check(&parts, peer);
    let mut response = match &authorization {
        Ok(_) => next.run(Request::from_parts(parts, body)).await,
        Err(why) => {
            state.refusals.log(peer.remote, why);
            (StatusCode::FORBIDDEN, format!("{why}\n")).into_response()
        }
    };
    let headers = response.headers_mut();
    for (name, value) in HEADERS {
        headers.insert(name, HeaderValue::from_static(value));
    }
    if authorization == Ok(Authorization::ByUrl) {
        state.access.cookie().map(|cookie| headers.insert(header::SET_COOKIE, cookie));
    }
    response
}

async fn catalog(State(state): State<Arc<ServerState>>) -> Response {
    ([(header::CONTENT_TYPE, "application/json")], state.catalog.text().to_owned()).into_response()
}

async fn thumbnail(Path(name): Path<String>) -> Response {
    match name.strip_suffix(".jpg").and_then(juggler_session::thumbnail) {
        Some(picture) => ([(header::CONTENT_TYPE, "image/jpeg")], picture).into_response(),
        None => (StatusCode::NOT_FOUND, "there is no such picture\n").into_response(),
    }
}

/// Returns the current image as a download: `/save/picture.png`, `/save/picture.exr`.
async fn save(State(state): State<Arc<ServerState>>, Path(name): Path<String>) -> Response {
    let (format, media_type) = match name.as_str() {
        "picture.png" => ("png", "image/png"),
        "picture.exr" => ("exr", "image/x-exr"),
        _ => return (StatusCode::NOT_FOUND, "pictures are saved as picture.png or picture.exr\n").into_response(),
    };
    let Ok(_turn) = state.saving.acquire().await else { return StatusCode::SERVICE_UNAVAILABLE.into_response() };
    let session = state.session.clone();
    let encoded = tokio::task::spawn_blocking(move || session.encode(format)).await;
    match encoded {
        Ok(Ok(bytes)) => {
            let disposition = format!("attachment; filename=\"{}.{format}\"", file_stem(&state.session.status().scene));
            ([(header::CONTENT_TYPE, media_type.to_owned()), (header::CONTENT_DISPOSITION, disposition)], bytes)
                .into_response()
        }
        Ok(Err(error)) => (StatusCode::CONFLICT, format!("{error}\n")).into_response(),
        Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

/// Receives files that were dropped on a page, and answers with the number under which the page
/// opens them. The stated length is judged before any byte is read.
async fn keep_dropped(State(state): State<Arc<ServerState>>, Extension(peer): Extension<Peer>, body: Body) -> Response {
    let Limits { dropped_bytes, upload_silence, .. } = state.limits;
    let length = body.size_hint().exact();
    if length.is_some_and(|length| length > dropped_bytes) {
        let reason =
            format!("the files have more than {:.1} MiB, the limit\n", dropped_bytes as f64 / f64::from(1 << 20));
        return last_response(StatusCode::PAYLOAD_TOO_LARGE, reason);
    }
    let Some(memory) = state.uploads.reserve(length.unwrap_or(dropped_bytes)) else {
        return last_response(StatusCode::SERVICE_UNAVAILABLE, "other pages upload files\n".to_owned());
    };
    match dropped::receive(body, length, dropped_bytes, upload_silence).await {
        Ok(files) => state.uploads.keep(files, memory).to_string().into_response(),
        Err(error) => {
            state.refusals.log(peer.remote, &error.to_string());
            last_response(error.status(), format!("{error}\n"))
        }
    }
}

/// Response to a request whose body is not read, after which the connection ends.
fn last_response(status: StatusCode, text: String) -> Response {
    (status, [(header::CONNECTION, "close")], text).into_response()
}

/// Returns a file name that is safe in a header and on any file system.
fn file_stem(scene: &str) -> String {
    let stem = std::path::Path::new(scene).file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '_' };
    let name: String = stem.chars().take(80).map(plain).collect();
    if name.is_empty() { "picture".into() } else { name }
}

async fn open_socket(
    State(state): State<Arc<ServerState>>,
    Extension(peer): Extension<Peer>,
    Extension(permit): Extension<ConnectionPermit>,
    headers: HeaderMap,
    upgrade: Result<WebSocketUpgrade, WebSocketUpgradeRejection>,
) -> Response {
    let upgrade = match upgrade {
        Ok(upgrade) if headers.contains_key(header::ORIGIN) => upgrade,
        Ok(_) => return (StatusCode::FORBIDDEN, "the request has no Origin header\n").into_response(),
        Err(rejection) => return rejection.into_response(),
    };
    let Ok(socket_permit) = Arc::clone(&state.sockets).try_acquire_owned() else {
        state.refusals.log(peer.remote, "too many pages");
        return (StatusCode::SERVICE_UNAVAILABLE, "too many pages are open\n").into_response();
    };
    let most = state.limits.message_bytes;
    upgrade.max_message_size(most).max_frame_size(most).on_upgrade(move |socket| async move {
        let _held = (socket_permit, permit);
        socket::run(socket, state, peer).await;
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn saved_pictures_have_harmless_names() {
        let names = ["scenes/juggler.json", "juggler", "a\"b\r\nc.json", "", "../..", "Ä b.json"].map(file_stem);
        assert_eq!(names, ["juggler", "juggler", "a_b__c", "picture", "picture", "__b"]);
    }
}
