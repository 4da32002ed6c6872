//! The weight of formula (3).

use lightmesh_scene::Weight;

/// w as a function of q² = (distance / radius)². Zero at the rim for all but the constant weight, so that a light point that
/// leaves the half-ball fades out instead of popping.
#[inline(always)]
pub fn weight(kind: Weight, q2: f32) -> f32 {
    let falling = (1.0 - q2).max(0.0);
    match kind {
        Weight::Constant => 1.0,
        Weight::Quadratic => falling,
        Weight::Smooth => falling * falling,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_one_in_the_middle_and_end_at_the_rim() {
        for kind in [Weight::Constant, Weight::Quadratic, Weight::Smooth] {
            assert_eq!(weight(kind, 0.0), 1.0);
        }
        assert_eq!(weight(Weight::Constant, 0.99), 1.0);
        assert_eq!(weight(Weight::Quadratic, 0.25), 0.75);
        assert_eq!(weight(Weight::Smooth, 0.25), 0.5625);
        assert_eq!(weight(Weight::Smooth, 1.0 + 1e-6), 0.0);
    }
}
