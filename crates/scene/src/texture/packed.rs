//! Two images of one number each to one image: roughness is its green, how metallic a surface is its blue, as in glTF.
//!
//! The image has the size of the larger one; of the other, the nearest texel counts. Where there is no image, the number is 1.

use super::Texture;
use crate::OpacityChannel;

/// An image, and what of it is the number.
pub(super) type Numbers<'t> = (&'t Texture, OpacityChannel);

/// The size of the larger one.
pub(super) fn size_of_packed(images: [Option<Numbers>; 2]) -> [u32; 2] {
    let sizes = images.into_iter().flatten().map(|(texture, _)| texture.size);
    sizes.max_by_key(|&[width, height]| u64::from(width) * u64::from(height)).unwrap_or([1; 2])
}

/// The image of roughness, then that of how metallic the surface is.
pub(super) fn packed(images: [Option<Numbers>; 2]) -> Texture {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(name: &str, size: [u32; 2], texels: &[[u8; 4]]) -> Texture {
        Texture { name: name.into(), size, texels: texels.to_vec() }
    }

    #[test]
    fn each_image_has_a_channel() {
        let rough = texture("a", [2, 1], &[[10, 10, 10, 255], [20, 20, 20, 255]]);
        let metal = texture("b", [2, 1], &[[1, 2, 3, 4], [5, 6, 7, 8]]);
        let (rough, metal) = (Some((&rough, OpacityChannel::Luminance)), Some((&metal, OpacityChannel::Blue)));
        let both = packed([rough, metal]);
        assert_eq!((both.size, both.texels), ([2, 1], vec![[255, 10, 3, 255], [255, 20, 7, 255]]));
        assert_eq!(both.name, "a as roughness, b as metallic");
        let alone = packed([None, metal]);
        assert_eq!((alone.name, alone.texels[1]), ("b as metallic".into(), [255, 255, 7, 255]));
        assert_eq!(packed([rough, None]).texels[1], [255, 20, 255, 255]);
    }

    #[test]
    fn the_smaller_image_is_stretched() {
        let small = texture("a", [2, 1], &[[10; 4], [20; 4]]);
        let large = texture("b", [3, 2], &[[0; 4], [1; 4], [2; 4], [3; 4], [4; 4], [5; 4]]);
        let (small, large) = (Some((&small, OpacityChannel::Red)), Some((&large, OpacityChannel::Red)));
        let green = |texture: &Texture| texture.texels.iter().map(|texel| texel[1]).collect::<Vec<_>>();
        let found = packed([small, large]);
        assert_eq!((found.size, green(&found)), ([3, 2], vec![10, 20, 20, 10, 20, 20]));
        assert_eq!(green(&packed([large, small])), [0, 1, 2, 3, 4, 5]);
    }
}
