//! [`Frame`], the result of a render, and [`Layers`], its per-pixel data.
//!
//! Pixels are row-major and row 0 is at the top, so pixel (x, y) is at `y * width + x` in every plane. All lengths are checked
//! when a frame is created; the writers rely on that.

use std::ops::Range;

use thiserror::Error;

use crate::Matte;

/// An image of linear radiance with Rec. 709 primaries, and optionally its alpha and its [`Layers`].
///
/// Alpha is the share of a pixel that is covered, in [0, 1]. Colours are what the covered part sends alone: they are premultiplied, and black
/// where alpha is 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    width: u32,
    height: u32,
    window: Window,
    pub(crate) color: Vec<[f32; 3]>,
    pub(crate) alpha: Option<Vec<f32>>,
    pub(crate) layers: Option<Layers>,
}

/// Where a frame lies in an image that it is a part of, or around one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Window {
    /// Column and row of its first pixel; negative to the left of the image and above.
    pub first: [i32; 2],
    /// Width and height of the image in pixels.
    pub whole: [u32; 2],
}

/// Per-pixel data of a render: one plane per quantity, each of `width * height` entries in the frame's order.
///
/// Lengths and vectors are in scene units and world coordinates. If a pixel's ray missed the scene, `depth` is
/// +infinity and everything else is 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    /// Distance from the camera along the pixel's ray.
    pub depth: Vec<f32>,
    /// Geometric normal, unit length, facing the viewer.
    pub normal: Vec<[f32; 3]>,
    /// Surface point.
    pub position: Vec<[f32; 3]>,
    /// One plane per light: visibility in [0, 1], which is 0 if the light is behind the surface.
    pub visibility: Vec<Vec<f32>>,
    /// Number of light points from which the pixel's visibility was interpolated.
    pub used: Vec<u32>,
    /// One plane per light: the radiance that reaches the eye from this light by itself, mirrors included. No planes if that is not known.
    pub lights: Vec<Vec<[f32; 3]>>,
    /// The radiance that belongs to no light: ambient and emitted light, the background, and what shadow catchers show. Together with
    /// `lights` it is the colour, but for rounding. Empty if that is not known.
    pub rest: Vec<[f32; 3]>,
    /// The objects that pixels see.
    pub object: Matte,
    /// The materials that pixels see.
    pub material: Matte,
}

/// The parts of a [`Frame`], see [`Frame::into_parts`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FrameParts {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Linear colours, row-major, row 0 at the top.
    pub color: Vec<[f32; 3]>,
    /// Share of each pixel that is covered, if the frame has it.
    pub alpha: Option<Vec<f32>>,
    /// The layers, if the frame has any.
    pub layers: Option<Layers>,
}

/// Planes that do not fit the size of their frame.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum FrameError {
    /// Width or height is 0, or the number of pixels is not addressable.
    #[error("a frame of {width}x{height} pixels is not possible: both sides must be at least 1 and fit in memory")]
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// The number of entries of a plane is not the number of pixels.
    #[error("plane '{plane}' has {found} entries, but a frame of {width}x{height} pixels needs {expected}")]
    Length {
        /// Name of the plane: `color`, `alpha`, or a field of [`Layers`] (`visibility[i]` and `lights[i]` for light i).
        plane: String,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// `width * height`.
        expected: usize,
        /// The plane's length.
        found: usize,
    },
}

impl Frame {
    /// A frame of `width * height` linear colours, row 0 at the top.
    ///
    /// # Errors
    /// [`FrameError`] if a side is 0 or `color` has the wrong length.
    pub fn new(width: u32, height: u32, color: Vec<[f32; 3]>) -> Result<Self, FrameError> {
        let pixels = pixel_count(width, height).ok_or(FrameError::Size { width, height })?;
        check_length("color", color.len(), width, height, pixels)?;
        let window = Window { first: [0; 2], whole: [width, height] };
        Ok(Self { width, height, window, color, alpha: None, layers: None })
    }

    /// The same frame as the part of an image of `whole` pixels whose first pixel is in column and row `first`; it may extend beyond the image.
    /// An exr file says so; dithering depends on it.
    #[must_use]
    pub fn with_window(self, first: [i32; 2], whole: [u32; 2]) -> Self {
        Self { window: Window { first, whole }, ..self }
    }

    /// Where the frame lies in the image that it is a part of; in an image of its own if it was not told.
    pub fn window(&self) -> Window {
        self.window
    }

    /// The part of `size` pixels from column and row `first` of the whole image on, with alpha and layers; `None` if the frame does not have
    /// all of it, or it has no pixel.
    pub fn cropped(&self, first: [i32; 2], size: [u32; 2]) -> Option<Self> {
        let (whole, corner) = (self.window.whole, self.corner(first, size)?);
        let cut = Cut { corner, size: size.map(|pixels| pixels as usize), width: self.width as usize };
        let layers = self.layers.as_ref().map(|layers| Layers {
            depth: cut.of(&layers.depth),
            normal: cut.of(&layers.normal),
            position: cut.of(&layers.position),
            visibility: layers.visibility.iter().map(|plane| cut.of(plane)).collect(),
            used: cut.of(&layers.used),
            lights: layers.lights.iter().map(|plane| cut.of(plane)).collect(),
            rest: cut.of(&layers.rest),
            object: layers.object.cut(|plane| cut.of(plane), |plane| cut.of(plane)),
            material: layers.material.cut(|plane| cut.of(plane), |plane| cut.of(plane)),
        });
        Some(Self {
            width: size[0],
            height: size[1],
            window: Window { first, whole },
            color: cut.of(&self.color),
            alpha: self.alpha.as_ref().map(|alpha| cut.of(alpha)),
            layers,
        })
    }

    /// The same frame with `layers`, replacing any previous ones.
    ///
    /// # Errors
    /// [`FrameError::Length`] if the number of entries of a plane is not the number of pixels.
    pub fn with_layers(mut self, layers: Layers) -> Result<Self, FrameError> {
        let check = |plane: &str, found| check_length(plane, found, self.width, self.height, self.color.len());
        check("depth", layers.depth.len())?;
        check("normal", layers.normal.len())?;
        check("position", layers.position.len())?;
        check("used", layers.used.len())?;
        for (light, plane) in layers.visibility.iter().enumerate() {
            check(&format!("visibility[{light}]"), plane.len())?;
        }
        for (light, plane) in layers.lights.iter().enumerate() {
            check(&format!("lights[{light}]"), plane.len())?;
        }
        if !layers.rest.is_empty() {
            check("rest", layers.rest.len())?;
        }
        for (plane, length) in layers.object.lengths("object").into_iter().chain(layers.material.lengths("material")) {
            check(&plane, length)?;
        }
        self.layers = Some(layers);
        Ok(self)
    }

    /// The same frame with `alpha`, the covered share of each pixel, replacing any previous one. Colours are taken as premultiplied.
    ///
    /// # Errors
    /// [`FrameError::Length`] if the number of entries is not the number of pixels.
    pub fn with_alpha(mut self, alpha: Vec<f32>) -> Result<Self, FrameError> {
        check_length("alpha", alpha.len(), self.width, self.height, self.color.len())?;
        self.alpha = Some(alpha);
        Ok(self)
    }

    /// The frame in front of a background of uniform radiance, without alpha; unchanged if it has none.
    #[must_use]
    pub fn over(mut self, background: [f32; 3]) -> Self {
        for (color, alpha) in self.color.iter_mut().zip(self.alpha.take().unwrap_or_default()) {
            let free = 1.0 - alpha;
            // A background that does not show does not count, however bright it is.
            if free > 0.0 {
                color.iter_mut().zip(background).for_each(|(channel, behind)| *channel += free * behind);
            }
        }
        self
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Linear colours, row-major, row 0 at the top.
    pub fn color(&self) -> &[[f32; 3]] {
        &self.color
    }

    /// Mutable linear colours.
    pub fn color_mut(&mut self) -> &mut [[f32; 3]] {
        &mut self.color
    }

    /// Splits the frame into its parts without copying. [`Frame::new`], [`Frame::with_alpha`] and [`Frame::with_layers`]
    /// reassemble it.
    ///
    /// ```
    /// let frame = lightmesh_image::Frame::new(2, 1, vec![[0.0; 3], [0.5; 3]])?;
    /// let floats: Vec<f32> = frame.into_parts().color.into_flattened();
    /// assert_eq!(floats, [0.0, 0.0, 0.0, 0.5, 0.5, 0.5]);
    /// # Ok::<(), lightmesh_image::FrameError>(())
    /// ```
    pub fn into_parts(self) -> FrameParts {
        FrameParts { size: [self.width, self.height], color: self.color, alpha: self.alpha, layers: self.layers }
    }

    /// The colour of pixel (x, y), or `None` outside of the frame.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[f32; 3]> {
        (x < self.width && y < self.height).then(|| self.color[y as usize * self.width as usize + x as usize])
    }

    /// The rows from top to bottom, each of `width` colours.
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = &[[f32; 3]]> + ExactSizeIterator {
        self.color.chunks_exact(self.width as usize)
    }

    /// The colours of row `y`.
    pub(crate) fn row(&self, y: usize) -> &[[f32; 3]] {
        &self.color[self.row_range(y)]
    }

    /// Where the pixels of row `y` are in every plane.
    pub(crate) fn row_range(&self, y: usize) -> Range<usize> {
        let width = self.width as usize;
        y * width..(y + 1) * width
    }

    /// A frame of the same size, without alpha and layers, with colours computed from pixel indices.
    pub(crate) fn recolored(&self, color: impl FnMut(usize) -> [f32; 3]) -> Self {
        Self { color: (0..self.color.len()).map(color).collect(), alpha: None, layers: None, ..*self }
    }

    /// The covered share of each pixel, if the frame has it.
    pub fn alpha(&self) -> Option<&[f32]> {
        self.alpha.as_deref()
    }

    /// The layers, if the frame has any.
    pub fn layers(&self) -> Option<&Layers> {
        self.layers.as_ref()
    }
}

/// A rectangle of a plane.
struct Cut {
    corner: [usize; 2],
    size: [usize; 2],
    /// Of the plane.
    width: usize,
}

impl Cut {
    fn of<T: Copy>(&self, plane: &[T]) -> Vec<T> {
        let ([x, y], [columns, rows]) = (self.corner, self.size);
        let mut cut = Vec::with_capacity(if plane.is_empty() { 0 } else { columns * rows });
        let all = plane.chunks_exact(self.width).skip(y).take(rows);
        all.for_each(|row| cut.extend_from_slice(&row[x..x + columns]));
        cut
    }
}

/// `width * height`, or `None` if there is no pixel or the colours would not be addressable.
pub(crate) fn pixel_count(width: u32, height: u32) -> Option<usize> {
    let pixels = usize::try_from(u64::from(width) * u64::from(height)).ok()?;
    let bytes = pixels.checked_mul(size_of::<[f32; 3]>())?;
    (pixels > 0 && isize::try_from(bytes).is_ok()).then_some(pixels)
}

fn check_length(plane: &str, found: usize, width: u32, height: u32, expected: usize) -> Result<(), FrameError> {
    if found == expected {
        return Ok(());
    }
    Err(FrameError::Length { plane: plane.to_owned(), width, height, expected, found })
}
