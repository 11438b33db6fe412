//! Files that lie: each is refused with the words that tell what is wrong, and none is read beyond its folder.

use lightloom_core::import;
use lightloom_core::{Error, Progress};
use serde_json::{Value, json};

use super::{Glb, Written, ball, packed};
use crate::hostile::{Row, told};

/// What is changed in a good file, and words of the refusal.
type Case = (&'static str, fn(&mut Glb), &'static str);

fn primitive(glb: &mut Glb) -> &mut Value {
    &mut glb.json["meshes"][0]["primitives"][0]
}

fn uri(glb: &mut Glb, uri: &str) {
    glb.json["buffers"] = json!([ { "uri": uri, "byteLength": 16 } ]);
}

fn required(glb: &mut Glb, name: &str) {
    glb.json["extensionsRequired"] = json!([name]);
}

const CASES: &[Case] = &[
    ("version 1", |glb| glb.json["asset"]["version"] = "1.0".into(), "is '1.0'; export it as glTF 2.0"),
    ("a later version", |glb| glb.json["asset"]["minVersion"] = "3.1".into(), "is '3.1'"),
    ("no asset", |glb| drop(glb.json.as_object_mut().unwrap().remove("asset")), "no glTF file"),
    ("Draco", |glb| required(glb, "KHR_draco_mesh_compression"), "export again without Draco"),
    ("meshopt", |glb| required(glb, "EXT_meshopt_compression"), "compressed by meshopt"),
    ("unknown extension", |glb| required(glb, "ACME_secret"), "the extension 'ACME_secret'"),
    ("up and away", |glb| uri(glb, "../../etc/passwd"), "leads out of the folder"),
    ("up in percents", |glb| uri(glb, "%2e%2e/secret.bin"), "leads out of the folder"),
    ("absolute", |glb| uri(glb, "/etc/passwd"), "leads out of the folder"),
    ("file:", |glb| uri(glb, "file:///etc/passwd"), "('file:'), which is never opened"),
    ("http:", |glb| uri(glb, "http://example.org/a.bin"), "('http:'), which is never opened"),
    ("a drive", |glb| uri(glb, "C:\\secret.bin"), "('C:'), which is never opened"),
    ("a share", |glb| uri(glb, "\\\\server\\a.bin"), "leads out of the folder"),
    ("a NUL", |glb| uri(glb, "a%00.bin"), "leads out of the folder"),
    ("not there", |glb| uri(glb, "none.bin"), "'none.bin' is not there"),
    ("no base64", |glb| uri(glb, "data:;base64,@@@@"), "is no data in base64"),
    ("data too short", |glb| uri(glb, "data:;base64,AAAA"), "says that it has 16 bytes, but has 3"),
    ("buffer too long", |glb| glb.json["buffers"] = json!([ { "byteLength": 1_u64 << 60 } ]), "but has"),
    (
        "a buffer without data",
        |glb| glb.json["buffers"] = json!([ { "byteLength": 4, "uri": "data:,abcd" }, { "byteLength": 4 } ]),
        "buffers[1]: has no data",
    ),
    ("view beyond", |glb| glb.json["bufferViews"][0]["byteLength"] = 1_000_000.into(), "beyond the"),
    (
        "view that wraps",
        |glb| glb.json["bufferViews"][0]["byteOffset"] = u64::MAX.into(),
        "bufferViews[0]: is",
    ),
    ("view of no buffer", |glb| glb.json["bufferViews"][0]["buffer"] = 9.into(), "names buffers[9]"),
    (
        "accessor beyond",
        |glb| glb.json["accessors"][0]["count"] = 1000.into(),
        "accessors[0]: has 1000 elements",
    ),
    (
        "2^64 - 1 elements",
        |glb| glb.json["accessors"][0]["count"] = u64::MAX.into(),
        "elements, beyond its data",
    ),
    (
        "offset that wraps",
        |glb| glb.json["accessors"][0]["byteOffset"] = u64::MAX.into(),
        "accessors[0]: has",
    ),
    ("stride of 1", |glb| glb.json["bufferViews"][0]["byteStride"] = 1.into(), "1 bytes apart"),
    ("accessor of another kind", |glb| glb.json["accessors"][0]["type"] = "VEC2".into(), "is Vec2"),
    (
        "accessor of no kind",
        |glb| glb.json["accessors"][0]["componentType"] = 1.into(),
        "of a type that glTF does not know",
    ),
    (
        "accessor without data",
        |glb| drop(glb.json["accessors"][0].as_object_mut().unwrap().remove("bufferView")),
        "has no data (bufferView)",
    ),
    (
        "zeros without end",
        |glb| {
            glb.json["accessors"][0] = json!({ "componentType": 5126, "count": 2_000_000_000, "type": "VEC3",
        "sparse": { "count": 0, "indices": { "bufferView": 0, "componentType": 5123 }, "values": { "bufferView": 0 } } });
        },
        "beyond its data",
    ),
    (
        "sparse beyond",
        |glb| {
            glb.json["accessors"][0]["sparse"] = json!({ "count": 2,
        "indices": { "bufferView": 1, "componentType": 5125 }, "values": { "bufferView": 0 } });
        },
        "indices that do not rise, or lie beyond",
    ),
    ("no such accessor", |glb| primitive(glb)["attributes"]["POSITION"] = 77.into(), "names accessors[77]"),
    ("no positions", |glb| primitive(glb)["attributes"] = json!({}), "has no POSITION"),
    ("indices beyond", |glb| glb.bin[504..506].copy_from_slice(&[0xff, 0xff]), "names vertex 65535"),
    ("indices of floats", |glb| primitive(glb)["indices"] = 0.into(), "needs Scalar"),
    (
        "vertices that are not finite",
        |glb| glb.bin[..4].copy_from_slice(&f32::NAN.to_le_bytes()),
        "1 vertices are no finite numbers",
    ),
    ("mode 9", |glb| primitive(glb)["mode"] = 9.into(), "is of a mode that glTF does not know"),
    ("no such mesh", |glb| glb.json["nodes"][0]["mesh"] = 5.into(), "names meshes[5]"),
    ("a circle of nodes", |glb| glb.json["nodes"][0]["children"] = json!([0]), "is reached twice"),
    (
        "a child of two",
        |glb| {
            glb.node(json!({ "children": [0] }));
        },
        "is reached twice",
    ),
    ("no such child", |glb| glb.json["nodes"][0]["children"] = json!([12]), "nodes[12]: is named as a child"),
    ("no such scene", |glb| glb.json["scene"] = 4.into(), "names scene 4"),
    (
        "a scale beyond 32 bits",
        |glb| glb.json["nodes"][0]["scale"] = json!([1e39, 1, 1]),
        "number out of range",
    ),
    ("farther than can be", |glb| glb.json["nodes"][0]["translation"] = json!([1e30, 0, 0]), ""),
    ("only lines", |glb| primitive(glb)["mode"] = 1.into(), "has no triangles"),
    ("no meshes", |glb| glb.json["nodes"] = json!([{}]), "holds no mesh"),
    (
        "no such light",
        |glb| glb.json["nodes"][0]["extensions"] = json!({ "KHR_lights_punctual": { "light": 3 } }),
        "names light 3",
    ),
    ("no such camera", |glb| glb.json["nodes"][0]["camera"] = 3.into(), "names camera 3"),
    ("text for a number", |glb| glb.json["nodes"][0]["mesh"] = "one".into(), "of its JSON"),
];

fn refused(bytes: &[u8]) -> String {
    Written::new(bytes)
        .import()
        .map(|import| format!("read: {:?}", import.summary))
        .unwrap_or_else(|e| e.to_string())
}

/// The rows of the table of bad inputs.
pub(crate) fn rows() -> Vec<Row> {
    let observe = |bytes: &[u8]| {
        let written = Written::new(bytes);
        written.import().map_err(|error| told(error, written.folder.path()))
    };
    let in_json = CASES.iter().map(|(name, change, words)| {
        let mut glb = ball();
        change(&mut glb);
        Row::refused(*name, &format!("scene.glb … {words}"), || observe(&glb.bytes()))
    });
    let containers =
        containers().into_iter().map(|(name, bytes, words)| Row::refused(name, words, || observe(&bytes)));
    in_json.chain(containers).collect()
}

/// Files whose parts are not as they say.
fn containers() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    let good = ball().bytes();
    let with = |at: usize, bytes: &[u8]| {
        let mut file = good.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    };
    let deep = format!("{{\"asset\":{}1{}}}", "[".repeat(100_000), "]".repeat(100_000));
    vec![
        ("empty", Vec::new(), "is empty"),
        ("a header alone", good[..10].to_vec(), "is it cut off?"),
        ("cut off", good[..good.len() - 9].to_vec(), "is it cut off?"),
        ("length 0", with(8, &[0; 4]), "says that it has 0 bytes"),
        ("all lengths", with(8, &[0xff; 4]), "says that it has 4294967295 bytes"),
        ("version 3", with(4, &[3]), "of version 3"),
        ("chunk too long", with(12, &[0xff; 4]), "chunk 0: says that it has 4294967295 bytes"),
        ("no JSON first", with(16, b"BIN\0"), "is no JSON"),
        ("no text", packed(b"\xff\xfe\xfd", &[]), "is no glTF"),
        ("not even JSON", b"solid ascii".to_vec(), "is no glTF"),
        ("nested without end", packed(deep.as_bytes(), &[]), "is no glTF"),
    ]
}

#[test]
fn a_tree_of_many_levels_is_refused_without_recursion() {
    let mut glb = ball();
    // Recursion would take some 200 bytes of stack and more for each.
    let count = 50_000;
    let nodes =
        (0..count).map(|i| if i + 1 < count { json!({ "children": [i + 1] }) } else { json!({ "mesh": 0 }) });
    glb.json["nodes"] = nodes.collect();
    let told = refused(&glb.bytes());
    assert!(told.contains("more than 1000 nodes below the top"), "{told}");
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder_are_refused() {
    let mut glb = ball();
    uri(&mut glb, "inside.bin");
    let written = Written::new(&glb.bytes());
    let secret = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(secret.path(), [0; 16]).unwrap();
    std::os::unix::fs::symlink(secret.path(), written.folder.path().join("inside.bin")).unwrap();
    let told = written.import().unwrap_err().to_string();
    assert!(told.contains("by a link"), "{told}");
}

#[test]
fn other_formats_are_refused_with_what_to_export() {
    let folder = tempfile::tempdir().unwrap();
    for (name, words) in [
        ("a.usda", "is USD"),
        ("a.USDZ", "is USD"),
        ("a.fbx", "open it in Blender"),
        ("a.blend", "File > Export > glTF 2.0 (.glb)"),
        ("a.abc", "without materials"),
        ("a.stl", "triangles without materials"),
        ("a.step", "CAD"),
        ("a.xyz", "none of .glb, .gltf and .obj"),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, "x").unwrap();
        let error = import::read(&path, &Progress::new()).unwrap_err();
        assert!(
            matches!(error, Error::Format { .. }) && error.to_string().contains(words),
            "{name}: {error}"
        );
    }
}
