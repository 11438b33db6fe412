//! Notes on scenes in which something is as nobody means it.

use crate::Note;
use crate::note::About;
use crate::render::{ReceiverView, RenderSettings, receiver_view};
use crate::scene::{LightDesc, Mesh, Scene};
use crate::setting::format::number;

/// Notes on a camera that sees no light, and on lamps around what they shall light.
pub(super) fn scene_notes(scene: &Scene, render: &RenderSettings) -> Vec<Note> {
    let mut notes: Vec<Note> = camera_note(scene, render).into_iter().collect();
    let lamps = scene.lights().iter().enumerate().filter(|(_, light)| light.casts_caustics());
    let specular = || scene.meshes().iter().filter(|mesh| mesh.material.is_specular());
    notes.extend(lamps.flat_map(|(i, light)| {
        About::Light(i).notes(specular().filter_map(|mesh| lamp_note(light, mesh)).collect::<Vec<_>>())
    }));
    notes
}

fn camera_note(scene: &Scene, render: &RenderSettings) -> Option<Note> {
    let why = match receiver_view(scene, [render.width as usize, render.height as usize]) {
        ReceiverView::Seen => return None,
        ReceiverView::Back => {
            "it stands behind the receiver, whose back no light reaches; move scene.camera.position \
             to the lit side, or turn the receiver"
                .to_owned()
        }
        ReceiverView::Outside => {
            let receiver = scene.receiver();
            let middle = receiver.world_from_plane(receiver.extent() / 2.0).to_array();
            let [x, y, z] = middle.map(|value| number(f64::from(value), false));
            format!("it looks elsewhere; set scene.camera.look_at to the receiver's middle ({x}, {y}, {z})")
        }
        ReceiverView::Hidden(mesh) => {
            format!("'{}' stands before it", scene.meshes()[usize::from(mesh)].name)
        }
    };
    let text = format!("the camera sees nothing of the receiver, so every frame is without caustics: {why}");
    Some(About::Camera.note(text))
}

/// A ball of light shines outward: what stands in it gets none of its light.
fn lamp_note(light: &LightDesc, mesh: &Mesh) -> Option<String> {
    light.encloses_box(mesh.lower, mesh.upper).then(|| {
        format!(
            "'{}' stands inside the ball lamp '{}', which shines outward only; make the lamp smaller, or move it away",
            mesh.name,
            light.name()
        )
    })
}
