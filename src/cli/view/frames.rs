//! The frames that the page can ask for, and their buffers.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::compress::Packed;
use super::model::{Buffer, Frame};

/// Frames whose buffers are kept in any case.
const NEWEST: usize = 2;

/// How long the buffers of an older frame are kept after it was fetched: a page may be fetching them while frames follow each other fast.
const GRACE: Duration = Duration::from_secs(5);

/// Frames that are kept at most, those within the grace included.
const MOST: usize = 64;

/// Bytes that frames within the grace may hold beside the newest ones.
const MOST_BYTES: usize = 256 << 20;

/// Bytes of a frame that stands in its event.
const SMALL: usize = 64 * 1024;

/// The newest frames.
#[derive(Debug, Default)]
pub struct Frames {
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    /// The newest last.
    frames: VecDeque<Kept>,
    buffers: BTreeMap<String, Used>,
    /// Bytes of all buffers.
    bytes: usize,
    /// The newest whole one.
    whole: Option<Arc<Packed>>,
}

#[derive(Debug)]
struct Used {
    packed: Arc<Packed>,
    /// Frames that have it.
    frames: usize,
}

#[derive(Debug)]
struct Kept {
    number: u64,
    json: Arc<Packed>,
    keys: Vec<String>,
    fetched: Option<Instant>,
}

impl Frames {
    /// Keeps a frame; `false` where there is one of that number or a newer one already, and nothing changes then.
    pub fn publish(&self, number: u64, frame: Frame) -> bool {
        let mut state = self.state();
        if state.frames.back().is_some_and(|newest| newest.number >= number) {
            return false;
        }
        let mut keys = Vec::new();
        for Buffer { key, bytes } in frame.buffers {
            let length = bytes.len();
            let fresh = || Used { packed: Arc::new(Packed::new(bytes)), frames: 0 };
            let used = state.buffers.entry(key.clone()).or_insert_with(fresh);
            used.frames += 1;
            let added = if used.frames == 1 { length } else { 0 };
            state.bytes += added;
            keys.push(key);
        }
        let json = Arc::new(Packed::new(Arc::new(frame.json.into_bytes())));
        if number.is_multiple_of(2) {
            state.whole = Some(json.clone());
        }
        state.frames.push_back(Kept { number, json, keys, fetched: None });
        state.forget();
        true
    }

    /// The newest frame.
    pub fn newest(&self) -> Option<Arc<Packed>> {
        let mut state = self.state();
        let newest = state.frames.back_mut()?;
        newest.fetched = Some(Instant::now());
        Some(newest.json.clone())
    }

    /// The number of the newest frame, and its JSON where it is small enough for an event: on one line, as events are. A page
    /// that has it goes on to its buffers.
    pub fn newest_if_small(&self) -> (u64, Option<Arc<Packed>>) {
        let mut state = self.state();
        let Some(newest) = state.frames.back_mut() else { return (0, None) };
        let plain = newest.json.plain();
        let small = plain.len() <= SMALL && !plain.iter().any(|b| matches!(b, b'\n' | b'\r'));
        if small {
            newest.fetched = Some(Instant::now());
        }
        (newest.number, small.then(|| newest.json.clone()))
    }

    /// The newest frame as it was published: its JSON and its buffers.
    pub fn newest_frame(&self) -> Option<(Vec<u8>, Vec<Buffer>)> {
        let state = self.state();
        let newest = state.frames.back()?;
        let buffer = |key: &String| Some(Buffer { key: key.clone(), bytes: state.buffers.get(key)?.packed.plain().clone() });
        Some((newest.json.plain().to_vec(), newest.keys.iter().filter_map(buffer).collect()))
    }

    /// The newest whole frame, as JSON.
    pub fn newest_whole(&self) -> Option<Arc<Packed>> {
        self.state().whole.clone()
    }

    /// Whether the newest frame is partial: its number is odd.
    pub fn is_partial(&self) -> bool {
        self.number() % 2 == 1
    }

    /// Number of the newest frame; 0 before the first.
    pub fn number(&self) -> u64 {
        self.state().frames.back().map_or(0, |newest| newest.number)
    }

    /// A buffer of one of the newest frames.
    pub fn buffer(&self, key: &str) -> Option<Arc<Packed>> {
        self.state().buffers.get(key).map(|used| used.packed.clone())
    }

    /// How many buffers are kept, and their bytes.
    pub fn size(&self) -> (usize, usize) {
        let state = self.state();
        (state.buffers.len(), state.bytes)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// Lets go of old frames, and of the buffers that none of the others has.
    fn forget(&mut self) {
        let recent = |kept: &Kept| kept.fetched.is_some_and(|at| at.elapsed() < GRACE);
        while self.frames.len() > NEWEST {
            let beyond = self.frames.len() - NEWEST;
            let dead = (0..beyond).find(|i| !recent(&self.frames[*i]));
            // Of those that somebody may be fetching, the oldest goes first.
            let Some(index) = dead.or((self.frames.len() > MOST || self.is_heavy()).then_some(0)) else { break };
            let gone = self.frames.remove(index);
            for key in gone.into_iter().flat_map(|kept| kept.keys) {
                self.release(&key);
            }
        }
    }

    /// One frame less has this buffer.
    fn release(&mut self, key: &str) {
        let Some(used) = self.buffers.get_mut(key) else { return };
        used.frames -= 1;
        if used.frames == 0 {
            self.bytes -= used.packed.plain().len();
            self.buffers.remove(key);
        }
    }

    /// The buffers that only older frames have are many bytes.
    fn is_heavy(&self) -> bool {
        let newest: BTreeSet<&String> = self.frames.iter().rev().take(NEWEST).flat_map(|kept| &kept.keys).collect();
        let bytes = |key: &String| self.buffers.get(key).map_or(0, |used| used.packed.plain().len());
        self.bytes - newest.into_iter().map(bytes).sum::<usize>() > MOST_BYTES
    }
}
