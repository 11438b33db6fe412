//! From a note to what it is about.

use lightloom_core::note::About;
use lightloom_core::project::Project;

use super::look::object::SceneObject;
use super::panels;
use super::selection::Selection;
use super::session::{Panel, Session};

/// The panel that shows what a note is about; none for the project as a whole.
pub(super) fn panel_of(about: &About) -> Option<Panel> {
    match about {
        About::Project => None,
        About::Mesh(_) | About::Light(_) | About::Camera => Some(Panel::Scene),
        About::Key(_) => Some(Panel::Keys),
        About::Caustic(_) => Some(Panel::Caustics),
        About::Constraint(_) => Some(Panel::Drawn),
        About::Setting(place) => {
            let of_setting = panels::controls_by_panel().find(|(_, control)| control.setting.place == *place);
            Some(of_setting.map_or(Panel::Drawn, |(panel, _)| panel.panel))
        }
    }
}

/// Selects what a note is about, and shows its panel. What is no longer there selects nothing.
pub(super) fn jump(project: &Project, session: &mut Session, about: &About) {
    let focus = &mut session.focus;
    match about {
        About::Project | About::Setting(_) => (),
        About::Mesh(index) => focus.object = Some(SceneObject::Mesh(*index)),
        About::Light(index) => focus.object = Some(SceneObject::Light(*index)),
        About::Camera => focus.object = Some(SceneObject::Camera),
        About::Key(index) => {
            if let Some(key) = project.keys.get(*index) {
                (focus.key, session.playhead, session.playing) = (Some(*index), key.frame, false);
            }
        }
        About::Caustic(name) => {
            focus.caustic = project.caustics.iter().position(|caustic| caustic.name == *name);
        }
        About::Constraint(index) => {
            session.selection = Selection::one(*index);
            session.overlays.drawn = true;
        }
    }
    session.panel = panel_of(about).unwrap_or(session.panel);
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use lightloom_core::flow::FlowSettings;
    use lightloom_core::render::RenderSettings;

    use super::*;

    #[test]
    fn every_kind_of_note_has_the_panel_of_its_controls() {
        let panels = [
            (About::Project, None),
            (About::Mesh(0), Some(Panel::Scene)),
            (About::Caustic("red".into()), Some(Panel::Caustics)),
            (About::Constraint(3), Some(Panel::Drawn)),
            (About::Setting("constraints"), Some(Panel::Drawn)),
            (About::Setting(FlowSettings::GRID.place), Some(Panel::Flow)),
            (About::Setting(FlowSettings::STEPS.place), Some(Panel::Flow)),
            (About::Setting(FlowSettings::ALPHA.place), Some(Panel::Flow)),
            (About::Setting(RenderSettings::PHOTONS.place), Some(Panel::Render)),
        ];
        for (about, panel) in panels {
            assert_eq!(panel_of(&about), panel, "{about:?}");
        }
    }
}
