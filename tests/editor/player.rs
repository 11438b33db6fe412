//! The player of rendered frames.

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use lightloom::editor::dialogs::{Picker, Scripted};
use lightloom::editor::player::{Clock, Loader, Player, Sequence};

/// Pictures of one grey each, brighter from number to number.
fn frames(folder: &Path, numbers: &[i32]) {
    for (i, number) in numbers.iter().enumerate() {
        let grey = image::Rgb([20 * i as u8; 3]);
        let picture = image::RgbImage::from_pixel(8, 6, grey);
        picture.save(folder.join(format!("shot.v2.{number:04}.png"))).unwrap();
    }
}

#[test]
fn a_sequence_is_found_by_its_folder_or_any_of_its_pictures() {
    let folder = tempfile::tempdir().unwrap();
    frames(folder.path(), &[10, -3, 5]);
    for other in ["contact_sheet.png", "other.0001.png", "shot.v2.0011.exr"] {
        std::fs::write(folder.path().join(other), "").unwrap();
    }
    let found = Sequence::find(folder.path()).unwrap();
    assert_eq!(found.frames.iter().map(|(number, _)| *number).collect::<Vec<_>>(), [-3, 5, 10]);
    assert_eq!(found.frames_per_second, [24, 1]);
    assert_eq!(found.holds(), [8, 5, 5]);
    assert_eq!(Sequence::find(&folder.path().join("shot.v2.0010.png")).unwrap(), found);
    let single = Sequence::find(&folder.path().join("other.0001.png")).unwrap();
    assert_eq!(single.frames.len(), 1);
    std::fs::write(folder.path().join("summary.json"), r#"{ "frames_per_second": [30000, 1001] }"#).unwrap();
    assert_eq!(Sequence::find(folder.path()).unwrap().frames_per_second, [30_000, 1001]);
}

#[test]
fn a_folder_without_pictures_says_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let problem = Sequence::find(folder.path()).unwrap_err();
    assert!(problem.contains("PNG among the formats"), "{problem}");
    assert!(Sequence::find(&folder.path().join("none/a.1.png")).unwrap_err().contains("cannot be read"));
}

#[test]
fn pictures_are_shown_for_their_time_and_over_and_over() {
    let mut clock = Clock::new(vec![2, 1, 1]);
    let mut seen = Vec::new();
    for _ in 0..8 {
        seen.push(clock.index());
        let next = clock.advance(1.0 / 24.0, 24.0).unwrap();
        assert!(next > 0.0 && next <= 2.0 / 24.0 + 1e-9);
    }
    assert_eq!(seen, [0, 0, 1, 2, 0, 0, 1, 2]);
    clock.looping = false;
    clock.go(2);
    assert_eq!((clock.index(), clock.advance(0.2, 24.0), clock.index(), clock.playing), (2, None, 2, false));
    clock.go(1);
    assert_eq!(clock.index(), 1);
    assert_eq!(Clock::new(Vec::new()).advance(0.1, 24.0), None);
}

#[test]
fn a_picture_that_cannot_be_read_is_told_and_the_others_are_shown() {
    let folder = tempfile::tempdir().unwrap();
    frames(folder.path(), &[1, 2]);
    std::fs::write(folder.path().join("shot.v2.0003.png"), "no picture").unwrap();
    let loader = Loader::start(&Sequence::find(folder.path()).unwrap(), || ()).unwrap();
    for _ in 0..1000 {
        if loader.count() == 3 {
            break;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    assert_eq!(loader.get(1).unwrap().unwrap().pixels[0], egui::Color32::from_gray(20));
    assert!(loader.get(2).unwrap().unwrap_err().contains("shot.v2.0003.png"));
}

#[test]
fn the_player_plays_pauses_and_scrubs() {
    let folder = tempfile::tempdir().unwrap();
    frames(folder.path(), &[1, 2, 3, 4]);
    let picker = Picker::new(Arc::new(Scripted::default()));
    let mut state = (Player::default(), picker);
    state.0.open = true;
    let builder = Harness::builder().with_size([900.0, 650.0]).with_max_steps(4);
    let mut harness = builder.build_ui_state(
        |ui, (player, picker): &mut (Player, Picker)| player.show(&ui.ctx().clone(), picker),
        state,
    );
    harness.run_ok();
    assert!(harness.query_by_label_contains("Choose a picture").is_some());
    let ctx = harness.ctx.clone();
    harness.state_mut().0.play(&ctx, folder.path());
    for _ in 0..200 {
        harness.step();
        if harness.query_by_label("4 pictures").is_some() {
            break;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    harness.get_by_role_and_label(Role::Button, "Pause").click();
    harness.run_ok();
    harness.get_by_role_and_label(Role::Button, "Last picture").click();
    harness.run_ok();
    assert!(harness.query_all_by_label("Frame 4").count() > 0);
    harness.get_by_role_and_label(Role::Button, "Previous picture").click();
    harness.run_ok();
    assert!(harness.query_all_by_label("Frame 3").count() > 0);
    // At rest it stays.
    harness.run_ok();
    assert!(harness.query_all_by_label("Frame 3").count() > 0);
}
