//! `juggler serve`: the interactive viewer in a web browser, also from a machine without a screen.

use crate::console;
use crate::failure::{Failure, plain};
use crate::interrupt::Interrupts;
use crate::model_args::ModelArgs;
use crate::source;
use crate::value;
use clap::Args;
use juggler_serve::{Limits, ServeError, Server, ServerOptions};
use juggler_session::Session;
use std::net::{SocketAddr, ToSocketAddrs};

/// Default scene.
const FIRST_SCENE: &str = "juggler";

/// Flags of `juggler serve`.
#[derive(Debug, Args)]
pub struct Serve {
    /// Scene file, model (glTF) or mesh (PLY, OBJ, STL) to watch, or built-in scene [default:
    /// juggler]
    scene: Option<String>,

    /// Address to listen on; port 0 selects a free port
    #[arg(long, value_name = "ADDRESS:PORT", value_parser = address, default_value = "127.0.0.1:8080")]
    addr: SocketAddr,

    /// Accept an address that other machines can reach
    #[arg(long)]
    allow_remote: bool,

    /// Give all users and programs of this machine access, without a token in the address
    #[arg(long, conflicts_with = "allow_remote")]
    no_token: bool,

    /// Width and height in pixels [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = value::size)]
    size: Option<[u32; 2]>,

    /// Number of rendering threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,

    /// Memory limit for files that are dropped on a page, such as 4G
    ///
    /// Uploads may take half of it. A scene whose files, world and film need more is refused.
    #[arg(long, value_name = "SIZE", value_parser = value::memory)]
    max_memory: Option<u64>,

    #[command(flatten)]
    model: ModelArgs,
}

impl Serve {
    /// Prints the address and serves until a signal arrives.
    pub fn run(self) -> Result<(), Failure> {
        let interrupts = Interrupts::watch()?;
        if let Some(scene) = &self.scene {
            check(scene)?;
        }
        let name = self.scene.as_deref().unwrap_or(FIRST_SCENE);
        let threads = self.threads.map_or(0, usize::from);
        let model = ModelArgs { size: self.size, ..self.model };
        let (size, values, lenient) = (self.size, source::model_values(name, &model)?, model.lenient);
        let (watch, max_memory) = (true, self.max_memory);
        let options =
            juggler_session::SessionOptions { size, values, lenient, threads, watch, max_memory, ..Default::default() };
        let session = Session::open(name, options);
        let (address, allow_remote, token) = (self.addr, self.allow_remote, !self.no_token);
        let limits = Limits::default();
        let limits = max_memory.map_or(limits, |bytes| limits.with_memory(bytes));
        let options = ServerOptions { address, allow_remote, token, scene: self.scene, limits };
        let server = Server::bind(session, options, console::print_message)?;
        let url = server.url();
        let _running = server.start()?;
        console::print_result(&format!("juggler serves at {url}"))?;
        Err(interrupts.wait())
    }
}

/// Refuses a scene that does not exist. A scene with mistakes is accepted, since it is watched and
/// may be corrected.
fn check(scene: &str) -> Result<(), Failure> {
    if scene == "-" {
        return Err(Failure::Invalid(
            "standard input cannot be watched: give a scene file or the name of a built-in scene".into(),
        ));
    }
    match source::load(scene, None) {
        Ok(_) | Err(Failure::Scene(_)) => Ok(()),
        Err(failure) => Err(failure),
    }
}

/// Parses an address: `127.0.0.1:8080`, `[::1]:8080`, `localhost:8080`.
fn address(text: &str) -> Result<SocketAddr, String> {
    let wrong = "an address is ADDRESS:PORT, such as 127.0.0.1:8080";
    let found = text.to_socket_addrs().map_err(|error| format!("{wrong} ({})", plain(&error)))?;
    let mut addresses: Vec<_> = found.collect();
    // Prefer IPv4, which is easier to type.
    addresses.sort_by_key(SocketAddr::is_ipv6);
    addresses.first().copied().ok_or_else(|| wrong.to_owned())
}

impl From<ServeError> for Failure {
    fn from(error: ServeError) -> Self {
        match error {
            ServeError::Remote(_) => Self::Invalid(error.to_string()),
            _ => Self::System(error.to_string()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read() {
        assert_eq!(address("127.0.0.1:0").unwrap(), SocketAddr::from(([127, 0, 0, 1], 0)));
        assert_eq!(address("localhost:81").unwrap(), SocketAddr::from(([127, 0, 0, 1], 81)));
        assert!(address("[::1]:8080").unwrap().is_ipv6());
        for wrong in ["", "8080", ":8080x", "127.0.0.1", "127.0.0.1:99999"] {
            assert!(address(wrong).unwrap_err().contains("such as"), "{wrong}");
        }
    }
}
