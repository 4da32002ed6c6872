//! Hours of direct sun in colours, with a legend.
//!
//! Colours are those of the scale, not shaded: they can be compared with it. Forms are told by thin lines, where surfaces end or meet at an
//! angle. Where there is no surface, the image is grey.

use glam::Vec3;
use lightmesh_image::{Frame, Transfer};
use lightmesh_render::Glass;

use super::colors::viridis;
use super::found::SunHours;
use super::legend::Canvas;
use super::pixel_area::PixelGrid;
use crate::sun::SunStudy;
use crate::value::clock;

/// Where there is no surface.
const NOTHING: [u8; 3] = [200; 3];
/// Surfaces meet at an angle if the cosine between their normals is less: 30 degrees.
const CREASE: f32 = 0.866;
/// One surface ends before another if their distance is more than this many pixels.
const STEP: f32 = 4.0;
/// Leaves have lines everywhere, which show nothing: there are none where more pixels than this share are on one.
const CROWDED: f32 = 0.3;
/// Pixels on each side that such a share is of. Fewer than one more are dots, and no line.
const AROUND: usize = 3;

/// The image with its legend.
pub(super) fn picture(found: &SunHours, study: &SunStudy) -> Frame {
    // The scale of a night is that of all the time.
    let all = f64::from(study.spec.to - study.spec.from) / 60.0;
    let most = Some(study.hours()).filter(|&hours| hours > 0.0).unwrap_or(all);
    let edges = edges(found);
    let code = |pixel: usize| match found.sees(pixel) {
        _ if edges[pixel] => [0; 3],
        true => viridis(f64::from(found.hours[pixel]) / most),
        false => NOTHING,
    };
    let codes = (0..found.hours.len()).map(code).collect();
    let canvas = Canvas::new(found.frame.width() as usize, codes).with_legend(most, &caption(study, found.glass));
    let ([width, height], codes) = canvas.into_codes();
    let colors = codes.iter().map(|code| code.map(|channel| Transfer::Srgb.decode(channel))).collect();
    Frame::new(width as u32, height as u32, colors).expect("a canvas has pixels")
}

pub(super) fn caption(study: &SunStudy, glass: Option<Glass>) -> String {
    let spec = &study.spec;
    let zone = match spec.offset {
        0 => "UTC".to_owned(),
        _ => format!("UTC{}", spec.zone()),
    };
    let side = |degrees: f64, [positive, negative]: [&str; 2]| {
        format!("{} {}", degrees.abs(), if degrees < 0.0 { negative } else { positive })
    };
    let step = spec.step.map_or(String::new(), |step| format!(", every {step} min"));
    let glass = glass.map_or(String::new(), |glass| format!(" Glass is {}. {}.", glass.name(), glass.help()));
    format!(
        "Direct sun on {}, {}-{} ({zone}), at {} {}{step}.{glass} Grey: no surface.",
        spec.date(),
        clock(spec.from),
        clock(spec.to),
        side(spec.latitude, ["N", "S"]),
        side(spec.longitude, ["E", "W"]),
    )
}

/// Pixels at the end of the nearer of two surfaces, or where surfaces meet at an angle.
fn edges(found: &SunHours) -> Vec<bool> {
    let (layers, width) = (found.layers(), found.frame.width() as usize);
    let height = found.hours.len() / width;
    let grid = PixelGrid::new(&found.camera, found.frame.window().whole);
    let mut edges = vec![false; found.hours.len()];
    for pixel in 0..found.hours.len() {
        let (column, row) = (pixel % width, pixel / width);
        let neighbours = [(column + 1 < width).then_some(pixel + 1), (row + 1 < height).then_some(pixel + width)];
        for other in neighbours.into_iter().flatten() {
            let [depth, beyond] = [pixel, other].map(|pixel| layers.depth[pixel]);
            let nearer = if depth <= beyond { pixel } else { other };
            let apart = match (depth.is_finite(), beyond.is_finite()) {
                (true, true) => {
                    let [normal, normal_there] = [pixel, other].map(|pixel| Vec3::from_array(layers.normal[pixel]));
                    let [from, to] = [pixel, other].map(|pixel| Vec3::from_array(layers.position[pixel]));
                    let off = (to - from).dot(normal).abs().min((to - from).dot(normal_there).abs());
                    normal.dot(normal_there) < CREASE || off > STEP * grid.side(depth.min(beyond))
                }
                (seen, seen_there) => seen != seen_there,
            };
            edges[nearer] |= apart;
        }
    }
    let is_line = |pixel: usize| {
        let (column, row) = (pixel % width, pixel / width);
        let rows = row.saturating_sub(AROUND)..(row + AROUND + 1).min(height);
        let columns = column.saturating_sub(AROUND)..(column + AROUND + 1).min(width);
        let all = (rows.len() * columns.len()) as f32;
        let on: usize =
            rows.map(|row| edges[row * width..][columns.clone()].iter().filter(|edge| **edge).count()).sum();
        on > AROUND && on as f32 <= CROWDED * all
    };
    (0..edges.len()).map(|pixel| edges[pixel] && is_line(pixel)).collect()
}
