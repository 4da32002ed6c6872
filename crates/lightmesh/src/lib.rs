//! Soft shadows by the light mesh.
//!
//! The triangles that can hide a light are found once for a group of neighbouring surface points, and clear the samples of the light that
//! they hide from each of them: the shadows of many rays per pixel, exactly. The method of the thesis, which interpolates visibility from
//! the nodes of a lattice, is another [`Lookup`].
//!
//! ```no_run
//! use lightmesh::{Request, render};
//!
//! render("garden.toml", &Request::default())?.save("garden.png")?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! This is what `lightmesh render garden.toml -o garden.png` does, to the byte: what the file lacks, a camera, lights, an exposure, is chosen. Below it, a
//! scene is rendered as it is:
//!
//! ```no_run
//! use lightmesh::{Device, Renderer, Scene, Settings};
//!
//! let scene = Scene::open("garden.toml")?;
//! let renderer = Renderer::new(Device::Auto)?;
//! let frame = renderer.render(&scene, &Settings::default())?;
//! frame.save("garden.png")?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A tour
//!
//! * [`Request`] has a field for each flag of the command line. [`render()`] makes a picture of a file, [`film()`] the frames of an animation, a turntable
//!   or a day, [`sun_hours()`] the hours of direct sun on what a picture shows.
//! * [`Scene`] is what is rendered: open a file or one of the built-in scenes (`builtin:gazebo`, `builtin:childpark`,
//!   `builtin:garden`), or put triangles together with [`SceneBuilder`](scene::SceneBuilder).
//! * [`Settings`] are the parameters: [`Mode`] (the method, hard-shadow ray tracing, or the area-shadow reference), image size,
//!   light-mesh step and radius, and so on. The defaults give a good image.
//! * [`Renderer`] renders on a [`Device`]: all cores of the CPU, or a CUDA GPU; [`Device::Auto`] uses a GPU if one works. One
//!   call to [`Renderer::prepare`] serves any number of images, and a GPU keeps its copy of the scene for as long.
//!   [`render::devices`] lists the devices.
//! * [`Renderer::visibility`] finds the visible share of each light at points of your own, to bake vertex colours or lightmaps;
//!   [`MeshCache`] keeps what light points see from image to image, and in files.
//! * [`Frame`] is the image with its [`Stats`]; an [`Observer`] receives progress and can stop the work, and with
//!   [`Settings::partial`] gets what is finished by then.
//!
//! The parts are separate crates, which are re-exported completely as [`scene`], [`image`], [`mod@render`] and [`request`].
#![forbid(unsafe_code)]

pub use lightmesh_image as image;
pub use lightmesh_render as render;
#[cfg(feature = "request")]
pub use lightmesh_request as request;
pub use lightmesh_scene as scene;

pub use lightmesh_image::{SaveError, Transfer};
pub use lightmesh_render::{
    Acceleration, Device, Frame, Lookup, MeshCache, MeshFileError, MeshSaveError, Mode, Observer, PointVisibility,
    RenderError, Renderer, Settings, Stage, Stats, Step,
};
#[cfg(feature = "request")]
pub use lightmesh_request::{Request, film, picture as render, sun_hours};
/// The vectors and matrices of this library's types.
pub use lightmesh_scene::glam;
pub use lightmesh_scene::{LoadError, Scene};
