//! Cameras: the viewpoints of images.

use glam::{DMat4, DVec3, DVec4, Quat, Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// The field of view of a perspective camera. The other angle follows from the image's aspect ratio, because pixels are square.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Fov {
    /// Full vertical field of view, degrees.
    Vertical(f32),
    /// Full horizontal field of view, degrees.
    Horizontal(f32),
}

impl Fov {
    /// The vertical field of view in degrees for an image with the aspect ratio `aspect` (width / height).
    pub fn vertical(self, aspect: f32) -> f32 {
        match self {
            Fov::Vertical(degrees) => degrees,
            Fov::Horizontal(degrees) => 2.0 * ((0.5 * degrees.to_radians()).tan() / aspect).atan().to_degrees(),
        }
    }

    /// The height of the image one unit before the camera.
    pub fn height(self, aspect: f32) -> f32 {
        2.0 * (0.5 * self.vertical(aspect).to_radians()).tan()
    }
}

/// How a camera maps directions or points to the image.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Projection {
    /// All rays leave the camera's position.
    Perspective(Fov),
    /// All rays are parallel to the view direction.
    Orthographic {
        /// Height of the image in scene units.
        height: f32,
    },
}

/// The largest shift of a camera, in heights of the image.
pub const LARGEST_SHIFT: f32 = 1000.0;

/// A camera in the scene's local frame (see [`Geometry::origin`](crate::Geometry::origin)).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Camera {
    /// Name in the file; empty if it has none.
    pub name: String,
    /// The eye, local frame, scene units.
    pub position: Vec3,
    /// The view direction; unit length.
    pub direction: Vec3,
    /// Up vector; unit length, not parallel to `direction`, not necessarily perpendicular to it.
    pub up: Vec3,
    /// Perspective or orthographic.
    pub projection: Projection,
    /// By how much the image is to the right of the view direction, and above it, in heights of the image: as with a lens that is shifted,
    /// what is parallel to the image stays undistorted. Fields of view are those without it.
    pub shift: Vec2,
    /// The depth from which on surfaces and lights are seen, scene units along the view direction; 0 for all. See [`Camera::with_clip`].
    pub near: f32,
    /// The depth up to which they are seen; infinite for all.
    pub far: f32,
    /// The number of its motion in the scene's animation.
    pub(crate) motion: Option<u32>,
}

/// A camera with invalid parameters.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// The view direction is zero.
    #[error("the camera's view direction {direction} has no length: choose a target other than the camera's position")]
    Direction {
        /// The given direction, or target minus position.
        direction: DVec3,
    },
    /// The up vector is zero.
    #[error("the camera's up vector {up} has no length: choose one such as +Y, [0, 1, 0]")]
    Up {
        /// The given vector.
        up: DVec3,
    },
    /// The field of view is not valid for a perspective view.
    #[error("the camera's vertical field of view of {vfov} degrees is not between 0 and 180: 40 to 60 is usual")]
    Angle {
        /// The given angle, degrees.
        vfov: f32,
    },
    /// There is no depth between the clip planes.
    #[error(
        "the camera sees nothing between the depths {near} and {far}: choose a near of at least 0, and a far beyond it"
    )]
    Clip {
        /// The given depth of the near plane.
        near: f32,
        /// The given depth of the far plane.
        far: f32,
    },
}

impl Camera {
    /// A camera at `position` that looks at `target`, both in the local frame, with the full vertical field of view `vfov` in
    /// degrees. `up` points upwards in the image; it need not be perpendicular to the view. If the view is parallel to it, the image
    /// is a plan or a view from below, and its upper edge is the scene's back: −Z, or +Y if `up` is ±Z.
    ///
    /// ```
    /// use lightmesh_scene::{Camera, glam::Vec3};
    ///
    /// let camera = Camera::look_at(Vec3::new(0.0, 2.0, 5.0), Vec3::Y, Vec3::Y, 45.0)?.named("front");
    /// assert_eq!(camera.position.y, 2.0);
    /// # Ok::<(), lightmesh_scene::CameraError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`CameraError`] if `target` is the position itself, `up` has no length, or the field of view is not between 0 and 180
    /// degrees.
    pub fn look_at(position: Vec3, target: Vec3, up: Vec3, vfov: f32) -> Result<Camera, CameraError> {
        Camera::look_to(position, target.as_dvec3() - position.as_dvec3(), up, vfov)
    }

    /// [`Camera::look_at`] with a view direction, of any length, in single or double precision.
    ///
    /// # Errors
    ///
    /// [`CameraError`] if `direction` or `up` has no length, or the field of view is not between 0 and 180 degrees.
    pub fn look_to(
        position: Vec3,
        direction: impl Into<DVec3>,
        up: impl Into<DVec3>,
        vfov: f32,
    ) -> Result<Camera, CameraError> {
        let (direction, up) = (direction.into(), up.into());
        let forward = direction.try_normalize().ok_or(CameraError::Direction { direction })?;
        let up = up.try_normalize().ok_or(CameraError::Up { up })?;
        if !(vfov > 0.0 && vfov < 180.0) {
            return Err(CameraError::Angle { vfov });
        }
        Ok(Camera {
            name: String::new(),
            position,
            direction: forward.as_vec3(),
            up: upper_edge(forward, up).as_vec3(),
            projection: Projection::Perspective(Fov::Vertical(vfov)),
            shift: Vec2::ZERO,
            near: 0.0,
            far: f32::INFINITY,
            motion: None,
        })
    }

    /// The same camera with a name.
    pub fn named(self, name: impl Into<String>) -> Camera {
        Camera { name: name.into(), ..self }
    }

    /// The same position and direction with another projection.
    pub fn with_projection(self, projection: Projection) -> Camera {
        Camera { projection, ..self }
    }

    /// The same camera with an image further to the right and up, see [`Camera::shift`]. Both are limited to the range from −1000 to 1000;
    /// NaN counts as 0.
    ///
    /// ```
    /// use lightmesh_scene::{Camera, glam::Vec3};
    ///
    /// // All of a tower from the ground, with upright edges.
    /// let camera = Camera::look_to(Vec3::new(0.0, 1.7, 40.0), Vec3::NEG_Z, Vec3::Y, 50.0)?.with_shift([0.0, 0.4]);
    /// assert_eq!(camera.shift.y, 0.4);
    /// # Ok::<(), lightmesh_scene::CameraError>(())
    /// ```
    pub fn with_shift(self, shift: impl Into<Vec2>) -> Camera {
        let limited = |part: f32| if part.is_nan() { 0.0 } else { part.clamp(-LARGEST_SHIFT, LARGEST_SHIFT) };
        Camera { shift: shift.into().map(limited), ..self }
    }

    /// The same camera, which sees surfaces and lights of the depths from `near` to `far` alone: distances along the view direction, in scene
    /// units, not along a pixel's ray. What is behind what is cut away is seen in its place, also behind surfaces that let light through.
    /// Shadows, mirrors and gathered light stay, and so does the sky.
    ///
    /// ```
    /// use lightmesh_scene::{Camera, glam::Vec3};
    ///
    /// // Into a room through its wall.
    /// let camera = Camera::look_to(Vec3::new(0.0, 1.7, 9.0), Vec3::NEG_Z, Vec3::Y, 50.0)?.with_clip(4.5, f32::INFINITY)?;
    /// assert_eq!(camera.near, 4.5);
    /// # Ok::<(), lightmesh_scene::CameraError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`CameraError::Clip`] if `near` is negative or not finite, or `far` is not above it.
    pub fn with_clip(self, near: f32, far: f32) -> Result<Camera, CameraError> {
        if near >= 0.0 && near.is_finite() && far > near {
            Ok(Camera { near, far, ..self })
        } else {
            Err(CameraError::Clip { near, far })
        }
    }

    /// The same direction and projection from another position, in the local frame.
    pub fn with_position(self, position: Vec3) -> Camera {
        Camera { position, ..self }
    }

    /// The same camera turned about the vertical through `middle`, which is along its up vector, by `angle` in radians.
    pub fn turned_about(self, middle: Vec3, angle: f32) -> Camera {
        let turn = Quat::from_axis_angle(self.up.normalize(), angle);
        let (position, direction) = (middle + turn * (self.position - middle), turn * self.direction);
        Camera { position, direction, ..self }
    }

    /// From world coordinates to the camera's: x to the right, y up, −z into the image. `origin` is where the local frame lies.
    pub fn from_world(&self, origin: DVec3) -> DMat4 {
        let eye = origin + self.position.as_dvec3();
        let (right, up, forward) = self.basis();
        let row = |axis: Vec3| axis.as_dvec3().extend(-axis.as_dvec3().dot(eye));
        DMat4::from_cols(row(right), row(up), row(-forward), DVec4::W).transpose()
    }

    /// From world coordinates to those of an image `aspect` times as wide as high: x and y from −1 at its left and lower edges to 1 at the
    /// others, and as z the distance in front of the camera, which for a perspective camera is divided by itself.
    pub fn from_world_to_image(&self, origin: DVec3, aspect: f64) -> DMat4 {
        // Half the height of the image, one unit before the camera or anywhere.
        let (half, perspective) = match self.projection {
            Projection::Perspective(fov) => {
                let vertical = f64::from(fov.vertical(aspect as f32));
                ((0.5 * vertical).to_radians().tan(), true)
            }
            Projection::Orthographic { height } => (0.5 * f64::from(height), false),
        };
        let scale = DVec3::new(1.0 / (half * aspect), 1.0 / half, -1.0);
        let last = if perspective { DVec4::NEG_Z } else { DVec4::W };
        // Twice, since the image is two units high.
        let shift = 2.0 * self.shift.as_dvec2();
        let (x, y) = (DVec4::X * scale.x - shift.x / aspect * last, DVec4::Y * scale.y - shift.y * last);
        let projection = DMat4::from_cols(x, y, DVec4::Z * scale.z, last).transpose();
        projection * self.from_world(origin)
    }

    /// The ray through the middle of an image `aspect` times as wide as high: where it starts, and its direction, which is one unit long
    /// along the view direction.
    pub fn middle(&self, aspect: f32) -> (Vec3, Vec3) {
        let (right, up, forward) = self.basis();
        // Not added where it is zero, so that zeros keep their signs.
        if self.shift == Vec2::ZERO {
            return (self.position, forward);
        }
        let aside = |height: f32| height * (self.shift.x * right + self.shift.y * up);
        match self.projection {
            Projection::Perspective(fov) => (self.position, forward + aside(fov.height(aspect))),
            Projection::Orthographic { height } => (self.position + aside(height), forward),
        }
    }

    /// The camera's axes: right, up and forward, orthonormal. Forward is the view direction.
    pub fn basis(&self) -> (Vec3, Vec3, Vec3) {
        let forward = self.direction.normalize();
        let right = forward.cross(self.up).normalize();
        (right, right.cross(forward), forward)
    }
}

/// `up` made perpendicular to the view; if they are parallel, the direction towards the back of an upright scene. All of unit
/// length.
pub fn upper_edge(forward: DVec3, up: DVec3) -> DVec3 {
    const PARALLEL: f64 = 1e-6;
    let upright = |up: DVec3| {
        let side = forward.cross(up);
        (side.length() > PARALLEL).then(|| side.cross(forward).normalize())
    };
    let back = if up.z.abs() > 1.0 - PARALLEL { DVec3::Y } else { DVec3::NEG_Z };
    upright(up).or_else(|| upright(back)).unwrap_or(back)
}
