//! A progress bar for whoever watches a terminal.

use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::base::job::Job;

/// Shorter work is not worth a bar.
const FIRST: Duration = Duration::from_millis(500);
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
            loop {
                show(&bar, &job);
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

fn show(bar: &ProgressBar, job: &Job) {
    let (done, total) = job.progress();
    let template = if total > 0 { "{elapsed_precise} {wide_bar} {percent}%" } else { "{elapsed_precise} {spinner} working" };
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    if total > 0 {
        bar.set_length(total);
        bar.set_position(done.min(total));
    } else {
        bar.tick();
    }
}
