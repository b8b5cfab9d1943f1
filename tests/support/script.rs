//! A script run to its end, as `loft run` does.

use lofting::base::job::Job;
use lofting::session::disk::Disk;
use lofting::session::run::{Outcome, Task, run};

/// All that comes of a script, with params set from outside.
pub fn outcome(name: &str, text: &[u8], sets: &[(String, String)], disk: &Disk) -> Outcome {
    let clock = || 0.0;
    let task = Task { full: true, ..Task::new(name, text, sets, &clock) };
    run(&task, disk, &Job::default())
}
