//! What the open pages are told: server-sent events, the newest of each kind.
//!
//! A page needs the state, not its history. So an event that could not be sent yet gives way to a newer one of its kind, and a page that
//! takes nothing holds one event of each kind here, until it is dropped. Numbers of frames only go up. A small frame stands in its event,
//! so that the page need not ask for it.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::answer::stream_head;
use super::compress::Packed;

/// Streams that are open at once. Browsers open six connections to a server for all tabs together; the rest is for what the tabs fetch.
/// One stream more ends the oldest, whose page asks again soon: many tabs take turns and all of them follow.
pub const MOST: usize = 4;

/// Milliseconds after which a page asks again when its stream ended.
const RETRY: u32 = 500;

/// How long a page may take nothing of what it is sent.
const PATIENCE: Duration = Duration::from_secs(10);

/// How long a stream is silent at most.
const SILENCE: Duration = Duration::from_secs(15);

/// Kinds of events beside frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// An evaluation is running, or ended.
    Work,
    /// The script is not there.
    Gone,
    /// A line in an editor.
    Cursor,
}

const KINDS: [(Kind, &str); 3] = [(Kind::Work, "work"), (Kind::Gone, "gone"), (Kind::Cursor, "cursor")];

/// All open streams.
#[derive(Debug, Default)]
pub struct Events {
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    tabs: Vec<Tab>,
    frame: Newest,
    /// What a page that opens now must know beside the frame.
    gone: Option<String>,
    over: bool,
}

/// The newest frame.
#[derive(Clone, Debug, Default)]
struct Newest {
    /// 0 before the first.
    number: u64,
    /// Where it is small: its JSON, on one line.
    json: Option<Arc<Packed>>,
}

#[derive(Debug)]
struct Tab {
    name: String,
    stream: Arc<TcpStream>,
    /// What is on its way, and how much of it was taken.
    sending: Vec<u8>,
    taken: usize,
    /// The newest frame that it was told.
    frame: u64,
    /// The newest event of each kind that is not on its way yet.
    waiting: [Option<String>; 3],
    /// When something was taken last.
    active: Instant,
}

impl Events {
    /// Opens a stream for a tab that shows frame `last`, in place of the one it had. A newer frame is told at once.
    ///
    /// Fails when the connection is gone.
    pub fn open(&self, name: &str, last: u64, stream: Arc<TcpStream>) -> io::Result<()> {
        stream.set_nonblocking(true)?;
        let sending = format!("{}retry: {RETRY}\n\n", stream_head("text/event-stream")).into_bytes();
        let mut state = self.state();
        if state.over {
            return Ok(());
        }
        state.tabs.retain(|tab| tab.name != name || tab.end());
        if state.tabs.len() >= MOST {
            state.tabs.remove(0).end();
        }
        let waiting = [None, state.gone.clone(), None];
        let mut tab = Tab { name: name.to_owned(), stream, sending, taken: 0, frame: last, waiting, active: Instant::now() };
        if tab.send(&state.frame).is_ok() {
            state.tabs.push(tab);
        }
        Ok(())
    }

    /// The script is there again; the next frame tells that.
    pub fn returned(&self) {
        let mut state = self.state();
        state.gone = None;
        state.tabs.iter_mut().for_each(|tab| tab.waiting[Kind::Gone as usize] = None);
    }

    /// Tells a new frame, with its JSON where that is on one line and small.
    pub fn frame(&self, number: u64, json: Option<Arc<Packed>>) {
        let mut state = self.state();
        if number > state.frame.number {
            state.frame = Newest { number, json };
        }
        state.send();
    }

    /// Tells anything else; `data` is one JSON object.
    pub fn tell(&self, kind: Kind, data: &serde_json::Value) {
        let data = data.to_string();
        let mut state = self.state();
        if kind == Kind::Gone {
            state.gone = Some(data.clone());
        }
        for tab in &mut state.tabs {
            tab.waiting[kind as usize] = Some(data.clone());
        }
        state.send();
    }

    /// Goes on with what is on its way, drops pages that are gone or take nothing, breaks silences. To be called some times a second.
    pub fn tick(&self) {
        let mut state = self.state();
        for tab in &mut state.tabs {
            if tab.taken == tab.sending.len() && tab.active.elapsed() > SILENCE {
                tab.sending = b":\n\n".to_vec();
                tab.taken = 0;
            }
        }
        state.tabs.retain(|tab| !tab.is_gone() && (tab.taken == tab.sending.len() || tab.active.elapsed() < PATIENCE) || tab.end());
        state.send();
    }

    /// Ends all streams and opens no new one.
    pub fn end(&self) {
        let mut state = self.state();
        state.over = true;
        state.tabs.drain(..).for_each(|tab| {
            tab.end();
        });
    }

    /// How many pages are open.
    pub fn count(&self) -> usize {
        self.state().tabs.len()
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn send(&mut self) {
        let Self { tabs, frame, .. } = self;
        tabs.retain_mut(|tab| tab.send(frame).is_ok());
    }
}

impl Tab {
    /// Sends as much as the other side takes now.
    fn send(&mut self, frame: &Newest) -> io::Result<()> {
        loop {
            while self.taken < self.sending.len() {
                match (&*self.stream).write(&self.sending[self.taken..]) {
                    Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                    Ok(n) => {
                        self.taken += n;
                        self.active = Instant::now();
                    }
                    Err(error) if error.kind() == io::ErrorKind::WouldBlock => return Ok(()),
                    Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                    Err(error) => return Err(error),
                }
            }
            let Some(next) = self.next(frame) else { return Ok(()) };
            (self.sending, self.taken, self.active) = (next, 0, Instant::now());
        }
    }

    /// The next event that it has not been told.
    fn next(&mut self, frame: &Newest) -> Option<Vec<u8>> {
        let number = frame.number;
        if self.frame < number {
            self.frame = number;
            // The browser names this number when it asks again by itself.
            let mut event = format!("id: {number}\nevent: frame\ndata: {{\"number\":{number}").into_bytes();
            if let Some(json) = &frame.json {
                event.extend_from_slice(b",\"frame\":");
                event.extend_from_slice(json.plain());
            }
            event.extend_from_slice(b"}\n\n");
            return Some(event);
        }
        let event = |name: &str, data: String| format!("event: {name}\ndata: {data}\n\n").into_bytes();
        KINDS.iter().zip(&mut self.waiting).find_map(|((_, name), data)| data.take().map(|data| event(name, data)))
    }

    /// The other side ended the stream.
    fn is_gone(&self) -> bool {
        match (&*self.stream).read(&mut [0; 256]) {
            Ok(n) => n == 0,
            Err(error) => !matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted),
        }
    }

    /// Ends the stream; `false`, for `retain`.
    fn end(&self) -> bool {
        // It may have ended meanwhile.
        let _ = self.stream.shutdown(Shutdown::Both);
        false
    }
}
