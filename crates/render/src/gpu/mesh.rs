//! The records that describe the light mesh and sampling to kernels.

use glam::IVec3;
use lightmesh_kernels::Runtime;
use lightmesh_layout::constants::MAX_REACH;
use lightmesh_layout::mesh::{LightMesh as Record, TemplateRow};
use lightmesh_layout::scene::Sampling;
use lightmesh_scene::Weight;

use super::device::Cuda;
use super::resident::DeviceTemplate;
use crate::error::RenderError;
use crate::light_mesh::LightMesh;
use crate::sync::locked;

/// Modules with a copy of the template in constant memory.
const USERS: [&str; 3] = ["short_tests", "light_points", "interpolate"];

impl<R: Runtime> Cuda<R> {
    /// The light mesh as a record for kernels. Uploads the template if the device holds another one.
    pub(crate) fn mesh(&self, mesh: &LightMesh) -> Result<Record, RenderError> {
        let mut held = locked(&self.template);
        let template = match held.take().filter(|held| held.radius == mesh.template.radius()) {
            Some(template) => template,
            None => self.bring_template(mesh)?,
        };
        let template = held.insert(template);
        Ok(record(mesh, template))
    }

    fn bring_template(&self, mesh: &LightMesh) -> Result<DeviceTemplate<R>, RenderError> {
        let rows = template_rows(mesh);
        let lines = lines(&rows);
        for module in USERS {
            self.set_lines(module, &lines)?;
        }
        let packed: Vec<u32> = rows.iter().map(|row| u32::from(row.bit) | u32::from(row.count) << 16).collect();
        let offsets: Vec<u32> = mesh.template.offsets().iter().map(|&offset| packed_offset(offset)).collect();
        Ok(DeviceTemplate {
            radius: mesh.template.radius(),
            lines: lines.len() as u32,
            offsets: self.pool.upload("template", &offsets)?,
            rows: self.pool.upload("rows of the template", &packed)?,
        })
    }

    /// Copies the template to the constant memory of a module if it is no [user](USERS), which have it: so it is loaded only if it is needed.
    pub(crate) fn bring_lines(&self, module: &'static str, mesh: &LightMesh) -> Result<(), RenderError> {
        if USERS.contains(&module) {
            return Ok(());
        }
        self.set_lines(module, &lines(&template_rows(mesh)))
    }

    fn set_lines(&self, module: &'static str, lines: &[TemplateRow]) -> Result<(), RenderError> {
        let result = self.pool.runtime().constant(module, "template_rows", bytemuck::cast_slice(lines));
        result.map_err(|fault| self.pool.fault(fault).into())
    }
}

/// The rows that have any light points.
fn lines(rows: &[TemplateRow]) -> Vec<TemplateRow> {
    rows.iter().copied().filter(|row| row.count > 0).collect()
}

fn packed_offset(offset: IVec3) -> u32 {
    let [x, y, z] = (offset + MAX_REACH).to_array().map(|i| i as u32);
    x | y << 8 | z << 16
}

/// The lines of the template along x, by z and y starting at 1 − reach.
fn template_rows(mesh: &LightMesh) -> Vec<TemplateRow> {
    let template = &mesh.template;
    let side = 1 - template.reach()..=template.reach();
    let lines = side.clone().flat_map(|z| side.clone().map(move |y| (y, z)));
    lines
        .map(|(y, z)| {
            let bits = template.row(y, z, 1 - template.reach(), template.reach());
            let x = template.offsets().get(bits.start).map_or(0, |offset| offset.x);
            TemplateRow { bit: bits.start as u16, count: bits.len() as u16, x, y, z }
        })
        .collect()
}

fn record<R: Runtime>(mesh: &LightMesh, template: &DeviceTemplate<R>) -> Record {
    Record {
        anchor: mesh.lattice.anchor.to_array().into(),
        step: mesh.lattice.step,
        radius: mesh.radius,
        least_height: mesh.least_height(),
        edge_on: mesh.edge_on(),
        slack: mesh.slack(),
        weight: match mesh.weight {
            Weight::Constant => Record::WEIGHT_CONSTANT,
            Weight::Quadratic => Record::WEIGHT_QUADRATIC,
            Weight::Smooth => Record::WEIGHT_SMOOTH,
        },
        points: mesh.template.len() as u32,
        words: mesh.template.words() as u32,
        reach: mesh.template.reach(),
        number: mesh.lattice.number.to_array(),
        lines: template.lines,
        offsets: template.offsets.input(),
        rows: template.rows.input(),
    }
}

/// The sampling of area lights, as a record for kernels.
pub(crate) fn sampling(sampling: crate::render_context::Sampling) -> Sampling {
    Sampling { seed: sampling.seed, samples: sampling.samples, spread: u32::from(sampling.spread) }
}
