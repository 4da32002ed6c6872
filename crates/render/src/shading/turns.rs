//! Angles and logarithms by polynomials of our own, so that the host and all devices give the same bits. Twin: `turns.cuh`.

use lightmesh_layout::constants::{
    ARC_TANGENT_3, ARC_TANGENT_5, ARC_TANGENT_7, ARC_TANGENT_9, EIGHTH_OF_TURN, F32_EXPONENT_STEP, LN_2,
    ROOT_OF_HALF_BITS, TANGENT_OF_EIGHTH, TAU, TURN_OF_RADIAN,
};

/// The angle of the point (x, y), counted from the x axis, as a share of a whole turn, from −0.5 to 0.5; 0 for the origin. Within 1e-7.
#[inline(always)]
pub fn turns(y: f32, x: f32) -> f32 {
    let (along, aside) = (x.abs(), y.abs());
    let (low, high) = if aside > along { (along, aside) } else { (aside, along) };
    let ratio = if high > 0.0 { low / high } else { 0.0 };
    let (first, tangent) =
        if ratio > TANGENT_OF_EIGHTH { (EIGHTH_OF_TURN, (ratio - 1.0) / (ratio + 1.0)) } else { (0.0, ratio) };
    let square = tangent * tangent;
    let sum = ((ARC_TANGENT_9 * square + ARC_TANGENT_7) * square + ARC_TANGENT_5) * square + ARC_TANGENT_3;
    let eighth = first + TURN_OF_RADIAN * (tangent + tangent * (square * sum));
    let quarter = if aside > along { 0.25 - eighth } else { eighth };
    let half = if x < 0.0 { 0.5 - quarter } else { quarter };
    if y < 0.0 { -half } else { half }
}

/// The same in radians, from −π to π. Within 6e-7.
#[inline(always)]
pub fn angle(y: f32, x: f32) -> f32 {
    TAU * turns(y, x)
}

/// The natural logarithm of a finite number from 1 on, within 2e-7 of its value or of 1, whichever is more: ln m = 2 artanh((m − 1)/(m + 1)) of
/// what remains beside a power of two, between √½ and √2.
#[inline(always)]
pub fn logarithm(number: f32) -> f32 {
    let above = number.to_bits() - ROOT_OF_HALF_BITS;
    let exponent = above / F32_EXPONENT_STEP;
    let rest = f32::from_bits(above % F32_EXPONENT_STEP + ROOT_OF_HALF_BITS);
    let part = (rest - 1.0) / (rest + 1.0);
    let square = part * part;
    let sum = (((square / 9.0 + 1.0 / 7.0) * square + 1.0 / 5.0) * square + 1.0 / 3.0) * square;
    exponent as f32 * LN_2 + 2.0 * (part + part * sum)
}
