//! The layers of EXR files read back: names, alpha, depth, camera, and frames of single caustics.

use std::path::Path;

use exr::meta::header::Header;
use exr::prelude::{FlatSamples, MetaData, read_all_flat_layers_from_file};
use glam::{Mat4, Vec2, Vec3, Vec4};
use half::f16;
use lightloom_core::Progress;
use lightloom_core::engine::Engine;
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::render::{Plate, PlateSettings};
use lightloom_core::scene::CameraDesc;

/// A goblet in the light of two lamps under an even sky; the caustic of the first lamp is named.
fn project(layers: &str) -> (Project, std::path::PathBuf) {
    project_of(layers, r#"{ "frame": 1, "shows": "physical_caustic" }"#)
}

fn project_of(layers: &str, keys: &str) -> (Project, std::path::PathBuf) {
    let text = format!(
        r#"{{
          "lightloom": 1,
          "scene": {{
            "meshes": [{{ "name": "goblet", "file": "../assets/meshes/goblet.obj" }}],
            "lights": [
              {{ "type": "spot", "name": "key", "position": [-0.8, 0.6, -0.7], "target": [0, 0.1, 0], "angle_deg": 8 }},
              {{ "type": "spot", "name": "rim", "position": [0.8, 0.7, 0.2], "target": [0, 0.1, 0], "angle_deg": 8 }}
            ],
            "environment": {{ "zenith": [0.1, 0.2, 0.3], "horizon": [0.1, 0.2, 0.3] }}
          }},
          "caustics": [{{ "name": "first light", "light": "key" }}],
          "keys": [{keys}],
          "render": {{ "width": 64, "height": 36, "photons": 4000, "passes": 2, "background_samples": 1 }},
          "output": {{ "name": "a.####", "formats": ["exr", "png"], "layers": {layers} }}
        }}"#
    );
    let place = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../projects/layers.json"));
    (Project::parse(text.as_bytes(), place).unwrap(), place.to_owned())
}

/// The headers of the rendered frame, and its channels by name.
struct Read {
    headers: Vec<Header>,
    parts: Vec<String>,
    channels: Vec<(String, Vec<f32>)>,
    stages: Vec<&'static str>,
}

impl Read {
    fn channel(&self, name: &str) -> &[f32] {
        let found = self.channels.iter().find(|(of, _)| of == name);
        &found.unwrap_or_else(|| panic!("no {name} among {:?}", self.names())).1
    }

    fn names(&self) -> Vec<&str> {
        self.channels.iter().map(|(name, _)| name.as_str()).collect()
    }
}

fn rendered(layers: &str) -> Read {
    let (project, place) = project(layers);
    last_frame(&project, &place)
}

/// The last frame of a project.
fn last_frame(project: &Project, place: &Path) -> Read {
    let folder = tempfile::tempdir().unwrap();
    let frame = project.keys.last().unwrap().frame;
    let mut project = project.clone();
    project.output.frames = Some(frame.to_string());
    let engine = Engine::new(AssetFolder::new(place, false).unwrap());
    let summary = engine.render(&project, folder.path(), &Progress::new(), &|_| ()).unwrap();
    let path = folder.path().join(format!("a.{frame:04}.exr"));
    let image = read_all_flat_layers_from_file(&path).unwrap();
    let mut parts = Vec::new();
    let mut channels = Vec::new();
    for layer in image.layer_data {
        parts.extend(layer.attributes.layer_name.map(|name| name.to_string()));
        for channel in layer.channel_data.list {
            let values = match channel.sample_data {
                FlatSamples::F16(values) => values.into_iter().map(f16::to_f32).collect(),
                FlatSamples::F32(values) => values,
                FlatSamples::U32(_) => panic!("no whole numbers are written"),
            };
            channels.push((channel.name.to_string(), values));
        }
    }
    let headers = MetaData::read_from_file(&path, true).unwrap().headers.to_vec();
    let stages = summary.stages.iter().map(|cost| cost.stage).collect();
    Read { headers, parts, channels, stages }
}

#[test]
fn every_layer_is_a_part_whose_channels_bear_its_name() {
    let read = rendered(r#"["beauty", "caustic", "caustics", "background", "depth"]"#);
    let parts = ["rgba", "caustic", "caustic_first_light", "caustic_rest", "background", "depth"];
    assert_eq!(read.parts, parts);
    let names = read.names();
    assert_eq!(names[..4], ["A", "B", "G", "R"]);
    assert_eq!(names[4..7], ["caustic.B", "caustic.G", "caustic.R"]);
    assert_eq!(names[names.len() - 1], "depth.Z");

    let sum = |a: &str, b: &str| -> f32 {
        let add = |(i, a): (usize, &f32)| a + read.channel(b)[i];
        let both: Vec<f32> = read.channel(a).iter().enumerate().map(add).collect();
        let whole = read.channel(if a.starts_with("caustic_") { "caustic.G" } else { "G" });
        // Each of the two and their sum is rounded to 11 bits.
        both.iter().zip(whole).map(|(sum, whole)| (sum - whole).abs() / whole.max(1e-3)).fold(0.0, f32::max)
    };
    assert!(sum("caustic_first_light.G", "caustic_rest.G") < 2e-3);
    assert!(sum("background.G", "caustic.G") < 2e-3);
    let light = |name: &str| read.channel(name).iter().sum::<f32>();
    assert!(light("caustic_first_light.G") > 0.0 && light("caustic_rest.G") > 0.0);
}

#[test]
fn a_plate_takes_the_place_of_the_background_and_leaves_the_caustics_alone() {
    let all = r#"["beauty", "caustic", "background", "depth"]"#;
    let (mut project, place) = project(all);
    let traced = last_frame(&project, &place);
    let file = "../assets/pictures/dark_glass.png";
    project.render.plate = Some(PlateSettings { exposure: 2.0, ..PlateSettings::new(file) });
    let read = last_frame(&project, &place);
    for channel in ["caustic.R", "caustic.G", "caustic.B", "depth.Z"] {
        assert_eq!(read.channel(channel), traced.channel(channel));
    }
    assert!(!read.stages.contains(&"background"), "{:?}", read.stages);
    assert!(read.channel("A").iter().all(|alpha| *alpha == 1.0), "a plate covers everything");
    let path = place.parent().unwrap().join(file);
    let settings = project.render.plate.clone().unwrap();
    let plate = Plate::load(&path, &settings, [64, 36], &Progress::new()).unwrap();
    for (i, light) in plate.image.pixels.iter().enumerate() {
        let sum = light.y + traced.channel("caustic.G")[i];
        // Both are rounded to 11 bits, and small ones to multiples of 6e-8.
        assert!((read.channel("G")[i] - sum).abs() <= 1e-3 * sum + 1e-7);
        assert!((read.channel("background.G")[i] - light.y).abs() <= 5e-4 * light.y + 6e-8);
    }
    project.render.plate = Some(PlateSettings::new("../assets/meshes/goblet.obj"));
    let engine = Engine::new(AssetFolder::new(&place, false).unwrap());
    let wrong = engine.check(&project).unwrap_err().to_string();
    assert!(wrong.contains("goblet.obj") && wrong.contains("no picture"), "{wrong}");
    project.render.plate = Some(PlateSettings::new("nowhere.png"));
    let wrong = engine.check(&project).unwrap_err().to_string();
    assert!(wrong.starts_with("render.plate.file: 'nowhere.png'"), "{wrong}");
}

#[test]
fn what_glass_keeps_is_in_the_layer_of_its_own_caustic() {
    let keys = r#"
      { "frame": 1, "shows": "physical_caustic" },
      { "frame": 9, "shows": "physical_caustic", "caustics": {
        "first light": { "shows": { "image": { "file": "../assets/targets/star.png" } } } } }"#;
    let (mut project, place) = project_of(r#"["caustic", "caustics"]"#, keys);
    let [kept, left] = [1.0, 0.0].map(|share| {
        project.render.kept_in_glass = share;
        last_frame(&project, &place)
    });
    for read in [&kept, &left] {
        let parts = read.channel("caustic_first_light.G").iter().zip(read.channel("caustic_rest.G"));
        let worst =
            parts.zip(read.channel("caustic.G")).map(|((a, b), all)| (a + b - all).abs() / all.max(1e-3));
        // Each of the two and their sum is rounded to 11 bits.
        assert!(worst.fold(0.0, f32::max) < 2e-3);
    }
    let light = |read: &Read, name: &str| read.channel(name).iter().sum::<f32>();
    assert!(light(&kept, "caustic_first_light.G") > 1.01 * light(&left, "caustic_first_light.G"));
    assert_eq!(kept.channel("caustic_rest.G"), left.channel("caustic_rest.G"));
}

#[test]
fn alpha_and_depth_are_those_of_the_surfaces() {
    let read = rendered(r#"["beauty", "depth"]"#);
    let (alpha, depth) = (read.channel("A"), read.channel("depth.Z"));
    // The camera of a scene without one looks down at the receiver: its middle is covered, and the corners are sky.
    let (middle, corner) = (18 * 64 + 32, 0);
    assert_eq!((alpha[middle], alpha[corner], depth[corner]), (1.0, 0.0, 1e10));
    // From (0, 1.2, 1.6) the origin is 2 m away, and the goblet is before it.
    assert!(depth[middle] > 1.2 && depth[middle] <= 2.01, "{}", depth[middle]);
    assert!(alpha.iter().any(|a| *a > 0.0 && *a < 1.0), "edges are soft");
    assert!(alpha.iter().zip(depth).all(|(a, z)| *a > 0.0 || *z == 1e10));
}

#[test]
fn the_header_tells_camera_and_time_as_openexr_defines_them() {
    let (mut project, place) = project(r#"["caustic"]"#);
    let shifted = CameraDesc { shift: [0.2, -0.1], ..CameraDesc::default() };
    project.scene.as_mut().unwrap().camera = shifted.clone();
    let read = last_frame(&project, &place);
    assert_eq!(read.headers.len(), 1);
    let header = &read.headers[0];
    let code = header.shared_attributes.time_code.unwrap();
    assert_eq!([code.hours, code.minutes, code.seconds, code.frame], [0, 0, 0, 1]);
    // Row vectors, row by row: as column vectors these are the columns.
    let matrix = |values: Option<[f32; 16]>| Mat4::from_cols_array(&values.unwrap());
    let to_camera = matrix(header.own_attributes.world_to_camera);
    let to_ndc = matrix(header.own_attributes.world_to_normalized_device);
    let camera = shifted.resolve("").unwrap();
    // Straight ahead is +z, the space is left-handed.
    let ahead = to_camera * (camera.position + 2.0 * camera.forward).extend(1.0);
    assert!(ahead.distance(Vec4::new(0.0, 0.0, 2.0, 1.0)) < 1e-5, "{ahead}");
    assert!(to_camera.determinant() < 0.0);
    for point in [Vec3::ZERO, Vec3::new(0.3, 0.1, 0.2), Vec3::new(-0.4, 0.0, -0.3)] {
        let seen = to_ndc * point.extend(1.0);
        let place = camera.project(point, 64.0 / 36.0).unwrap();
        // (0, 0) is the upper left corner.
        let expected = [0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y];
        assert!((seen.x / seen.w - expected[0]).abs() < 1e-5 && (seen.y / seen.w - expected[1]).abs() < 1e-5);
    }
}

#[test]
fn the_caustic_alone_traces_no_background_and_is_the_same_light() {
    let alone = rendered(r#"["caustic"]"#);
    assert!(!alone.stages.contains(&"background"), "{:?}", alone.stages);
    let with = rendered(r#"["beauty", "caustic"]"#);
    assert!(with.stages.contains(&"background"));
    assert_eq!(alone.channel("caustic.R"), with.channel("caustic.R"));
}

#[test]
fn layers_that_cannot_be_are_refused() {
    let (mut project, _) = project(r#"["caustic"]"#);
    project.output.layers = vec![lightloom_core::export::FrameLayer::Depth];
    assert!(project.check().unwrap_err().to_string().starts_with("output.layers: "));
    project.output.layers = vec![lightloom_core::export::FrameLayer::Caustics];
    project.caustics.clear();
    let error = project.check().unwrap_err().to_string();
    assert!(error.starts_with("output.layers: ") && error.contains("named caustic"), "{error}");
}

/// R, G, B of the plane's file of a frame, and its size and attributes.
fn plane_of(project: &Project, place: &Path, folder: &Path) -> (Vec<[f32; 3]>, [usize; 2], Header) {
    let engine = Engine::new(AssetFolder::new(place, false).unwrap());
    engine.render(project, folder, &Progress::new(), &|_| ()).unwrap();
    let path = folder.join(format!("a_plane.{:04}.exr", project.keys[0].frame));
    let header = MetaData::read_from_file(&path, true).unwrap().headers[0].clone();
    let layer = read_all_flat_layers_from_file(&path).unwrap().layer_data.remove(0);
    let size = [layer.size.0, layer.size.1];
    let values = |name: &str| {
        let channel =
            layer.channel_data.list.iter().find(|channel| channel.name.to_string() == name).unwrap();
        let FlatSamples::F32(values) = &channel.sample_data else { panic!("32 bits") };
        values.clone()
    };
    let [r, g, b] = ["R", "G", "B"].map(values);
    ((0..r.len()).map(|i| [r[i], g[i], b[i]]).collect(), size, header)
}

#[test]
fn the_plane_alone_is_a_texture_of_all_its_light() {
    let text = r#"{ "lightloom": 1, "plane": { "watts": 3 },
      "keys": [{ "frame": 1, "shows": { "image": { "file": "../assets/targets/star.png" } } }],
      "render": { "width": 64, "height": 64, "photons": 20000, "passes": 1 },
      "output": { "name": "a.####", "formats": ["exr"], "layers": ["plane"] } }"#;
    let place = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../projects/layers.json"));
    let project = Project::parse(text.as_bytes(), place).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let (light, [width, height], header) = plane_of(&project, place, folder.path());
    // The star lies within the plane: its watts are the mean irradiance times one square metre, to the kernel's reach.
    let watts = light.iter().map(|v| v.iter().sum::<f32>()).sum::<f32>() / (width * height) as f32;
    assert!((watts - 3.0).abs() < 0.01, "{watts} W");
    assert!(!folder.path().join("a.0001.exr").exists(), "no frames through the camera were asked for");
    let unit = &header.own_attributes.other[&exr::prelude::Text::from("lightloom:unit")];
    assert!(format!("{unit:?}").contains("W/m^2"), "{unit:?}");
}

#[test]
fn the_light_on_the_plane_is_what_the_camera_sees_of_it() {
    let (mut project, place) = project(r#"["caustic", "caustics", "plane"]"#);
    let desc = project.scene.as_mut().unwrap();
    // High above, so that the glass hides little.
    desc.camera = CameraDesc { position: [0.0, 3.0, 0.01], fov_deg: 20.0, ..CameraDesc::default() };
    project.render.photons = 40_000;
    let folder = tempfile::tempdir().unwrap();
    let (light, [width, height], header) = plane_of(&project, &place, folder.path());
    assert!(header.own_attributes.world_to_camera.is_none());
    let image = read_all_flat_layers_from_file(folder.path().join("a.0001.exr")).unwrap();
    let layer =
        image.layer_data.iter().find(|layer| layer.attributes.layer_name == Some("caustic".into())).unwrap();
    let red = layer.channel_data.list.iter().find(|channel| channel.name.to_string() == "caustic.R").unwrap();
    let seen: Vec<f32> = red.sample_data.values_as_f32().collect();
    let (camera, receiver) = project.scene.as_ref().unwrap().camera_and_receiver().unwrap();
    // Blocks of the plane on the far side of the lamps, in the light and out of the glass; each pixel in its block.
    let (mut on_plane, mut through_camera) = (0.0, 0.0);
    for y in 0..36 {
        for x in 0..64 {
            let ray = camera.ray((x as f32 + 0.5) / 32.0 - 1.0, 1.0 - (y as f32 + 0.5) / 18.0, 64.0 / 36.0);
            let place = receiver.plane_from_ray(&ray).unwrap();
            let inside = place.min_element() > 0.0 && place.max_element() < 1.0;
            if inside && place.distance(Vec2::splat(0.5)) > 0.12 {
                let [column, row] =
                    [place.x * width as f32, (1.0 - place.y) * height as f32].map(|v| v as usize);
                on_plane += f64::from(light[row * width + column][0] * 0.8 / std::f32::consts::PI);
                through_camera += f64::from(seen[y * 64 + x]);
            }
        }
    }
    // One texel of about five by five in each pixel: sampling noise over some hundred lit pixels.
    assert!((on_plane / through_camera - 1.0).abs() < 0.05, "{on_plane} {through_camera}");
}

#[test]
fn the_plane_needs_exr() {
    let (mut project, _) = project(r#"["caustic", "plane"]"#);
    project.output.formats = vec![lightloom_core::export::FrameFormat::Png];
    let error = project.check().unwrap_err().to_string();
    assert!(error.starts_with("output.formats: ") && error.contains("plane"), "{error}");
    project.output.formats = vec![lightloom_core::export::FrameFormat::Exr];
    project.check().unwrap();
    assert!(project.output.writes("a_plane.0001.exr") && project.output.writes("a.0001.exr"));
}
