//! More points on objects that few pixels show.
//!
//! A row of the table that rests on one pixel says whether one point has sun. So pixels around such objects are divided, and each part
//! that shows the object is a point whose hours are found as those of given points. The image stays as it is.

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;
use lightmesh_render::{Crop, Observer, PreparedScene, RenderError, Renderer, Settings};
use lightmesh_scene::{Light, Lights};

use super::found::SunHours;
use super::pixel_area::PixelGrid;
use super::points::{Finer, Point};
use super::suns::{BYTES_AT_ONCE, MAX_AT_ONCE};
use crate::host::{Host, Quiet};

/// Rows that rest on fewer points are made better.
pub(super) const ENOUGH: u64 = 16;
/// Parts of a pixel on each side, at most.
const PARTS: u32 = 8;
/// Sides of the tiles of the image that are looked at as a whole.
const TILE: u32 = 32;
/// More points of an object say nothing new; each then stands for several.
const MOST: usize = 256;

impl Finer {
    /// Those of an image. `settings` are those of the image, and `suns` those that it was found with.
    pub(super) fn of(
        found: &SunHours,
        renderer: &Renderer,
        prepared: &PreparedScene,
        (settings, suns): (&Settings, &[(Light, f64)]),
        host: &dyn Host,
    ) -> Result<Finer, RenderError> {
        // Whoever watches the image is told of it alone, and can end this, too.
        let observer = &Quiet(host);
        let mut finer = Finer::default();
        let whole = found.frame.window().whole;
        let pixels = u64::from(whole[0]) * u64::from(whole[1]);
        let parts = PARTS.min(((f64::from(u32::MAX) / pixels as f64).sqrt() * 0.999) as u32);
        if parts > 1 {
            let (few, tiles) = few(found);
            let dark = prepared.with_lights(Lights::default().with_ambient(Vec3::ZERO));
            let settings = settings.clone().with_camera(found.camera.clone());
            let whole = whole.map(|side| side * parts);
            for tile in tiles {
                let crop = Crop::new(tile.first.map(|place| place * parts as i32), tile.size.map(|side| side * parts));
                // Of an image this large, what lies far outside is not rendered.
                if !crop.is_near(whole) {
                    continue;
                }
                let settings = settings.clone().with_size(whole).with_crop(crop);
                finer.add(&few, &renderer.render_prepared(&dark, &settings, observer)?.image, &found.camera);
            }
        }
        finer.thin_out();
        finer.shine(renderer, prepared, (settings, suns), observer)?;
        Ok(finer)
    }

    /// Adds what a part of a larger image shows of some objects.
    fn add(&mut self, few: &BTreeSet<u32>, image: &lightmesh_image::Frame, camera: &lightmesh_scene::Camera) {
        let (Some(layers), window) = (image.layers(), image.window()) else { return };
        let grid = PixelGrid::new(camera, window.whole);
        for (pixel, number) in layers.object.nearest.iter().enumerate() {
            if !few.contains(number) || !layers.depth[pixel].is_finite() {
                continue;
            }
            let width = image.width() as usize;
            let place = [window.first[0] + (pixel % width) as i32, window.first[1] + (pixel / width) as i32];
            let [position, normal] = [layers.position[pixel], layers.normal[pixel]].map(Vec3::from_array);
            let area = f64::from(grid.area(place, layers.depth[pixel], normal));
            self.0.entry(*number).or_default().push(Point { position, normal, area, hours: 0.0 });
        }
    }

    /// Leaves every n-th point of objects that have more than enough.
    fn thin_out(&mut self) {
        for points in self.0.values_mut().filter(|points| points.len() > MOST) {
            let each = points.len().div_ceil(MOST);
            let all: f64 = points.iter().map(|point| point.area).sum();
            *points = points.iter().copied().step_by(each).collect();
            let left: f64 = points.iter().map(|point| point.area).sum();
            points.iter_mut().for_each(|point| point.area *= all / left);
        }
    }

    /// Finds the hours of all points.
    fn shine(
        &mut self,
        renderer: &Renderer,
        prepared: &PreparedScene,
        (settings, suns): (&Settings, &[(Light, f64)]),
        observer: &dyn Observer,
    ) -> Result<(), RenderError> {
        let mut points: Vec<&mut Point> = self.0.values_mut().flatten().collect();
        if points.is_empty() {
            return Ok(());
        }
        let places: Vec<Vec3> = points.iter().map(|point| point.position).collect();
        let normals: Vec<Vec3> = points.iter().map(|point| point.normal).collect();
        let at_once = (BYTES_AT_ONCE / (size_of::<f32>() * points.len())).clamp(1, MAX_AT_ONCE);
        for suns in suns.chunks(at_once) {
            let lights: Lights = suns.iter().map(|(light, _)| light.clone()).collect();
            let lit = prepared.with_lights(lights.with_ambient(Vec3::ZERO));
            let seen = renderer.visibility(&lit, &places, &normals, settings, observer)?;
            for (light, &(_, time)) in suns.iter().enumerate() {
                let add = |(point, &share): (&mut &mut Point, &f32)| point.hours += time * f64::from(share);
                points.iter_mut().zip(seen.of_light(light)).for_each(add);
            }
        }
        Ok(())
    }
}

/// The objects that some pixels show, but not enough of them, and the parts of the image in which these pixels are.
fn few(found: &SunHours) -> (BTreeSet<u32>, Vec<Crop>) {
    let (nearest, window) = (&found.layers().object.nearest, found.frame.window());
    let mut pixels: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (pixel, &number) in nearest.iter().enumerate().filter(|&(pixel, &number)| number > 0 && found.sees(pixel)) {
        let pixels = pixels.entry(number).or_default();
        if pixels.len() < ENOUGH as usize {
            pixels.push(pixel);
        }
    }
    pixels.retain(|_, pixels| pixels.len() < ENOUGH as usize);
    let [width, height] = [found.frame.width(), found.frame.height()];
    let tile = |pixel: usize| [pixel as u32 / width / TILE, pixel as u32 % width / TILE];
    let tiles: BTreeSet<[u32; 2]> = pixels.values().flatten().map(|&pixel| tile(pixel)).collect();
    let crop = |[row, column]: [u32; 2]| {
        let [x, y] = [column * TILE, row * TILE];
        Crop::new([window.first[0] + x as i32, window.first[1] + y as i32], [TILE.min(width - x), TILE.min(height - y)])
    };
    (pixels.into_keys().collect(), tiles.into_iter().map(crop).collect())
}
