//! The worker that makes pictures of one moment: the plane, the shot, the orbit view.

use std::sync::{Arc, Mutex, PoisonError};

use egui::{Color32, ColorImage};
use glam::Vec3;
use lightloom_core::engine::{Preview, PreviewExposure, Quality, Shot};
use lightloom_core::render::{Image, PlaneMaterial, ReceiverTexture, View, ViewSettings, plane_image};
use rayon::prelude::*;

use super::false_colour::of_image;
use super::gpu::PhotonColumns;
use super::worker::{Share, Turn, Worker};

/// The light of one moment, and how it is shown.
#[derive(Clone)]
pub(super) struct Moment {
    pub(super) preview: Arc<Preview>,
    pub(super) frame: i32,
    /// Which groups of photons are shown.
    pub(super) shown: Vec<bool>,
}

/// What shall be painted.
#[derive(Clone)]
pub(super) struct PictureRequest {
    pub(super) moment: Moment,
    /// The other side of the wipe.
    pub(super) other: Option<Moment>,
    pub(super) view: ViewSettings,
    pub(super) paper: PlaneMaterial,
    /// How the plane is wanted.
    pub(super) plane: Plane,
    /// The camera's view of the plane, where the shot is wanted.
    pub(super) shot: Option<Arc<Shot>>,
    /// Whether luminance is shown in false colours.
    pub(super) false_colour: bool,
}

/// How the plane is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Plane {
    /// Not at all.
    Hidden,
    /// As a picture of so many pixels along its longer side.
    Picture(usize),
    /// As photons for the graphics card.
    Photons,
}

/// What was painted last.
#[derive(Clone, Default)]
pub struct Painted {
    /// Counts the pictures, so that each is uploaded once.
    pub number: u64,
    /// The frame they show.
    pub frame: i32,
    /// The light they show.
    pub light: Option<Arc<Preview>>,
    /// The plane: this flow, and what it is compared with.
    pub plane: [Option<Arc<ColorImage>>; 2],
    /// Its photons, where the graphics card draws them.
    pub photons: [Option<Arc<PhotonColumns>>; 2],
    /// The shot.
    pub shot: [Option<Arc<ColorImage>>; 2],
    /// The linear light of this flow's plane and shot, where they are pictures.
    pub linear: [Option<Arc<Image>>; 2],
}

/// Paints the newest moment that was asked for.
pub(super) struct PictureWorker {
    worker: Worker<PictureRequest>,
    painted: Arc<Mutex<Painted>>,
}

impl PictureWorker {
    /// `wake` is called when a picture is done.
    pub(super) fn new(wake: impl Fn() + Clone + Send + 'static) -> Self {
        let painted: Arc<Mutex<Painted>> = Arc::default();
        let theirs = painted.clone();
        let seen = wake.clone();
        let worker = Worker::new("pictures", Share::Whole, wake, move || {
            let (painted, seen) = (theirs.clone(), seen.clone());
            let mut buffers = PictureBuffers::default();
            move |request: PictureRequest, turn: &Turn| {
                // A picture takes less than the patience of a viewer, and while one scrubs a newer moment always waits:
                // each is finished, or none would ever be seen.
                turn.shielded(|_| {
                    buffers.paint(&request, &mut |picture| {
                        let mut painted = painted.lock().unwrap_or_else(PoisonError::into_inner);
                        *painted = Painted { number: painted.number + 1, ..picture.clone() };
                        drop(painted);
                        seen();
                    });
                });
            }
        });
        Self { worker, painted }
    }

    pub(super) fn ask(&self, request: PictureRequest) {
        self.worker.ask(request);
    }

    /// The newest pictures.
    pub(super) fn painted(&self) -> Painted {
        self.painted.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// What a panic of the worker said, once.
    pub(super) fn panicked(&self) -> Option<String> {
        self.worker.panicked()
    }
}

/// Buffers kept from picture to picture.
#[derive(Default)]
struct PictureBuffers {
    exposure: PreviewExposure,
}

impl PictureBuffers {
    /// Paints the plane, shows it, then the shot.
    fn paint(&mut self, request: &PictureRequest, show: &mut dyn FnMut(&Painted)) {
        let view = request.view.view();
        let encoded = |image: &Image| {
            let gain = request.view.exposure.exp2();
            Arc::new(if request.false_colour { of_image(image, gain) } else { shown(image, &view) })
        };
        let light = Some(request.moment.preview.clone());
        let mut painted = Painted { frame: request.moment.frame, light, ..Painted::default() };
        let moments = || [Some(&request.moment), request.other.as_ref()].into_iter().enumerate();
        for (side, moment) in moments().filter_map(|(side, moment)| Some((side, moment?))) {
            match request.plane {
                Plane::Hidden => {}
                Plane::Picture(pixels) => {
                    let image = self.plane(moment, pixels, request.paper);
                    painted.plane[side] = image.as_ref().map(encoded);
                    if side == 0 {
                        painted.linear[0] = image.map(Arc::new);
                    }
                }
                Plane::Photons => painted.photons[side] = photons(moment).map(Arc::new),
            }
        }
        show(&painted);
        let Some(shot) = &request.shot else { return };
        for (side, moment) in moments().filter_map(|(side, moment)| Some((side, moment?))) {
            let image = self
                .expose(moment, shot.resolution())
                .and_then(|light| shot.picture(light, &moment.preview, moment.frame));
            painted.shot[side] = image.as_ref().map(encoded);
            if side == 0 {
                painted.linear[1] = image.map(Arc::new);
            }
        }
        show(&painted);
    }

    fn expose(&mut self, moment: &Moment, resolution: usize) -> Option<&ReceiverTexture> {
        self.exposure.expose(&moment.preview, moment.frame, resolution, &moment.shown)
    }

    fn plane(&mut self, moment: &Moment, pixels: usize, paper: PlaneMaterial) -> Option<Image> {
        // Few photons are spread so wide that more pixels would show nothing more.
        let most = match moment.preview.quality() {
            Quality::Draft => 384,
            Quality::Preview => 768,
            Quality::Fine | Quality::Final => 1024,
        };
        let light = self.expose(moment, pixels.min(most))?;
        Some(plane_image(light, moment.preview.extent(), paper))
    }
}

/// The photons of a moment that are shown.
fn photons(Moment { preview, frame, shown }: &Moment) -> Option<PhotonColumns> {
    let positions = preview.positions(*frame)?;
    let mut flux = Vec::new();
    preview.flux(*frame, &mut flux);
    for (group, (_, rows)) in preview.groups().iter().enumerate() {
        if shown.get(group) == Some(&false) {
            flux[rows.clone()].fill(Vec3::ZERO);
        }
    }
    Some(PhotonColumns::new(positions, &flux, PreviewExposure::radius(preview)))
}

/// The picture as the screen shows it.
pub(super) fn shown(image: &Image, view: &View) -> ColorImage {
    let pixel = |&linear: &Vec3| {
        let [r, g, b] = (view.encode(linear) * 255.0 + 0.5).to_array().map(|v| v as u8);
        Color32::from_rgb(r, g, b)
    };
    let pixels = image.pixels.par_iter().map(pixel).collect();
    ColorImage::new([image.width, image.height], pixels)
}
