//! Pictures as measured: what covers how many pixels, what hides what, what the files hold.

use std::path::{Path, PathBuf};
use std::process::Command;

use glam::DVec3;
use lofting::draw::color::FACE;
use lofting::draw::raster::{self, Image, Thick};
use lofting::draw::{Camera, Format, Kind, Label, Line, Paint, Picture, Scene, Settings, Sheet, View};

fn settings(width: usize, height: usize) -> Settings {
    let view = View::named("top").unwrap();
    Settings { view, width, height, title: String::new(), unit: "mm".into(), edges: true, axes: false, ruler: false, legend: false }
}

fn sheet(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> Sheet {
    let points = points.iter().map(|p| DVec3::from_array(*p)).collect();
    Sheet {
        name: "s".into(),
        points,
        normals: Vec::new(),
        triangles: triangles.to_vec(),
        edges: Vec::new(),
        paint: Paint::Even(FACE),
        bends: Vec::new(),
    }
}

fn square(side: f64, z: f64) -> Sheet {
    sheet(&[[0., 0., z], [side, 0., z], [side, side, z], [0., side, z]], &[[0, 1, 2], [0, 2, 3]])
}

fn drawn(scene: &Scene, view: &str, size: (usize, usize)) -> (Camera, Image) {
    scene.check().unwrap();
    let frame = lofting::draw::camera::Rect::new(glam::DVec2::ZERO, glam::DVec2::new(size.0 as f64, size.1 as f64));
    let camera = Camera::framing(&View::named(view).unwrap(), &scene.points(), &scene.focus, &frame);
    let image = raster::draw(scene, &camera, &[], raster::EdgeStyle::default(), size);
    (camera, image)
}

fn covered(image: &Image) -> usize {
    image.near.iter().filter(|n| n.is_finite()).count()
}

#[test]
fn a_square_covers_its_pixels_and_no_others() {
    // 100 of 200 pixels across: the frame is filled by a line twice as long.
    let mut scene = Scene { sheets: vec![square(1.0, 0.0)], ..Scene::default() };
    scene.focus = vec![DVec3::new(-0.5, -0.5, 0.0), DVec3::new(1.5, 1.5, 0.0)];
    let (_, image) = drawn(&scene, "top", (200, 200));
    assert_eq!(covered(&image), 100 * 100);
    let at = |x: usize, y: usize| image.near[y * 200 + x].is_finite();
    assert!(at(50, 50) && at(149, 149) && !at(49, 50) && !at(150, 149));
    // Nothing shows between the two triangles.
    let white = (50..150).flat_map(|y| (50..150).map(move |x| 3 * (y * 200 + x))).filter(|k| image.rgb[*k] == 255).count();
    assert_eq!(white, 0);
}

#[test]
fn what_is_nearer_hides_what_is_farther_in_any_order() {
    let red = |mut s: Sheet| {
        s.paint = Paint::Even(lofting::draw::color::Rgb(255, 0, 0));
        s
    };
    let mut scene = Scene { sheets: vec![square(2.0, 0.0), red(square(1.0, 1.0))], ..Scene::default() };
    let (_, first) = drawn(&scene, "top", (100, 100));
    scene.sheets.reverse();
    let (_, second) = drawn(&scene, "top", (100, 100));
    assert_eq!(first.rgb, second.rgb);
    let red_pixels = first.rgb.chunks(3).filter(|p| p[0] > 60 && p[1] < 30).count();
    assert_eq!(red_pixels, 50 * 50);
    // From below the large one hides all of the small one.
    let (_, below) = drawn(&scene, "bottom", (100, 100));
    assert_eq!(below.rgb.chunks(3).filter(|p| p[0] > 60 && p[1] < 30).count(), 0);
}

#[test]
fn a_line_behind_a_face_is_hidden_and_one_on_it_is_seen() {
    let line = |z: f64| Line { kind: Kind::Free, points: vec![DVec3::new(0.2, 0.5, z), DVec3::new(0.8, 0.5, z)] };
    let red = |z: f64, format: Format| {
        let scene = Scene { sheets: vec![square(1.0, 0.0)], lines: vec![line(z)], ..Scene::default() };
        let picture = Picture::new(&scene, &settings(200, 200), format);
        let mut out = Vec::new();
        picture.write(format, &mut out).unwrap();
        match format {
            Format::Png => decoded(&out).2.chunks(3).filter(|p| p[0] > 150 && p[1] < 80).count(),
            Format::Svg => String::from_utf8(out).unwrap().matches("stroke=\"#d6121e\"").count(),
        }
    };
    assert!(red(0.0, Format::Png) > 100 && red(0.5, Format::Png) > 100);
    assert_eq!(red(-0.5, Format::Png), 0);
    assert_eq!((red(0.0, Format::Svg), red(-0.5, Format::Svg)), (1, 0));
}

fn decoded(bytes: &[u8]) -> (usize, usize, Vec<u8>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    (info.width as usize, info.height as usize, pixels)
}

/// A ball of triangles with names, marks and values: something of everything.
fn ball(n: u32) -> Scene {
    let at = |i: u32, j: u32| {
        let (u, v) = (f64::from(i) / f64::from(n) * std::f64::consts::TAU, f64::from(j) / f64::from(n) * std::f64::consts::PI);
        let (su, cu) = lofting::base::math::sin_cos(u);
        let (sv, cv) = lofting::base::math::sin_cos(v);
        DVec3::new(cu * sv, su * sv, cv)
    };
    let points: Vec<DVec3> = (0..=n).flat_map(|j| (0..=n).map(move |i| at(i, j))).collect();
    let index = |i: u32, j: u32| j * (n + 1) + i;
    let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
    let triangles: Vec<[u32; 3]> = cells
        .flat_map(|(i, j)| [[index(i, j), index(i + 1, j), index(i + 1, j + 1)], [index(i, j), index(i + 1, j + 1), index(i, j + 1)]])
        .collect();
    let values = points.iter().map(|p| p.z as f32).collect();
    let edges = vec![0b111; triangles.len()];
    let sheet =
        Sheet { name: "ball".into(), normals: points.clone(), points, triangles, edges, paint: Paint::OfPoints(values), bends: Vec::new() };
    let scale =
        lofting::draw::Scale { title: "height".into(), unit: "m".into(), low: -1.0, high: 1.0, ramp: lofting::draw::color::LITTLE_TO_MUCH };
    let labels = (0..40).map(|k| {
        let place = at(k % n, k / 4 % n);
        Label { text: format!("place {k}"), places: vec![place], rank: 0, centered: false }
    });
    let lines = vec![Line { kind: Kind::Kink, points: (0..=n).map(|i| at(i, n / 2)).collect() }];
    Scene { sheets: vec![sheet], lines, labels: labels.collect(), scale: Some(scale), ..Scene::default() }
}

fn everything() -> Settings {
    let view = View { eye: DVec3::new(1.0, -2.0, 0.5), up: None, perspective: false };
    Settings { title: "a <ball> & \"more\"".into(), axes: true, ruler: true, legend: true, view, ..settings(600, 400) }
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    for format in [Format::Png, Format::Svg] {
        let bytes = || {
            let mut out = Vec::new();
            Picture::new(&ball(24), &everything(), format).write(format, &mut out).unwrap();
            out
        };
        assert_eq!(bytes(), bytes());
    }
}

#[test]
fn names_are_inside_the_picture_and_none_is_over_another() {
    let picture = Picture::new(&ball(24), &everything(), Format::Png);
    let rooms: Vec<_> = picture.texts().into_iter().filter(|(words, _)| words.starts_with("place")).collect();
    assert!(rooms.len() > 5, "{} names", rooms.len());
    let all = picture.texts();
    for (k, (words, room)) in all.iter().enumerate() {
        assert!(room.min.x >= 0.0 && room.min.y >= 0.0 && room.max.x <= 600.0 && room.max.y <= 400.0, "{words}: {room:?}");
        for (other, second) in &all[k + 1..] {
            assert!(!room.meets(second), "{words} over {other}");
        }
    }
}

#[test]
fn svg_is_well_formed() {
    let mut out = Vec::new();
    Picture::new(&ball(12), &everything(), Format::Svg).write(Format::Svg, &mut out).unwrap();
    let text = String::from_utf8(out).unwrap();
    let mut open: Vec<&str> = Vec::new();
    for part in text.split('<').skip(1) {
        let (tag, after) = part.split_once('>').expect("a tag is closed");
        assert!(
            !after.contains('>') && !after.replace("&amp;", "").replace("&lt;", "").replace("&gt;", "").replace("&quot;", "").contains('&')
        );
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        let name = tag.split([' ', '/']).next().unwrap();
        match (tag.strip_prefix('/'), tag.ends_with('/')) {
            (Some(closed), _) => assert_eq!(open.pop(), Some(closed)),
            (None, false) => open.push(name),
            (None, true) => {}
        }
    }
    assert!(open.is_empty(), "{open:?}");
    assert!(text.contains("a &lt;ball&gt; &amp; &quot;more&quot;") && text.contains("data:image/png;base64,"));
}

#[test]
fn hostile_scenes_are_drawn() {
    let far = 1e300;
    let cases = [
        Scene::default(),
        Scene { sheets: vec![sheet(&[[0.; 3], [0.; 3], [0.; 3]], &[[0, 1, 2]])], ..Scene::default() },
        Scene { sheets: vec![sheet(&[[0.; 3], [1e-300, 0., 0.], [0., 1e-300, 0.]], &[[0, 1, 2]])], ..Scene::default() },
        Scene { sheets: vec![sheet(&[[-far, 0., 0.], [far, 0., 0.], [0., far, 0.]], &[[0, 1, 2]])], ..Scene::default() },
        Scene { lines: vec![Line { kind: Kind::Curve, points: vec![DVec3::ONE; 2] }], ..Scene::default() },
        Scene { labels: vec![Label { text: "지붕".repeat(500), places: vec![DVec3::ONE], rank: 0, centered: true }], ..Scene::default() },
    ];
    for scene in &cases {
        for (width, height) in [(16, 16), (16, 300), (300, 16), (120, 80)] {
            for format in [Format::Png, Format::Svg] {
                for perspective in [false, true] {
                    let mut wish = Settings { width, height, ..everything() };
                    wish.view.perspective = perspective;
                    Picture::new(scene, &wish, format).write(format, &mut Vec::new()).unwrap();
                }
            }
        }
    }
}

#[test]
fn a_dot_is_round() {
    let spot = |x: f64| lofting::draw::camera::Spot { x, y: 50.0, near: 0.0, grow: 1.0 };
    let dot = Thick { a: spot(50.0), b: spot(50.0), half: 20.0, color: lofting::draw::color::INK, lift: 0.0 };
    let camera = drawn(&Scene::default(), "top", (100, 100)).0;
    let image = raster::draw(&Scene::default(), &camera, &[dot], raster::EdgeStyle::default(), (100, 100));
    let area = covered(&image) as f64;
    assert!((area - std::f64::consts::PI * 400.0).abs() < 8.0, "{area}");
}

/// Runs `loft` in a folder of its own; gives exit status, what it printed and said, and the folder.
fn loft(name: &str, script: &str, arguments: &[&str]) -> (i32, String, PathBuf) {
    let folder = std::env::temp_dir().join(format!("loft-draw-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("model.loft"), script).unwrap();
    let out = Command::new(env!("CARGO_BIN_EXE_loft")).current_dir(&folder).args(arguments).output().unwrap();
    let said = String::from_utf8_lossy(&out.stdout).into_owned() + &String::from_utf8_lossy(&out.stderr);
    (out.status.code().unwrap_or(-1), said, folder)
}

const ROOF: &str = "units m
point A = (0, 0, 0)
curve s = line(A, (6, 0, 0))
curve n = arc((0, 4, 0), (6, 4, 0), through: (3, 4.5, 2))
curve w = line(s.start, n.start)
curve e = line(s.end, n.end)
surface roof = coons(s, e, n, w)
mesh fine of roof { size: 500mm }
";

#[test]
fn pictures_of_scripts_are_outputs_like_exports() {
    let family = "picture fine for v in [front, top] to \"{v}.png\" { view: v  width: 300  height: 200  shade: quality }\n";
    let rest = "picture network to \"sub/net.svg\" { view: (1, -2, 0.5)  up: (0, 0, 1)  title: \"net & nodes\" }
picture roof to \"curvature.png\" { shade: curvature  zoom: A  perspective: true  labels: true  network: true }
picture s, A, roof.edges, roof.patches, roof.vertices to \"parts.png\" { borders: false }
";
    let (status, said, folder) = loft("outputs", &format!("{ROOF}{family}{rest}"), &["run", "model.loft", "--json"]);
    assert_eq!(status, 0, "{said}");
    for file in ["front.png", "top.png", "sub/net.svg", "curvature.png", "parts.png"] {
        let bytes = std::fs::read(folder.join(file)).unwrap();
        assert!(said.contains(&format!("\"path\": \"{file}\"")) && said.contains(&format!("\"bytes\": {}", bytes.len())), "{file}: {said}");
    }
    let (width, height, pixels) = decoded(&std::fs::read(folder.join("front.png")).unwrap());
    assert_eq!((width, height, pixels.len()), (300, 200, 300 * 200 * 3));
    let net = std::fs::read_to_string(folder.join("sub/net.svg")).unwrap();
    for name in ["net &amp; nodes", ">A<", ">s &amp; e<", ">s<", ">n<"] {
        assert!(net.contains(name), "{name}");
    }
    // With a failed check nothing new is written.
    std::fs::remove_file(folder.join("top.png")).unwrap();
    let (status, _, folder) = loft("outputs", &format!("{ROOF}{family}check 1 == 2\n"), &["run", "model.loft"]);
    assert!(status == 1 && !folder.join("top.png").exists());
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn what_cannot_be_drawn_is_told_at_its_place() {
    let cases = [
        ("picture fine to \"a.jpg\"", "E804"),
        ("picture roof to \"a.png\" { shade: quality }", "E805"),
        ("picture roof to \"a.png\" { shade: nice }", "E213"),
        ("picture roof to \"a.png\" { width: 8 }", "E306"),
        ("picture roof to \"a.png\" { width: 100000 }", "E306"),
        ("picture roof to \"a.png\" { width: 8000  height: 8000 }", "E306"),
        ("picture roof to \"a.png\" { width: 2.5 }", "E306"),
        ("picture roof to \"a.png\" { view: (0, 0, 0) }", "E306"),
        ("picture roof to \"a.png\" { view: (0, 0, 1)  up: (0, 0, 2) }", "E306"),
        ("picture roof to \"a.png\" { view: nowhere }", "E2"),
        ("picture 3 to \"a.png\"", "E211"),
        ("picture roof to \"a.png\" { zoom: 3 }", "E211"),
        ("picture roof to \"../a.png\"", "E802"),
        ("picture roof to \"a.png\" { colour: red }", "E303"),
    ];
    for (k, (line, code)) in cases.iter().enumerate() {
        let (status, said, folder) = loft(&format!("bad{k}"), &format!("{ROOF}{line}\n"), &["run", "model.loft"]);
        assert_eq!(status, 1, "{line}: {said}");
        assert!(said.contains(code), "{line}: {said}");
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1, "{line} wrote something");
        std::fs::remove_dir_all(folder).unwrap();
    }
}

#[test]
fn render_draws_what_is_sound_and_the_same_with_any_threads() {
    let bytes = |threads: &str| {
        let arguments = ["render", "model.loft", "-o", "a.png", "--shade", "zebra", "--network", "--labels", "--threads", threads];
        let (status, said, folder) = loft(&format!("threads{threads}"), ROOF, &arguments);
        assert_eq!(status, 0, "{said}");
        let bytes = std::fs::read(folder.join("a.png")).unwrap();
        std::fs::remove_dir_all(folder).unwrap();
        bytes
    };
    assert!(bytes("1") == bytes("8"));
    let broken = format!("{ROOF}surface more = coons(s, w)\nmesh other of more\ncurve z = line(A, nothing)\n");
    let (status, said, folder) = loft("broken", &broken, &["render", "model.loft", "-o", "a.png", "--size", "400x300"]);
    assert!(status == 1 && said.contains("E201") && folder.join("a.png").exists(), "{said}");
    let (_, _, pixels) = decoded(&std::fs::read(folder.join("a.png")).unwrap());
    assert!(pixels.chunks(3).filter(|p| p[2] > p[0] && p[0] < 220).count() > 5_000, "the roof is not drawn");
    std::fs::remove_dir_all(folder).unwrap();
    let (status, said, folder) = loft("usage", ROOF, &["render", "model.loft", "-o", "a.gif"]);
    assert!(status == 2 && said.contains(".png or .svg"), "{said}");
    std::fs::remove_dir_all(folder).unwrap();
    for wrong in [["--size", "0x5"], ["--size", "99999x99999"], ["--view", "sideways"], ["--up", "0,0,0"], ["--shade", "nice"]] {
        let (status, said, folder) = loft("wrong", ROOF, &["render", "model.loft", "-o", "a.png", wrong[0], wrong[1]]);
        assert!(status == 2 && !folder.join("a.png").exists(), "{wrong:?}: {said}");
        std::fs::remove_dir_all(folder).unwrap();
    }
    let (status, said, folder) = loft("empty", "units m\n", &["render", "model.loft", "-o", "a.png"]);
    assert!(status == 1 && said.contains("nothing to draw") && !folder.join("a.png").exists(), "{said}");
    std::fs::remove_dir_all(folder).unwrap();
    let (status, said, _) = loft("name", ROOF, &["render", "model.loft", "-o", "a.png", "--of", "rof"]);
    assert!(status == 1 && said.contains("E201") && said.contains("`rof`"), "{said}");
}

/// What to draw is said by names and by paths of the script; a wrong path is told without a place in it.
#[test]
fn paths_are_drawn() {
    let script = "units m\ncurve ribs for i in 0..3 = line((i, 0, 0), (i, 2, 0))\nsurface roof = ruled(ribs[0], ribs[2])";
    let drawn = |of: &[&str]| {
        let (status, said, folder) = loft("path", script, &[&["render", "model.loft", "-o", "a.png"], of].concat());
        assert_eq!(status, 0, "{said}");
        std::fs::read(folder.join("a.png")).unwrap()
    };
    let titled = |of: &str| drawn(&["--of", of, "--title", "a", "--no-borders", "--bare"]);
    assert!(titled("roof.patches[0]") == titled("roof.patches[-1]"));
    assert!(titled("ribs[0]") != titled("roof"));
    assert!(drawn(&["--of", "roof"]) != drawn(&["--of", "roof", "--zoom", "ribs[1].start"]));
    for (path, words) in [("ribs[7]", "E215"), ("ribs[", "E102"), ("rib[0]", "E201"), ("len(ribs)", "E805")] {
        let (status, said, _) = loft("path", script, &["render", "model.loft", "-o", "a.png", "--of", path]);
        assert_eq!(status, 1, "{said}");
        assert!(said.starts_with(words) && said.matches(" × ").count() == 1 && !said.contains("asked_of"), "{said}");
    }
}

/// How far a picture of the guide may be from what its command draws: share of pixels that differ visibly.
const ALIKE: f64 = 0.03;

#[test]
fn pictures_of_the_guide_are_what_their_commands_draw() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("docs/guide/pictures/README.md")).unwrap();
    let accept = std::env::var_os("LOFT_ACCEPT").is_some();
    let folder = std::env::temp_dir().join(format!("loft-guide-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let mut seen = 0;
    for command in page.lines().filter_map(|l| l.strip_prefix("loft ")) {
        let mut words: Vec<String> = command.split_whitespace().map(str::to_owned).collect();
        let at = words.iter().position(|w| w == "-o").unwrap() + 1;
        let kept = root.join(&words[at]);
        let name = kept.file_name().unwrap().to_string_lossy().into_owned();
        assert!(page.contains(&format!("]({name})")), "{name} is made and not shown");
        if !accept {
            words[at] = folder.join(&name).to_string_lossy().into_owned();
        }
        let out = Command::new(env!("CARGO_BIN_EXE_loft")).current_dir(root).args(&words).output().unwrap();
        assert!(out.status.success(), "{command}: {}", String::from_utf8_lossy(&out.stderr));
        let (old, new) = (std::fs::read(&kept).unwrap(), std::fs::read(root.join(&words[at])).unwrap());
        assert!(old.len() < 200_000, "{name} has {} bytes", old.len());
        let (old, new) = (decoded(&old), decoded(&new));
        assert_eq!((old.0, old.1), (new.0, new.1), "{name}");
        let far = |p: &(&[u8], &[u8])| p.0.iter().zip(p.1).any(|(a, b)| a.abs_diff(*b) > 48);
        let different = old.2.chunks(3).zip(new.2.chunks(3)).filter(far).count();
        assert!((different as f64) < ALIKE * (old.0 * old.1) as f64, "{name}: {different} pixels are others; LOFT_ACCEPT=1 makes it anew");
        seen += 1;
    }
    assert!(seen >= 6, "{seen} pictures");
    std::fs::remove_dir_all(folder).unwrap();
}

/// Pixels of a picture of a script, without words around it.
fn pixels_of(name: &str, script: &str, arguments: &[&str]) -> Vec<u8> {
    let drawn = [&["render", "model.loft", "-o", "a.png", "--size", "400x300", "--title", "a", "--bare"], arguments].concat();
    let (status, said, folder) = loft(name, script, &drawn);
    assert_eq!(status, 0, "{said}");
    let pixels = decoded(&std::fs::read(folder.join("a.png")).unwrap()).2;
    std::fs::remove_dir_all(folder).unwrap();
    pixels
}

/// A vector picture of a script seen from above.
fn svg_of(name: &str, script: &str, arguments: &[&str]) -> String {
    let (status, said, folder) = loft(name, script, &[&["render", "model.loft", "-o", "a.svg", "--view", "top"], arguments].concat());
    assert_eq!(status, 0, "{said}");
    let text = std::fs::read_to_string(folder.join("a.svg")).unwrap();
    std::fs::remove_dir_all(folder).unwrap();
    text
}

/// Places across, to a pixel, where lines of a colour begin or end.
fn columns(svg: &str, color: lofting::draw::color::Rgb) -> Vec<i64> {
    let wanted = format!("stroke=\"{}\"", color.hex());
    let paths = svg.lines().filter(|line| line.starts_with("<path fill=\"none\"") && line.contains(&wanted) && line.contains("M"));
    // The key of the legend is a short line of its own.
    let data = paths.map(|line| line.split(" d=\"").nth(1).unwrap().trim_end_matches("\"/>").to_owned());
    let mut found: Vec<i64> = data
        .flat_map(|d| {
            d.split(['M', 'L'])
                .filter(|p| !p.is_empty())
                .map(|p| p.split(' ').next().unwrap().parse::<f64>().unwrap().round() as i64)
                .collect::<Vec<_>>()
        })
        .collect();
    found.sort_unstable();
    found.dedup_by(|a, b| (*a - *b).abs() < 3);
    found
}

const PARTS: &str = "units m
curve a = line((0, 0, 0), (4, 0, 0))
curve b = arc((0, 3, 0), (4, 3, 0), through: (2, 3, 1))
surface roof = ruled(a, b)
curve hole = project(circle(center: (2, 1.5, 2), radius: 600mm), onto: roof, along: (0, 0, 1))
";

#[test]
fn what_a_part_was_cut_from_is_not_drawn_over_it() {
    let trimmed = format!("{PARTS}surface panel = trim(roof, holes: [hole])\n");
    let all = pixels_of("trimmed", &trimmed, &[]);
    assert!(all == pixels_of("panel", &trimmed, &["--of", "panel"]));
    assert!(all != pixels_of("both", &trimmed, &["--of", "roof", "--of", "panel"]));
    // Its rims are free, which those that it shares with the whole would not be.
    let svg = svg_of("rims", &trimmed, &["--bare"]);
    let rims = columns(&svg, lofting::draw::color::FREE);
    assert!(rims.len() > 6, "{rims:?}");
    // Pieces of a list, a plane, and a part that is meshed while the whole is not.
    let split = format!("{PARTS}surface halves for i in 0..2 = split(roof, by: hole)[i]\n");
    assert!(pixels_of("halves", &split, &[]) == pixels_of("halves2", &split, &["--of", "halves"]));
    let plane = "units m\ncurve rim = circle(center: (0, 0, 0), radius: 2m)\ncurve h = circle(center: (0, 0, 0), radius: 1m)\nsurface disc = plane(rim)\nsurface ring = trim(disc, holes: h)\n";
    assert!(pixels_of("ring", plane, &[]) == pixels_of("ring2", plane, &["--of", "ring"]));
    let meshed = format!("{trimmed}mesh m of panel {{ size: 300mm }}\n");
    assert!(pixels_of("meshed", &meshed, &[]) == pixels_of("meshed2", &meshed, &["--of", "m"]));
    // A shell that is made of the whole shows it, and so does what only touches it.
    let shell = format!("{trimmed}shell hall of roof\n");
    assert!(pixels_of("shell", &shell, &[]) == pixels_of("shell2", &shell, &["--of", "roof", "--of", "panel"]));
    let beside =
        "units m\ncurve a = line((0, 0, 0), (4, 0, 0))\nsurface one = extrude(a, by: (0, 2, 0))\nsurface two = move(one, by: (0, 2, 0))\n";
    assert!(pixels_of("beside", beside, &[]) == pixels_of("beside2", beside, &["--of", "one", "--of", "two"]));
}

#[test]
fn folds_are_orange_between_surfaces_too() {
    let folded = "units m
curve a = polyline([(0, 0, 0), (2, 0, 1), (4, 0, 0)])
surface folded = extrude(a, by: (0, 3, 0))
surface side = extrude(line((4, 0, 0), (4, 3, 0)), by: (1, 0, -2))
surface smooth = extrude(line((0, 0, 0), (0, 3, 0)), by: (-2, 0, -1))
";
    use lofting::draw::color::{FREE, KINK};
    let meshed = format!("{folded}mesh m of folded, side, smooth {{ size: 500mm }}\n");
    for (name, script) in [("folds", folded), ("folds-meshed", &meshed)] {
        let svg = svg_of(name, script, &["--bare"]);
        // The ridge at x = 2 and the edge at x = 4; at x = 0 the tangent plane goes on.
        assert_eq!(columns(&svg, KINK).len(), 2, "{name}: {:?}", columns(&svg, KINK));
        // The rims at x = -2 and x = 5.
        let rims = columns(&svg, FREE);
        let kinks = columns(&svg, KINK);
        assert!(rims[0] < kinks[0] - 100 && rims[rims.len() - 1] > kinks[1] + 20, "{name}: {rims:?} {kinks:?}");
    }
    // A round wall of coarse elements has no kink, not at its seam either.
    let round = "units m\nsurface wall = extrude(circle(center: (0, 0, 0), radius: 1m), by: (0, 0, 1))\nmesh m of wall { size: 900mm }\n";
    assert!(columns(&svg_of("round", round, &["--bare"]), KINK).is_empty());
}

#[test]
fn of_several_meshes_the_last_of_each_surface_is_drawn() {
    let faces = "units m
curve a = line((0, 0, 0), (4, 0, 0))
curve b = line((0, 3, 0), (4, 3, 0))
curve c = line((0, 6, 1), (4, 6, 1))
surface roof = ruled(a, b)
surface wing = ruled(b, c)
";
    let both = format!("{faces}mesh coarse of roof, wing {{ size: 1m }}\nmesh fine of roof {{ size: 250mm }}\n");
    let apart = format!("{faces}mesh coarse of wing {{ size: 1m }}\nmesh fine of roof {{ size: 250mm }}\n");
    assert!(pixels_of("several", &both, &[]) == pixels_of("apart", &apart, &[]));
    assert!(
        pixels_of("named", &both, &["--of", "coarse", "--of", "fine"]) == pixels_of("named2", &apart, &["--of", "coarse", "--of", "fine"])
    );
    // The first is drawn where it is asked for alone, and one that was moved lies elsewhere.
    assert!(pixels_of("coarse", &both, &["--of", "coarse"]) != pixels_of("fine", &both, &["--of", "fine"]));
    let moved = format!("{faces}mesh m of roof {{ size: 1m }}\nlet twin = move(m, by: (0, 0, 2))\n");
    assert!(pixels_of("moved", &moved, &["--of", "m", "--of", "twin"]) != pixels_of("twin", &moved, &["--of", "twin"]));
}

#[test]
fn imported_curves_have_their_names() {
    let script =
        "units m\ncurve deck = line((0, 0, 0), (4, 0, 0))\ncurve keel = line((0, 2, 0), (4, 3, 0))\nexport deck, keel to \"hull.igs\"\n";
    let (status, said, folder) = loft("imported", script, &["run", "model.loft"]);
    assert_eq!(status, 0, "{said}");
    let import = "units m\nimport \"hull.igs\" as hull\ncurve bow = line((4, 0, 0), (4, 3, 0))\ncurve bottom = hull.curves[1]\npicture hull.curves, bow to \"a.svg\"\n";
    std::fs::write(folder.join("model.loft"), import).unwrap();
    let out = Command::new(env!("CARGO_BIN_EXE_loft")).current_dir(&folder).args(["run", "model.loft"]).output().unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let svg = std::fs::read_to_string(folder.join("a.svg")).unwrap();
    for name in [">deck<", ">bottom<", ">bow<"] {
        assert!(svg.contains(name), "{name}: {}", svg.lines().filter(|l| l.starts_with("<text")).collect::<Vec<_>>().join("\n"));
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn rims_of_words_in_svg_are_texts_below_them() {
    let mut out = Vec::new();
    Picture::new(&ball(12), &everything(), Format::Svg).write(Format::Svg, &mut out).unwrap();
    let text = String::from_utf8(out).unwrap();
    assert!(!text.contains("paint-order"));
    let lines: Vec<&str> = text.lines().collect();
    let rims: Vec<usize> =
        (0..lines.len()).filter(|k| lines[*k].starts_with("<text") && lines[*k].contains("stroke=\"#ffffff\"")).collect();
    assert!(rims.len() > 3, "{rims:?}");
    for k in rims {
        let words = |line: &str| line.split('>').nth(1).unwrap().to_owned();
        assert!(
            lines[k].contains("aria-hidden") && !lines[k + 1].contains("stroke=") && words(lines[k]) == words(lines[k + 1]),
            "{}",
            lines[k]
        );
    }
}

#[test]
fn faces_that_lie_on_each_other_do_not_flicker() {
    let painted = |mut s: Sheet, color: lofting::draw::color::Rgb| {
        s.paint = Paint::Even(color);
        s
    };
    let (red, blue) = (lofting::draw::color::Rgb(255, 0, 0), lofting::draw::color::Rgb(0, 0, 255));
    // The same square cut along its other diagonal, and bent by less than a picture shows.
    let e = 1e-3;
    let other = sheet(&[[0., 0., e], [1., 0., 0.], [1., 1., e], [0., 1., 0.]], &[[0, 1, 3], [1, 2, 3]]);
    for view in ["isometric", "top"] {
        let scene = Scene { sheets: vec![painted(square(1.0, 0.0), red), painted(other.clone(), blue)], ..Scene::default() };
        let (_, image) = drawn(&scene, view, (200, 200));
        let count = |c: usize| image.rgb.chunks(3).filter(|p| p[c] > 40 && p[2 - c] < 20).count();
        assert!(count(2) > 5_000 && count(0) < 150, "{view}: {} blue, {} red", count(2), count(0));
    }
}

#[test]
fn a_line_on_a_face_seen_from_the_side_is_whole() {
    // Along the middle of a face that is seen at 2 degrees.
    let line = Line { kind: Kind::Free, points: vec![DVec3::new(0.1, 0.5, 0.0), DVec3::new(0.9, 0.5, 0.0)] };
    let scene = Scene { sheets: vec![square(1.0, 0.0)], lines: vec![line], ..Scene::default() };
    let view = View { eye: DVec3::new(0.0, -1.0, 0.035), up: None, perspective: false };
    let red = |format: Format| {
        let picture = Picture::new(&scene, &Settings { view, ..settings(400, 400) }, format);
        let mut out = Vec::new();
        picture.write(format, &mut out).unwrap();
        out
    };
    let pixels = decoded(&red(Format::Png)).2;
    let seen = pixels.chunks(3).filter(|p| p[0] > 150 && p[1] < 110).count();
    // 0.8 of 400 pixels less the margins, at least two pixels high.
    assert!(seen > 500, "{seen}");
    let svg = String::from_utf8(red(Format::Svg)).unwrap();
    assert_eq!(svg.lines().filter(|l| l.contains("stroke=\"#d6121e\"")).map(|l| l.matches('M').count()).sum::<usize>(), 1);
}
