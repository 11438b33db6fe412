//! Materials and lamps: what the file says, and what it becomes.

use lightloom_core::scene::material::{Diffuse, Glass, Material, Mirror};
use lightloom_core::scene::{LightDesc, MeshDesc};
use serde_json::{Value, json};

use super::{ball, imported};

fn glass(ior: f32, absorption: [f32; 3], dispersion: Option<f32>) -> Material {
    Material::Glass(Glass { ior, absorption, dispersion })
}

fn near(a: &Material, b: &Material) -> bool {
    match (a, b) {
        (Material::Glass(a), Material::Glass(b)) => {
            let close = |x: f32, y: f32| (x - y).abs() <= 1e-4 * y.abs().max(1.0);
            close(a.ior, b.ior)
                && a.absorption.iter().zip(b.absorption).all(|(x, y)| close(*x, y))
                && a.dispersion.is_some() == b.dispersion.is_some()
                && close(a.dispersion.unwrap_or(0.0), b.dispersion.unwrap_or(0.0))
        }
        _ => a == b,
    }
}

/// A material as written, what it becomes, and words of a note.
fn table() -> Vec<(&'static str, Value, Material, &'static str)> {
    let pbr = |colour: [f32; 4], metal: f32, rough: f32| json!({ "baseColorFactor": colour, "metallicFactor": metal, "roughnessFactor": rough });
    let white = [1.0; 4];
    let clear = json!({ "transmissionFactor": 1 });
    let tenth = -(0.5_f32.ln()) / 0.1;
    vec![
        ("glass", super::glass(), glass(1.5, [0.0; 3], None), ""),
        (
            "index and volume",
            json!({ "pbrMetallicRoughness": pbr(white, 0.0, 0.0), "extensions": { "KHR_materials_transmission": clear,
                "KHR_materials_ior": { "ior": 1.33 },
                "KHR_materials_volume": { "attenuationDistance": 0.1, "attenuationColor": [1, 0.5, 1] } } }),
            glass(1.33, [0.0, tenth, 0.0], None),
            "",
        ),
        (
            "dispersion",
            json!({ "pbrMetallicRoughness": pbr(white, 0.0, 0.0), "extensions": { "KHR_materials_transmission": clear,
                "KHR_materials_dispersion": { "dispersion": 0.5 } } }),
            glass(1.5, [0.0; 3], Some(40.0)),
            "",
        ),
        (
            "rough glass",
            json!({ "pbrMetallicRoughness": pbr(white, 0.0, 0.4), "extensions": { "KHR_materials_transmission": clear } }),
            glass(1.5, [0.0; 3], None),
            "glass of roughness 0.40 is taken as polished",
        ),
        (
            "an index out of range",
            json!({ "pbrMetallicRoughness": pbr(white, 0.0, 0.0), "extensions": { "KHR_materials_transmission": clear,
                "KHR_materials_ior": { "ior": 9 } } }),
            glass(4.0, [0.0; 3], None),
            "its index 9 is taken as 4",
        ),
        (
            "a mirror",
            json!({ "pbrMetallicRoughness": pbr([0.9, 0.8, 0.7, 1.0], 1.0, 0.0) }),
            Material::Mirror(Mirror { reflectance: [0.9, 0.8, 0.7] }),
            "",
        ),
        (
            "by its name",
            json!({ "name": "Window GLASS", "pbrMetallicRoughness": pbr(white, 0.0, 0.0) }),
            glass(1.5, [0.0; 3], None),
            "taken as glass, by its name",
        ),
        (
            "by its transparency",
            json!({ "alphaMode": "BLEND", "pbrMetallicRoughness": pbr([1.0, 1.0, 1.0, 0.2], 0.0, 0.0) }),
            glass(1.5, [0.0; 3], None),
            "taken as glass, by its transparency",
        ),
        (
            "nothing said",
            json!({ "name": "x" }),
            glass(1.5, [0.0; 3], None),
            "an empty one: taken as glass: Ball",
        ),
        // Nothing else casts a caustic.
        (
            "matt alone",
            json!({ "pbrMetallicRoughness": pbr([0.2, 0.3, 0.4, 1.0], 0.0, 0.5) }),
            glass(1.5, [0.0; 3], None),
            "no material is glass or a mirror: taken as glass: Ball",
        ),
    ]
}

#[test]
fn materials_become_ours() {
    for (name, written, expected, words) in table() {
        let mut glb = ball();
        glb.json["materials"][0] = written;
        let import = imported(&glb);
        let made = import.scene.meshes[0].material.clone().unwrap();
        assert!(near(&made, &expected), "{name}: {made:?}");
        let notes = import.summary.notes.join("\n");
        assert!(notes.contains(words), "{name}: {notes}");
    }
}

#[test]
fn matt_things_beside_glass_stay_matt() {
    let mut glb = ball();
    let (unit, faces) = crate::scenes::icosphere(1);
    let matt =
        json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.2, 0.3, 0.4, 1], "metallicFactor": 0 } });
    let material = glb.push("materials", matt);
    let mesh = glb.mesh(&unit, &faces, Some(material));
    glb.node(json!({ "name": "Matt", "mesh": mesh, "translation": [3, 0, 0] }));
    let import = imported(&glb);
    let MeshDesc { material, .. } = &import.scene.meshes[1];
    assert_eq!(*material, Some(Material::Diffuse(Diffuse { albedo: [0.2, 0.3, 0.4] })));
}

#[test]
fn candela_and_lux_become_watts() {
    let mut glb = ball();
    let down = json!({ "translation": [0, 2, 0], "rotation": [-0.5_f32.sqrt(), 0, 0, 0.5_f32.sqrt()] });
    let named = |name: &str| {
        let mut node = down.clone();
        node["name"] = name.into();
        node
    };
    // 1000 W in Blender.
    let candela = 1000.0 * 683.0 / (4.0 * std::f64::consts::PI);
    glb.light(json!({ "type": "point", "intensity": candela }), named("point"));
    let cone = json!({ "innerConeAngle": 0.0, "outerConeAngle": std::f64::consts::FRAC_PI_3 });
    glb.light(json!({ "type": "spot", "intensity": candela, "spot": cone }), named("spot"));
    glb.light(json!({ "type": "directional", "intensity": 3.0 * 683.0, "color": [1, 0.5, 0] }), named("sun"));
    let lights = imported(&glb).scene.lights;
    let LightDesc::Point(point) = &lights[0] else { panic!("{lights:?}") };
    assert!((point.watts - 1000.0).abs() < 0.01, "{}", point.watts);
    let LightDesc::Spot(spot) = &lights[1] else { panic!("{lights:?}") };
    // Of the sphere, the cone of 120 degrees has a quarter, and half of that where all of it fades.
    assert!((spot.watts - 125.0).abs() < 0.01 && (spot.angle_deg - 120.0).abs() < 1e-3, "{spot:?}");
    assert!((spot.target[1] - 0.0).abs() < 1e-4 && spot.target[0].abs() < 1e-4, "{:?}", spot.target);
    let LightDesc::Directional(sun) = &lights[2] else { panic!("{lights:?}") };
    assert!((sun.irradiance - 3.0).abs() < 1e-4 && sun.colour == [1.0, 0.5, 0.0], "{sun:?}");
    assert!((sun.direction[1] + 1.0).abs() < 1e-5, "{:?}", sun.direction);
}
