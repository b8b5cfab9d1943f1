//! Pictures as measured: what covers how many pixels, what hides what, what the files hold.

#![allow(clippy::unwrap_used, clippy::panic)]

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
    Sheet { name: "s".into(), points, normals: Vec::new(), triangles: triangles.to_vec(), edges: Vec::new(), paint: Paint::Even(FACE) }
}

fn square(side: f64, z: f64) -> Sheet {
    sheet(&[[0., 0., z], [side, 0., z], [side, side, z], [0., side, z]], &[[0, 1, 2], [0, 2, 3]])
}

fn drawn(scene: &Scene, view: &str, size: (usize, usize)) -> (Camera, Image) {
    scene.check().unwrap();
    let frame = lofting::draw::camera::Rect::new(glam::DVec2::ZERO, glam::DVec2::new(size.0 as f64, size.1 as f64));
    let camera = Camera::framing(&View::named(view).unwrap(), &scene.points(), &scene.focus, &frame);
    let image = raster::draw(scene, &camera, &[], (0.0, 0.0), size);
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
    let sheet = Sheet { name: "ball".into(), normals: points.clone(), points, triangles, edges, paint: Paint::OfPoints(values) };
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
    let image = raster::draw(&Scene::default(), &camera, &[dot], (0.0, 0.0), (100, 100));
    let area = covered(&image) as f64;
    assert!((area - std::f64::consts::PI * 400.0).abs() < 8.0, "{area}");
}
