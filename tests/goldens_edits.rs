//! Random edits of the examples: a number that changes the model fails its golden, what changes nothing does not.
//!
//! 22 edits of each kind, 100 in a long run; `LOFT_EDITS` says how many. Examples with
//! large meshes are left out: nearly all of their time goes into those.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use lofting::base::job::Job;
use lofting::lang::eval::context::Cx;
use lofting::lang::syntax::keywords::openers;
use lofting::lang::values::value::ModuleId;
use lofting::session::disk::{Disk, Outputs};
use lofting::session::golden::{Settings, discover, run_one_again};
use lofting::session::guard::guarded;
use lofting::session::kept::Kept;
use lofting::session::run::{Task, run_seen};
use lofting::surface::Side;

use crate::support::long::count;
use crate::support::random::Random;

/// Share of the diagonal of the model's box by which values may differ that are one: the centroid of a curve moves less than the
/// place that moves most, so it is some times what a golden allows.
const SAME: f64 = 4e-9;

/// Examples that are edited: those whose meshes have a few thousand elements, the same on every machine.
const EXAMPLES: &[&str] = &["barrel_vault", "block", "canopy", "fuselage", "greenhouse", "perforated", "porch", "tank", "wing"];

/// A folder with one example and its accepted golden.
struct Folder {
    path: PathBuf,
    base: String,
    /// What its last run left for the next one: most edits leave most of a model as it was.
    kept: Kept,
}

impl Folder {
    fn of(kind: &str, example: &Path) -> Self {
        let name = example.file_stem().unwrap().to_string_lossy();
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("edits-{kind}-{name}"));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(path.join("data")).unwrap();
        for entry in fs::read_dir("examples/data").unwrap().flatten() {
            fs::copy(entry.path(), path.join("data").join(entry.file_name())).unwrap();
        }
        let mut folder = Self { path, base: fs::read_to_string(example).unwrap(), kept: Kept::default() };
        folder.run(&folder.base.clone(), true);
        folder
    }

    /// What the golden says about a script; empty when it passes.
    fn run(&mut self, script: &str, accept: bool) -> String {
        let model = self.path.join("model.loft");
        fs::write(&model, script).unwrap();
        let (job, clock) = (Job::new(), || 0.0);
        let settings = Settings { accept, filter: None, jobs: 1, clock: &clock, job: &job };
        let mut said = String::new();
        let cases = run_one_again(&discover(&[model]).unwrap()[0], &settings, &mut self.kept);
        for case in cases.iter().filter(|case| !case.verdict.is_good()) {
            let lines: Vec<String> = case.lines.iter().map(|said| said.text(false)).collect();
            said.push_str(&format!("{}\n{}\n", case.message, lines.join("\n")));
        }
        said
    }

    /// All that was evaluated of a script: words and numbers, and places on curves and surfaces; not what a golden makes of them.
    fn evaluated(&self, script: &str) -> (String, Vec<f64>) {
        let disk = Disk::new(Some(&self.path.join("model.loft")), None, &[], Outputs::Counted).unwrap();
        let clock = || 0.0;
        let task = Task { full: true, ..Task::new("model.loft", script.as_bytes(), &[], &clock) };
        let mut found = (String::new(), Vec::new());
        let job = Job::new();
        let outcome = guarded(|| run_seen(&task, &disk, &job, &mut |cx| found = values(cx))).unwrap();
        let said: Vec<String> = outcome.diagnostics.iter().map(|d| d.message.clone()).collect();
        (format!("{}{said:?}", found.0), found.1)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.path);
    }
}

fn values(cx: &mut Cx) -> (String, Vec<f64>) {
    let (mut out, mut places) = (String::new(), Vec::new());
    let mut put = |text: String| out.push_str(&(text + "\n"));
    if let Ok(parts) = cx.parts(ModuleId::MAIN) {
        const STEPS: usize = 16;
        let step = |k: usize| k as f64 / STEPS as f64;
        parts.points.iter().for_each(|p| places.extend(p.value.to_array()));
        for chain in parts.curves.iter().chain(&parts.modeling) {
            (0..=STEPS).for_each(|k| places.extend(chain.value.point(step(k)).to_array()));
        }
        for surface in &parts.surfaces {
            let all = (0..=STEPS).flat_map(|i| (0..=STEPS).map(move |j| (i, j)));
            all.for_each(|(i, j)| places.extend(surface.value.point(step(i), step(j)).to_array()));
            // What is trimmed may end elsewhere on the same surface.
            (0..surface.value.n_sides()).for_each(|side| {
                if let Side::Chain { chain, from, to } = surface.value.side(side) {
                    (0..=STEPS).for_each(|k| places.extend(chain.point(from + (to - from) * step(k)).to_array()));
                }
            });
        }
    }
    for group in cx.groups(ModuleId::MAIN).unwrap_or_default() {
        let shown: Vec<String> = group.value.iter().map(|v| cx.show(v)).collect();
        put(shown.join(" "));
    }
    for mesh in cx.meshes(ModuleId::MAIN) {
        put(format!("{:?}", mesh.settings));
        mesh.rules.iter().for_each(|r| put(format!("{:?}", r.settings)));
        mesh.refines.iter().for_each(|r| put(format!("{:?} {:?} {:?}", r.boxes, r.size, r.radius)));
    }
    for check in cx.checks() {
        let sides = [&check.left_value, &check.right_value, &check.allowed];
        put(format!("{} {:?}", check.pass, sides.map(|side| side.as_ref().map(|v| cx.show(v)))));
    }
    for report in cx.reports() {
        report.rows.iter().flatten().for_each(|cell| put(cx.show(cell)));
    }
    cx.pictures().iter().for_each(|p| put(format!("{:?} {:?} {:?} {:?}", p.view, p.size, p.title, p.show)));
    cx.exports().iter().for_each(|e| e.things.iter().for_each(|t| put(cx.show(&t.0))));
    (out, places)
}

/// Numbers of a text, and what stands between them.
fn pieces(words: &str) -> Vec<&str> {
    let (mut found, mut start) = (Vec::new(), 0);
    let is_number = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '+' | '_');
    for (at, c) in words.char_indices() {
        if !is_number(c) {
            found.extend([&words[start..at], &words[at..at + c.len_utf8()]]);
            start = at + c.len_utf8();
        }
    }
    found.push(&words[start..]);
    found
}

fn same((words, places): &(String, Vec<f64>), (others, there): &(String, Vec<f64>)) -> bool {
    let ends = |axis: usize| {
        let all = places.iter().skip(axis).step_by(3).filter(|x| x.is_finite());
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)))
    };
    let size = (0..3).map(|axis| ends(axis).1 - ends(axis).0).filter(|d| d.is_finite()).map(|d| d * d).sum::<f64>().sqrt();
    let near = |a: f64, b: f64| (a - b).abs() <= SAME * size || a.is_nan() && b.is_nan();
    let unit = |text: &str| text.len() - text.trim_end_matches(|c: char| c.is_alphabetic()).len();
    let alike = |a: &str, b: &str| {
        let (number, last) =
            (|text: &str| text[..text.len() - unit(text)].parse::<f64>(), |text: &str| text[text.len() - unit(text)..].to_owned());
        match (number(a), number(b)) {
            _ if a == b => true,
            (Ok(x), Ok(y)) => (x - y).abs() <= SAME * x.abs() && last(a) == last(b),
            _ => false,
        }
    };
    let (one, other) = (pieces(words), pieces(others));
    let told = one.len() == other.len() && one.iter().zip(&other).all(|(a, b)| alike(a, b));
    told && places.len() == there.len() && places.iter().zip(there).all(|(a, b)| near(*a, *b))
}

/// Stretches of a script that are code: comments and texts aside, what is interpolated into texts included.
fn code(text: &str) -> Vec<bool> {
    let bytes = text.as_bytes();
    let (mut is, mut at, mut quotes) = (vec![false; bytes.len()], 0, Vec::new());
    let mut inside = false;
    while at < bytes.len() {
        match bytes[at] {
            b'\\' if inside => at += 1,
            b'"' => inside = !inside,
            b'{' if inside => {
                quotes.push(0);
                inside = false;
            }
            b'}' if !inside && quotes.last() == Some(&0) => {
                quotes.pop();
                inside = true;
            }
            b'{' if !inside && !quotes.is_empty() => *quotes.last_mut().unwrap() += 1,
            b'}' if !inside && !quotes.is_empty() => *quotes.last_mut().unwrap() -= 1,
            b'/' if !inside && bytes.get(at + 1) == Some(&b'/') => {
                while at < bytes.len() && bytes[at] != b'\n' {
                    at += 1;
                }
                continue;
            }
            _ => is[at] = !inside,
        }
        at += 1;
    }
    is
}

fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_' || byte >= 128
}

/// Places of numbers. The limits of a param (`in 1..9`) are none: they are tested and then forgotten.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let (bytes, is) = (text.as_bytes(), code(text));
    let (mut found, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        let starts = is[at] && bytes[at].is_ascii_digit() && (at == 0 || !is_word(bytes[at - 1]));
        // A digit behind `a.` or `1.` goes on with what stands there; behind `..` it begins anew.
        let follows = at > 1 && bytes[at - 1] == b'.' && bytes[at - 2] != b'.';
        if !starts || follows {
            at += 1;
            continue;
        }
        let digits = |mut at: usize| {
            while at < bytes.len() && bytes[at].is_ascii_digit() {
                at += 1;
            }
            at
        };
        let mut end = digits(at);
        if bytes.get(end) == Some(&b'.') && bytes.get(end + 1).is_some_and(u8::is_ascii_digit) {
            end = digits(end + 1);
        }
        let line = text[..at].rfind('\n').map_or(0, |n| n + 1);
        let limit = text[line..].starts_with("param ") && text[line..at].contains(" in ");
        if !limit {
            found.push((at, end));
        }
        at = end.max(at + 1);
    }
    found
}

/// One number is another one, by at least 1e-5 of itself.
fn with_another_number(text: &str, random: &mut Random) -> String {
    let all = numbers(text);
    let (start, end) = all[random.below(all.len())];
    let old: f64 = text[start..end].parse().unwrap();
    let bare = !text[end..].starts_with(|c: char| c.is_alphabetic() || c == '%');
    let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
    let new = if bare && old.fract() == 0.0 && random.below(2) == 0 {
        if old > 0.0 { old + sign } else { 1.0 }
    } else {
        let share = 10.0_f64.powf(-5.0 * random.share());
        if old == 0.0 { share } else { old * (1.0 + sign * 0.5 * share) }
    };
    format!("{}{new}{}", &text[..start], &text[end..])
}

const HEADS: &[&str] = &["units", "tolerance", "snap", "use"];
/// The declarations of a script with the comments above them; what stands above all of them first.
fn declarations(text: &str) -> Vec<String> {
    let opens: Vec<&str> = openers().into_iter().map(|word| word.word).collect();
    let mut all: Vec<String> = vec![String::new()];
    let mut above = String::new();
    for line in text.lines() {
        let word = line.split(|c: char| !c.is_alphanumeric()).next().unwrap_or("");
        if line.starts_with("//") || line.trim().is_empty() {
            above.push_str(&format!("{line}\n"));
        } else {
            if opens.contains(&word) {
                all.push(std::mem::take(&mut above));
            }
            let last = all.last_mut().unwrap();
            last.push_str(&std::mem::take(&mut above));
            last.push_str(&format!("{line}\n"));
        }
    }
    all
}

/// The declarations in another order; the head stays where it is.
fn shuffled(text: &str, random: &mut Random) -> String {
    let is_head = |d: &String| {
        let first = d.lines().find(|line| !line.starts_with("//") && !line.trim().is_empty());
        first.is_none_or(|line| HEADS.contains(&line.split(' ').next().unwrap_or("")))
    };
    let (head, mut rest): (Vec<String>, Vec<String>) = declarations(text).into_iter().partition(is_head);
    for k in (1..rest.len()).rev() {
        rest.swap(k, random.below(k + 1));
    }
    head.concat() + &rest.concat()
}

/// Names of `let`s, parameters of functions and members of comprehensions, which no golden shows.
fn inner_names(text: &str) -> Vec<String> {
    let (bytes, is) = (text.as_bytes(), code(text));
    let word_at = |at: usize| -> &str {
        let end = (at..bytes.len()).find(|k| !is_word(bytes[*k])).unwrap_or(bytes.len());
        &text[at..end]
    };
    let mut found: Vec<String> = Vec::new();
    for at in (0..bytes.len()).filter(|at| is[*at] && (*at == 0 || !is_word(bytes[*at - 1]))) {
        let rest = &text[at..];
        for before in ["let ", "for "] {
            if rest.starts_with(before) {
                found.push(word_at(at + before.len()).to_owned());
            }
        }
        if rest.starts_with("fn ") {
            let (open, close) = (rest.find('(').unwrap_or(0), rest.find(')').unwrap_or(0));
            let parameters = rest.get(open + 1..close).unwrap_or("");
            found.extend(parameters.split(',').map(|p| p.trim().split([' ', ':', '=']).next().unwrap_or("").to_owned()));
        }
    }
    // A name that is also a field, a setting or a named argument stays as it is.
    let taken = |name: &str| text.contains(&format!("{name}:")) || text.contains(&format!(".{name}"));
    found.retain(|name| !name.is_empty() && name.bytes().all(is_word) && !name.as_bytes()[0].is_ascii_digit() && !taken(name));
    found.sort();
    found.dedup();
    found
}

fn renamed(text: &str, old: &str, new: &str) -> String {
    let (bytes, is) = (text.as_bytes(), code(text));
    let (mut out, mut at) = (String::new(), 0);
    while at < text.len() {
        let whole = text[at..].starts_with(old)
            && is[at]
            && (at == 0 || !is_word(bytes[at - 1]))
            && !bytes.get(at + old.len()).is_some_and(|b| is_word(*b));
        if whole {
            out.push_str(new);
            at += old.len();
        } else {
            let c = text[at..].chars().next().unwrap();
            out.push(c);
            at += c.len_utf8();
        }
    }
    out
}

/// An edit without effect, and what it is.
fn idle(text: &str, random: &mut Random) -> (&'static str, String) {
    match random.below(4) {
        0 => ("another order", shuffled(text, random)),
        1 => {
            let names = inner_names(text);
            if names.is_empty() {
                return ("another order", shuffled(text, random));
            }
            let name = &names[random.below(names.len())];
            ("a renamed inner name", renamed(text, name, &format!("{name}_renamed")))
        }
        2 => {
            let parts = declarations(text);
            ("comments", parts.iter().map(|d| format!("// note {}\n{d}", random.below(100))).collect())
        }
        _ => {
            let enclosure: String = declarations(text).iter().map(|d| format!("{d}\n")).collect();
            (
                "another layout",
                if random.below(2) == 0 { enclosure } else { lofting::lang::fmt::format(&enclosure.replace(", ", ",")).text },
            )
        }
    }
}

/// How many edits are tried in all.
fn wanted() -> usize {
    count("LOFT_EDITS", 22, 100)
}

/// The edits of each example, which are made from a seed of its own: `each` gives what is wrong with one, or nothing.
///
/// The examples go side by side, each in a folder of its own.
fn tried(kind: &str, each: impl Fn(&mut Folder, &mut Random, &mut Tally) + Sync) -> Tally {
    let next = AtomicUsize::new(0);
    let all = Mutex::new(Tally::default());
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(example) = EXAMPLES.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let place = EXAMPLES.iter().position(|name| name == example).unwrap();
                    let edits = (wanted() + EXAMPLES.len() - 1 - place) / EXAMPLES.len();
                    let mut folder = Folder::of(kind, &Path::new("examples").join(format!("{example}.loft")));
                    let (mut random, mut tally) = (Random(1000 + place as u64), Tally::default());
                    for _ in 0..edits {
                        tally.edits += 1;
                        each(&mut folder, &mut random, &mut tally);
                    }
                    let mut all = all.lock().unwrap();
                    all.edits += tally.edits;
                    all.without_effect += tally.without_effect;
                    all.wrong.extend(tally.wrong);
                }
            });
        }
    });
    all.into_inner().unwrap()
}

/// What became of edits.
#[derive(Default)]
struct Tally {
    edits: usize,
    without_effect: usize,
    wrong: Vec<String>,
}

#[test]
fn no_changed_number_passes() {
    let tally = tried("numbers", |folder, random, tally| {
        let edited = with_another_number(&folder.base, random);
        if !folder.run(&edited, false).is_empty() {
            return;
        }
        // Silence is right only where no value that was evaluated is another one.
        if same(&folder.evaluated(&edited), &folder.evaluated(&folder.base)) {
            tally.without_effect += 1;
        } else {
            let line = edited.lines().zip(folder.base.lines()).find(|(a, b)| a != b).map_or("", |(a, _)| a);
            tally.wrong.push(format!("{}: {line}", folder.path.display()));
        }
    });
    println!("{} edits of {} examples, {} without any effect", tally.edits, EXAMPLES.len(), tally.without_effect);
    assert_eq!(tally.edits, wanted());
    assert!(tally.wrong.is_empty(), "{} of {} edits are not seen:\n{}", tally.wrong.len(), tally.edits, tally.wrong.join("\n"));
    assert!(tally.without_effect * 5 <= tally.edits, "{} of {} edits had no effect", tally.without_effect, tally.edits);
}

#[test]
fn no_edit_without_effect_fails() {
    let tally = tried("idle", |folder, random, tally| {
        let (what, edited) = idle(&folder.base, random);
        let said = folder.run(&edited, false);
        if !said.is_empty() {
            tally.wrong.push(format!("{} after {what}:\n{said}", folder.path.display()));
        }
    });
    println!("{} edits of {} examples", tally.edits, EXAMPLES.len());
    assert_eq!(tally.edits, wanted());
    assert!(tally.wrong.is_empty(), "{} of {} edits fail:\n{}", tally.wrong.len(), tally.edits, tally.wrong.join("\n"));
}
