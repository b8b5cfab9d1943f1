//! Plots and lines plans as measured in their SVG files: ticks, series, circles of a sphere, scales; and what is told of bad ones.

use glam::DVec2;
use lofting::Script;

/// Millimetres of a pixel of a printed SVG.
const PIXEL: f64 = 25.4 / 96.0;

fn svg(text: &str, file: &str) -> String {
    let model = Script::from_str(text).run().unwrap_or_else(|e| panic!("{}", e.report()));
    model.output(file).unwrap().text().unwrap().to_owned()
}

fn code(text: &str) -> (String, String) {
    match Script::from_str(text).run() {
        Ok(_) => panic!("no error: {text}"),
        Err(e) => (e.code().to_owned(), e.report()),
    }
}

fn attribute<'t>(line: &'t str, name: &str) -> Option<&'t str> {
    let from = line.find(&format!(" {name}=\""))? + name.len() + 3;
    line[from..].split('"').next()
}

/// Lines of a colour, as points.
fn strokes(svg: &str, color: &str) -> Vec<Vec<DVec2>> {
    let own = svg.lines().filter(|line| line.starts_with("<path") && attribute(line, "stroke") == Some(color));
    let points = |line: &str| {
        let numbers: Vec<f64> = attribute(line, "d").unwrap().split(['M', 'L', ' ']).filter_map(|n| n.parse().ok()).collect();
        numbers.chunks(2).map(|p| DVec2::new(p[0], p[1])).collect()
    };
    own.map(points).collect()
}

fn texts(svg: &str) -> Vec<&str> {
    let text = |line: &'_ str| -> Option<usize> { line.find('>').map(|k| k + 1) };
    svg.lines().filter(|line| line.starts_with("<text")).map(|line| line[text(line).unwrap()..].trim_end_matches("</text>")).collect()
}

const ROWS: &str = "units m
let rows = [for k in 0..11: {draft: k * 1m, volume: 40m2 * k * 1m, lcb: k * 100mm - 500mm, gap: if k == 5 then none else k * 1m, name: \"row\"}]
";

#[test]
fn a_plot_has_round_ticks_units_and_its_values_in_place() {
    let svg = svg(&format!("{ROWS}picture plot(rows, x: \"draft\", y: \"volume\") to \"a.svg\" {{ width: 1000  height: 800 }}\n"), "a.svg");
    let texts = texts(&svg);
    for words in ["0", "2", "4", "6", "8", "10", "100", "400", "draft [m]", "volume [m3]", "volume over draft"] {
        assert!(texts.contains(&words), "{words}: {texts:?}");
    }
    let lines = strokes(&svg, "#005cb8");
    assert_eq!(lines.len(), 1);
    let line = &lines[0];
    assert_eq!(line.len(), 11);
    // Straight from the lower left to the upper right corner of the frame.
    let frame = strokes(&svg, "#22262e").into_iter().find(|line| line.len() == 5).unwrap();
    let (low, high) = (frame[3], frame[1]);
    assert!(line[0].distance(low) < 0.02 && line[10].distance(high) < 0.02, "{line:?} {frame:?}");
    assert!(line[0].lerp(line[10], 0.3).distance(line[3]) < 0.02);
}

#[test]
fn columns_of_two_units_have_an_axis_on_either_side_and_none_is_a_gap() {
    let text = format!("{ROWS}picture plot(rows, x: \"draft\", y: [\"volume\", \"lcb\", \"gap\"]) to \"a.svg\"\n");
    let svg = svg(&text, "a.svg");
    let texts = texts(&svg);
    assert!(texts.contains(&"volume [m3]") && texts.contains(&"lcb, gap [m]"), "{texts:?}");
    // The series and its sign in the legend; the gap parts a line.
    assert_eq!(strokes(&svg, "#005cb8").len(), 2);
    assert_eq!(strokes(&svg, "#d45400").len(), 2);
    let parted = strokes(&svg, "#008662");
    assert_eq!(parted.iter().map(Vec::len).collect::<Vec<_>>(), [5, 5, 2]);
    assert_eq!(svg, self::svg(&text, "a.svg"));
}

#[test]
fn plots_become_png_as_well() {
    let model = Script::from_str(&format!(
        "{ROWS}picture plot(rows, x: \"draft\", y: \"volume\", style: both) to \"a.png\" {{ width: 300  height: 200 }}\n"
    ));
    let model = model.run().unwrap();
    let bytes = model.output("a.png").unwrap().bytes().unwrap().to_vec();
    let (width, pixels) = lofting::draw::png::read(&bytes).unwrap();
    assert_eq!((width, pixels.len()), (300, 300 * 200));
    let blue = pixels.iter().filter(|p| p[2] > 150 && p[0] < 60).count();
    assert!(blue > 150, "{blue}");
}

const BALL: &str = "units m
curve half = arc((0, 0, -2), (0, 0, 2), through: (2, 0, 0))
surface side = revolve(half, angle: 180deg)
surface whole = revolve(half)
";

/// The scale of a lines plan, pixels of a metre.
fn pixels(svg: &str) -> f64 {
    let texts = texts(svg);
    let scale = texts.iter().find_map(|t| t.strip_prefix("1 : ")?.split(',').next()).unwrap();
    1000.0 / (scale.parse::<f64>().unwrap() * PIXEL)
}

/// The radius that all points of some lines have round one of some places.
fn radii(lines: &[Vec<DVec2>]) -> Vec<f64> {
    let of = |line: &Vec<DVec2>| {
        // The circle through three of its points.
        let (a, b, c) = (line[0], line[line.len() / 3], line[2 * line.len() / 3]);
        let (ab, ac) = (b - a, c - a);
        let turn = 2.0 * ab.perp_dot(ac);
        let center = a + DVec2::new(
            ac.y * ab.length_squared() - ab.y * ac.length_squared(),
            ab.x * ac.length_squared() - ac.x * ab.length_squared(),
        ) / turn;
        let radius = center.distance(a);
        assert!(line.iter().all(|p| (p.distance(center) - radius).abs() < 0.1), "no circle: {line:?}");
        radius
    };
    lines.iter().filter(|line| line.len() >= 6).map(of).collect()
}

#[test]
fn sections_of_a_sphere_are_circles_of_their_radius() {
    for hull in ["side", "whole"] {
        let plan = format!(
            "{BALL}picture lines_plan({hull}, stations: [-1, 0, 1], waterlines: [1m], buttocks: [1.2m], diagonals: [{{height: 0m, angle: 45deg}}]) to \"a.svg\" {{ legend: false }}\n"
        );
        let svg = svg(&plan, "a.svg");
        let scale = pixels(&svg);
        let is_near = |found: f64, metres: f64| (found / scale - metres).abs() < 0.005;
        let three = f64::sqrt(3.0);
        let water = radii(&strokes(&svg, "#007e5c"));
        assert!(!water.is_empty() && water.iter().all(|r| is_near(*r, three)), "{hull}: {water:?} of {scale}");
        let buttocks = radii(&strokes(&svg, "#bc5400"));
        assert!(!buttocks.is_empty() && buttocks.iter().all(|r| is_near(*r, 1.6)), "{hull}: {buttocks:?}");
        // The middle one on both sides, one aft, one fore.
        let stations = radii(&strokes(&svg, "#144aa0"));
        let large = stations.iter().filter(|r| is_near(**r, 2.0)).count();
        let small = stations.iter().filter(|r| is_near(**r, three)).count();
        assert!(large >= 2 && small >= 2 && large + small == stations.len(), "{hull}: {stations:?}");
        let texts = texts(&svg);
        for words in ["length 4 m", "beam 4 m", "4 m", "WL 1", "B 1.2", "D1", "profile", "half-breadth plan", "body plan", "4 × 4 × 4"] {
            assert!(texts.contains(&words), "{hull}: {words}: {texts:?}");
        }
    }
}

#[test]
fn words_of_a_lines_plan_do_not_cover_each_other() {
    let plan = format!(
        "{BALL}picture lines_plan(side, stations: [for k in 0..31: k * 0.1m - 1.5m], waterlines: [for k in 0..21: k * 0.1m - 1m]) to \"a.svg\"\n"
    );
    let svg = svg(&plan, "a.svg");
    let number = |line: &str, name: &str| attribute(line, name).unwrap().parse::<f64>().unwrap();
    let room = |line: &str| {
        let (x, y, size, width) = (number(line, "x"), number(line, "y"), number(line, "font-size"), number(line, "textLength"));
        (x, y - 0.7 * size, x + width, y)
    };
    let rooms: Vec<_> = svg.lines().filter(|line| line.starts_with("<text") && !line.contains("aria-hidden")).map(room).collect();
    for (k, a) in rooms.iter().enumerate() {
        for b in &rooms[k + 1..] {
            assert!(a.0 >= b.2 || b.0 >= a.2 || a.1 >= b.3 || b.1 >= a.3, "{a:?} {b:?}");
        }
    }
    assert!(rooms.len() > 30, "{}", rooms.len());
}

#[test]
fn bad_drawings_are_told() {
    let plot = |arguments: &str| format!("{ROWS}picture plot({arguments}) to \"a.svg\"\n");
    let plan = |arguments: &str| format!("{BALL}picture lines_plan({arguments}) to \"a.svg\"\n");
    let cases = [
        (plot("rows, x: \"drft\""), "E306", "the name of a column: draft, volume, lcb, gap, name"),
        (plot("rows, x: \"draft\", y: \"name\""), "E306", "a column of numbers"),
        (plot("[], x: \"draft\""), "E306", "one row or more"),
        (plot("[1, 2], x: \"draft\""), "E211", "a list of records"),
        (plot("[for k in 0..3: {a: k, b: k * 1m, c: k * 1m2, d: k * 1deg}], x: \"a\""), "E306", "at most two units"),
        (plan("side, stations: [3m]"), "E306", "where the hull is"),
        (plan("side, waterlines: [-2.5m]"), "E306", "where the hull is"),
        (plan("side, buttocks: [0m]"), "E306", "above 0"),
        (plan("side, diagonals: [{height: 1m, angle: 90deg}]"), "E306", "between 0deg and 90deg"),
        (plan("side, diagonals: [{height: 9m, angle: 10deg}]"), "E306", "where its plane meets the hull"),
        (plan("side, diagonals: [{height: 1m}]"), "E306", "{height: 8m, angle: 30deg}"),
        (format!("{ROWS}picture plot(rows, x: \"draft\", y: \"lcb\"), (0, 0, 0) to \"a.svg\"\n"), "E805", "fills a picture by itself"),
        (
            format!("{ROWS}picture plot(rows, x: \"draft\", y: \"lcb\") to \"a.svg\" {{ shade: zebra }}\n"),
            "E805",
            "`shade` says nothing of a plot",
        ),
        (
            format!("{ROWS}picture plot(rows, x: \"draft\", y: \"lcb\") to \"a.svg\" {{ view: top }}\n"),
            "E805",
            "`view` says nothing of a plot",
        ),
        (format!("{BALL}picture side to \"a.svg\" {{ zoom: lines_plan(side) }}\n"), "E805", "no place to zoom to"),
    ];
    for (text, wanted, words) in cases {
        let (found, report) = code(&text);
        assert!(found == wanted && report.contains(words), "{text}\n{report}");
    }
}

/// Lengths of the teeth of combs, pixels.
fn teeth(svg: &str) -> Vec<f64> {
    let own = svg.lines().filter(|line| line.starts_with("<path fill=\"none\"") && attribute(line, "stroke") == Some("#962896"));
    let lines = own.flat_map(|line| attribute(line, "d").unwrap().split('M').filter(|part| !part.is_empty()).collect::<Vec<_>>());
    let points = |part: &str| {
        let numbers: Vec<f64> = part.split(['L', ' ', 'Z']).filter_map(|n| n.parse().ok()).collect();
        numbers.chunks_exact(2).map(|p| DVec2::new(p[0], p[1])).collect::<Vec<_>>()
    };
    lines.map(points).filter(|line| line.len() == 2).map(|line| line[0].distance(line[1])).collect()
}

fn combed(curves: &str, names: &str) -> String {
    svg(&format!("units m\n{curves}\npicture {names} to \"a.svg\" {{ view: top  combs: true }}\n"), "a.svg")
}

#[test]
fn combs_are_as_long_as_the_curvature_is_large() {
    // Of two circles the smaller one has teeth longer by the ratio of the radii, all of one length.
    let two = "curve a = arc((2, 0, 0), (-2, 0, 0), through: (0, 2, 0))\ncurve b = arc((9, 0, 0), (1, 0, 0), through: (5, 4, 0))";
    let circles = combed(two, "a, b");
    let found = teeth(&circles);
    let longest = found.iter().copied().fold(0.0, f64::max);
    let (long, short): (Vec<f64>, Vec<f64>) = found.iter().partition(|length| **length > 0.75 * longest);
    assert!(long.len() == 49 && short.len() == 49, "{} {}", long.len(), short.len());
    assert!(long.iter().all(|length| (length - longest).abs() < 0.05), "{long:?}");
    assert!(short.iter().all(|length| (length - 0.5 * longest).abs() < 0.05), "{short:?}");
    assert!(texts(&circles).contains(&"curvature, at most 0.5/m"), "{:?}", texts(&circles));

    let straight = combed("curve a = line((0, 0, 0), (3, 1, 0))", "a");
    assert!(teeth(&straight).is_empty() && texts(&straight).contains(&"no curvature"));

    // y = x³/600: the curvature grows evenly, as long as the slope is small.
    let eased = combed("curve a = bezier([(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0.045, 0)])", "a");
    let found = teeth(&eased);
    let most = found.iter().copied().fold(0.0, f64::max);
    let parts = found.len() as f64 - 1.0;
    // The first tooth has no length.
    let even = found.iter().enumerate().all(|(k, length)| (length - most * k as f64 / parts).abs() < 0.01 * most);
    let later = found.iter().enumerate().all(|(k, length)| (length - most * (k + 1) as f64 / (parts + 1.0)).abs() < 0.01 * most);
    assert!(most > 20.0 && (even || later), "{found:?}");
}

#[test]
fn a_sheet_shows_each_view_with_its_name() {
    let text = "units m\nsurface roof = ruled(line((0, 0, 0), (4, 0, 0)), line((0, 2, 1), (4, 2, 2)))
picture roof to \"a.svg\" { views: [front, top, (1, 2, 1)]  width: 900  height: 600  title: \"Roof\" }
picture roof to \"a.png\" { views: [front, top, (1, 2, 1)]  width: 300  height: 200  shade: reflection }
";
    let model = Script::from_str(text).run().unwrap_or_else(|e| panic!("{}", e.report()));
    let svg = model.output("a.svg").unwrap().text().unwrap().to_owned();
    let texts = texts(&svg);
    for words in ["Roof", "front", "top", "(1, 2, 1)"] {
        assert!(texts.contains(&words), "{words}: {texts:?}");
    }
    let (width, pixels) = lofting::draw::png::read(model.output("a.png").unwrap().bytes().unwrap()).unwrap();
    assert_eq!((width, pixels.len()), (300, 300 * 200));
    let bad = |settings: &str| code(&format!("{}picture roof to \"b.svg\" {{ {settings} }}\n", &text[..text.find("picture").unwrap()]));
    for (settings, wanted, words) in [
        ("views: []", "E306", "a sheet has 1 to 16 views, got 0"),
        ("views: [front]  view: top", "E305", "`views` or `view`, not both"),
        ("views: [(0, 0, 0)]", "E306", "a view is a direction"),
        ("combs: true", "E805", "`combs` stand on curves"),
    ] {
        let (found, report) = bad(settings);
        assert!(found == wanted && report.contains(words), "{settings}\n{report}");
    }
}

#[test]
fn a_hull_whose_sides_differ_is_shown_on_both() {
    // Port reaches to y = 2, starboard to y = −1.
    let hull = "units m
fn rib(x: length, b: length): curve = line((x, 0m, 0m), (x, b, 3m))
surface port = skin([for i in 0..5: rib(i * 4m, 2m)])
surface starboard = skin([for i in 0..5: rib(i * 4m, -1m)])
surface equal = skin([for i in 0..5: rib(i * 4m, -2m)])
";
    let plan = |side: &str| {
        format!(
            "{hull}picture lines_plan([port, {side}], stations: [4m, 12m], waterlines: [3m], buttocks: [0.5m, 1.5m]) to \"a.svg\" {{ legend: false }}\n"
        )
    };
    let differ = svg(&plan("starboard"), "a.svg");
    let scale = pixels(&differ);
    assert!(texts(&differ).contains(&"body plan, port left, aft dashed"), "{:?}", texts(&differ));
    assert!(texts(&differ).contains(&"beam 3 m"), "{:?}", texts(&differ));
    // The waterline at the deck: 2 m above the centreline, 1 m below.
    let mut levels: Vec<f64> = strokes(&differ, "#007e5c").iter().map(|line| line[0].y).collect();
    levels.sort_by(f64::total_cmp);
    assert!(levels.len() == 2 && ((levels[1] - levels[0]) / scale - 3.0).abs() < 0.01, "{levels:?}");
    let same = svg(&plan("equal"), "a.svg");
    assert!(texts(&same).contains(&"body plan"), "{:?}", texts(&same));
    let (found, report) =
        code(&format!("{hull}picture lines_plan([port, starboard], diagonals: [{{height: 1m, angle: 30deg}}]) to \"a.svg\"\n"));
    assert!(found == "E306" && report.contains("sides differ"), "{report}");
}
