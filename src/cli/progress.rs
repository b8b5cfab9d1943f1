//! A progress bar for whoever watches a terminal.

use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::base::job::Job;

/// Shorter work is not worth a bar.
const FIRST: Duration = Duration::from_millis(300);
/// Time between two looks at the counters.
const STEP: Duration = Duration::from_millis(100);

/// Does `work`, with a bar on standard error once it takes long; without one where nobody watches.
pub fn with_progress<T>(job: &Arc<Job>, watched: bool, work: impl FnOnce() -> T) -> T {
    if !watched {
        return work();
    }
    let (done, wait) = channel::<()>();
    let watcher = thread::spawn({
        let job = job.clone();
        move || {
            if wait.recv_timeout(FIRST) != Err(RecvTimeoutError::Timeout) {
                return;
            }
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
            let mut text = PhaseText::default();
            loop {
                show(&bar, &mut text, &job);
                if wait.recv_timeout(STEP) != Err(RecvTimeoutError::Timeout) {
                    bar.finish_and_clear();
                    return;
                }
            }
        }
    });
    let result = work();
    drop(done);
    // The watcher only draws; when it fails the result stands.
    let _ = watcher.join();
    result
}

/// What the line says: the phase, and how much of it is done; that never becomes less within one phase, though the work may
/// turn out to be more than was announced.
#[derive(Debug, Default)]
struct PhaseText {
    number: u64,
    most: u64,
}

impl PhaseText {
    fn words(&mut self, phase: &str, number: u64, (done, total): (u64, u64)) -> String {
        if number != self.number {
            *self = Self { number, most: 0 };
        }
        self.most = self.most.max((100 * done.min(total)).checked_div(total).unwrap_or_default());
        let phase = if phase.is_empty() { "working" } else { phase };
        if self.most > 0 { format!("{phase}, {} %", self.most) } else { phase.to_owned() }
    }
}

fn show(bar: &ProgressBar, text: &mut PhaseText, job: &Job) {
    if let Ok(style) = ProgressStyle::with_template("{elapsed_precise} {spinner} {wide_msg}") {
        bar.set_style(style);
    }
    let (phase, number) = job.now();
    bar.set_message(text.words(&phase, number, job.progress()));
    bar.tick();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phase_never_runs_backwards() {
        let mut text = PhaseText::default();
        let phase = "meshing roof (1 of 2)";
        assert_eq!(text.words(phase, 1, (0, 0)), "meshing roof (1 of 2)");
        assert_eq!(text.words(phase, 1, (2, 4)), "meshing roof (1 of 2), 50 %");
        assert_eq!(text.words(phase, 1, (2, 8)), "meshing roof (1 of 2), 50 %");
        assert_eq!(text.words(phase, 1, (9, 8)), "meshing roof (1 of 2), 100 %");
        assert_eq!(text.words("", 2, (0, 8)), "working");
    }
}
