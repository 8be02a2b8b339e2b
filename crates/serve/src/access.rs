//! Access rules for every request.
//!
//! The server must not be reachable by other users of this machine, nor by pages of other sites
//! through a user's browser:
//! - `Host` must name this machine by a loopback name or by the address of the connection, with the
//!   right port. A foreign name that resolves to this machine (DNS rebinding) is refused.
//! - `Origin`, which browsers send with WebSockets and which pages cannot forge, must be this
//!   server. It is required for WebSockets; no other request changes anything.
//! - Every request needs a token: `?token=`, or the cookie that the page received for it. Only a
//!   server at a loopback address may run without a token.
//!
//! A refusal gives its reason and repeats nothing of the request, which might be crafted for the
//! reader of the answer or the log.

use axum::http::request::Parts;
use axum::http::uri::Authority;
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, header};
use std::io;
use std::net::{IpAddr, SocketAddr};
use subtle::ConstantTimeEq;

/// Access token: 128 random bits as 32 hexadecimal digits.
pub struct Token(String);

impl Token {
    /// Creates a random token.
    pub fn random() -> io::Result<Self> {
        let mut bits = [0; 16];
        getrandom::fill(&mut bits).map_err(|error| io::Error::other(error.to_string()))?;
        Ok(Self(bits.iter().map(|byte| format!("{byte:02x}")).collect()))
    }

    /// Returns the hexadecimal digits.
    pub fn text(&self) -> &str {
        &self.0
    }

    /// Compares in constant time.
    fn equals(&self, other: &str) -> bool {
        self.0.as_bytes().ct_eq(other.as_bytes()).into()
    }
}

/// Endpoints of a connection.
#[derive(Clone, Copy, Debug)]
pub struct Peer {
    /// Address of the client.
    pub remote: SocketAddr,
    /// Address at which the server was reached.
    pub local: SocketAddr,
}

impl Peer {
    /// Returns whether the client is on this machine.
    pub fn is_local(&self) -> bool {
        self.remote.ip().to_canonical().is_loopback()
    }
}

/// Access rules of a server.
pub struct Access {
    port: u16,
    token: Option<Token>,
}

/// How an accepted request was authorized.
#[derive(Debug, PartialEq, Eq)]
pub enum Authorization {
    /// By the token in the URL; the response sets the cookie.
    ByUrl,
    /// By the cookie, or no token is needed.
    Known,
}

impl Access {
    /// Creates the rules of a server at this port; if a token is given, every request needs it.
    pub fn new(port: u16, token: Option<Token>) -> Self {
        Self { port, token }
    }

    /// Checks a request. An error is the reason of the refusal.
    pub fn check(&self, request: &Parts, peer: Peer) -> Result<Authorization, &'static str> {
        let host = self.check_host(request, peer)?;
        check_origin(request, host)?;
        self.check_token(request)
    }

    /// Returns the cookie that replaces the token in later requests.
    pub fn cookie(&self) -> Option<HeaderValue> {
        let token = self.token.as_ref()?;
        let text = format!("{}={}; Path=/; HttpOnly; SameSite=Strict", self.cookie_name(), token.text());
        HeaderValue::try_from(text).ok()
    }

    fn cookie_name(&self) -> String {
        format!("juggler_{}", self.port)
    }

    fn check_host<'r>(&self, request: &'r Parts, peer: Peer) -> Result<&'r str, &'static str> {
        let host = single_header(&request.headers, &header::HOST)?.ok_or("the request has no Host header")?;
        let named = request.uri.authority().map(Authority::as_str);
        for name in [Some(host), named].into_iter().flatten() {
            if !self.is_own(name, peer.local.ip()) {
                return Err("the Host header names another server: open the address that this server printed");
            }
        }
        Ok(host)
    }

    /// Returns whether a host name is this server's: a loopback name or its own address, never a
    /// DNS name.
    fn is_own(&self, host: &str, local: IpAddr) -> bool {
        let Ok(authority) = host.parse::<Authority>() else { return false };
        if host.contains('@') || authority.port_u16().unwrap_or(80) != self.port {
            return false;
        }
        let name = authority.host().trim_start_matches('[').trim_end_matches(']');
        match name.parse::<IpAddr>() {
            Ok(address) => address.is_loopback() || address.to_canonical() == local.to_canonical(),
            Err(_) => name.eq_ignore_ascii_case("localhost"),
        }
    }

    fn check_token(&self, request: &Parts) -> Result<Authorization, &'static str> {
        let Some(token) = &self.token else { return Ok(Authorization::Known) };
        let pairs = request.uri.query().unwrap_or_default().split('&');
        if let Some(given) = pairs.filter_map(|pair| pair.strip_prefix("token=")).next() {
            return if token.equals(given) { Ok(Authorization::ByUrl) } else { Err("a wrong token") };
        }
        let name = self.cookie_name();
        let cookies = request.headers.get_all(header::COOKIE).iter().filter_map(|value| value.to_str().ok());
        let mut pairs = cookies.flat_map(|line| line.split(';')).filter_map(|pair| pair.trim().split_once('='));
        match pairs.find(|(key, _)| *key == name) {
            Some((_, given)) if token.equals(given) => Ok(Authorization::Known),
            Some(_) => Err("a wrong token"),
            None => Err("no token: open the address that the server printed"),
        }
    }
}

/// Checks that the page that sends the request is one of this server.
fn check_origin(request: &Parts, host: &str) -> Result<(), &'static str> {
    let changes = !matches!(request.method, Method::GET | Method::HEAD);
    match single_header(&request.headers, &header::ORIGIN)? {
        Some(origin) if origin.strip_prefix("http://").is_some_and(|own| own.eq_ignore_ascii_case(host)) => Ok(()),
        Some(_) => Err("the Origin header names another site"),
        None if changes || request.headers.contains_key(header::UPGRADE) => Err("the request has no Origin header"),
        None => Ok(()),
    }
}

/// Returns a header that may occur at most once.
fn single_header<'r>(headers: &'r HeaderMap, name: &HeaderName) -> Result<Option<&'r str>, &'static str> {
    let mut values = headers.get_all(name).iter();
    let first = values.next();
    if values.next().is_some() {
        return Err("a header that must be unique occurs twice");
    }
    first.map(|value| value.to_str().map_err(|_| "an unreadable header")).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn own(host: &str, local: &str) -> bool {
        Access::new(8080, None).is_own(host, local.parse().unwrap())
    }

    #[test]
    fn only_loopback_host_names_with_the_own_port_are_accepted() {
        for host in ["localhost:8080", "LOCALHOST:8080", "127.0.0.1:8080", "127.9.9.9:8080", "[::1]:8080"] {
            assert!(own(host, "127.0.0.1"), "{host}");
        }
        let foreign =
            ["localhost", "localhost:80", "127.0.0.1:8081", "evil.example:8080", "localhost.evil.example:8080"];
        let odd =
            ["10.0.0.5:8080", "", ":8080", "u@localhost:8080", "localhost:8080:8080", "127.0.0.1.:8080", "0x7f.1:8080"];
        for host in foreign.into_iter().chain(odd) {
            assert!(!own(host, "127.0.0.1"), "{host}");
        }
        assert!(own("10.0.0.5:8080", "10.0.0.5") && own("10.0.0.5:8080", "::ffff:10.0.0.5"));
    }

    #[test]
    fn tokens_are_long_and_random() {
        let (one, other) = (Token::random().unwrap(), Token::random().unwrap());
        assert_eq!(one.text().len(), 32);
        assert!(
            one.equals(one.text()) && !one.equals(other.text()) && !one.equals("") && !one.equals(&one.text()[..31])
        );
    }
}
