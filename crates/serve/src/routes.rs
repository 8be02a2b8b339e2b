//! What there is at which address. Nothing changes by a plain request; all changes come through the WebSocket.

use crate::accept::Place;
use crate::access::{Entry, Peer};
use crate::assets::ASSETS;
use crate::hub::Hub;
use crate::socket;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::ws::rejection::WebSocketUpgradeRejection;
use axum::extract::{Path, Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use axum::{Extension, Router};
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;

/// Sent with everything: nothing from elsewhere, nothing kept, no page of others around it.
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

/// All addresses, behind the rules of [`crate::access`].
pub fn router(hub: Arc<Hub>) -> Router {
    let mut router = Router::new()
        .route("/catalogue.json", get(catalogue))
        .route("/thumbnail/{name}", get(thumbnail))
        .route("/save/{name}", get(save))
        .route("/socket", get(open_socket));
    for asset in ASSETS {
        router = router.route(asset.path, get(|| async { ([(header::CONTENT_TYPE, asset.media_type)], asset.text) }));
    }
    let nothing = (StatusCode::NOT_FOUND, "there is nothing here\n");
    router.fallback(move || async move { nothing }).layer(from_fn_with_state(Arc::clone(&hub), guard)).with_state(hub)
}

/// Lets in, or says why not; and the headers that everything has.
async fn guard(
    State(hub): State<Arc<Hub>>,
    Extension(peer): Extension<Peer>,
    Extension(place): Extension<Place>,
    request: Request,
    next: Next,
) -> Response {
    place.served.store(true, Relaxed);
    let (parts, body) = request.into_parts();
    let entry = hub.access.check(&parts, peer);
    let mut response = match &entry {
        Ok(_) => next.run(Request::from_parts(parts, body)).await,
        Err(why) => {
            hub.refusals.say(peer.remote, why);
            (StatusCode::FORBIDDEN, format!("{why}\n")).into_response()
        }
    };
    let headers = response.headers_mut();
    for (name, value) in HEADERS {
        headers.insert(name, HeaderValue::from_static(value));
    }
    if entry == Ok(Entry::ByAddress) {
        hub.access.cookie().map(|cookie| headers.insert(header::SET_COOKIE, cookie));
    }
    response
}

async fn catalogue(State(hub): State<Arc<Hub>>) -> Response {
    ([(header::CONTENT_TYPE, "application/json")], hub.catalogue.text().to_owned()).into_response()
}

async fn thumbnail(Path(name): Path<String>) -> Response {
    match name.strip_suffix(".jpg").and_then(juggler_session::thumbnail) {
        Some(picture) => ([(header::CONTENT_TYPE, "image/jpeg")], picture).into_response(),
        None => (StatusCode::NOT_FOUND, "there is no such picture\n").into_response(),
    }
}

/// The picture as it is now, as a download: `/save/picture.png`, `/save/picture.exr`.
async fn save(State(hub): State<Arc<Hub>>, Path(name): Path<String>) -> Response {
    let (format, media_type) = match name.as_str() {
        "picture.png" => ("png", "image/png"),
        "picture.exr" => ("exr", "image/x-exr"),
        _ => return (StatusCode::NOT_FOUND, "pictures are saved as picture.png or picture.exr\n").into_response(),
    };
    let Ok(_turn) = hub.saving.acquire().await else { return StatusCode::SERVICE_UNAVAILABLE.into_response() };
    let session = hub.session.clone();
    let encoded = tokio::task::spawn_blocking(move || session.encoded(format)).await;
    match encoded {
        Ok(Ok(bytes)) => {
            let disposition = format!("attachment; filename=\"{}.{format}\"", file_stem(&hub.session.status().scene));
            ([(header::CONTENT_TYPE, media_type.to_owned()), (header::CONTENT_DISPOSITION, disposition)], bytes)
                .into_response()
        }
        Ok(Err(error)) => (StatusCode::CONFLICT, format!("{error}\n")).into_response(),
        Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

/// A name that is harmless in a header and on any disk.
fn file_stem(scene: &str) -> String {
    let stem = std::path::Path::new(scene).file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '_' };
    let name: String = stem.chars().take(80).map(plain).collect();
    if name.is_empty() { "picture".into() } else { name }
}

async fn open_socket(
    State(hub): State<Arc<Hub>>,
    Extension(peer): Extension<Peer>,
    Extension(place): Extension<Place>,
    headers: HeaderMap,
    upgrade: Result<WebSocketUpgrade, WebSocketUpgradeRejection>,
) -> Response {
    let upgrade = match upgrade {
        Ok(upgrade) if headers.contains_key(header::ORIGIN) => upgrade,
        Ok(_) => return (StatusCode::FORBIDDEN, "no Origin\n").into_response(),
        Err(rejection) => return rejection.into_response(),
    };
    let Ok(seat) = Arc::clone(&hub.sockets).try_acquire_owned() else {
        hub.refusals.say(peer.remote, "too many pages");
        return (StatusCode::SERVICE_UNAVAILABLE, "too many pages are open\n").into_response();
    };
    let most = hub.limits.message_bytes;
    upgrade.max_message_size(most).max_frame_size(most).on_upgrade(move |socket| async move {
        let _held = (seat, place);
        socket::run(socket, hub, peer).await;
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
