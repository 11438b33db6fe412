//! A disk that fails while a frame is written: at any byte the old file stays, and nothing else. A folder that disappears.

use std::path::Path;
use std::process::Command;

use glam::Vec3;
use lightloom_core::engine::{Engine, Output, RenderObserver, prepare_folder};
use lightloom_core::export::{Backdrop, Frame, FrameFormat, FrameLayer, Metadata, PngDepth, write_frame};
use lightloom_core::project::{AssetFolder, Project};
use lightloom_core::render::{Image, View, ViewSettings};
use lightloom_core::{Error, Progress};
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

use crate::hostile::projects;

/// Set for the process that is let fail.
const VICTIM: &str = "LIGHTLOOM_FAILING_DISK";

/// Files of this process may grow to so many bytes; beyond, the system refuses to write as on a full disk.
fn limit_files(bytes: u64) {
    let maximum = getrlimit(Resource::Fsize).maximum;
    setrlimit(Resource::Fsize, Rlimit { current: Some(bytes), maximum }).unwrap();
}

fn view() -> View {
    ViewSettings::default().view()
}

/// Runs in a process of its own: the limit is that of all files of a process.
#[test]
fn victim_writes_frames() {
    if std::env::var_os(VICTIM).is_none() {
        return;
    }
    let mut light = Image::new(6, 5);
    light.pixels.iter_mut().enumerate().for_each(|(i, pixel)| *pixel = Vec3::splat(i as f32 / 30.0));
    let metadata = Metadata {
        frame: 1,
        frames_per_second: (24, 1),
        seed: 7,
        passes: 1,
        camera: None,
        settings: vec![("gamma".into(), "0.5".into())],
    };
    let backdrop = Backdrop::new(&FrameLayer::DEFAULT, &light, None);
    let frame =
        Frame { backdrop: &backdrop, caustic: &light, caustics: &[], metadata: &metadata, compressed: true };
    for (format, name) in [(FrameFormat::Exr, "a.0001.exr"), (FrameFormat::Png, "a.0001.png")] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        let write = || write_frame(&path, format, &frame, &view(), PngDepth::Eight);
        write().unwrap();
        let whole = std::fs::read(&path).unwrap();
        std::fs::write(&path, "the old file").unwrap();
        for most in 0..whole.len() as u64 {
            limit_files(most);
            let failed = write().map(|_| ());
            limit_files(u64::MAX >> 1);
            let told = failed.unwrap_err().to_string();
            assert!(told.contains("cannot write") && told.contains(name), "{most}: {told}");
            assert_eq!(std::fs::read_to_string(&path).unwrap(), "the old file", "{name} at byte {most}");
            assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "{name} at byte {most}");
        }
        limit_files(whole.len() as u64);
        write().unwrap();
        limit_files(u64::MAX >> 1);
        assert!(std::fs::read(&path).unwrap() == whole);
        println!("failed at each of {} bytes: {name}", whole.len());
    }
}

#[test]
fn a_frame_whose_disk_fails_at_any_byte_leaves_the_old_one() {
    // The signal of the limit would end the process: the shell has it ignored, which is inherited.
    let done = Command::new("sh")
        .args(["-c", "trap '' XFSZ; exec \"$0\" --exact frame_faults::victim_writes_frames --nocapture"])
        .arg(std::env::current_exe().unwrap())
        .env(VICTIM, "1")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success() && said.matches("failed at each of").count() == 2, "{said}");
}

/// Removes the folder of the frames when the light is gathered, or when the first frame is there.
struct Remover<'a> {
    folder: &'a Path,
    after_pass: bool,
}

impl RenderObserver for Remover<'_> {
    fn passed(&self, _: usize, _: &dyn Fn(i32) -> lightloom_core::Result<Option<Image>>) {
        if self.after_pass {
            std::fs::remove_dir_all(self.folder).unwrap();
        }
    }
}

#[test]
fn a_folder_that_is_removed_during_an_export_is_named_and_made_again_by_the_next() {
    let place = tempfile::tempdir().unwrap();
    let path = projects::written(place.path(), projects::good().to_string().as_bytes());
    let project = Project::load(&path).unwrap();
    for after_pass in [true, false] {
        let frames = place.path().join(format!("frames {after_pass}"));
        let engine = Engine::new(AssetFolder::new(&path, false).unwrap());
        prepare_folder(&frames, &path, &project, "folder").unwrap();
        // Files of other threads may come and go meanwhile.
        let saved = |_: &Path| drop(std::fs::remove_dir_all(&frames));
        let (keep, progress) = (|_: &Path| (), Progress::new());
        let remover = Remover { folder: &frames, after_pass };
        let saved: &(dyn Fn(&Path) + Sync) = if after_pass { &keep } else { &saved };
        let output = Output { observer: &remover, ..Output::new(&frames, &progress, saved) };
        let failed = engine.render_to(&project, &output).map(|_| ());
        println!("removed {}: {failed:?}", if after_pass { "after a pass" } else { "after a frame" });
        let failed = failed.unwrap_err();
        assert!(matches!(failed, Error::Io { .. }) && failed.to_string().contains("frames"), "{failed}");
        prepare_folder(&frames, &path, &project, "folder").unwrap();
        engine.render_to(&project, &Output::new(&frames, &Progress::new(), &keep)).unwrap();
        assert!(frames.join("shot.0011.exr").is_file() || frames.join("shot.0011.png").is_file());
    }
}
