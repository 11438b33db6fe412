//! The receiver: a flat matt mesh beneath the glass, or a table that is made; as large as the light of the glass needs.

use glam::{EulerRot, Mat3, Quat, Vec3};

use super::draft::{Bounds, Draft};
use super::flat::Rectangle;
use crate::scene::{LightDesc, ReceiverDesc};

/// Cosine of the steepest slope of a table.
const STEEP: f32 = 0.7;
/// Share of the radius of the glass by which a table may cut into it.
const CUT: f32 = 0.5;
/// Size over that needed above which only a part of a plane receives: the texels and the cells of the flow are shares of it.
const LARGE: f32 = 1.5;
/// The same of a plane that the artist called so.
const LARGE_CHOSEN: f32 = 4.0;
/// Farthest reach of light beyond the glass, in radii of it: beyond, it is too spread out to be seen.
const REACH: f32 = 7.0;
/// Room around the light, in radii of the glass.
const MARGIN: f32 = 1.6;
/// Share of light that a made table gives back.
const ALBEDO: [f32; 3] = [0.5; 3];

/// Takes the object that is the table out of a draft: its place, name and share of light given back.
pub(super) fn found(draft: &mut Draft, glass: &Bounds) -> Option<(Rectangle, String, [f32; 3])> {
    let (centre, radius) = (glass.centre(), glass.radius());
    let rank = |index: usize| {
        let object = &draft.objects[index];
        let plane = object.flat.filter(|_| !object.is_caster)?.facing(centre);
        let height = plane.height(centre);
        let large = plane.size.iter().all(|side| *side > radius);
        if plane.normal.y < STEEP || height < CUT * radius.min(centre.y - glass.lower.y) || !large {
            return None;
        }
        let [u, v] = plane.along(centre);
        let beneath = 2.0 * u.abs() <= plane.size[0] && 2.0 * v.abs() <= plane.size[1];
        let name = object.desc.name.to_lowercase();
        Some((plane, (is_chosen(&name), beneath, -height, plane.size[0] * plane.size[1])))
    };
    let ranked = (0..draft.objects.len()).filter_map(|index| Some((index, rank(index)?)));
    let (index, (plane, _)) =
        ranked.max_by(|a, b| a.1.1.partial_cmp(&b.1.1).unwrap_or(std::cmp::Ordering::Equal))?;
    let object = draft.objects.remove(index);
    let albedo = match object.desc.material {
        Some(crate::scene::Material::Diffuse(matt)) => matt.albedo,
        _ => ReceiverDesc::ALBEDO.value(),
    };
    Some((plane, object.desc.name, albedo))
}

/// The receiver on a found plane, with a note where it is but a part of it.
pub(super) fn on_plane(
    plane: &Rectangle,
    name: &str,
    albedo: [f32; 3],
    needed: &Rectangle,
    notes: &mut Vec<String>,
) -> ReceiverDesc {
    let [width, height] = plane.size;
    if plane.filled < 0.95 {
        notes.push(format!("{name}: is no rectangle; the light falls on the one around it"));
    }
    let large = if is_chosen(&name.to_lowercase()) { LARGE_CHOSEN } else { LARGE };
    if width.max(height) <= large * needed.size[0].max(needed.size[1]) {
        return desc(plane, albedo, 0.0);
    }
    // Only what lies on the plane.
    let [x, y] = plane.along(needed.centre);
    let side = |at: f32, size: f32, most: f32| {
        let (low, high) = ((at - size / 2.0).max(-most / 2.0), (at + size / 2.0).min(most / 2.0));
        if low < high { ((low + high) / 2.0, high - low) } else { (0.0, size.min(most)) }
    };
    let ((x, u), (y, v)) = (side(x, needed.size[0], width), side(y, needed.size[1], height));
    let centre = plane.centre + plane.u * x + plane.v * y;
    notes.push(format!(
        "{name}: is {width:.3} x {height:.3} m; the {u:.3} x {v:.3} m by the glass receive its light \
         (scene.receiver.size), the rest is floor"
    ));
    desc(&Rectangle { centre, size: [u, v], ..*plane }, albedo, width.max(height) / 2.0)
}

/// Whether an artist called something so, in small letters, in order that it receives.
fn is_chosen(name: &str) -> bool {
    name.contains("receiver")
}

/// The receiver of a table that is made.
pub(super) fn made(needed: &Rectangle) -> ReceiverDesc {
    desc(needed, ALBEDO, 3.0 * needed.size[0].max(needed.size[1]))
}

/// The part of a plane on which the light of the glass falls.
pub(super) fn needed(plane: &Rectangle, glass: &Bounds, lights: &[LightDesc]) -> Rectangle {
    let (centre, radius) = (glass.centre(), glass.radius());
    let foot = centre - plane.normal * plane.height(centre);
    let mut corners = vec![foot];
    for light in lights {
        let from = match light {
            LightDesc::Directional(sun) => {
                centre - Vec3::from(sun.direction).normalize_or(Vec3::NEG_Y) * radius
            }
            other => other.position().unwrap_or(centre),
        };
        let Some(along) = (centre - from).try_normalize() else { continue };
        // From the upper edge of the glass on, where its light reaches farthest.
        let top = centre + plane.normal * (radius * 0.8);
        let fall = -along.dot(plane.normal);
        let reach = if fall > 0.05 { plane.height(top).max(0.0) / fall } else { 0.0 };
        let landed = top + along * reach;
        let away = landed - plane.normal * plane.height(landed) - foot;
        corners.push(foot + away.clamp_length_max(REACH * radius));
    }
    let along: Vec<[f32; 2]> = corners.iter().map(|corner| plane.along(*corner)).collect();
    let range = |axis: usize| {
        let all = along.iter().map(|at| at[axis]);
        let margin = MARGIN * radius;
        (all.clone().fold(f32::INFINITY, f32::min) - margin, all.fold(f32::NEG_INFINITY, f32::max) + margin)
    };
    let ((left, right), (low, high)) = (range(0), range(1));
    let centre = plane.centre + plane.u * ((left + right) / 2.0) + plane.v * ((low + high) / 2.0);
    Rectangle { centre, size: [right - left, high - low], ..*plane }
}

fn desc(plane: &Rectangle, albedo: [f32; 3], surround: f32) -> ReceiverDesc {
    // Its width lies along x, its height along -z, its normal along y.
    let turn = Quat::from_mat3(&Mat3::from_cols(plane.u, plane.normal, -plane.v));
    let (z, y, x) = turn.to_euler(EulerRot::ZYX);
    // Rounded away: what remains of zero.
    let rotate = [x, y, z].map(|angle| (angle.to_degrees() * 1e4).round() / 1e4 + 0.0);
    ReceiverDesc {
        centre: plane.centre.to_array().map(|n| ReceiverDesc::CENTRE.clamped(n)),
        size: plane.size.map(|side| ReceiverDesc::SIZE.clamped(side)),
        rotate,
        albedo,
        surround: ReceiverDesc::SURROUND.clamped(surround),
        ..ReceiverDesc::default()
    }
}
