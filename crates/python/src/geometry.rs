//! Triangles from arrays.

use std::sync::Arc;

use glam::{DMat4, DVec3, Vec2, Vec3};
use lightmesh::scene::{self, GeometryError, Instancing, MeshPart, SceneBuilder};
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::argument::Given;
use crate::convert::{self, Points};
use crate::errors::{self, OrRaise};
use crate::material::Material;
use crate::stored::{self, Reduced};
use crate::texture::Album;

/// If copies of objects in many places have more triangles in all, they are stored once: rays take longer then.
const MAX_COPIED: usize = 1 << 20;

/// Triangles with materials, in one place or many.
#[pyclass(frozen, from_py_object, module = "lightmesh")]
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Geometry {
    arrays: Arc<Arrays>,
    places: Vec<DMat4>,
    name: String,
}

/// What places share.
#[derive(Serialize, Deserialize)]
struct Arrays {
    positions: Points,
    #[serde(with = "scene::packed")]
    normals: Vec<Vec3>,
    #[serde(with = "scene::packed")]
    uvs: Vec<Vec2>,
    #[serde(with = "scene::packed")]
    colors: Vec<Vec3>,
    #[serde(with = "scene::packed")]
    triangles: Vec<[u32; 3]>,
    materials: Vec<Material>,
    /// By triangle; empty: the first.
    indices: Vec<u32>,
}

#[pymethods]
impl Geometry {
    /// An object.
    ///
    /// `vertices`: (V, 3) `float32` or `float64`, scene units. `triangles`: (T, 3) indices of vertices, counterclockwise seen from the front.
    /// `normals`: (V, 3), need not be of unit length; `None`: flat. `uvs`: (V, 2), origin in the upper left corner of the image, as in glTF.
    /// `colors`: (V, 3), linear, tint the material; those of `uint8` are shares of 255. `material` is that of all triangles; or `materials` is a list,
    /// and `material_indices`, (T,), says which each triangle has. `transforms`: (4, 4), or (N, 4, 4) for N places, in which the object
    /// is stored once; they are applied to column vectors, and end in the row 0, 0, 0, 1. `name` is that of the object.
    ///
    /// Raises `GeometryError` for indices out of range and lengths that do not match.
    #[staticmethod]
    #[pyo3(
        signature = (
            vertices, triangles, *, normals = None, uvs = None, colors = None, material = None, materials = None,
            material_indices = None, transforms = None, name = Given(String::new())
        ),
        text_signature = "(vertices, triangles, *, normals=None, uvs=None, colors=None, material=None, materials=None, material_indices=None, \
            transforms=None, name='')"
    )]
    #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
    fn from_arrays(
        vertices: &Bound<'_, PyAny>,
        triangles: &Bound<'_, PyAny>,
        normals: Option<&Bound<'_, PyAny>>,
        uvs: Option<&Bound<'_, PyAny>>,
        colors: Option<&Bound<'_, PyAny>>,
        material: Option<Given<Material>>,
        materials: Option<Given<Vec<Material>>>,
        material_indices: Option<&Bound<'_, PyAny>>,
        transforms: Option<&Bound<'_, PyAny>>,
        name: Given<String>,
    ) -> PyResult<Geometry> {
        let materials = match (material, materials) {
            (Some(_), Some(_)) => return Err(errors::setting("give material or materials, not both")),
            (Some(Given(one)), None) => vec![one],
            (None, Some(many)) if many.0.is_empty() => {
                return Err(errors::geometry("materials is empty: give one at least"));
            }
            (None, Some(Given(many))) => many,
            (None, None) => vec![Material::default_matt()],
        };
        let arrays = Arrays {
            positions: convert::points("vertices", vertices)?,
            triangles: convert::triangles("triangles", triangles)?,
            normals: normals.map_or(Ok(Vec::new()), |array| convert::vectors("normals", array))?,
            uvs: uvs.map_or(Ok(Vec::new()), |array| convert::pairs("uvs", array))?,
            colors: colors.map_or(Ok(Vec::new()), |array| convert::colors("colors", array))?,
            indices: material_indices.map_or(Ok(Vec::new()), |array| convert::list("material_indices", array))?,
            materials,
        };
        arrays.check()?;
        let places = transforms.map_or(Ok(vec![DMat4::IDENTITY]), |array| convert::transforms("transforms", array))?;
        Ok(Geometry { arrays: arrays.into(), places, name: name.0 })
    }

    /// As it was given; may be empty.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// In one place.
    #[getter]
    fn vertex_count(&self) -> usize {
        self.arrays.positions.len()
    }

    /// In all places together.
    #[getter]
    fn triangle_count(&self) -> usize {
        self.arrays.triangles.len() * self.places.len()
    }

    /// The same object in other places, which `transforms` say, perhaps with another `name`; its arrays are shared.
    #[pyo3(signature = (transforms, *, name = None))]
    fn placed(&self, transforms: &Bound<'_, PyAny>, name: Option<Given<String>>) -> PyResult<Geometry> {
        let places = convert::transforms("transforms", transforms)?;
        Ok(Geometry { places, name: name.map_or_else(|| self.name.clone(), |name| name.0), ..self.clone() })
    }

    /// For `pickle`.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Reduced<'py>> {
        stored::reduce(py, "Geometry", self)
    }

    /// It never changes: a copy is the same.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __repr__(&self) -> String {
        let (triangles, places) = (self.arrays.triangles.len(), self.places.len());
        let places = if places == 1 { String::new() } else { format!(" in {places} places") };
        format!("<lightmesh.Geometry {:?}, {triangles} triangles{places}>", self.name)
    }
}

impl Arrays {
    /// What the builder does not check.
    fn check(&self) -> PyResult<()> {
        let triangles = self.triangles.len();
        if !self.indices.is_empty() && self.indices.len() != triangles {
            let found = self.indices.len();
            return Err(GeometryError::MaterialCount { found, triangles }).or_raise();
        }
        let materials = self.materials.len();
        if let Some((triangle, &index)) = (0..).zip(&self.indices).find(|(_, index)| **index as usize >= materials) {
            return Err(GeometryError::Material { triangle, index, materials }).or_raise();
        }
        if self.uvs.is_empty() && triangles > 0 && self.materials.iter().any(Material::has_images) {
            return Err(errors::geometry(
                "a material has an image, but there are no uvs to place it: give uvs, (V, 2)",
            ));
        }
        let vertices = self.positions.len();
        let attributes = [("normals", self.normals.len()), ("uvs", self.uvs.len()), ("colors", self.colors.len())];
        let differs = |&(_, found): &(&str, usize)| found != 0 && found != vertices;
        if let Some((attribute, found)) = attributes.into_iter().find(differs) {
            return Err(GeometryError::Attribute { attribute, found, vertices }).or_raise();
        }
        let bad = self.triangles.iter().position(|corners| corners.iter().any(|&index| index as usize >= vertices));
        match bad {
            None => Ok(()),
            Some(triangle) => {
                let index = self.triangles[triangle].into_iter().max().unwrap_or_default();
                Err(GeometryError::Vertex { triangle, index, vertices }).or_raise()
            }
        }
    }

    fn part<'a, P>(&'a self, positions: &'a [P]) -> MeshPart<'a, P> {
        MeshPart {
            positions,
            normals: &self.normals,
            uvs: &self.uvs,
            colors: &self.colors,
            triangles: &self.triangles,
            ..MeshPart::default()
        }
    }

    fn material(&self, first: u32, triangle: usize) -> u32 {
        first + self.indices.get(triangle).copied().unwrap_or(0)
    }
}

/// A scene of these objects alone, which are stored once for all their places if `instancing` says so.
pub(crate) fn scene(name: &str, objects: &[Geometry], instancing: Instancing) -> Result<scene::Scene, GeometryError> {
    let many = objects.iter().filter(|object| object.places.len() > 1);
    let copied: usize = many.map(Geometry::triangle_count).sum();
    let is_stored_once = match instancing {
        Instancing::Auto => copied > MAX_COPIED,
        Instancing::Always => true,
        Instancing::Never => false,
    };
    let (mut builder, mut album) = (SceneBuilder::new(), Album::default());
    for object in objects {
        let first = builder.material_count();
        let arrays = &*object.arrays;
        arrays.materials.iter().for_each(|material| {
            builder.add_material(material.build(&mut album));
        });
        let material = |triangle| arrays.material(first, triangle);
        if is_stored_once && object.places.len() > 1 {
            let stored = match &arrays.positions {
                Points::Single(positions) => {
                    builder.add_instances(arrays.part(positions), &object.places, &object.name, material)
                }
                Points::Double(positions) => {
                    builder.add_instances(arrays.part(positions), &object.places, &object.name, material)
                }
            };
            match stored {
                // What is squeezed flat somewhere is copied.
                Err(GeometryError::Place { .. }) => {}
                other => {
                    other?;
                    continue;
                }
            }
        }
        for place in &object.places {
            builder.begin_object(object.name.as_str());
            match &arrays.positions {
                Points::Single(positions) => builder.add(arrays.part::<Vec3>(positions), place, material)?,
                Points::Double(positions) => builder.add(arrays.part::<DVec3>(positions), place, material)?,
            }
        }
    }
    let mut scene = builder.finish_scene(name);
    scene.geometry_mut().textures = album.into_images().into();
    Ok(scene)
}
