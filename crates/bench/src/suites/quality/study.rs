//! What is studied, and what comes of it.

use lightmesh::render::PreparedScene;
use lightmesh::{Observer, Settings};

use super::cases::{Case, Emitter};
use super::errors::{Errors, Reference};
use crate::engine::Engine;
use crate::measure::{Measured, Variant};
use crate::suites::subjects::Subject;
use crate::{Key, Plan, Row};

/// A scene, prepared for all cases.
pub(super) struct Study<'a> {
    pub(super) plan: &'a Plan,
    pub(super) subject: &'a Subject,
    /// With area lights.
    pub(super) balls: PreparedScene,
    /// With point lights.
    pub(super) points: PreparedScene,
    pub(super) side: u32,
    pub(super) reference: Reference,
    pub(super) observer: &'a dyn Observer,
}

/// A case with its results.
pub(super) struct Outcome {
    pub(super) case: Case,
    pub(super) errors: Errors,
    pub(super) measured: Measured,
}

impl Study<'_> {
    pub(super) fn scene(&self, emitter: Emitter) -> &PreparedScene {
        match emitter {
            Emitter::Ball => &self.balls,
            Emitter::Point => &self.points,
        }
    }

    pub(super) fn variant<'v>(&'v self, engine: &'v Engine, case: &Case, settings: &Settings) -> Variant<'v> {
        Variant { renderer: &engine.renderer, scene: self.scene(case.emitter), settings: settings.clone() }
    }

    /// A row of this scene on a device, filled by `fill`.
    pub(super) fn row(
        &self,
        experiment: &str,
        engine: &Engine,
        keys: Vec<(&'static str, Key)>,
        fill: impl FnOnce(&mut Row),
    ) -> Row {
        let keys = self.keys().into_iter().chain(keys).chain(engine.keys());
        let mut row = Row::new(experiment, keys);
        fill(&mut row);
        row
    }

    pub(super) fn reference_row(&self) -> Row {
        let mut row = Row::new("reference", self.keys());
        self.reference.residue.fill(&mut row);
        row.values.insert("samples".to_owned(), f64::from(self.reference.samples));
        row
    }

    pub(super) fn keys(&self) -> Vec<(&'static str, Key)> {
        vec![("scene", self.subject.name.as_str().into()), ("size", f64::from(self.side).into())]
    }
}
