//! The encodings of colours: sRGB, linear, or as tags of a picture say; the package `moxcms` reads the tags' curves and
//! primaries.

use std::io::Cursor;
use std::sync::Arc;

use moxcms::{
    Chromaticity, CicpProfile, ColorPrimaries, ColorProfile, DataColorSpace, Layout, MatrixCoefficients,
    ToneReprCurve, TransformF32Executor, TransformOptions,
};
use png::{Info, ScaledFloat};

/// gAMA of sRGB, which has no power law.
const SRGB_GAMMA: f32 = 0.45455;

/// How a picture's numbers mean light.
pub(super) enum Encoding {
    /// IEC 61966-2-1.
    Srgb,
    /// Light itself.
    Linear,
    /// By a profile, to linear Rec.709.
    Profile {
        /// From one channel to three, or from three to three.
        transform: Arc<TransformF32Executor>,
        /// Channels that the profile takes.
        channels: usize,
    },
}

impl Encoding {
    /// That of an ICC profile.
    ///
    /// # Errors
    /// Why it cannot be used.
    pub(super) fn of_profile(icc: &[u8]) -> Result<Self, String> {
        let profile = ColorProfile::new_from_slice(icc);
        Self::of(&profile.map_err(|error| format!("its ICC profile cannot be read ({error})"))?)
    }

    fn of(profile: &ColorProfile) -> Result<Self, String> {
        let (layout, channels) = match profile.color_space {
            DataColorSpace::Rgb => (Layout::Rgb, 3),
            DataColorSpace::Gray => (Layout::Gray, 1),
            other => {
                return Err(format!("its ICC profile is for {other:?}, not for RGB; convert it to sRGB"));
            }
        };
        let mut linear = ColorProfile::new_srgb();
        // Without entries the curve is a straight line.
        let line = Some(ToneReprCurve::Lut(Vec::new()));
        (linear.red_trc, linear.green_trc, linear.blue_trc) = (line.clone(), line.clone(), line);
        linear.cicp = None;
        let options = TransformOptions { allow_extended_range_rgb_xyz: true, ..TransformOptions::default() };
        let transform = profile.create_transform_f32(layout, &linear, Layout::Rgb, options);
        let transform = transform.map_err(|error| format!("its ICC profile cannot be used ({error})"))?;
        Ok(Self::Profile { transform, channels })
    }

    /// Makes the colours of a row linear Rec.709; alpha is kept.
    pub(super) fn decode(&self, row: &mut [[f32; 4]]) {
        match self {
            Self::Linear => (),
            Self::Srgb => {
                row.iter_mut().flat_map(|pixel| &mut pixel[..3]).for_each(|v| *v = linear_from_srgb(*v));
            }
            Self::Profile { transform, channels } => {
                let source: Vec<f32> = row.iter().flat_map(|pixel| &pixel[..*channels]).copied().collect();
                let mut light = vec![0.0; 3 * row.len()];
                // It fails only where the numbers of samples differ.
                let done = transform.transform(&source, &mut light).is_ok();
                debug_assert!(done, "as many samples as pixels");
                let (light, _) = light.as_chunks::<3>();
                for (pixel, light) in row.iter_mut().zip(light) {
                    // Colours outside Rec.709 have negative channels.
                    pixel[..3].copy_from_slice(&light.map(|channel| channel.max(0.0)));
                }
            }
        }
    }
}

/// The encoding by the tags cICP, iCCP, sRGB, gAMA and cHRM of a PNG file, in this order (PNG 3, 12.1); none where it has none.
///
/// # Errors
/// Why they cannot be used.
pub(super) fn of_png(bytes: &[u8]) -> Result<Option<Encoding>, String> {
    // What is no PNG the decoder of the pixels tells.
    let Ok(reader) = png::Decoder::new(Cursor::new(bytes)).read_info() else { return Ok(None) };
    let info = reader.info();
    if let Some(code) = info.coding_independent_code_points {
        return of_code_points(code.color_primaries, code.transfer_function).map(Some);
    }
    if let Some(profile) = &info.icc_profile {
        return Encoding::of_profile(profile).map(Some);
    }
    if info.srgb.is_some() || (info.gama_chunk.is_none() && info.chrm_chunk.is_none()) {
        return Ok(None);
    }
    of_gamma(info).map(Some)
}

fn of_code_points(primaries: u8, transfer: u8) -> Result<Encoding, String> {
    let unknown = || format!("the code points {primaries}, {transfer} of its cICP tag are unknown");
    if (primaries, transfer) == (1, 13) {
        return Ok(Encoding::Srgb);
    }
    let code = CicpProfile {
        color_primaries: primaries.try_into().map_err(|_| unknown())?,
        transfer_characteristics: transfer.try_into().map_err(|_| unknown())?,
        matrix_coefficients: MatrixCoefficients::Identity,
        full_range: true,
    };
    let profile = ColorProfile::new_from_cicp(code);
    if profile.red_trc.is_none() {
        return Err(unknown());
    }
    Encoding::of(&profile)
}

fn of_gamma(info: &Info<'_>) -> Result<Encoding, String> {
    let gamma = info.gama_chunk.map_or(SRGB_GAMMA, ScaledFloat::into_value);
    if !(0.01..=10.0).contains(&gamma) {
        return Err(format!("the gamma {gamma} of its gAMA tag makes no sense"));
    }
    let srgb = (gamma - SRGB_GAMMA).abs() < 1e-3;
    let mut profile = ColorProfile::new_srgb();
    profile.cicp = None;
    if !srgb {
        let curve = Some(ToneReprCurve::Parametric(vec![1.0 / gamma]));
        (profile.red_trc, profile.green_trc, profile.blue_trc) = (curve.clone(), curve.clone(), curve);
    }
    if let Some(tag) = info.chrm_chunk {
        let point = |(x, y): (ScaledFloat, ScaledFloat)| Chromaticity::new(x.into_value(), y.into_value());
        let points = [tag.white, tag.red, tag.green, tag.blue].map(point);
        if points.iter().any(|point| !(0.01..=1.0).contains(&point.y)) {
            return Err("the primaries of its cHRM tag make no sense".to_owned());
        }
        let [white, red, green, blue] = points;
        if srgb && is_rec709(points) {
            return Ok(Encoding::Srgb);
        }
        profile.update_rgb_colorimetry(white.to_xyyb(), ColorPrimaries { red, green, blue });
    } else if srgb {
        return Ok(Encoding::Srgb);
    }
    Encoding::of(&profile)
}

/// Whether white, red, green and blue are those of sRGB.
fn is_rec709(points: [Chromaticity; 4]) -> bool {
    let rec709 = [(0.3127, 0.329), (0.64, 0.33), (0.3, 0.6), (0.15, 0.06)];
    points.iter().zip(rec709).all(|(point, (x, y))| (point.x - x).abs() < 2e-3 && (point.y - y).abs() < 2e-3)
}

/// IEC 61966-2-1.
pub(in crate::targets) fn linear_from_srgb(value: f32) -> f32 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}
