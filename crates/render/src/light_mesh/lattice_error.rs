//! Why there is no lattice.

/// A lattice that cannot be numbered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LatticeError {
    /// The step is zero, negative, infinite or NaN.
    #[error("light-mesh step {step} is not a positive number: choose one above 0, or auto")]
    Step {
        /// What was asked for.
        step: f32,
    },
    /// More points on an axis than can be told apart.
    #[error(
        "light-mesh step h = {step} is too fine for a scene that reaches {reach} far from its origin: choose {least} or more"
    )]
    TooFine {
        /// What was asked for.
        step: f32,
        /// Largest coordinate of the scene.
        reach: f64,
        /// A step that would do.
        least: f32,
    },
}
