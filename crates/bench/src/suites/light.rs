//! What light costs: each row of the experiment `light` is measured in turns with a plainer one.
//!
//! Rows have the keys scene, size, `cost`, `with`, accel, device and threads. Times are those of the default settings; values besides counts are
//! `lights`, and `time_by_plain`, the time by that of the plainer row. The costs are
//!
//! * `cut-outs`: materials that an image cuts out, against the same ones opaque. A scene has its own, or else leaves, ivy, grass and petals, or
//!   all materials if it has none of these, get round holes of a size that is found all over the scene;
//! * `mirrors`: five bounces where everything mirrors a tenth, against five bounces without any mirror;
//! * `gathered light`: a clear sky with gathered light, against the same sky as a constant;
//! * `lamps`: a thousand emissive bulbs as the only light, against ten.

use std::time::Duration;

use lightmesh::glam::{Vec2, Vec3};
use lightmesh::render::{AmbientSource, PreparedScene};
use lightmesh::scene::{Lights, Material, Opacity, OpacityChannel, OpacityMode, Texture, TextureUse};
use lightmesh::{Acceleration, Observer, Scene, Settings};

use super::flight::under_a_sky;
use super::subjects::{self, Subject};
use super::turns::Turns;
use crate::engine::{self, Engine};
use crate::measure::{Silent, Variant};
use crate::{BenchError, Findings, LIGHT, Plan, Row};

/// Pixels along a side, and in the short version.
const SIDES: [u32; 2] = [512, 192];
/// Pixels along a side of the first image of a variant.
const WARM_UP: u32 = 32;
/// Mirrors' share, and how often they are followed.
const MIRRORS: f32 = 0.1;
const BOUNCES: u32 = 5;
/// Bulbs: few and many.
const BULBS: [usize; 2] = [10, 1000];
/// The radius of a bulb, relative to the scene's diagonal.
const BULB: f32 = 1e-3;
/// The distance of holes, relative to the scene's diagonal.
const HOLES: f32 = 1.0 / 600.0;
/// Texels along a side of the image with a hole.
const TEXELS: u32 = 32;
/// What grows and has an outline.
const FOLIAGE: [&str; 4] = ["leaf", "ivy", "grass", "petal"];

/// A scene with its settings, and what it has.
struct Side {
    with: &'static str,
    scene: Scene,
    settings: Settings,
}

/// The plainer side, and the other.
struct Cost {
    name: &'static str,
    sides: [Side; 2],
}

pub(super) fn run(plan: &Plan, observer: &dyn Observer, findings: &mut Findings) -> Result<(), BenchError> {
    let engines = engine::engines(plan)?;
    findings.devices = engines.iter().map(|engine| engine.device.clone()).collect();
    let side = plan.side_or(SIDES);
    subjects::each(plan, observer, |subject, share| {
        let costs = costs(&subject.scene)?;
        let share = share / (costs.len() * engines.len()) as u32;
        for cost in &costs {
            observer.note(cost.name);
            cost.measure((subject, side), &engines, (plan, share), observer, findings)?;
        }
        Ok(())
    })
}

fn costs(scene: &Scene) -> Result<[Cost; 4], BenchError> {
    let side = |with, scene: Scene, settings: Settings| Side { with, scene, settings };
    let usual = Settings::default;
    let [opaque, cut] = opaque_and_cut_out(scene);
    let [plain, mirrors] = [0.0, MIRRORS].map(|ks| mirroring(scene, ks));
    let sky = under_a_sky(scene)?;
    let [few, many] = BULBS.map(|count| lit_by_bulbs(scene, count));
    let bounces = || usual().with_bounces(BOUNCES);
    let light = |source| usual().with_ambient_light(source);
    let (constant, mesh) = (light(AmbientSource::Constant), light(AmbientSource::Mesh));
    Ok([
        Cost { name: "cut-outs", sides: [side("opaque", opaque, usual()), side("cut out", cut, usual())] },
        Cost { name: "mirrors", sides: [side("none", plain, bounces()), side("a tenth", mirrors, bounces())] },
        Cost { name: "gathered light", sides: [side("constant", sky.clone(), constant), side("mesh", sky, mesh)] },
        Cost { name: "lamps", sides: [side("10 bulbs", few, usual()), side("1000 bulbs", many, usual())] },
    ])
}

impl Cost {
    fn measure(
        &self,
        (subject, side): (&Subject, u32),
        engines: &[Engine],
        (plan, share): (&Plan, Duration),
        observer: &dyn Observer,
        findings: &mut Findings,
    ) -> Result<(), BenchError> {
        let prepare = |side: &Side| PreparedScene::new(&side.scene, &Acceleration::Auto, &Silent(observer));
        let prepared = self.sides.iter().map(prepare).collect::<Result<Vec<PreparedScene>, _>>()?;
        for engine in engines {
            let pairs = self.sides.iter().zip(&prepared);
            let variant = |(of, scene): (&Side, _)| {
                let settings = of.settings.clone().with_size([side; 2]);
                Variant { renderer: &engine.renderer, scene, settings }
            };
            let variants: Vec<Variant> = pairs.map(variant).collect();
            // A driver compiles kernels when they are first used: small images first, so that no budget is judged by that.
            for Variant { renderer, scene, settings } in &variants {
                renderer.render_prepared(scene, &settings.clone().with_size([WARM_UP; 2]), &Silent(observer))?;
            }
            let turns = Turns::take(&variants, plan.repetitions, share, observer)?;
            findings.notes.extend(turns.notes(&format!("{} of {}", self.name, subject.name), plan.repetitions));
            let plain = turns.measured[0].median();
            let rows = self.sides.iter().zip(&prepared).zip(&turns.measured).map(|((of, scene), measured)| {
                let keys = [
                    ("scene", subject.name.as_str().into()),
                    ("size", f64::from(side).into()),
                    ("cost", self.name.into()),
                    ("with", of.with.into()),
                    ("accel", scene.geometry.accelerator.name().into()),
                ];
                let mut row = Row::new(LIGHT, keys.into_iter().chain(engine.keys()));
                measured.fill(&mut row);
                row.values.insert("lights".to_owned(), scene.scene.lights.len() as f64);
                if plain > 0.0 {
                    row.values.insert("time_by_plain".to_owned(), measured.median() / plain);
                }
                row
            });
            findings.add(rows.collect::<Vec<_>>());
        }
        Ok(())
    }
}

/// The scene without its cut-outs, and with them; some are made if it has none.
fn opaque_and_cut_out(scene: &Scene) -> [Scene; 2] {
    let is_cut_out =
        |material: &Material| material.opacity.is_some_and(|opacity| matches!(opacity.mode, OpacityMode::Mask { .. }));
    let (mut opaque, mut cut) = (scene.clone(), scene.clone());
    if !scene.geometry.materials.iter().any(is_cut_out) {
        cut_holes(&mut cut);
    }
    for material in opaque.geometry_mut().materials.iter_mut().filter(|material| is_cut_out(material)) {
        material.opacity = None;
    }
    [opaque, cut]
}

/// Cuts round holes, which fill two fifths, into foliage, or into everything.
fn cut_holes(scene: &mut Scene) {
    let size = HOLES * scene.geometry.mesh.bounds().diagonal();
    let geometry = scene.geometry_mut();
    let is_solid = |x: u32, y: u32| {
        let [x, y] = [x, y].map(|at| (2.0 * at as f32 + 1.0) / TEXELS as f32 - 1.0);
        x * x + y * y > 0.51
    };
    let texels =
        (0..TEXELS * TEXELS).map(|texel| [255, 255, 255, 255 * u8::from(is_solid(texel % TEXELS, texel / TEXELS))]);
    geometry.textures.push(Texture { name: "hole".into(), size: [TEXELS; 2], texels: texels.collect() });
    let uses = TextureUse::new(geometry.textures.len() as u32 - 1);
    let opacity = Opacity::by(uses, OpacityChannel::Alpha).with_cutoff(0.5);
    let is_foliage = |material: &Material| FOLIAGE.iter().any(|part| material.name.contains(part));
    let all = !geometry.materials.iter().any(is_foliage);
    for material in geometry.materials.iter_mut().filter(|material| all || is_foliage(material)) {
        material.opacity = Some(opacity);
    }
    let mesh = &mut geometry.mesh;
    if mesh.uvs.is_empty() {
        // No plane that matters is seen from its edge by both.
        let place = |p: &Vec3| Vec2::new(p.x + 0.37 * p.y, p.z + 0.61 * p.y) / size;
        mesh.uvs = mesh.positions.iter().map(place).collect();
    }
}

/// The scene with one specular coefficient everywhere.
fn mirroring(scene: &Scene, ks: f32) -> Scene {
    let mut scene = scene.clone();
    for material in &mut scene.geometry_mut().materials {
        (material.ks, material.ks_tinted) = (Vec3::splat(ks), Vec3::ZERO);
    }
    scene
}

/// The scene with no other light than that of bulbs, which are eight-sided and hang in its upper half.
fn lit_by_bulbs(scene: &Scene, count: usize) -> Scene {
    let mut scene = scene.clone();
    scene.lights = Lights::default();
    let bounds = scene.geometry.mesh.bounds();
    let radius = BULB * bounds.diagonal();
    let geometry = scene.geometry_mut();
    let shines = Material::matt(Vec3::ZERO).with_emission(Vec3::splat(50.0)).named("bulb");
    geometry.materials.push(shines);
    let material = geometry.materials.len() as u32 - 1;
    let mesh = &mut geometry.mesh;
    for bulb in 1..=count {
        let place = Vec3::new(radical_inverse(bulb, 2), 0.5 + 0.5 * radical_inverse(bulb, 5), radical_inverse(bulb, 3));
        let middle = bounds.min + place * bounds.extent();
        let first = mesh.positions.len() as u32;
        let corners = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
        mesh.positions.extend(corners.map(|corner| middle + radius * corner));
        for side in 0..8 {
            let [x, y, z] = [0, 1, 2].map(|axis| first + 2 * axis + (side >> axis & 1));
            // Counter-clockwise from outside: each corner on the other side of its axis turns the triangle over.
            mesh.triangles.push(if side.count_ones() % 2 == 0 { [x, y, z] } else { [x, z, y] });
            mesh.materials.push(material);
        }
    }
    // What vertices have beside a position, they have all or none.
    let all = mesh.positions.len();
    if !mesh.normals.is_empty() {
        mesh.normals.resize(all, Vec3::ZERO);
    }
    if !mesh.uvs.is_empty() {
        mesh.uvs.resize(all, Vec2::ZERO);
    }
    if !mesh.colors.is_empty() {
        mesh.colors.resize(all, Vec3::ONE);
    }
    if !mesh.opacities.is_empty() {
        mesh.opacities.resize(all, 1.0);
    }
    scene.add_lamps();
    scene
}

/// The digits of a number behind the point, in reverse: evenly spread over [0, 1).
fn radical_inverse(mut number: usize, base: usize) -> f32 {
    let (mut sum, mut weight) = (0.0, 1.0 / base as f32);
    while number > 0 {
        sum += weight * (number % base) as f32;
        (number, weight) = (number / base, weight / base as f32);
    }
    sum
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use lightmesh::Device;
    use lightmesh::render::Unobserved;

    use super::*;
    use crate::{Key, WHOLE};

    fn found(plan: Plan) -> Findings {
        let scenes = vec![PathBuf::from("builtin:gazebo")];
        let plan = Plan { device: Device::Cpu, threads: Some(2), scenes, size: Some(16), repetitions: 2, ..plan };
        let mut findings = Findings::default();
        run(&plan, &Unobserved, &mut findings).unwrap();
        findings
    }

    #[test]
    fn each_cost_has_a_plain_row_and_another() {
        let findings = found(Plan::new(true));
        assert_eq!((findings.rows.len(), findings.notes.len()), (8, 0), "{:?}", findings.notes);
        for pair in findings.rows.chunks(2) {
            assert_eq!(pair[0].values["time_by_plain"], 1.0);
            assert!(pair[1].values["time_by_plain"] > 0.0 && pair[1].seconds[WHOLE].0.len() == 2, "{pair:?}");
        }
        let value = |with: &str, name: &str| {
            let row = findings.rows.iter().find(|row| row.keys["with"] == Key::from(with)).unwrap();
            row.values.get(name).copied().unwrap_or(0.0)
        };
        assert!(value("a tenth", "rays") > 1.5 * value("none", "rays"));
        assert!(value("mesh", "gather_rays") > 1000.0 && value("constant", "gather_rays") == 0.0);
        assert_eq!((value("10 bulbs", "lights"), value("1000 bulbs", "lights")), (40.0, 128.0));
    }

    #[test]
    fn holes_are_cut_into_leaves_unless_there_are_any() {
        let garden = Scene::open("builtin:garden").unwrap();
        let [opaque, cut] = opaque_and_cut_out(&garden);
        let count = |scene: &Scene| scene.geometry.materials.iter().filter(|one| one.opacity.is_some()).count();
        assert_eq!((count(&opaque), &opaque.geometry.materials), (0, &garden.geometry.materials));
        assert!((10..garden.geometry.materials.len()).contains(&count(&cut)), "{}", count(&cut));
        // Again: those that are there.
        let [opaque, same] = opaque_and_cut_out(&cut);
        assert_eq!((count(&opaque), &same.geometry.materials), (0, &cut.geometry.materials));
    }

    #[test]
    fn bulbs_shine_outwards() {
        let garden = Scene::open("builtin:garden").unwrap();
        let lit = lit_by_bulbs(&garden, 3);
        let bounds = garden.geometry.mesh.bounds();
        assert_eq!((lit.lights.len(), lit.geometry.mesh.bounds()), (24, bounds));
        let mesh = &lit.geometry.mesh;
        for index in garden.geometry.mesh.triangles.len()..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(index);
            let bulb = (index - garden.geometry.mesh.triangles.len()) / 8;
            let start = garden.geometry.mesh.positions.len() + 6 * bulb;
            let middle = (mesh.positions[start] + mesh.positions[start + 1]) * 0.5;
            assert!((b - a).cross(c - a).dot(a - middle) > 0.0, "{index}");
        }
    }
}
