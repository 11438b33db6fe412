//! Density estimation, frame store and view transform.

use glam::{DVec3, Vec2, Vec3, Vec3Swizzles, vec2};
use lightloom_core::Progress;
use lightloom_core::math::rng::{Purpose, Stream};
use lightloom_core::render::density::{KernelFilter, default_radius, radius_of_pass};
use lightloom_core::render::splat::{OutsidePhotons, Splatter};
use lightloom_core::render::{
    GatherMatrix, Image, ProgressiveRender, ReceiverTexture, RenderSettings, TextureLayout, ViewSettings,
    ViewTransform, Workspace, layout_for,
};

/// Photons over the plane, some a little and some far outside, with coloured flux.
fn scattered(count: usize, pass: u64) -> (Vec<Vec2>, Vec<Vec3>) {
    let rng = &mut Stream::new(7, Purpose::Trace, pass, 0);
    let positions = (0..count).map(|_| vec2(rng.f32(), rng.f32()) * 1.1 - 0.05).collect();
    let flux = (0..count).map(|_| Vec3::new(rng.f32(), rng.f32(), rng.f32()) / count as f32).collect();
    (positions, flux)
}

fn sum(flux: &[Vec3]) -> DVec3 {
    flux.iter().map(|f| f.as_dvec3()).sum()
}

fn relative_gap(a: DVec3, b: DVec3) -> f64 {
    ((a - b).abs() / b.abs()).max_element()
}

fn splat(positions: &[Vec2], flux: &[Vec3], layout: TextureLayout) -> (ReceiverTexture, OutsidePhotons) {
    let mut texture = ReceiverTexture::new(layout);
    let outside = Splatter::default().splat(positions, flux, &mut texture);
    (texture, outside)
}

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

#[test]
fn the_texture_holds_the_flux_of_the_photons_and_counts_what_falls_outside() {
    let layout = TextureLayout::new(Vec2::ONE, 300, 0.02);
    let (mut positions, mut flux) = scattered(200_000, 0);
    positions.extend([vec2(f32::NAN, 0.5), vec2(0.5, f32::INFINITY), vec2(0.5, 0.5)]);
    flux.extend([Vec3::ONE, Vec3::ONE, Vec3::splat(f32::NAN)]);
    let (texture, outside) = splat(&positions, &flux, layout);
    // 1 - (1.04 / 1.1)^2 of 200 000 on average, give or take five deviations of 137, and a texel's width.
    assert!(outside.photons.abs_diff(21_223) < 1_500, "{outside:?}");
    // A texel sums a few photons in f32: rounding errors of random sign, far below 1e-6 of the whole.
    let finite: Vec<Vec3> = flux.into_iter().filter(|f| f.is_finite()).collect();
    assert!(relative_gap(texture.total() + outside.flux, sum(&finite)) < 1e-6);
}

#[test]
fn a_photon_between_texels_stays_where_it_is_in_the_mean() {
    let layout = TextureLayout::new(vec2(1.0, 0.5), 64, 0.1);
    let place = vec2(0.3217, 0.2113);
    let (texture, _) = splat(&[place], &[Vec3::ONE], layout);
    let mut mean = Vec2::ZERO;
    for row in 0..layout.rows {
        for column in 0..layout.columns {
            mean += texture.texels()[row * layout.columns + column].x * layout.plane_from_texel(column, row);
        }
    }
    assert!(mean.distance(place) < 1e-5, "{mean} instead of {place}");
}

#[test]
fn splat_and_filter_give_the_same_bytes_for_one_and_two_threads() {
    let (positions, flux) = scattered(300_000, 0);
    let run = || {
        let (mut texture, _) = splat(&positions, &flux, TextureLayout::new(vec2(1.0, 0.7), 500, 0.03));
        KernelFilter::default().filter(&mut texture, 0.0123);
        texture
    };
    let (one, two) = (with_threads(1, run), with_threads(2, run));
    assert!(
        one.texels()
            .iter()
            .zip(two.texels())
            .all(|(a, b)| a.to_array().map(f32::to_bits) == b.to_array().map(f32::to_bits))
    );
}

#[test]
fn the_filter_conserves_flux_for_any_radius() {
    let layout = TextureLayout::new(vec2(1.0, 0.6), 200, 0.05);
    let (positions, flux) = scattered(20_000, 0);
    let (texture, _) = splat(&positions, &flux, layout);
    let whole = texture.total();
    for radius in [0.0, 1e-4, 0.004, 0.005, 0.0071, 0.03, 0.2, 3.0] {
        let mut filtered = texture.clone();
        KernelFilter::default().filter(&mut filtered, radius);
        // 40 000 texels rounded to f32 with random signs.
        assert!(relative_gap(filtered.total(), whole) < 1e-6, "radius {radius}");
        assert!(filtered.texels().iter().all(|t| t.min_element() >= 0.0), "radius {radius}");
    }
}

#[test]
fn the_kernel_has_the_variance_and_the_reach_it_says() {
    let layout = TextureLayout::new(Vec2::ONE, 256, 0.1);
    let centre = layout.plane_from_texel(layout.columns / 2, layout.rows / 2);
    for radius in [0.006_f32, 0.0101, 0.02, 0.0777, 0.2] {
        let (mut texture, _) = splat(&[centre], &[Vec3::ONE], layout);
        KernelFilter::default().filter(&mut texture, radius);
        let (mut x2, mut y2, mut reach) = (0.0, 0.0, 0.0_f32);
        for (i, texel) in texture.texels().iter().enumerate() {
            let offset = layout.plane_from_texel(i % layout.columns, i / layout.columns) - centre;
            x2 += f64::from(texel.x * offset.x * offset.x);
            y2 += f64::from(texel.x * offset.y * offset.y);
            reach = if texel.x > 0.0 { reach.max(offset.x.abs()) } else { reach };
        }
        let expected = f64::from(radius * radius) / 9.0;
        // f32 texels: seven digits, and the sum of squares weighs the faint ones most.
        assert!(
            (x2 / expected - 1.0).abs() < 1e-4 && (y2 / expected - 1.0).abs() < 1e-4,
            "radius {radius}: {x2} {y2}"
        );
        // Three boxes end within one texel each of the radius.
        assert!(reach < radius + 3.0 * layout.texel, "radius {radius} reaches {reach}");
    }
}

#[test]
fn radii_shrink_as_knaus_and_zwicker_say() {
    assert_eq!(radius_of_pass(0.01, 0), 0.01);
    assert!((radius_of_pass(1.0, 1).powi(2) - (5.0 / 3.0) / 2.0).abs() < 1e-6);
    assert!((radius_of_pass(1.0, 2).powi(2) - (5.0 / 3.0) / 2.0 * (8.0 / 3.0) / 3.0).abs() < 1e-6);
    // In the long run r^2 falls as i^(-1/3): by half from pass to eightfold pass.
    let ratio = (radius_of_pass(1.0, 8000) / radius_of_pass(1.0, 1000)).powi(2);
    assert!((ratio - 0.5).abs() < 1e-3, "{ratio}");
    assert!(default_radius(1_000_000, 1.0) < default_radius(10_000, 1.0));
}

/// Photons of a smooth slope over the left part and an edge: density 2x on 0..1 for x < 0.5, and 1.5 above.
fn slope_with_edge(count: usize, pass: u64) -> Vec<Vec2> {
    let rng = &mut Stream::new(3, Purpose::Trace, pass, 1);
    let mut draw = || loop {
        let (p, height) = (vec2(rng.f32(), rng.f32()), rng.f32() * 1.5);
        if height < density(p) {
            return p;
        }
    };
    (0..count).map(|_| draw()).collect()
}

fn density(p: Vec2) -> f32 {
    if p.x < 0.5 { 2.0 * p.x } else { 1.5 }
}

#[test]
fn the_error_falls_with_the_passes_as_n_to_the_minus_one_third_or_faster() {
    let layout = TextureLayout::new(Vec2::ONE, 256, 0.0);
    let photons = 20_000;
    let folder = tempfile::tempdir().unwrap();
    let render = ProgressiveRender::new(layout, 0.03, 1, folder.path()).unwrap();
    let mut work = Workspace::new(layout);
    let flux = vec![Vec3::splat(1.0 / photons as f32); photons]; // One watt.
    // Root mean square error after more passes: where the light is smooth, and with the edge. Away from the border of
    // the plane, where light ends, and from the texels beside the edge, which no kernel resolves.
    let mut rms_after = |passes: std::ops::Range<usize>| {
        for pass in passes {
            render.add(0, pass, &slope_with_edge(photons, pass as u64), &flux, &mut work).unwrap();
        }
        let (mean, _) = render.mean(0).unwrap();
        let rms = |strip: f32| {
            let mut errors = Vec::new();
            for (i, texel) in mean.texels().iter().enumerate() {
                let p = layout.plane_from_texel(i % layout.columns, i / layout.columns);
                if p.x > 0.1 && p.x < 0.9 && p.y > 0.1 && p.y < 0.9 && (p.x - 0.5).abs() > strip {
                    let expected = density(p) * layout.texel * layout.texel;
                    errors.push(f64::from((texel.x / expected - 1.0).powi(2)));
                }
            }
            (errors.iter().sum::<f64>() / errors.len() as f64).sqrt()
        };
        [rms(0.04), rms(layout.texel)]
    };
    let (few, many) = (rms_after(0..4), rms_after(4..64));
    let [smooth, edge] = [0, 1].map(|i| (few[i] / many[i]).log2() / 16.0_f64.log2());
    // Knaus & Zwicker 2011: noise and bias fall so that the rms goes as N^(-1/3). Measured 0.37 for both: the seeds are
    // fixed, so only another kernel or another radius can bring it below.
    assert!(smooth > 1.0 / 3.0, "rms {few:?} after 4 passes, {many:?} after 64: order {smooth}");
    assert!(edge > 1.0 / 3.0, "rms {few:?} after 4 passes, {many:?} after 64: order {edge}");
}

#[test]
fn frames_come_back_as_they_were_added_in_any_order() {
    let layout = TextureLayout::new(vec2(1.0, 0.5), 70, 0.0);
    let folder = tempfile::tempdir().unwrap();
    let run = |frames: &[usize]| {
        let render = ProgressiveRender::new(layout, 0.05, 4, folder.path()).unwrap();
        let mut work = Workspace::new(layout);
        for pass in 0..3 {
            for &frame in frames {
                let (positions, flux) = scattered(1000, (10 * frame + pass) as u64);
                render.add(frame, pass, &positions, &flux, &mut work).unwrap();
            }
        }
        render.mean(2).unwrap()
    };
    assert_eq!(run(&[0, 1, 2, 3]), run(&[3, 2]));
    let untouched = ProgressiveRender::new(layout, 0.05, 4, folder.path()).unwrap().mean(1).unwrap();
    assert_eq!((untouched.0.total(), untouched.1), (DVec3::ZERO, 0));
    assert_eq!(folder.path().read_dir().unwrap().count(), 0, "the scratch file has no name");
}

#[test]
fn the_flat_view_shows_the_whole_plane_upright_with_its_irradiance() {
    let settings = RenderSettings { width: 160, height: 120, ..RenderSettings::default() };
    let extent = vec2(1.0, 0.5);
    let layout = layout_for(None, extent, &settings, (0.05, 0.03));
    let visible = GatherMatrix::flat(extent, &layout, &settings, &Progress::new()).unwrap();
    let mut texture = ReceiverTexture::new(layout);
    let per_texel = layout.texel * layout.texel;
    for i in 0..layout.len() {
        let p = layout.plane_from_texel(i % layout.columns, i / layout.columns);
        texture.texels_mut()[i] = Vec3::new(p.x, p.y, 1.0).extend(0.0) * per_texel;
    }
    let image = visible.gather(&texture);
    // An irradiance of 1 on white paper is a radiance of 1/pi; the place is read off the red and green ramps.
    for (x, y) in [(10, 30), (80, 60), (150, 85)] {
        let value = image.at(x, y) * std::f32::consts::PI;
        let plane = vec2((x as f32 + 0.5) / 160.0, (100.0 - (y as f32 + 0.5)) / 160.0);
        assert!((value.z - 1.0).abs() < 1e-4 && value.xy().distance(plane) < 0.003, "{value} at {plane}");
    }
    assert_eq!(image.at(80, 10), Vec3::ZERO, "beside the plane");
}

#[test]
fn agx_keeps_grey_neutral_and_is_monotone() {
    for transform in [ViewTransform::Agx, ViewTransform::Standard] {
        let view = ViewSettings { exposure: 0.5, transform }.view();
        let mut last = Vec3::splat(-1.0);
        for step in 0..4000 {
            let grey = view.encode(Vec3::splat(1e-4 * 1.004_f32.powi(step)));
            // Less than a step of 16 bits; the curve cancels numbers of 40 in f32.
            assert!(grey.max_element() - grey.min_element() < 1e-5, "{transform:?} {grey}");
            assert!(grey.x >= last.x, "{transform:?} falls at step {step}");
            last = grey;
        }
        assert_eq!(view.encode(Vec3::ZERO), Vec3::ZERO);
        assert!(last.x > 0.9999);
        assert_eq!(view.encode(Vec3::splat(f32::NAN)), Vec3::ZERO);
        assert!(view.encode(Vec3::new(f32::INFINITY, -1.0, 0.0)).is_finite());
    }
}

#[test]
fn agx_puts_middle_grey_in_the_middle_and_white_six_and_a_half_stops_above() {
    let view = ViewSettings::default().view();
    let shown = |grey: f32| view.encode(Vec3::splat(grey)).x;
    assert!((shown(0.18) - 0.5).abs() < 0.01);
    assert!(shown(0.18 * 6.51_f32.exp2()) > 0.9999 && shown(0.18 * 6.0_f32.exp2()) < 0.995);
    assert_eq!(shown(0.18 * (-10.01_f32).exp2()), 0.0);
    // A saturated light bleaches as it gets brighter.
    let red = |strength: f32| view.encode(Vec3::new(strength, 0.0, 0.0));
    assert!(red(0.2).y < 0.35 * red(0.2).x && red(50.0).y > 0.6 * red(50.0).x, "{} {}", red(0.2), red(50.0));
}

#[test]
fn a_smaller_picture_keeps_the_mean() {
    let mut image = Image::new(37, 23);
    let rng = &mut Stream::new(1, Purpose::Target, 0, 0);
    image.pixels.iter_mut().for_each(|p| *p = Vec3::new(rng.f32(), rng.f32(), rng.f32()));
    let mean = |image: &Image| sum(&image.pixels) / image.pixels.len() as f64;
    assert!(mean(&image.resized(10, 7)).distance(mean(&image)) < 1e-6);
}

#[test]
fn settings_out_of_range_are_named() {
    let refused = |settings: RenderSettings| settings.check("render").unwrap_err().to_string();
    let with = RenderSettings::default;
    assert!(with().check("render").is_ok());
    assert!(refused(RenderSettings { width: 0, ..with() }).starts_with("render.width: is 0"));
    assert!(refused(RenderSettings { photons: 1_000_000_000_000, ..with() }).contains("render.photons"));
    assert!(refused(RenderSettings { radius: Some(f32::NAN), ..with() }).contains("render.radius"));
    let view = ViewSettings { exposure: f32::INFINITY, ..ViewSettings::default() };
    assert!(refused(RenderSettings { view, ..with() }).contains("render.view.exposure"));
}
