//! Access rules for every request.
//!
//! Neither other users of this machine nor other sites' pages, through the browser of somebody who sits at it, may reach
//! this server:
//! - `Host` names this machine by a loopback name or by the very address that was connected to, with the right port. A
//!   foreign name that was made to point here (DNS rebinding) is refused.
//! - `Origin`, which browsers send with WebSockets and which pages cannot forge, is this server's own. A WebSocket needs
//!   one; nothing else changes anything.
//! - Every request needs a token: `?token=` or a cookie that the page got by it. Only a server at a loopback address may
//!   be started without one.
//!
//! A refusal gives its reason and repeats nothing of the request: what was sent may be meant for whoever reads the answer
//! or the log.

use axum::http::request::Parts;
use axum::http::uri::Authority;
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, header};
use std::io;
use std::net::{IpAddr, SocketAddr};
use subtle::ConstantTimeEq;

/// 128 random bits, as 32 hexadecimal digits.
pub struct Token(String);

impl Token {
    /// A new one.
    pub fn random() -> io::Result<Self> {
        let mut bits = [0; 16];
        getrandom::fill(&mut bits).map_err(|error| io::Error::other(error.to_string()))?;
        Ok(Self(bits.iter().map(|byte| format!("{byte:02x}")).collect()))
    }

    /// The digits.
    pub fn text(&self) -> &str {
        &self.0
    }

    /// Takes the same time whatever is wrong.
    fn is(&self, other: &str) -> bool {
        self.0.as_bytes().ct_eq(other.as_bytes()).into()
    }
}

/// The two ends of a connection.
#[derive(Clone, Copy, Debug)]
pub struct Peer {
    /// The other machine.
    pub remote: SocketAddr,
    /// This one, as it was reached.
    pub local: SocketAddr,
}

impl Peer {
    /// Whether both ends are on this machine.
    pub fn is_local(&self) -> bool {
        self.remote.ip().to_canonical().is_loopback()
    }
}

/// The rules.
pub struct Access {
    port: u16,
    token: Option<Token>,
}

/// What the token was given by.
#[derive(Debug, PartialEq, Eq)]
pub enum Entry {
    /// The page is to be given a cookie.
    ByAddress,
    /// Nothing else is needed.
    Known,
}

impl Access {
    /// Rules of a server at this port; with a token, every request needs it.
    pub fn new(port: u16, token: Option<Token>) -> Self {
        Self { port, token }
    }

    /// Whether a request is let in, or why not.
    pub fn check(&self, request: &Parts, peer: Peer) -> Result<Entry, &'static str> {
        let host = self.check_host(request, peer)?;
        check_origin(request, host)?;
        self.check_token(request)
    }

    /// The cookie that stands for the token from now on.
    pub fn cookie(&self) -> Option<HeaderValue> {
        let token = self.token.as_ref()?;
        let text = format!("{}={}; Path=/; HttpOnly; SameSite=Strict", self.cookie_name(), token.text());
        HeaderValue::try_from(text).ok()
    }

    fn cookie_name(&self) -> String {
        format!("juggler_{}", self.port)
    }

    fn check_host<'r>(&self, request: &'r Parts, peer: Peer) -> Result<&'r str, &'static str> {
        let host = single(&request.headers, &header::HOST)?.ok_or("no Host")?;
        let named = request.uri.authority().map(Authority::as_str);
        for name in [Some(host), named].into_iter().flatten() {
            if !self.is_own(name, peer.local.ip()) {
                return Err("the Host is another server: open the address that this one printed");
            }
        }
        Ok(host)
    }

    /// Whether a name leads here: never by a name that somebody else could give to this machine.
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

    fn check_token(&self, request: &Parts) -> Result<Entry, &'static str> {
        let Some(token) = &self.token else { return Ok(Entry::Known) };
        let pairs = request.uri.query().unwrap_or_default().split('&');
        if let Some(given) = pairs.filter_map(|pair| pair.strip_prefix("token=")).next() {
            return if token.is(given) { Ok(Entry::ByAddress) } else { Err("a wrong token") };
        }
        let name = self.cookie_name();
        let cookies = request.headers.get_all(header::COOKIE).iter().filter_map(|value| value.to_str().ok());
        let mut pairs = cookies.flat_map(|line| line.split(';')).filter_map(|pair| pair.trim().split_once('='));
        match pairs.find(|(key, _)| *key == name) {
            Some((_, given)) if token.is(given) => Ok(Entry::Known),
            Some(_) => Err("a wrong token"),
            None => Err("no token: open the address that the server printed"),
        }
    }
}

/// Browsers name the page that asks; it must be one of this server.
fn check_origin(request: &Parts, host: &str) -> Result<(), &'static str> {
    let changes = !matches!(request.method, Method::GET | Method::HEAD);
    match single(&request.headers, &header::ORIGIN)? {
        Some(origin) if origin.strip_prefix("http://").is_some_and(|own| own.eq_ignore_ascii_case(host)) => Ok(()),
        Some(_) => Err("the Origin is another site"),
        None if changes || request.headers.contains_key(header::UPGRADE) => Err("no Origin"),
        None => Ok(()),
    }
}

/// A header that may be there once.
fn single<'r>(headers: &'r HeaderMap, name: &HeaderName) -> Result<Option<&'r str>, &'static str> {
    let mut values = headers.get_all(name).iter();
    let first = values.next();
    if values.next().is_some() {
        return Err("a header that may be there once is there twice");
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
    fn only_names_that_nobody_else_can_give() {
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
    fn tokens_are_long_and_new() {
        let (one, other) = (Token::random().unwrap(), Token::random().unwrap());
        assert_eq!(one.text().len(), 32);
        assert!(one.is(one.text()) && !one.is(other.text()) && !one.is("") && !one.is(&one.text()[..31]));
    }
}
