//! Guarded work: a deep stack for recursive scripts, and a bug in loft ends as a message, not as a crash.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread;

/// Bytes of stack for evaluation; the limits of the language keep recursion inside it.
const STACK: usize = 64 << 20;

/// A bug in loft that was caught.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bug {
    /// What the program said about itself.
    pub what: String,
}

/// Runs `work` in a thread of its own and waits for it.
pub fn guarded<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T, Bug> {
    let caught = thread::scope(|scope| {
        let body = || catch_unwind(AssertUnwindSafe(work));
        match thread::Builder::new().name("loft".to_owned()).stack_size(STACK).spawn_scoped(scope, body) {
            Ok(handle) => handle.join().unwrap_or_else(Err),
            Err(error) => Err(Box::new(format!("no thread could be started: {error}")) as Box<dyn Any + Send>),
        }
    });
    caught.map_err(|payload| Bug { what: words_of(payload.as_ref()) })
}

fn words_of(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().map(|s| (*s).to_owned());
    text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no words were left".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bug_is_caught_and_told() {
        assert_eq!(guarded(|| 2 + 2), Ok(4));
        let bug: Result<(), Bug> = guarded(|| panic!("seven is {}", 8));
        assert_eq!(bug, Err(Bug { what: "seven is 8".to_owned() }));
    }

    #[test]
    fn the_stack_is_deep() {
        fn depth(n: u32) -> u64 {
            let room = std::hint::black_box([u64::from(n); 512]);
            if n == 0 { room[0] } else { depth(n - 1) + room[511] }
        }
        assert_eq!(guarded(|| depth(8_000)), Ok(8_000 * 8_001 / 2));
    }
}
