// Photons as light: each adds its flux to a float picture with the core's kernel; a second pass maps it to the screen.

struct View {
    // Size of the float picture in pixels.
    size: vec2<f32>,
    // Pixel of the plane's origin; plane y points up.
    origin: vec2<f32>,
    // Pixels per plane unit, kernel radius in plane units.
    scale: f32,
    radius: f32,
    // Upper left corner of the picture in the window, pixels.
    corner: vec2<f32>,
    // Extent of the plane in plane units.
    extent: vec2<f32>,
    // Radiance per watt and square pixel, times 2^exposure.
    gain: vec3<f32>,
    // Stops of the first entry of the table, and stops from it to the last.
    stops: vec2<f32>,
};
@group(0) @binding(0) var<uniform> view: View;

struct Photon {
    @builtin(position) at: vec4<f32>,
    // Place in the kernel, -1..=1.
    @location(0) place: vec2<f32>,
    @location(1) @interpolate(flat) flux: vec3<f32>,
};

// The kernel reaches at least this many pixels, or photons would fall between the pixels' middles.
const LEAST_RADIUS: f32 = 1.5;

fn radius_in_pixels() -> f32 { return max(view.radius * view.scale, LEAST_RADIUS); }

@vertex fn photon_vertex(
    @builtin(vertex_index) corner: u32,
    @location(0) position: vec2<f32>,
    @location(1) flux: vec3<f32>,
) -> Photon {
    let place = vec2<f32>(f32(corner & 1u), f32(corner >> 1u)) * 2.0 - 1.0;
    let middle = view.origin + vec2<f32>(position.x, -position.y) * view.scale;
    let pixel = middle + place * radius_in_pixels();
    var out: Photon;
    out.at = vec4<f32>(pixel.x / view.size.x * 2.0 - 1.0, 1.0 - pixel.y / view.size.y * 2.0, 0.0, 1.0);
    out.place = place;
    out.flux = flux;
    return out;
}

// The quadratic B-spline that reaches from -1 to 1, its integral being 1: three boxes, as in the core's density estimate.
fn spline(x: f32) -> f32 {
    let t = abs(x) * 1.5;
    let inner = 0.75 - t * t;
    let outer = 0.5 * (1.5 - t) * (1.5 - t);
    return 1.5 * select(outer, inner, t < 0.5);
}

@fragment fn photon_fragment(in: Photon) -> @location(0) vec4<f32> {
    let r = radius_in_pixels();
    return vec4<f32>(in.flux * (spline(in.place.x) * spline(in.place.y) / (r * r)), 0.0);
}

@group(0) @binding(1) var light: texture_2d<f32>;
@group(0) @binding(2) var table: texture_3d<f32>;
@group(0) @binding(3) var linear_sampler: sampler;

@vertex fn screen_vertex(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32((corner << 1u) & 2u) * 2.0 - 1.0, f32(corner & 2u) * 2.0 - 1.0, 0.0, 1.0);
}

@fragment fn screen_fragment(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = at.xy - view.corner;
    let plane = vec2<f32>(pixel.x - view.origin.x, view.origin.y - pixel.y) / view.scale;
    if (any(plane < vec2<f32>(0.0)) || any(plane > view.extent)) {
        discard;
    }
    let last = vec2<i32>(textureDimensions(light)) - 1;
    let watts = textureLoad(light, clamp(vec2<i32>(pixel), vec2<i32>(0), last), 0).rgb;
    let stops = log2(max(watts * view.gain, vec3<f32>(1e-20)));
    let share = clamp((stops - view.stops.x) / view.stops.y, vec3<f32>(0.0), vec3<f32>(1.0));
    // From the middle of the first entry to that of the last.
    let entries = vec3<f32>(textureDimensions(table));
    let shown = textureSampleLevel(table, linear_sampler, (share * (entries - 1.0) + 0.5) / entries, 0.0);
    return vec4<f32>(shown.rgb, 1.0);
}
