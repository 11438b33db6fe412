//! Files of scenes that are not read: what to export instead, and where.

use std::path::Path;

/// Endings of files, and how to get one that is read out of the program that wrote them.
const FOREIGN: [(&[&str], &str); 7] = [
    (
        &["blend", "blend1"],
        "is a file of Blender itself; in Blender, use File > Export > glTF 2.0 (.glb) with Data > Lighting and Include > \
         Cameras and Punctual Lights, or the add-on's File > Export > Lightloom",
    ),
    (
        &["usd", "usda", "usdc", "usdz"],
        "is USD, which does not say what is glass; export glTF 2.0 instead (Blender: File > Export > glTF 2.0; Houdini: \
         ROP GLTF Output)",
    ),
    (
        &["fbx", "dae", "3ds", "max", "ma", "mb", "c4d", "lwo"],
        "is not read; export glTF 2.0 (.glb) instead, or open it in Blender and use File > Export > glTF 2.0 (.glb)",
    ),
    (
        &["abc", "vdb"],
        "is a cache of geometry without materials; export the frame that is wanted as glTF 2.0 (.glb) or OBJ",
    ),
    (
        &["stl", "ply", "3mf", "off"],
        "holds triangles without materials; export OBJ or glTF instead (Blender: File > Import it, then File > Export > \
         glTF 2.0)",
    ),
    (
        &["step", "stp", "iges", "igs", "brep", "sldprt", "f3d", "3dm", "skp"],
        "holds surfaces of a CAD program, not triangles; export glTF or OBJ from there, finely meshed",
    ),
    (&["vrm", "b3dm", "gltf2"], "is a relative of glTF; export plain glTF 2.0 (.glb)"),
];

/// What to do about a file that is not read, by its ending; none for all others.
pub fn advice(path: &Path) -> Option<&'static str> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    FOREIGN.iter().find(|(endings, _)| endings.contains(&ending.as_str())).map(|(_, advice)| *advice)
}
