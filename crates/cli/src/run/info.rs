//! `lightmesh info`.

use std::path::PathBuf;

use lightmesh::render::{DeviceReport, devices};
use lightmesh::request::cluster::files_of;
use lightmesh::request::{format_of, load_options};
use lightmesh::scene::{SceneFormat, Up, UpInfo};
use lightmesh_files::visible;
use serde::Serialize;

use super::open::read;
use crate::args::InfoArgs;
use crate::failure::Failure;
use crate::output::{self, OutputError};

#[derive(Serialize)]
struct Files<'a> {
    files: &'a [PathBuf],
}

#[derive(Serialize)]
struct Devices {
    devices: Vec<DeviceReport>,
}

pub(super) fn run(args: &InfoArgs) -> Result<(), Failure> {
    let printed = match &args.scene {
        Some(path) => {
            let request = args.reading.request();
            let options = load_options(&request, args.smooth.0, args.instances);
            let scene = read((path, request.scene_format), &options)?;
            if args.files {
                return Ok(print_files(&files_of(&scene, path, request.allow_outside), args.json)?);
            }
            let mut info = scene.info();
            info.up.get_or_insert_with(|| usual_up(format_of(path, request.scene_format)));
            if args.json {
                output::print_json(&info)
            } else {
                output::print(&format!("scene   {}\n{info}", visible(&scene.name)))
            }
        }
        None if args.json => output::print_json(&Devices { devices: devices() }),
        None => output::print(&devices().iter().map(device_line).collect::<String>()),
    };
    Ok(printed?)
}

/// Names are printed as they are, for other programs.
fn print_files(files: &[PathBuf], as_json: bool) -> Result<(), OutputError> {
    if as_json {
        return output::print_json(&Files { files });
    }
    output::print_paths(files)
}

/// For scenes whose geometry does not indicate it.
fn usual_up(format: Option<SceneFormat>) -> UpInfo {
    let kind = format.map_or_else(|| "built-in scenes".to_owned(), |format| format!(".{format} files"));
    UpInfo {
        axis: format.map_or(Up::Y, SceneFormat::usual_up).name(),
        reason: format!("its shape gives no indication, and it is the usual axis of {kind}"),
    }
}

fn device_line(DeviceReport { device, name, usable, remark, .. }: &DeviceReport) -> String {
    let state = if *usable { "usable" } else { "not usable" };
    let facts: Vec<&str> = [name.as_str(), remark].into_iter().filter(|fact| !fact.is_empty()).collect();
    format!("{device:8}{state}: {}\n", facts.join(", "))
}
