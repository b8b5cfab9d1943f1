//! Where outputs stand: each in a file of its own, and none over a file that the script reads.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::disk::same_file;
use super::store::Store;
use crate::base::origin::Origin;
use crate::io::files::fault::OutputFault;
use crate::lang::eval::context::Cx;

/// Says E812 for each file that several outputs of the script would write, and E813 for each output over the script, a
/// module or a file that it imports; gives the files in question, identified as by [`Store::file_of`]: none of them is
/// written. `script` is the resolved name of the script.
pub fn one_file_each(cx: &mut Cx, disk: &dyn Store, script: &str) -> BTreeSet<String> {
    let exports = cx.exports().into_iter().map(|spec| (spec.path_origin, spec.path));
    let pictures = cx.pictures().into_iter().map(|spec| (spec.path_origin, spec.path));
    let outputs: Vec<(Origin, String)> = exports.chain(pictures).collect();
    let mut files: Vec<(String, Vec<(Origin, String)>)> = Vec::new();
    let mut known: BTreeMap<String, usize> = BTreeMap::new();
    for (of, path) in outputs {
        // What may not be written at all is reported when it is tried.
        let Some(file) = disk.file_of(&path) else { continue };
        let place = *known.entry(file.clone()).or_insert(files.len());
        match files.get_mut(place) {
            Some((_, same)) => same.push((of, path)),
            None => files.push((file, vec![(of, path)])),
        }
    }
    let mut barred = BTreeSet::new();
    let (script, read) = (same_file(Path::new(script)), disk.files_read());
    for (file, same) in files {
        if let Some((of, path)) = same.first() {
            let what =
                if file == script { Some("the script itself") } else { read.contains(&file).then_some("a file that this script reads") };
            if let Some(what) = what {
                cx.say(&OutputFault::OverInput { of: *of, path: path.clone(), what: what.to_owned() }.into());
                barred.insert(file.clone());
            }
        }
        if same.len() > 1 {
            let fault = several(cx, same);
            cx.say(&fault.into());
            barred.insert(file);
        }
    }
    barred
}

/// The fault for outputs that are one file: of a family when one place of the script says all of them.
fn several(cx: &Cx, same: Vec<(Origin, String)>) -> OutputFault {
    let count = same.len();
    let mut places = BTreeSet::new();
    let mut outputs = same;
    outputs.retain(|(of, _)| places.insert(cx.span_of(*of)));
    let members = (outputs.len() == 1).then_some(count);
    OutputFault::SameFile { outputs, members }
}
