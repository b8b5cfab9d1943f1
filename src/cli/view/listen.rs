//! The port that the page is served on.

use std::fmt;
use std::io;
use std::net::{Ipv4Addr, TcpListener};

/// The port that is taken where none is asked for.
pub const DEFAULT_PORT: u16 = 7357;

/// Ports from the default one on that are tried.
const TRIED: u16 = 16;

/// Why the page cannot be served.
#[derive(Debug)]
pub enum StartError {
    /// Another program has the port that was asked for.
    InUse(u16),
    /// The system does not let the program listen at the port.
    Port(u16, io::Error),
    /// The system has no random numbers for a token.
    Random(String),
    /// The system does not start another thread.
    Thread(io::Error),
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::InUse(port) => write!(f, "port {port} is in use by another program; `--port 0` takes any that is free"),
            Self::Port(port, error) => write!(f, "cannot listen at port {port}: {error}"),
            Self::Random(error) => write!(f, "the system has no random numbers for the address of the page: {error}"),
            Self::Thread(error) => write!(f, "cannot start a thread: {error}"),
        }
    }
}

impl std::error::Error for StartError {}

/// Listens on the loopback interface: at a port that was asked for, where 0 is any that is free; else at the default one or the next
/// that is free.
///
/// Fails when the port that was asked for cannot be had, or none.
pub fn listen(port: Option<u16>) -> Result<TcpListener, StartError> {
    let open = |port: u16| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
    match port {
        Some(port) => open(port).map_err(|error| match error.kind() {
            io::ErrorKind::AddrInUse => StartError::InUse(port),
            _ => StartError::Port(port, error),
        }),
        None => {
            let free = (DEFAULT_PORT..DEFAULT_PORT + TRIED).find_map(|port| open(port).ok());
            free.map_or_else(|| open(0).map_err(|error| StartError::Port(0, error)), Ok)
        }
    }
}
