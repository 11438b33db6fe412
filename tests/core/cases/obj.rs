//! OBJ files: line ends, names, numbers, polygons, places far away.

use glam::{Vec2, Vec3, vec2};
use lightloom_core::scene::material::{Glass, Material};
use lightloom_core::scene::mesh::Transform;
use lightloom_core::scene::{Ray, Scene};

use super::{BALL, FACES, GLASS, RADIUS, ball, load};

/// Rows that must be the ball of glass: name, how the text of the ball is changed, files beside it, words of a note.
type Row =
    (&'static str, fn(String) -> String, &'static [(&'static str, &'static str)], &'static [&'static str]);

fn with(head: &str, text: String) -> String {
    format!("{head}\n{text}")
}

const FILE: &[(&str, &str)] = &[("glass.mtl", GLASS)];
const WOOD: &str = "newmtl Wood\nKd 0.5 0.3 0.1\n";

#[rustfmt::skip]
const ROWS: [Row; 35] = [
    ("plain", |t| with("mtllib glass.mtl\nusemtl Glass", t), FILE, &[]),
    ("two libraries on a line", |t| with("mtllib wood.mtl glass.mtl\nusemtl Glass", t), &[("wood.mtl", WOOD), ("glass.mtl", GLASS)], &[]),
    ("two libraries in quotes", |t| with("mtllib \"wood.mtl\" \"my glass.mtl\"\nusemtl Glass", t), &[("wood.mtl", WOOD), ("my glass.mtl", GLASS)], &["found as"]),
    ("a name with spaces", |t| with("mtllib my clear glass.mtl\nusemtl Glass", t), &[("my clear glass.mtl", GLASS)], &[]),
    ("a name with spaces as in an address", |t| with("mtllib my%20glass.mtl\nusemtl Glass", t), &[("my glass.mtl", GLASS)], &["found as 'my glass.mtl'"]),
    ("names with spaces, two on a line", |t| with("mtllib old wood.mtl my glass.mtl\nusemtl Glass", t), &[("old wood.mtl", WOOD), ("my glass.mtl", GLASS)], &[]),
    ("one of two is missing", |t| with("mtllib lost.mtl glass.mtl\nusemtl Glass", t), FILE, &["material file was not used", "lost.mtl"]),
    ("backslash", |t| with("mtllib .\\glass.mtl\nusemtl Glass", t), FILE, &["found as 'glass.mtl'"]),
    ("backslash into a folder", |t| with("mtllib maps\\glass.mtl\nusemtl Glass", t), &[("maps/glass.mtl", GLASS)], &["found as 'maps/glass.mtl'"]),
    ("absolute path of Unix", |t| with("mtllib /home/me/scene/glass.mtl\nusemtl Glass", t), FILE, &["found as 'glass.mtl'"]),
    ("absolute path of Windows", |t| with("mtllib C:\\Users\\me\\glass.mtl\nusemtl Glass", t), FILE, &["found as 'glass.mtl'"]),
    ("a folder that is not there", |t| with("mtllib ../materials/glass.mtl\nusemtl Glass", t), FILE, &["found as 'glass.mtl'"]),
    ("other case", |t| with("mtllib Glass.MTL\nusemtl Glass", t), FILE, &["found as 'glass.mtl'"]),
    ("other case of a folder", |t| with("mtllib Maps/Glass.mtl\nusemtl Glass", t), &[("maps/GLASS.mtl", GLASS)], &["found as 'maps/GLASS.mtl'"]),
    ("comment after mtllib", |t| with("mtllib glass.mtl # materials\nusemtl Glass", t), FILE, &[]),
    ("comment after usemtl", |t| with("mtllib glass.mtl\nusemtl Glass # ball", t), FILE, &[]),
    ("comment after newmtl", |t| with("mtllib glass.mtl\nusemtl Glass", t), &[("glass.mtl", "newmtl Glass # clear\nNi 1.5\nd 0.1\n")], &[]),
    ("a number sign in a name", |t| with("mtllib glass.mtl\nusemtl Material #25", t), &[("glass.mtl", "newmtl Material #25\nNi 1.5\nd 0.1\nnewmtl Material #26\nKd 1 0 0\n")], &[]),
    ("quotes around a name", |t| with("mtllib glass.mtl\nusemtl \"Glass\"", t), FILE, &[]),
    ("name in other case", |t| with("mtllib glass.mtl\nusemtl GLASS", t), FILE, &[]),
    ("keywords in capitals", |t| with("MTLLIB glass.mtl\nUseMtl Glass", t.replace("vn ", "VN ").replace("\nv ", "\nV ").replace("f ", "F ")), FILE, &[]),
    ("comment that ends in a backslash", |t| with("# from C:\\models\\\nmtllib glass.mtl\nusemtl Glass", t), FILE, &[]),
    ("comment after a face that ends in a backslash", |t| with("mtllib glass.mtl\nusemtl Glass", t.replacen("\nf ", " # C:\\\nf ", 1)), FILE, &[]),
    ("continued lines", |t| with("mtllib \\\nglass.mtl\nusemtl Glass", t.replace("//1 ", "//1 \\\n")), FILE, &[]),
    ("CR", |t| with("mtllib glass.mtl\nusemtl Glass", t).replace('\n', "\r"), FILE, &[]),
    ("CR, continued", |t| with("mtllib glass.mtl\nusemtl Glass", t.replace("//1 ", "//1 \\\n")).replace('\n', "\r"), FILE, &[]),
    ("CR LF and a byte order mark", |t| format!("\u{feff}{}", with("mtllib glass.mtl\nusemtl Glass", t)).replace('\n', "\r\n"), FILE, &[]),
    ("LF and CR mixed", |t| with("mtllib glass.mtl\rusemtl Glass", t), FILE, &[]),
    ("seven numbers", |t| with("mtllib glass.mtl\nusemtl Glass", t.replace("\nvn", " 1 0.5 0.5 0.5\nvn").replacen("\nv ", " 1 0.5 0.5 0.5\nv ", 9)), FILE, &[]),
    ("a weight of 0", |t| with("mtllib glass.mtl\nusemtl Glass", t.replacen("\nv ", " 0\nv ", 9)), FILE, &[]),
    ("five numbers", |t| with("mtllib glass.mtl\nusemtl Glass", t.replacen("\nv ", " 1 1\nv ", 9)), FILE, &[]),
    ("a normal that is NaN", |t| with("mtllib glass.mtl\nusemtl Glass", replaced(&t, "vn", 5, "vn nan nan nan")), FILE, &["1 normals are no finite numbers", "line 170"]),
    ("normals as C libraries write NaN", |t| with("mtllib glass.mtl\nusemtl Glass", replaced(&replaced(&t, "vn", 5, "vn -1.#IND 1.#QNAN 0"), "vn", 7, "vn -nan(ind) 0 1")), FILE, &["2 normals"]),
    ("texture coordinates and groups", |t| with("mtllib glass.mtl\nvt 0 0\ng a\no b\ns 1\nusemtl Glass", t.replace("//", "/1/")), FILE, &[]),
    ("faces without normals among others", |t| with("mtllib glass.mtl\nusemtl Glass", replaced(&replaced(&t, "f", 3, ""), "f", 7, "")) + &bare(&t, 3) + &bare(&t, 7), FILE, &[]),
];

/// The text with line `number` (from 0) of a keyword replaced.
fn replaced(text: &str, keyword: &str, number: usize, by: &str) -> String {
    let mut count = 0;
    let lines = text.lines().map(|line| {
        let found = line.split(' ').next() == Some(keyword) && {
            count += 1;
            count == number + 1
        };
        if found { by } else { line }
    });
    lines.collect::<Vec<_>>().join("\n") + "\n"
}

/// Face `number` without normals.
fn bare(text: &str, number: usize) -> String {
    let face = text.lines().filter(|line| line.starts_with("f ")).nth(number).unwrap();
    let corners: Vec<&str> = face.split(' ').map(|corner| corner.split('/').next().unwrap()).collect();
    corners.join(" ") + "\n"
}

#[test]
fn a_ball_of_glass_is_read_however_its_file_is_written() {
    for (name, change, others, words) in ROWS {
        let (scene, notes) =
            load(change(ball()), others, Transform::default()).unwrap_or_else(|e| panic!("{name}: {e}"));
        let meshes = scene.meshes();
        assert_eq!(meshes.len(), 1, "{name}: {notes}");
        assert!(matches!(meshes[0].material, Material::Glass(Glass { ior: 1.5, .. })), "{name}: {notes}");
        assert_eq!((meshes[0].triangles, &*meshes[0].name), (FACES, "mesh"), "{name}: {notes}");
        // One note tells that it was taken as glass, or two for a mesh and its guess.
        assert!(words.iter().all(|word| notes.contains(word)), "{name}: {notes}");
        assert!(!notes.contains("open edges") && !notes.contains("wound"), "{name}: {notes}");
        assert!(!words.is_empty() || notes.lines().count() == 1, "{name}: {notes}");
        assert_is_the_ball(&scene, name);
    }
}

/// Rays through the centre leave and enter at the radius, with the ball's own normals.
fn assert_is_the_ball(scene: &Scene, name: &str) {
    for direction in [Vec3::new(0.3, -1.0, 0.2), Vec3::new(-0.7, -0.1, 0.9), Vec3::new(0.2, -0.5, -0.9)] {
        let direction = direction.normalize();
        let hit = scene.intersect(&Ray::new(BALL - direction, direction)).unwrap();
        // Facets of 18 degrees cut up to 1.9 % off the radius; normals that are computed for a corner lie within a degree.
        assert!((hit.point.distance(BALL) - RADIUS).abs() < 0.02 * RADIUS, "{name}: {}", hit.point);
        assert!(hit.shading_normal.angle_between(hit.point - BALL) < 0.03, "{name}");
    }
}

#[test]
fn what_nobody_can_read_is_refused_with_its_line() {
    const V: &str = "v 0 0 0\nv 1 0 0\nv 0 0 -1\n";
    let rows = [
        ("v 0,5 0,25 1,0\n", "line 1", "decimal comma"),
        ("v 1 2\n", "line 1", "three numbers"),
        ("v 1 2 0.5f\n", "line 1", "'0.5f' is no number"),
        ("v 0 0 0\nvn 0 0,5 1\n", "line 2", "decimal comma"),
        ("v 0 0 0\r\n\r\nv 1 0x1 0\r\n", "line 3", "'0x1' is no number"),
        ("v 0 0 \\\n0\nv 1 x 0\n", "line 3", "'x' is no number"),
        (&format!("{V}f 1 2 0\n"), "line 4", "counts from 1"),
        (&format!("{V}f 1 2 4\n"), "line 4", "only 3 stand before it"),
        (&format!("{V}f 1.0 2 3\n"), "line 4", "no whole number"),
        (&format!("{V}f 1 2 \\\n-4\n"), "line 4", "only 3 stand before it"),
        (&format!("{V}v 1e39 0 0\nv 0 1.#INF 0\nf 1 2 3\n"), "line 4", "2 vertices"),
        ("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n", "", "git lfs pull"),
        ("v\0 \00\0 \00\0", "", "UTF-16"),
    ];
    for (text, line, words) in rows {
        let error = load(text, &[], Transform::default()).err().unwrap();
        assert!(
            error.contains("mesh.obj") && error.contains(line) && error.contains(words),
            "{text}: {error}"
        );
    }
}

#[test]
fn coordinates_of_maps_are_placed_before_they_are_rounded() {
    // Easting and northing of a place, and of another, farther than f32 has tenths of metres.
    for far in
        [[431_250.37, 95.0, -541_102.81], [389_871.25, 5_819_213.5, 34.1], [-2_600_000.5, 1e7, 1_200_000.7]]
    {
        let moved = |line: &str| -> String {
            let Some(rest) = line.strip_prefix("v ") else { return line.into() };
            let words = rest
                .split(' ')
                .zip(far)
                .map(|(word, far)| format!("{:.6}", word.parse::<f64>().unwrap() + far));
            format!("v {}", words.collect::<Vec<_>>().join(" "))
        };
        let text: Vec<String> = ball().lines().map(moved).collect();
        let text = with("mtllib glass.mtl\nusemtl Glass", text.join("\n"));
        let place = Transform { translate: far.map(|x| -x), ..Transform::default() };
        let (scene, notes) = load(&text, FILE, place).unwrap();
        let mesh = &scene.meshes()[0];
        // Six decimals in the file.
        assert!((mesh.lower - (BALL - RADIUS)).abs().max_element() < 2e-6, "{} {notes}", mesh.lower);
        assert_eq!((mesh.triangles, notes.lines().count()), (FACES, 1), "{notes}");
        let notes = load(&text, FILE, Transform::default()).map_or_else(|error| error, |(_, notes)| notes);
        assert!(notes.contains("m from the origin") && notes.contains("transform.translate"), "{notes}");
    }
}

/// A vertical prism over an outline, whose ends are polygons, and with a vertex more on the edges of one side.
fn prism(outline: &[Vec2]) -> String {
    let mut text = String::new();
    for y in [0.1, 0.3] {
        outline.iter().for_each(|p| text.push_str(&format!("v {} {y} {}\n", p.x, p.y)));
    }
    let count = outline.len();
    let corners = |corners: Vec<usize>| -> String {
        format!("f {}\n", corners.iter().map(|c| (c + 1).to_string()).collect::<Vec<_>>().join(" "))
    };
    text += &corners((0..count).collect());
    text += &corners((count..2 * count).rev().collect());
    for i in 0..count {
        let next = (i + 1) % count;
        text += &corners(vec![next, i, i + count, next + count]);
    }
    with("mtllib glass.mtl\nusemtl Glass", text)
}

#[test]
fn concave_polygons_keep_their_outline() {
    let star: Vec<Vec2> = (0..10)
        .map(|i| Vec2::from_angle(i as f32 * 0.628_318_5) * if i % 2 == 0 { 0.4 } else { 0.15 })
        .collect();
    let comb: Vec<Vec2> = (0..12)
        .map(|i| vec2(0.05 * i as f32 - 0.3, if i % 2 == 0 { -0.2 } else { 0.3 }))
        .chain([vec2(0.25, -0.3), vec2(-0.3, -0.3)])
        .collect();
    let outlines: [Vec<Vec2>; 7] = [
        vec![vec2(-0.4, -0.3), vec2(0.4, -0.3), vec2(-0.1, -0.1), vec2(-0.4, 0.4)],
        vec![vec2(-0.4, 0.4), vec2(-0.4, -0.3), vec2(0.4, -0.3), vec2(-0.1, -0.1)],
        // An L, with a corner in the middle of each long side.
        vec![
            vec2(-0.4, -0.4),
            vec2(0.0, -0.4),
            vec2(0.4, -0.4),
            vec2(0.4, -0.1),
            vec2(0.1, -0.1),
            vec2(-0.1, -0.1),
            vec2(-0.1, 0.4),
            vec2(-0.4, 0.4),
            vec2(-0.4, 0.1),
        ],
        // A square with corners in the middle of its sides.
        vec![
            vec2(-0.3, -0.3),
            vec2(0.0, -0.3),
            vec2(0.3, -0.3),
            vec2(0.3, 0.0),
            vec2(0.3, 0.3),
            vec2(0.0, 0.3),
            vec2(-0.3, 0.3),
            vec2(-0.3, 0.0),
        ],
        star.clone(),
        star.into_iter().rev().collect(),
        comb,
    ];
    for (number, outline) in outlines.iter().enumerate() {
        let (scene, notes) = load(prism(outline), FILE, Transform::default()).unwrap();
        assert!(!notes.contains("open edges") && !notes.contains("wound"), "{number}: {notes}");
        // A polygon of n corners has n - 2 triangles; a prism n quads besides.
        assert_eq!(scene.meshes()[0].triangles, 2 * (outline.len() - 2) + 2 * outline.len(), "{number}");
        // Points off the outline by more than rounding.
        for i in 0..900 {
            let point = vec2((i % 30) as f32, (i / 30) as f32) / 30.0 - 0.4837;
            let hit = scene
                .intersect(&Ray::new(Vec3::new(point.x, 1.0, point.y), Vec3::NEG_Y))
                .is_some_and(|hit| hit.point.y > 0.05);
            assert_eq!(hit, inside(outline, point), "{number}: {point}");
        }
    }
}

/// Whether a ray to the right crosses the outline an odd number of times.
fn inside(outline: &[Vec2], point: Vec2) -> bool {
    let edges = outline.iter().zip(outline.iter().cycle().skip(1));
    let crossed = edges.filter(|(a, b)| {
        (a.y > point.y) != (b.y > point.y) && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossed.count() % 2 == 1
}

#[test]
fn a_polygon_that_crosses_itself_is_told() {
    let bow = "v 0 0 0\nv 1 0 1\nv 1 0 0\nv 0 0 2\nf 1 2 3 4\n";
    let (_, notes) = load(bow, &[], Transform::default()).unwrap();
    assert!(notes.contains("1 polygons cross themselves"), "{notes}");
    let corners = 5000;
    let mut saw: String = (0..corners).map(|i| format!("v {} 0.1 {}\n", i, i % 2)).collect();
    saw += &format!("v 0 0.1 -9\nf {}\n", (1..=corners + 1).map(|i| format!("{i} ")).collect::<String>());
    let (_, notes) = load(saw, &[], Transform::default()).unwrap();
    assert!(notes.contains("have thousands of corners"), "{notes}");
}

#[test]
fn names_that_mean_one_material_are_one_object() {
    let faces = "v 0 0 0\nv 1 0 0\nv 0 0 -1\nusemtl Glass\nf 1 2 3\nusemtl glass\nf 1 2 3\nusemtl Glass # c\nf 1 2 3\nusemtl stone\nf 1 2 3\n";
    let (scene, _) = load(with("mtllib glass.mtl", faces.into()), FILE, Transform::default()).unwrap();
    let names: Vec<&str> = scene.meshes().iter().map(|mesh| &*mesh.name).collect();
    assert_eq!(names, ["mesh/Glass", "mesh/stone"]);
}
