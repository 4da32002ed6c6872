//! The texels around a position on one axis of an image. Twin: `neighbours.cuh`.

use lightmesh_scene::Wrap;

/// The two texels of a row or column of `size` whose centres are on either side of `place`, and the fraction of the way to the
/// second.
pub fn neighbours(place: f32, size: u32, wrap: Wrap) -> ([u32; 2], f32) {
    // 1. Into the image.
    let inside = match wrap {
        Wrap::Repeat => place - place.floor(),
        Wrap::Mirror => {
            let twice = place - 2.0 * (0.5 * place).floor();
            if twice > 1.0 { 2.0 - twice } else { twice }
        }
        Wrap::Clamp => place,
    };
    // Also if the position is infinite or NaN.
    let inside = if inside > 0.0 { if inside < 1.0 { inside } else { 1.0 } } else { 0.0 };
    // 2. In texels, counted from the centre of the first.
    let middle = inside * size as f32 - 0.5;
    let first = middle.floor();
    // 3. Beyond the border the image continues with its opposite side, or with itself. From -1 to the size.
    let last = size as i32 - 1;
    let (first_texel, second_texel) = (first as i32, first as i32 + 1);
    let texel = |index: i32| match wrap {
        Wrap::Repeat if index < 0 => last,
        Wrap::Repeat if index > last => 0,
        _ => index.clamp(0, last),
    };
    ([texel(first_texel) as u32, texel(second_texel) as u32], middle - first)
}
