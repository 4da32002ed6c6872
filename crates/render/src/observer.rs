//! Watching a render: progress, timing, choices made, and a way to stop it.

/// The stages of a render, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Building the acceleration structure.
    Build,
    /// Copying the scene to a device that has memory of its own.
    Upload,
    /// What does each pixel see?
    PrimaryRays,
    /// Which light points does each object point see?
    ShortTests,
    /// Each used light point once.
    Collect,
    /// Which lights does each light point (or, in the other modes, object point) see?
    LongTests,
    /// Formula (3), then (1).
    Shade,
    /// Copying the picture from a device.
    Download,
}

impl Stage {
    /// All of them, in order.
    pub const ALL: [Stage; 8] = [
        Stage::Build,
        Stage::Upload,
        Stage::PrimaryRays,
        Stage::ShortTests,
        Stage::Collect,
        Stage::LongTests,
        Stage::Shade,
        Stage::Download,
    ];

    /// The word in statistics.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Build => "build",
            Stage::Upload => "upload",
            Stage::PrimaryRays => "primary_rays",
            Stage::ShortTests => "short_tests",
            Stage::Collect => "collect",
            Stage::LongTests => "long_tests",
            Stage::Shade => "shade",
            Stage::Download => "download",
        }
    }
}

/// Somebody who watches a render. Called from many threads.
pub trait Observer: Sync {
    /// A stage begins that has `total` pieces of work.
    fn begin(&self, stage: Stage, total: u64) {
        let _ = (stage, total);
    }

    /// `pieces` more pieces of the current stage are done.
    fn advance(&self, pieces: u64) {
        let _ = pieces;
    }

    /// The stage is over.
    fn end(&self, stage: Stage) {
        let _ = stage;
    }

    /// The renderer chose something by itself; a sentence for people.
    fn note(&self, text: &str) {
        let _ = text;
    }

    /// Asked between pieces of work: `true` ends the render with [`RenderError::Cancelled`](crate::RenderError::Cancelled).
    fn cancelled(&self) -> bool {
        false
    }
}

/// Nobody watches.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unobserved;

impl Observer for Unobserved {}
