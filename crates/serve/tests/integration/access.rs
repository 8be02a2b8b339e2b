//! Access rules, one test each.
use crate::common::{Serving, serve, serve_open, serve_with};
use juggler_serve::{ServeError, Server, ServerOptions};
use std::net::SocketAddr;

/// Starts a server at all addresses, which other machines could reach; the test uses the loopback
/// address.
fn serve_remote() -> Serving {
    let address = SocketAddr::from(([0, 0, 0, 0], 0));
    serve_with(ServerOptions { address, allow_remote: true, ..ServerOptions::default() })
}

#[test]
fn server_listens_on_loopback_by_default() {
    assert!(ServerOptions::default().address.ip().is_loopback());
    let session = crate::common::small_session();
    let options = ServerOptions { address: SocketAddr::from(([0, 0, 0, 0], 0)), ..ServerOptions::default() };
    assert!(matches!(Server::bind(session, options, |_| ()), Err(ServeError::Remote(_))));
    assert!(serve().is_alive());
}

#[test]
fn busy_port_is_reported() {
    let serving = serve();
    let options = ServerOptions { address: serving.address, ..ServerOptions::default() };
    let error = Server::bind(crate::common::small_session(), options, |_| ()).err().unwrap();
    assert!(matches!(error, ServeError::Busy(_)), "{error}");
}

#[test]
fn foreign_host_headers_are_rejected() {
    let serving = serve_open();
    let port = serving.address.port();
    for own in [format!("localhost:{port}"), format!("127.0.0.1:{port}"), format!("[::1]:{port}")] {
        assert_eq!(serving.request("GET", "/", &[&format!("Host: {own}")]).status, 200, "{own}");
    }
    let foreign =
        [format!("evil.example:{port}"), "localhost".into(), format!("localhost:{}", port ^ 1), String::new()];
    for host in foreign {
        assert_eq!(serving.request("GET", "/", &[&format!("Host: {host}")]).status, 403, "{host:?}");
    }
    let own = format!("Host: {}", serving.host());
    assert_eq!(serving.request("GET", "/", &[]).status, 403, "no Host");
    assert_eq!(serving.request("GET", "/", &[&own, "Host: evil.example"]).status, 403, "two of them");
    assert_eq!(serving.request("GET", &format!("http://evil.example:{port}/"), &[&own]).status, 403, "in the address");
    let page = serving.open("/socket", &[("Host", "evil.example"), ("Origin", "http://evil.example")]);
    assert_eq!(page.err(), Some(403), "a rebound name");
    serving.wait_for_line("the Host header names another server");
}

#[test]
fn pages_of_other_sites_get_no_socket() {
    let serving = serve_open();
    let own = format!("http://{}", serving.host());
    assert!(serving.open("/socket", &[("Origin", &own)]).is_ok());
    let port = serving.address.port();
    let foreign = [
        "http://evil.example".into(),
        format!("http://localhost:{port}"),
        format!("{own}.evil.example"),
        "null".into(),
    ];
    for origin in foreign {
        assert_eq!(serving.open("/socket", &[("Origin", &origin)]).err(), Some(403), "{origin}");
    }
    assert_eq!(serving.open("/socket", &[]).err(), Some(403), "the request has no Origin header");
    serving.wait_for_line("Origin");
    // Other requests are refused too.
    let host = format!("Host: {}", serving.host());
    assert_eq!(serving.request("GET", "/save/picture.png", &[&host, "Origin: http://evil.example"]).status, 403);
}

#[test]
fn methods_that_change_state_are_rejected() {
    let serving = serve_open();
    let (host, own) = (format!("Host: {}", serving.host()), format!("Origin: http://{}", serving.host()));
    for method in ["POST", "PUT", "DELETE", "PATCH", "OPTIONS", "NONSENSE"] {
        for path in ["/", "/socket", "/save/picture.png", "/catalogue.json"] {
            assert_eq!(serving.request(method, path, &[&host, &own]).status, 405, "{method} {path}");
            assert_eq!(serving.request(method, path, &[&host]).status, 403, "{method} {path} without Origin");
        }
    }
}

/// Asserts that every request needs the token.
fn needs_its_token(serving: &Serving) {
    let token = serving.url.split_once("?token=").expect("an address with a token").1;
    assert_eq!(token.len(), 32);
    let own = format!("http://{}", serving.host());
    let host = format!("Host: {}", serving.host());
    let paths = ["/", "/page.js", "/catalogue.json", "/thumbnail/one-sphere.jpg", "/save/picture.png", "/socket", "/x"];
    let other = "0".repeat(32);
    for path in paths {
        assert_eq!(serving.request("GET", path, &[&host]).status, 403, "{path}");
        for wrong in ["", &token[..31], &format!("{token}0"), &other] {
            assert_eq!(
                serving.request("GET", &format!("{path}?token={wrong}"), &[&host]).status,
                403,
                "{path} {wrong}"
            );
            let cookie = format!("Cookie: juggler_{}={wrong}", serving.address.port());
            assert_eq!(serving.request("GET", path, &[&host, &cookie]).status, 403);
        }
    }
    assert_eq!(serving.open("/socket", &[("Origin", &own)]).err(), Some(403));
    assert!(serving.open(&format!("/socket?token={token}"), &[("Origin", &own)]).is_ok());
    serving.wait_for_line("no token");
    assert!(serving.log.lock().unwrap().iter().all(|line| !line.contains(token)), "the token is in the log");
}

#[test]
fn other_users_of_this_machine_need_the_token() {
    needs_its_token(&serve());
}

#[test]
fn remote_servers_require_a_token_even_if_disabled() {
    needs_its_token(&serve_remote());
    let address = SocketAddr::from(([0, 0, 0, 0], 0));
    needs_its_token(&serve_with(ServerOptions {
        address,
        allow_remote: true,
        token: false,
        ..ServerOptions::default()
    }));
}

#[test]
fn local_server_without_a_token_is_accessible() {
    let serving = serve_open();
    assert!(!serving.url.contains("token"), "{}", serving.url);
    assert_eq!(serving.request("GET", "/", &[&format!("Host: {}", serving.host())]).status, 200);
    serving.page().next_text("status", |_| true);
}

#[test]
fn refusals_repeat_nothing_that_was_sent() {
    let (serving, sent) = (serve(), "marker7f3a");
    let host = format!("Host: {}", serving.host());
    let cookie = format!("Cookie: {}", serving.cookie.as_ref().unwrap());
    let answers = [
        serving.request("GET", "/", &[&format!("Host: {sent}")]),
        serving.request("GET", "/", &[&host, &cookie, &format!("Origin: http://{sent}")]),
        serving.request("GET", &format!("/?token={sent}"), &[&host]),
        serving.request("GET", "/", &[&host, &format!("Cookie: juggler_{}={sent}", serving.address.port())]),
        serving.request("GET", &format!("/{sent}"), &[&host, &cookie]),
        serving.request("GET", &format!("/thumbnail/{sent}.jpg"), &[&host, &cookie]),
        serving.request("GET", &format!("/save/{sent}.png"), &[&host, &cookie]),
        serving.request("GET", &format!("http://{sent}/"), &[&host, &cookie]),
        serving.request(sent, "/", &[&host, &cookie]),
    ];
    for answer in answers {
        assert!(answer.status >= 400 && !answer.text().contains(sent) && !answer.head.contains(sent), "{answer:?}");
    }
    let mut page = serving.page();
    for message in [
        sent.to_owned(),
        format!(r#"{{"{sent}": true}}"#),
        format!(r#"{{"edit": {{"{sent}": 1}}}}"#),
        format!(r#"{{"edit": {{"scene": "{sent}"}}}}"#),
        format!(r#"{{"edit": {{"set": {{"path": "/{sent}", "value": 1}}}}}}"#),
        format!(r#"{{"edit": {{"set": {{"path": "/lights/0", "value": "{sent}"}}}}}}"#),
    ] {
        page.send(&message);
        let why = page.next_text("refused", |_| true).to_string();
        assert!(!why.contains(sent), "{message}: {why}");
    }
    let log = serving.log.lock().unwrap();
    assert!(log.len() > 5 && log.iter().all(|line| !line.contains(sent)), "{log:?}");
}

#[test]
fn the_page_gets_a_cookie_for_the_token() {
    let serving = serve_remote();
    let (_, with_token) = serving.url.rsplit_once('/').unwrap();
    let page = serving.request("GET", &format!("/{with_token}"), &[&format!("Host: {}", serving.host())]);
    assert_eq!(page.status, 200);
    let cookie = page.header("set-cookie").unwrap();
    assert!(cookie.contains("HttpOnly") && cookie.contains("SameSite=Strict"), "{cookie}");
    let cookie = cookie.split(';').next().unwrap();
    let host = format!("Host: {}", serving.host());
    assert_eq!(serving.request("GET", "/page.js", &[&host, &format!("Cookie: a=b; {cookie}; c=d")]).status, 200);
    let own = format!("http://{}", serving.host());
    assert!(serving.open("/socket", &[("Origin", &own), ("Cookie", cookie)]).is_ok());
    assert_eq!(serving.open("/socket", &[("Origin", "http://evil.example"), ("Cookie", cookie)]).err(), Some(403));
}

#[test]
fn responses_have_security_headers() {
    let serving = serve_open();
    for path in ["/", "/page.js", "/catalogue.json", "/nothing"] {
        let answer = serving.get(path);
        let policy = answer.header("content-security-policy").unwrap();
        assert!(policy.contains("default-src 'self'") && policy.contains("frame-ancestors 'none'"), "{policy}");
        assert_eq!(answer.header("x-content-type-options"), Some("nosniff"), "{path}");
        assert_eq!(answer.header("cache-control"), Some("no-store"), "{path}");
        assert_eq!(answer.header("cross-origin-resource-policy"), Some("same-origin"), "{path}");
    }
    assert_eq!(serving.request("GET", "/", &["Host: evil.example"]).header("x-frame-options"), Some("DENY"));
}

#[test]
fn path_traversal_is_rejected() {
    let serving = serve();
    for path in ["/../Cargo.toml", "/..%2fCargo.toml", "/thumbnail/..%2f..%2fx.jpg", "/save/..%2fx.png", "/etc/passwd"]
    {
        assert_eq!(serving.get(path).status, 404, "{path}");
    }
}
