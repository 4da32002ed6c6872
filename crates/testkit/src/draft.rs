//! Scenes assembled by hand, in world coordinates.

use glam::{DMat4, DVec3, Vec3};
use lightmesh_scene::{Camera, Falloff, Fov, Light, LightKind, Material, MeshPart, Projection, Scene, SceneBuilder};

/// A scene under construction. Everything is specified near the world's origin and moved by an offset when the scene is finished.
///
/// Ambient light and background are black unless they are set.
#[derive(Debug)]
pub struct SceneDraft {
    builder: SceneBuilder,
    offset: DVec3,
    materials: Vec<Material>,
    lights: Vec<Light>,
    camera: Option<(DVec3, DVec3, Projection)>,
    ambient: Vec3,
    background: Vec3,
}

impl Default for SceneDraft {
    fn default() -> SceneDraft {
        SceneDraft::new()
    }
}

impl SceneDraft {
    /// An empty scene at the world's origin.
    pub fn new() -> SceneDraft {
        SceneDraft {
            builder: SceneBuilder::new(),
            offset: DVec3::ZERO,
            materials: vec![Material::default()],
            lights: Vec::new(),
            camera: None,
            ambient: Vec3::ZERO,
            background: Vec3::ZERO,
        }
    }

    /// Moves the whole scene, camera and lights included. Before the first triangle.
    pub fn moved(self, offset: DVec3) -> SceneDraft {
        assert_eq!(self.builder.triangle_count(), 0, "a draft is moved before it has triangles");
        SceneDraft { offset, ..self }
    }

    /// Subsequent triangles have this material.
    pub fn painted(mut self, material: Material) -> SceneDraft {
        self.materials.push(material);
        self
    }

    /// Adds triangles that share vertices.
    pub fn triangles(mut self, positions: &[DVec3], triangles: &[[u32; 3]]) -> SceneDraft {
        let material = self.materials.len() as u32 - 1;
        let part = MeshPart { positions, triangles, ..Default::default() };
        let added = self.builder.add(part, &DMat4::from_translation(self.offset), |_| material);
        added.unwrap_or_else(|error| panic!("{error}"));
        self
    }

    /// Adds a ball of `2 · columns · (rings − 1)` triangles with the normals of a sphere.
    pub fn smooth_ball(mut self, center: DVec3, radius: f64, [rings, columns]: [u32; 2]) -> SceneDraft {
        let vertex = |ring: u32, column: u32| {
            let up = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
            let around = std::f64::consts::TAU * f64::from(column) / f64::from(columns);
            DVec3::new(up.sin() * around.cos(), up.cos(), up.sin() * around.sin())
        };
        let ways: Vec<DVec3> =
            (0..=rings).flat_map(|ring| (0..columns).map(move |column| vertex(ring, column))).collect();
        let positions: Vec<DVec3> = ways.iter().map(|way| center + radius * way).collect();
        let normals: Vec<Vec3> = ways.iter().map(|way| way.as_vec3().normalize()).collect();
        let mut triangles = Vec::new();
        for ring in 0..rings {
            for column in 0..columns {
                let place = |ring: u32, column: u32| ring * columns + column % columns;
                let [a, b] = [place(ring, column), place(ring, column + 1)];
                let [c, d] = [place(ring + 1, column), place(ring + 1, column + 1)];
                if ring > 0 {
                    triangles.push([a, b, c]);
                }
                if ring < rings - 1 {
                    triangles.push([b, d, c]);
                }
            }
        }
        let material = self.materials.len() as u32 - 1;
        let part = MeshPart { positions: &positions, normals: &normals, triangles: &triangles, ..Default::default() };
        let added = self.builder.add(part, &DMat4::from_translation(self.offset), |_| material);
        added.unwrap_or_else(|error| panic!("{error}"));
        self
    }

    /// Adds a planar quadrilateral, corners in order around its border.
    pub fn quad(self, corners: [[f64; 3]; 4]) -> SceneDraft {
        self.triangles(&corners.map(DVec3::from), &[[0, 1, 2], [0, 2, 3]])
    }

    /// Adds a horizontal square, `half` to each side of the y axis.
    pub fn floor(self, height: f64, half: f64) -> SceneDraft {
        self.quad([[-half, height, -half], [-half, height, half], [half, height, half], [half, height, -half]])
    }

    /// Adds a closed box whose twelve triangles share eight corners.
    pub fn cuboid(self, min: [f64; 3], max: [f64; 3]) -> SceneDraft {
        let corner = |bits: usize| DVec3::from([0, 1, 2].map(|axis| [min, max][bits >> axis & 1][axis]));
        let corners: [DVec3; 8] = std::array::from_fn(corner);
        let faces = [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];
        let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect::<Vec<[u32; 3]>>();
        self.triangles(&corners, &triangles)
    }

    /// Adds a white light of strength 1 without falloff.
    pub fn light(self, kind: LightKind) -> SceneDraft {
        self.light_of(kind, 1.0, Falloff::None)
    }

    /// Adds a white light.
    pub fn light_of(mut self, kind: LightKind, intensity: f32, falloff: Falloff) -> SceneDraft {
        self.lights.push(Light::new(kind).with_intensity([intensity; 3]).with_falloff(falloff));
        self
    }

    /// Adds a point light without falloff.
    pub fn point_light(self, position: [f32; 3]) -> SceneDraft {
        self.light(LightKind::Point { position: Vec3::from(position), spread: 0.0 })
    }

    /// Looks from `eye` to `target` with a vertical field of view of 50 degrees.
    pub fn camera(self, eye: [f64; 3], target: [f64; 3]) -> SceneDraft {
        self.projected(eye, target, Projection::Perspective(Fov::Vertical(50.0)))
    }

    /// Looks from `eye` to `target` along parallel rays; the image is `height` high.
    pub fn orthographic(self, eye: [f64; 3], target: [f64; 3], height: f32) -> SceneDraft {
        self.projected(eye, target, Projection::Orthographic { height })
    }

    fn projected(mut self, eye: [f64; 3], target: [f64; 3], projection: Projection) -> SceneDraft {
        self.camera = Some((DVec3::from(eye), DVec3::from(target), projection));
        self
    }

    /// I_a of formula (1), on all channels.
    pub fn ambient(self, intensity: f32) -> SceneDraft {
        SceneDraft { ambient: Vec3::splat(intensity), ..self }
    }

    /// Radiance of rays that hit nothing.
    pub fn background(self, radiance: Vec3) -> SceneDraft {
        SceneDraft { background: radiance, ..self }
    }

    /// The scene, in the local frame that the builder chooses.
    pub fn finish(self, name: &str) -> Scene {
        let mut scene = self.builder.finish_scene(name);
        let (offset, origin) = (self.offset, scene.geometry.origin);
        let local = |position: DVec3| (offset + position - origin).as_vec3();
        scene.cameras =
            self.camera.iter().map(|&(eye, target, projection)| camera(local(eye), eye, target, projection)).collect();
        scene.lights.list = self.lights;
        for light in &mut scene.lights {
            if let LightKind::Point { position, .. }
            | LightKind::Spot { position, .. }
            | LightKind::Sphere { position, .. }
            | LightKind::Disk { position, .. }
            | LightKind::Rectangle { position, .. } = &mut light.kind
            {
                *position = local(position.as_dvec3());
            }
        }
        scene.geometry_mut().materials = self.materials;
        scene.lights.ambient = Some(self.ambient);
        scene.lights.background = Some(self.background);
        scene
    }
}

fn camera(position: Vec3, eye: DVec3, target: DVec3, projection: Projection) -> Camera {
    // Seen from above, the image's top is -z, so that x runs to the right.
    let camera = Camera::look_to(position, target - eye, Vec3::Y, 50.0);
    camera.unwrap_or_else(|error| panic!("{error}")).with_projection(projection)
}
