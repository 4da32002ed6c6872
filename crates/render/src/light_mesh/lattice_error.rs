//! Why a lattice is impossible.

/// A lattice whose points cannot be numbered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LatticeError {
    /// The step is zero, negative, infinite or NaN.
    #[error("light-mesh step must be a positive number or auto, but is {step}")]
    Step {
        /// The requested step.
        step: f32,
    },
    /// More points along an axis than can be distinguished.
    #[error(
        "light-mesh step h = {step} is too fine for a scene that extends {reach} from its origin: choose {least} or more"
    )]
    TooFine {
        /// The requested step.
        step: f32,
        /// Largest coordinate of the scene.
        reach: f64,
        /// A step that is large enough.
        least: f32,
    },
}
