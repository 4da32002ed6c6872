//! A C interface: images of a scene that stays open in the caller's process. `bench/peers` times them there, through Python's ctypes.
//!
//! `cargo build --release -p lightmesh-examples --lib` makes the shared library `target/release/libc_interface.so`.

use std::error::Error;
use std::ffi::{CStr, c_char};
use std::time::Instant;

use lightmesh::render::{PreparedScene, ShadowTests, Unobserved};
use lightmesh::{Device, Lookup, Mode, Renderer, Scene, Settings};

/// A scene and what renders it.
pub struct Opened {
    renderer: Renderer,
    scene: PreparedScene,
}

/// What is rendered.
#[repr(C)]
pub struct Request {
    /// How visibility is computed: `ray-trace`; `area`, n shadow rays per pixel and light; or the name of a lookup.
    method: *const c_char,
    /// Width and height in pixels.
    side: u32,
    samples: u32,
    seed: u64,
    /// Receives linear colours, three numbers per pixel, row 0 at the top.
    color: *mut f32,
    /// Receives the visibility of each light, light by light; or null.
    visibility: *mut f32,
}

/// What an image took.
#[repr(C)]
#[derive(Default)]
pub struct Report {
    /// From the call to the finished image in host memory, without copying it to the caller.
    seconds: f64,
    primary_seconds: f64,
    shadow_seconds: f64,
    rays: u64,
    hits: u64,
    shadow_rays: u64,
}

/// Opens a scene on `cpu` or `cuda` with a number of CPU threads. Null, with a message on standard error, if that fails.
///
/// # Safety
/// Both texts end with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lightmesh_open(scene: *const c_char, device: *const c_char, threads: u32) -> *mut Opened {
    // SAFETY: as this function demands.
    let [scene, device] = [scene, device].map(|text| unsafe { CStr::from_ptr(text) });
    told(open(scene, device, threads)).map_or(std::ptr::null_mut(), |opened| Box::into_raw(Box::new(opened)))
}

/// Renders an image. False, with a message on standard error, if that fails.
///
/// # Safety
/// `opened` is from [`lightmesh_open`], the method's name ends with a zero, and there is room for `side`² colours and, for each light of
/// the scene, as many numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lightmesh_render(opened: *const Opened, request: *const Request, report: *mut Report) -> bool {
    // SAFETY: as this function demands.
    told(unsafe { render(&*opened, &*request) }).map(|found| unsafe { *report = found }).is_some()
}

/// Closes a scene.
///
/// # Safety
/// `opened` is from [`lightmesh_open`], and not used afterwards.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lightmesh_close(opened: *mut Opened) {
    // SAFETY: as this function demands.
    drop(unsafe { Box::from_raw(opened) });
}

fn open(scene: &CStr, device: &CStr, threads: u32) -> Result<Opened, Box<dyn Error>> {
    let (scene, device) = (Scene::open(scene.to_str()?)?, device.to_str()?.parse()?);
    let renderer = Renderer::with_threads(device, (device == Device::Cpu).then_some(threads as usize))?;
    let scene = renderer.prepare(&scene, &Settings::default(), &Unobserved)?;
    Ok(Opened { renderer, scene })
}

/// # Safety
/// See [`lightmesh_render`].
unsafe fn render(opened: &Opened, request: &Request) -> Result<Report, Box<dyn Error>> {
    // SAFETY: the caller's promise.
    let method = unsafe { CStr::from_ptr(request.method) }.to_str()?;
    let settings = of_method(method)?
        .with_size([request.side; 2])
        .with_samples(request.samples)
        .with_seed(request.seed)
        .with_layers(!request.visibility.is_null());
    let start = Instant::now();
    let frame = opened.renderer.render_prepared(&opened.scene, &settings, &Unobserved)?;
    let seconds = start.elapsed().as_secs_f64();
    // SAFETY: the caller's promise.
    unsafe { copy(frame.color().as_flattened(), request.color) };
    for (light, plane) in frame.layers().iter().flat_map(|layers| layers.visibility.iter().enumerate()) {
        // SAFETY: the caller's promise.
        unsafe { copy(plane, request.visibility.add(light * plane.len())) };
    }
    let (stages, counts) = (&frame.stats.seconds, &frame.stats.counts);
    let primary_seconds = stages.primary_rays;
    let shadow_seconds =
        stages.shadow_rays + stages.area_shadows + stages.adaptive_shadows + stages.occluder_lists + stages.long_tests;
    let (rays, hits, shadow_rays) = (counts.rays, counts.hits, counts.shadow_rays);
    Ok(Report { seconds, primary_seconds, shadow_seconds, rays, hits, shadow_rays })
}

fn of_method(name: &str) -> Result<Settings, Box<dyn Error>> {
    let settings = Settings::default().with_aa(1);
    Ok(match name.parse::<Mode>() {
        Ok(mode) => settings.with_mode(mode).with_shadow_tests(ShadowTests::Rays),
        Err(_) => settings.with_lookup(name.parse::<Lookup>()?),
    })
}

/// # Safety
/// There is room for all of `values`.
unsafe fn copy(values: &[f32], to: *mut f32) {
    // SAFETY: the caller's promise.
    unsafe { values.as_ptr().copy_to_nonoverlapping(to, values.len()) };
}

#[allow(clippy::print_stderr, reason = "a caller in C has no other way to learn it")]
fn told<T>(result: Result<T, Box<dyn Error>>) -> Option<T> {
    result.inspect_err(|error| eprintln!("lightmesh: {error}")).ok()
}
