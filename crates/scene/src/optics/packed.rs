//! Two images of one number each to one image: roughness is its green, how metallic a surface is its blue, as in glTF.
//!
//! The image has the size of the larger one; of the other, the nearest texel counts. Where there is no image, the number is 1.

use crate::{OpacityChannel, Texture};

/// An image, and what of it is the number.
pub(crate) type Numbers<'t> = (&'t Texture, OpacityChannel);

/// The size of the larger one.
pub(crate) fn size_of_packed(images: [Option<Numbers>; 2]) -> [u32; 2] {
    let sizes = images.into_iter().flatten().map(|(texture, _)| texture.size);
    sizes.max_by_key(|&[width, height]| u64::from(width) * u64::from(height)).unwrap_or([1; 2])
}

/// The image of roughness, then that of how metallic the surface is.
pub fn packed(images: [Option<Numbers>; 2]) -> Texture {
    let size @ [width, height] = size_of_packed(images);
    let texel = |column: u32, row: u32| {
        let [green, blue] = images.map(|image| image.map_or(u8::MAX, |numbers| nearest(numbers, size, [column, row])));
        [u8::MAX, green, blue, u8::MAX]
    };
    let names = images.iter().zip(["roughness", "metallic"]).filter_map(|(image, what)| Some((image.as_ref()?, what)));
    let clauses: Vec<String> = names.map(|((texture, _), what)| format!("{} as {what}", texture.name)).collect();
    let texels = (0..height).flat_map(|row| (0..width).map(move |column| texel(column, row))).collect();
    Texture { name: clauses.join(", "), size, texels }
}

/// The number of an image at a texel of one of this size.
fn nearest((texture, channel): Numbers, size: [u32; 2], place: [u32; 2]) -> u8 {
    let [column, row] = [0, 1].map(|axis| {
        let middle = 2 * u64::from(place[axis]) + 1;
        middle * u64::from(texture.size[axis]) / (2 * u64::from(size[axis]))
    });
    let texel = row * u64::from(texture.size[0]) + column;
    OpacityChannel::of(texture.texels[texel as usize], channel)
}
