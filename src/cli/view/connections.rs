//! The connections that are open, and which of them gives way when there are too many.
//!
//! Each open connection has a thread, so their number is bounded. One more than that ends the connection that has waited longest for its
//! other side: an idle connection never keeps out a browser, and a slow one does only as long as others are slower.

use std::net::{Shutdown, TcpStream};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Connections that are served at once; event streams, which need no thread, do not count.
pub const MOST: usize = 64;

/// How long a new connection waits for a place.
const PATIENCE: Duration = Duration::from_secs(1);

/// All connections that have a thread.
#[derive(Debug, Default)]
pub struct Connections {
    state: Mutex<State>,
    freed: Condvar,
}

#[derive(Debug, Default)]
struct State {
    open: Vec<Open>,
    next: u64,
    over: bool,
}

#[derive(Debug)]
struct Open {
    id: u64,
    stream: Arc<TcpStream>,
    /// Since when it waits for its other side.
    waits: Option<Instant>,
}

/// A connection's place among the open ones, given back when this is dropped.
#[derive(Debug)]
pub struct Place {
    of: Arc<Connections>,
    id: u64,
}

impl Connections {
    /// A place for a new connection; `None` where all are busy, or after [`Connections::end`].
    pub fn admit(self: &Arc<Self>, stream: &Arc<TcpStream>) -> Option<Place> {
        let deadline = Instant::now() + PATIENCE;
        let mut state = self.state();
        while state.open.len() >= MOST && !state.over {
            if let Some(oldest) = state.open.iter_mut().filter(|open| open.waits.is_some()).min_by_key(|open| open.waits) {
                oldest.waits = None;
                // It may have ended meanwhile.
                let _ = oldest.stream.shutdown(Shutdown::Both);
            }
            let left = deadline.checked_duration_since(Instant::now())?;
            state = self.freed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
        }
        if state.over {
            return None;
        }
        let id = state.next;
        state.next += 1;
        state.open.push(Open { id, stream: stream.clone(), waits: Some(Instant::now()) });
        Some(Place { of: self.clone(), id })
    }

    /// Ends all connections and lets no new one in.
    pub fn end(&self) {
        let mut state = self.state();
        state.over = true;
        for open in &state.open {
            let _ = open.stream.shutdown(Shutdown::Both);
        }
        self.freed.notify_all();
    }

    /// How many are open.
    pub fn count(&self) -> usize {
        self.state().open.len()
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Place {
    /// The connection waits for its other side from now on: for a request, or until an answer is taken.
    pub fn waits(&self) {
        self.set(Some(Instant::now()));
    }

    /// The connection is at work, and is not ended for another one.
    pub fn works(&self) {
        self.set(None);
    }

    fn set(&self, waits: Option<Instant>) {
        if let Some(open) = self.of.state().open.iter_mut().find(|open| open.id == self.id) {
            open.waits = waits;
        }
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.of.state().open.retain(|open| open.id != self.id);
        self.of.freed.notify_one();
    }
}
