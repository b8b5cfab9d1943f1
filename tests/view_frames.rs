//! Frames of a model as the live page is sent them: what is drawn and where it comes from, what is kept and what is stale.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use lofting::base::job::Job;
use lofting::session::view::buffer::{Buffer, Role};
use lofting::session::view::frame::Thing;
use lofting::session::view::viewer::{View, Viewer, Wanted};

/// A folder with files, and a viewer of the first.
fn viewer(name: &str, files: &[(&str, &str)]) -> Viewer {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("view-frames-{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    for (file, text) in files {
        fs::write(folder.join(file), text).unwrap();
    }
    Viewer::new(files[0].0, Some(&folder.join(files[0].0)), &[] as &[PathBuf], Arc::new(|| 0.0))
}

fn show(viewer: &mut Viewer, number: u64, text: &str) -> View {
    let wanted = Wanted { number, text: text.to_owned(), ..Wanted::default() };
    viewer.show(&wanted, &Job::new()).unwrap().unwrap()
}

fn thing<'v>(view: &'v View, name: &str) -> &'v Thing {
    view.frame.things.iter().find(|thing| thing.name == name).unwrap_or_else(|| panic!("no {name} in {:?}", names(view)))
}

fn names(view: &View) -> Vec<&str> {
    view.frame.things.iter().map(|thing| &*thing.name).collect()
}

fn buffer<'v>(view: &'v View, name: &str, role: Role) -> &'v Buffer {
    let row = thing(view, name).buffers.iter().find(|row| row.role == role.name()).unwrap();
    &view.buffers[&row.key]
}

/// Numbers of an array by name, as a page reads them.
fn array(buffer: &Buffer, name: &str) -> (serde_json::Value, Vec<f64>) {
    let bytes = &buffer.bytes;
    let length = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize;
    let header: serde_json::Value = serde_json::from_slice(&bytes[8..8 + length]).unwrap();
    let about = &header["arrays"][name];
    let number = |key: &str| about[key].as_u64().unwrap() as usize;
    let (offset, n) = (number("offset"), number("count") * number("width"));
    let values = match about["type"].as_str().unwrap() {
        "f32" => (0..n).map(|k| f64::from(f32::from_le_bytes(bytes[offset + 4 * k..][..4].try_into().unwrap()))).collect(),
        "u32" => (0..n).map(|k| f64::from(u32::from_le_bytes(bytes[offset + 4 * k..][..4].try_into().unwrap()))).collect(),
        "i16" if about["coding"] == "steps" => {
            let step = |k: usize| f64::from(i16::from_le_bytes(bytes[offset + 2 * k..][..2].try_into().unwrap()));
            let width = number("width");
            let mut first = 0.0;
            let place = |k: usize| {
                first += if k.is_multiple_of(width) { step(k) } else { 0.0 };
                if k.is_multiple_of(width) { first } else { first + step(k) }
            };
            (0..n).map(place).collect()
        }
        "i16" => (0..n).map(|k| f64::from(i16::from_le_bytes(bytes[offset + 2 * k..][..2].try_into().unwrap())) / 32767.0).collect(),
        _ => (0..n).map(|k| f64::from(bytes[offset + k])).collect(),
    };
    (header, values)
}

/// Points of a buffer in space.
fn points(buffer: &Buffer) -> Vec<DVec3> {
    let (header, values) = array(buffer, "positions");
    let origin = DVec3::from_array(serde_json::from_value(header["origin"].clone()).unwrap());
    values.chunks(3).map(|p| origin + DVec3::from_slice(p)).collect()
}

/// Area of the triangles, and how far the normals at their corners are from theirs at most, as a cosine.
fn area(buffer: &Buffer) -> (f64, f64) {
    let (p, corners, normals) = (points(buffer), array(buffer, "triangles").1, array(buffer, "normals").1);
    let (mut sum, mut least) = (0.0, 1.0_f64);
    for t in corners.chunks(3) {
        let [a, b, c] = [0, 1, 2].map(|k| t[k] as usize);
        let cross = (p[b] - p[a]).cross(p[c] - p[a]);
        sum += 0.5 * cross.length();
        if cross.length() > 0.0 {
            least = [a, b, c].iter().fold(least, |l, k| l.min(DVec3::from_slice(&normals[3 * k..3 * k + 3]).dot(cross.normalize())));
        }
    }
    (sum, least)
}

const ROOF: &str = "units m
param rise: length = 1.5m in 0.5m to 3m
param bays = 3 in 1 to 8
param kind = flat in [flat, bent]
curve south = arc((0, 0, 0), (4, 0, 0), through: (2, 0, rise))
curve north = arc((0, 3, 0), (4, 3, 0), through: (2, 3, rise))
curve west = line((0, 0, 0), (0, 3, 0))
curve east = line((4, 0, 0), (4, 3, 0))
surface roof = coons(south, east, north, west)
curve foot = line((0, 0, -2), (4, 0, -2))
surface wall = ruled(foot, line((0, 0, -1), (4, 0, -1)))
group top of roof
mesh fine of roof, south { size: 0.4 }
check \"steep\": rise > 1m
check \"far\": roof.area > 100m2
report \"sizes\": [{area: roof.area, length: south.length}]
";

#[test]
fn what_is_drawn_is_the_model() {
    let mut viewer = viewer("roof", &[("roof.loft", ROOF)]);
    let view = show(&mut viewer, 1, ROOF);
    let frame = &view.frame;
    assert_eq!((frame.number, frame.drawn, frame.stale, frame.ok), (1, 1, false, false));
    assert_eq!(names(&view), ["south", "north", "west", "east", "roof", "foot", "wall", "top", "fine"]);
    // An arc over a chord of 4 and a rise of 1.5: radius 25/12, angle 4·atan(3/4).
    let exact = 25.0 / 12.0 * 4.0 * 0.75_f64.atan() * 3.0;
    let (found, leaning) = area(buffer(&view, "roof", Role::Faces));
    assert!((found / exact - 1.0).abs() < 1e-3, "{found} for {exact}");
    assert!(leaning > 0.99, "a normal leans by {leaning}");
    let radius = |p: &DVec3| ((p.x - 2.0).powi(2) + (p.z - (1.5 - 25.0 / 12.0)).powi(2)).sqrt();
    assert!(points(buffer(&view, "south", Role::Lines)).iter().all(|p| (radius(p) - 25.0 / 12.0).abs() < 1e-6));
    // Curvatures are those of the cylinder: 1 / radius, half of it as the mean.
    let bends = array(buffer(&view, "roof", Role::Faces), "curvature").1;
    assert!(bends.chunks(2).all(|b| b[0].abs() < 1e-3 && (b[1].abs() - 0.24).abs() < 1e-3), "{:?}", &bends[..4]);
    let fine = buffer(&view, "fine", Role::Mesh);
    assert_eq!(array(fine, "triangles").1.len() + array(fine, "quads").1.len(), 3 * array(fine, "face").1.len());
    // Elements of groups are numbered as in decks, behind the line elements.
    let (header, elements) = (array(fine, "face").0, array(fine, "face").1.len() as u64);
    let first = header["first_element"].as_u64().unwrap();
    assert_eq!(first, array(fine, "lines").1.len() as u64 / 2 + 1);
    let top = header["groups"].as_array().unwrap().iter().find(|group| group["name"] == "top").unwrap();
    assert_eq!(top["elements"], serde_json::json!([[first, first + elements - 1]]));
    assert!(!thing(&view, "fine").visible && thing(&view, "roof").visible);
    let [low, high] = frame.corners.unwrap();
    assert!((low[2] + 2.0).abs() < 1e-6 && (high[2] - 1.5).abs() < 1e-6, "{low:?} {high:?}");
    let checks: Vec<(&str, bool, usize)> = frame.checks.iter().map(|c| (&*c.name, c.pass, c.place.line)).collect();
    assert_eq!(checks, [("steep", true, 14), ("far", false, 15)]);
    assert_eq!(frame.checks[1].things, ["roof"]);
    assert_eq!((&*frame.reports[0].columns.join(" "), &*frame.reports[0].units.join(" ")), ("area length", "m2 m"));
    let params: Vec<_> = frame.params.iter().map(|p| (&*p.name, p.kind, p.value, &*p.unit, p.min, p.max)).collect();
    let expected = [
        ("rise", "length", Some(1.5), "m", Some(0.5), Some(3.0)),
        ("bays", "count", Some(3.0), "", Some(1.0), Some(8.0)),
        ("kind", "choice", None, "", None, None),
    ];
    assert_eq!(params, expected);
}

#[test]
fn only_what_changed_has_other_keys() {
    let mut viewer = viewer("keys", &[("roof.loft", ROOF)]);
    let keys = |view: &View| -> BTreeMap<String, Vec<String>> {
        view.frame.things.iter().map(|t| (t.name.clone(), t.buffers.iter().map(|b| b.key.clone()).collect())).collect()
    };
    let first = keys(&show(&mut viewer, 1, ROOF));
    assert_eq!(keys(&show(&mut viewer, 2, &format!("// A line above.\n{ROOF}"))), first, "lines moved");
    let lower = keys(&show(&mut viewer, 3, &ROOF.replace("(0, 0, -1)", "(0, 0, -1.1)")));
    // A model that grows a little keeps its triangles.
    let grown = keys(&show(&mut viewer, 4, &ROOF.replace("(0, 0, -2)", "(0, 0, -2.1)")));
    let others: Vec<&String> = first.keys().filter(|name| first[*name] != grown[*name]).collect();
    assert_eq!(others, ["foot", "wall"]);
    let changed: Vec<&String> = first.keys().filter(|name| first[*name] != lower[*name]).collect();
    assert_eq!(changed, ["wall"]);
    // A viewer that knows nothing finds the same.
    let mut other = self::viewer("keys-anew", &[("roof.loft", ROOF)]);
    assert_eq!(keys(&show(&mut other, 1, &ROOF.replace("(0, 0, -1)", "(0, 0, -1.1)"))), lower);
    let finer = Wanted { number: 5, text: ROOF.to_owned(), sets: vec![("rise".into(), "2m".into())], chord_error: Some(5e-4) };
    let set = viewer.show(&finer, &Job::new()).unwrap().unwrap();
    assert!(set.frame.params[0].set && set.frame.params[0].value == Some(2.0));
    assert!(set.frame.chord_error <= 5e-4 && set.frame.chord_error > 2.5e-4, "{}", set.frame.chord_error);
    assert!(set.frame.sources.len() == 1, "texts of options are no sources");
    assert!(keys(&set)["roof"] != first["roof"]);
}

#[test]
fn what_cannot_be_made_stays_as_it_was_and_is_marked() {
    let mut viewer = viewer("stale", &[("roof.loft", ROOF)]);
    let whole = show(&mut viewer, 1, ROOF);
    // A gap: the surface fails, and what stands on it.
    let gap = show(&mut viewer, 2, &ROOF.replace("line((0, 0, 0), (0, 3, 0))", "line((0, 0, 0.05), (0, 3, 0))"));
    assert!(gap.frame.stale && gap.frame.drawn == 2);
    for name in ["roof", "fine"] {
        let (now, before) = (thing(&gap, name), thing(&whole, name));
        assert!(now.stale && now.unmade.is_some() && now.buffers == before.buffers, "{now:?}");
        assert!(now.buffers.iter().all(|row| gap.buffers.contains_key(&row.key)));
    }
    assert!(!thing(&gap, "south").stale && thing(&gap, "west").buffers != thing(&whole, "west").buffers);
    let said = gap.frame.diagnostics.iter().find(|said| said.code == "E501").unwrap();
    assert_eq!((said.points.len(), said.things.contains(&"west".to_owned())), (2, true), "{said:?}");
    assert!((said.size.unwrap() - 0.05).abs() < 1e-9);
    // A text that is no script keeps everything that its declarations would have bound.
    let broken = show(&mut viewer, 3, &ROOF.replace("surface roof = coons(", "surface roof = coons(("));
    assert!(thing(&broken, "roof").stale, "{:?}", names(&broken));
    // What is deleted goes; what is repaired is drawn anew.
    let less = show(&mut viewer, 4, &ROOF.replace("surface wall = ruled(foot, line((0, 0, -1), (4, 0, -1)))\n", ""));
    assert!(!names(&less).contains(&"wall") && !less.frame.stale && thing(&less, "roof").buffers == thing(&whole, "roof").buffers);
}

#[test]
fn a_model_far_away_loses_nothing() {
    let far =
        ROOF.replace("units m\n", "units m\nlet far = 1000000m\n").replace("(0, 0, -2), (4, 0, -2)", "(far, 0, -2), (far + 4m, 0, -2)");
    let far = far.replace("(0, 0, -1), (4, 0, -1)", "(far, 0, -1), (far + 4m, 0, -1)");
    let mut viewer = viewer("far", &[("roof.loft", &far)]);
    let view = show(&mut viewer, 1, &far);
    let wall = points(buffer(&view, "wall", Role::Faces));
    let off = wall.iter().map(|p| (p.x - 1e6).min((p.x - 1e6 - 4.0).abs()).abs()).fold(0.0, f64::max);
    assert!(!wall.is_empty() && off < 1e-6, "{off}");
}

#[test]
fn shapes_come_before_the_rest() {
    let mut viewer = viewer("partial", &[("roof.loft", ROOF)]);
    let mut early = Vec::new();
    let mut show = |number: u64, text: &str, early: &mut Vec<View>| {
        let wanted = Wanted { number, text: text.to_owned(), ..Wanted::default() };
        viewer.show_early(&wanted, &Job::new(), &mut |view| early.push(view)).unwrap().unwrap()
    };
    let whole = show(2, ROOF, &mut early);
    let part = early.pop().expect("the first run shows its shapes");
    assert!(part.frame.partial && part.frame.number == 1 && !whole.frame.partial && whole.frame.number == 2);
    assert!(part.frame.checks.is_empty() && part.frame.reports.is_empty());
    assert_eq!(
        (&part.frame.params, &part.frame.sources, &part.frame.units),
        (&whole.frame.params, &whole.frame.sources, &whole.frame.units)
    );
    let shapes: Vec<&str> = whole.frame.things.iter().filter(|t| t.kind != "mesh" && t.kind != "group").map(|t| &*t.name).collect();
    for name in shapes {
        assert_eq!(thing(&part, name).buffers, thing(&whole, name).buffers, "{name}");
        assert!(thing(&part, name).buffers.iter().all(|row| part.buffers.contains_key(&row.key)));
    }
    for name in ["fine", "top"] {
        assert!(thing(&part, name).pending && thing(&part, name).buffers.is_empty(), "{name} is not made for it");
    }
    // The clock of these tests stands: the rest took no time, so that nothing is shown early again.
    let again = show(4, &ROOF.replace("(0, 0, -1)", "(0, 0, -1.1)"), &mut early);
    assert!(early.is_empty() && again.frame.number == 4);
}

#[test]
fn what_is_not_made_yet_stays_with_a_mark() {
    let now = Arc::new(std::sync::atomic::AtomicU64::new(0));
    let ticks = now.clone();
    // Each look at the clock takes a second, so that all runs are long.
    let clock = Arc::new(move || ticks.fetch_add(1, std::sync::atomic::Ordering::Relaxed) as f64);
    let mut viewer = Viewer::new("roof.loft", None, &[] as &[PathBuf], clock);
    let mut early = Vec::new();
    let mut show = |number: u64, text: &str, early: &mut Vec<View>| {
        let wanted = Wanted { number, text: text.to_owned(), ..Wanted::default() };
        viewer.show_early(&wanted, &Job::new(), &mut |view| early.push(view)).unwrap().unwrap()
    };
    let first = show(2, ROOF, &mut early);
    let second = show(4, &ROOF.replace("(0, 0, -1)", "(0, 0, -1.1)"), &mut early);
    let [_, part] = &early[..] else { panic!("{} partial frames", early.len()) };
    assert!(part.frame.number == 3 && thing(part, "fine").stale && thing(part, "fine").unmade.is_none());
    assert_eq!(thing(part, "fine").buffers, thing(&first, "fine").buffers);
    assert!(thing(part, "fine").buffers.iter().all(|row| part.buffers.contains_key(&row.key)));
    assert_eq!(thing(part, "wall").buffers, thing(&second, "wall").buffers);
    assert_ne!(thing(part, "wall").buffers, thing(&first, "wall").buffers);
    assert!(thing(part, "roof").facts.contains(&("patches".to_owned(), "1".to_owned())), "{:?}", thing(part, "roof").facts);
    assert!(!second.frame.stale && !thing(&second, "fine").stale);
}

const SIZES: &str = "units m
curve a = line((0, 0, 0), (4, 0, 0))
curve b = line((4, 0, 0), (4, 4, 0))
curve c = line((4, 4, 0), (0, 4, 0))
curve d = line((0, 4, 0), (0, 0, 0))
surface flat = coons(a, b, c, d)
mesh free of flat { method: delaunay  size: 0.5m  on a { count: 16 }  near (2, 2, 0) { size: 0.1m } }
mesh even of flat { method: mapped  size: 0.5m  on b { count: 16 } }
surface round = revolve(line((2, 0, 5), (3, 0, 9)), axis: line((0, 0, 5), (0, 0, 6)))
mesh few of round { method: display  chord_error: 1cm }
mesh second of flat { method: delaunay  size: 0.5m  order: 2 }
mesh lines of round { method: isoline  chord_error: 1cm  size: 2m }
";

#[test]
fn meshes_tell_what_decided_their_sizes() {
    let mut viewer = viewer("sizes", &[("sizes.loft", SIZES)]);
    let view = show(&mut viewer, 1, SIZES);
    assert!(view.frame.ok, "{:?}", view.frame.diagnostics);
    let found = |name: &str| {
        let mesh = buffer(&view, name, Role::Mesh);
        let (header, of) = array(mesh, "decided");
        let words: Vec<String> = header["deciders"].as_array().unwrap().iter().map(|w| w.as_str().unwrap().to_owned()).collect();
        let asked = array(mesh, "asked").1;
        assert_eq!((of.len(), asked.len()), (points(mesh).len(), points(mesh).len()));
        points(mesh).into_iter().zip(of.into_iter().map(move |k| words[k as usize].clone())).zip(asked).collect::<Vec<_>>()
    };
    let close = |a: f64, b: f64| (a - b).abs() < 1e-6 * b;
    // How many nodes are near a place, on a count and on a side of the size alone.
    let mut seen = [0; 3];
    for ((p, word), asked) in found("free") {
        assert!(word != "not known" && asked > 0.0 && asked <= 0.500_001, "{p} {word} {asked}");
        let off = p.distance(DVec3::new(2.0, 2.0, 0.0));
        if off < 0.2 {
            assert!(word == "size 0.1 near (2, 2, 0)" && asked < 0.2, "{p} {word} {asked}");
            seen[0] += 1;
        }
        if p.y == 0.0 && p.x > 0.5 && p.x < 3.5 {
            assert!(word == "count 16 on a" && close(asked, 0.25), "{p} {word} {asked}");
            seen[1] += 1;
        }
        if p.x == 4.0 && p.y > 3.2 && p.y < 3.9 {
            // Nodes on the border of a free face are to be nearer to each other than sides may be long.
            assert!(word == "the size" && close(asked, 0.4), "{p} {word} {asked}");
            seen[2] += 1;
        }
    }
    assert!(seen[0] > 4 && seen[1] == 11 && seen[2] > 0, "{seen:?}");
    // Rows lead from side to side: the count of one side decides them.
    let inner = |p: &DVec3| p.y > 0.1 && p.y < 3.9 && p.x > 0.1 && p.x < 3.9;
    let even: Vec<_> = found("even").into_iter().filter(|((p, _), _)| inner(p)).collect();
    assert_eq!(even.len(), 7 * 15);
    assert!(even.iter().all(|((_, word), asked)| word == "count 16 on b" && close(*asked, 0.25)), "{even:?}");
    // As few triangles as the limit allows, a mesh of second order, and lines between equal parameters.
    for (name, words) in [("few", vec!["chord_error"]), ("second", vec!["the size"]), ("lines", vec!["chord_error", "the size"])] {
        let all = found(name);
        assert!(!all.is_empty());
        for ((p, word), _) in all {
            assert!(words.contains(&&*word) || word.starts_with("chord_error"), "{name} at {p}: {word}");
        }
    }
}

#[test]
fn a_stopped_evaluation_gives_no_frame() {
    let mut viewer = viewer("stop", &[("roof.loft", ROOF)]);
    let job = Job::new();
    job.cancel();
    let wanted = Wanted { number: 1, text: ROOF.to_owned(), ..Wanted::default() };
    assert!(viewer.show(&wanted, &job).unwrap().is_none());
    assert_eq!(show(&mut viewer, 2, ROOF).frame.number, 2);
}

const BAY: &str = "units m
param height = 3m
curve post = line((0, 0, 0), (0, 0, height))
curve beam = line((0, 0, height), (4, 0, height))
surface panel = ruled(line((0, 0, 0), (4, 0, 0)), beam)
fn stay(x: length) = line((x, 0, 0), (x, 0, height))
surface bays for k in 0..2 = move(panel, (0, k * 1m, 0))
";

const HALL: &str = "units m
use \"bay.loft\" (height: 2m) as bay
fn rib(x: length) = line((x, 0, 0), (x, 3, 0))
fn pair(x: length) = [rib(x), rib(x + 1m)]

curve first = rib(0m)
curve ribs for i in 0..3 = rib(i * 2m)
surface panel = bay.panel
surface floor = ruled(rib(0m), rib(4m))
let pairs = pair(7m)
curve plain = line((0, 0, 0),
  (4, 0, 0))
shell all of panel, floor
group lines of first, plain
mesh m of floor { size: 1m }
point corner = (1, 2, 3)
surface moved = move(floor, (0, 0, 1))
surface copies for k in 0..2 = move(bay.panel, (0, 5m * (k + 1), 0))
curve stay = bay.stay(1m)
surface second = bay.bays[1]
curve chosen = if 2 > 1 then rib(9m) else plain
curve raised for c in pairs = move(c, (0, 0, 1))
group posts of bay.post, stay
surface between for i in 0..2 = ruled(ribs[i], ribs[i + 1])
mesh fine of copies { size: 1m }
let walls = [ruled(bay.post, bay.stay(4m)), panel]
fn through(x: length) = bay.stay(x)
surface faced = ruled(through(4m), bay.post)
";

/// Each thing leads to the lines that a person would name: its own first, then the functions and modules that its declaration names.
#[test]
fn things_lead_to_their_lines() {
    let mut viewer = viewer("lines", &[("hall.loft", HALL), ("bay.loft", BAY)]);
    let view = show(&mut viewer, 1, HALL);
    assert_eq!(view.frame.diagnostics.iter().filter(|d| d.severity == "error").count(), 0, "{:?}", view.frame.diagnostics);
    let chain = |name: &str| -> String {
        let line = |p: &lofting::session::view::frame::Place| format!("{}{}", if p.file == 0 { "" } else { "bay " }, p.line);
        thing(&view, name).chain.iter().map(line).collect::<Vec<_>>().join(" ")
    };
    let expected = [
        ("first", "6 3"),
        ("ribs[0]", "7 3"),
        ("ribs[2]", "7 3"),
        ("panel", "8 2 bay 5"),
        ("floor", "9 3"),
        ("pairs[0]", "10 4 3"),
        ("plain", "11"),
        ("all", "13"),
        ("lines", "14"),
        ("m", "15"),
        ("corner", "16"),
        ("moved", "17"),
        ("copies[1]", "18 2 bay 5"),
        ("stay", "19 2 bay 6"),
        ("second", "20 2 bay 7"),
        ("chosen", "21 3"),
        ("raised[1]", "22"),
        ("posts", "23 2 bay 3"),
        ("between[0]", "24"),
        ("fine", "25"),
        ("walls[0]", "26 2 bay 3 bay 6"),
        ("faced", "28 2 bay 3 27 bay 6"),
    ];
    let found: Vec<(&str, String)> = expected.iter().map(|(name, _)| (*name, chain(name))).collect();
    assert_eq!(found, expected.map(|(name, lines)| (name, lines.to_owned())));
    let plain = &thing(&view, "plain").chain[0];
    assert_eq!((plain.line, plain.end_line), (11, 12));
    assert_eq!(view.frame.sources.iter().map(|s| &*s.file).collect::<Vec<_>>(), ["hall.loft", "bay.loft"]);
    assert!(view.frame.sources.iter().all(|s| Path::new(&s.path).is_file()));
}

/// A family of many members is one thing that is drawn at once, in which each has its name.
#[test]
fn many_members_are_one_thing() {
    let text = "units m\ncurve few for i in 0..40 = line((i * 1m, 0, 0), (i * 1m, 1, 0))\ncurve many for i in 0..50 = line((i * 1m, 0, 1), (i * 1m, 1, 1))\n";
    let mut viewer = viewer("many", &[("many.loft", text)]);
    let view = show(&mut viewer, 1, text);
    assert_eq!(view.frame.things.len(), 41, "{:?}", names(&view));
    let (header, starts) = array(buffer(&view, "many", Role::Lines), "starts");
    assert_eq!((starts.len(), &header["edges"][49]["name"]), (51, &serde_json::Value::from("many[49]")));
    assert_eq!(thing(&view, "many").chain[0].line, 3);
}

/// A shell says which of its surfaces other things draw, a group which surfaces and patches it has, and an edge how many faces meet on it.
#[test]
fn shells_and_groups_name_what_other_things_draw() {
    let text = "units m\n\
        curve rim = polyline([(0, 0, 0), (2, 0, 0), (2, 1, 0)])\n\
        surface walls = extrude(rim, by: (0, 0, 1))\n\
        surface fin = extrude(line((2, 0, 0), (3, 0, 0)), by: (0, 0, 1))\n\
        shell both of walls, fin, move(fin, by: (0, 1, 0)) { imprint: true }\n\
        group first of walls.patches[0], fin\n\
        group all of both\n";
    let mut viewer = viewer("held", &[("held.loft", text)]);
    let view = show(&mut viewer, 1, text);
    assert_eq!(thing(&view, "both").surfaces, ["walls", "fin"]);
    assert_eq!(thing(&view, "first").surfaces, ["walls.patches[0]", "fin"]);
    assert_eq!(thing(&view, "all").surfaces.len(), 3);
    let mut meeting = array(buffer(&view, "both", Role::Edges), "faces").1;
    meeting.sort_by(f64::total_cmp);
    assert_eq!(meeting.last(), Some(&3.0), "{meeting:?}");
    assert!(thing(&view, "walls").surfaces.is_empty());
}
