//! `lightmesh info`.

use lightmesh::Scene;
use lightmesh::render::{DeviceReport, devices};
use serde::Serialize;

use crate::args::InfoArgs;
use crate::failure::Failure;
use crate::output;
use crate::report::json;

#[derive(Serialize)]
struct Devices {
    devices: Vec<DeviceReport>,
}

pub(super) fn run(args: &InfoArgs) -> Result<(), Failure> {
    let text = match &args.scene {
        Some(path) => {
            let scene = Scene::open(path)?;
            let info = scene.info();
            if args.json { json(&info) } else { format!("scene   {}\n{info}", scene.name) }
        }
        None if args.json => json(&Devices { devices: devices() }),
        None => devices().iter().map(device_line).collect(),
    };
    Ok(output::print(&text)?)
}

fn device_line(DeviceReport { device, name, usable, remark, .. }: &DeviceReport) -> String {
    let state = if *usable { "usable" } else { "not usable" };
    let facts: Vec<&str> = [name.as_str(), remark].into_iter().filter(|fact| !fact.is_empty()).collect();
    format!("{device:8}{state}: {}\n", facts.join(", "))
}
